// Null when there is no such node, or it is not a T.
template <class T>
T* get_node(const NodePath& p_path) const {
    return Object::cast_to<T>(get_node_internal(p_path));
}
