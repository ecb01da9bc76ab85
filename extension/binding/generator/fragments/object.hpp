// Null when the object is null or not a T.
template <class T>
static T* cast_to(Object* p_object) {
    return dynamic_cast<T*>(p_object);
}
template <class T>
static const T* cast_to(const Object* p_object) {
    return dynamic_cast<const T*>(p_object);
}
