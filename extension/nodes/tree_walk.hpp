// Ways to nodes: by id, by path, through all that stands below one. Main thread only.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace tactus {

// Null: it is gone, or of another kind.
template <class NodeType>
NodeType* node_of_id(std::uint64_t id) {
    return godot::Object::cast_to<NodeType>(godot::ObjectDB::get_instance(id));
}

// The object of a Variant; null: it holds none, one of another kind, or one that has been freed.
template <class ObjectType>
ObjectType* object_in(const godot::Variant& value) {
    return godot::Object::cast_to<ObjectType>(value.get_validated_object());
}

// It goes when nothing uses it any more; gone already is as well.
inline void free_later(std::uint64_t id) {
    if (auto* const node = node_of_id<godot::Node>(id)) {
        node->queue_free();
    }
}

// Where a path property leads; null: it is empty, leads nowhere, or to another kind.
template <class NodeType>
NodeType* node_at(const godot::Node& from, const godot::NodePath& path) {
    return from.is_inside_tree() && !path.is_empty()
               ? godot::Object::cast_to<NodeType>(from.get_node_or_null(path))
               : nullptr;
}

// Below a node that is scaled to zero there are no places; null: below none.
inline bool has_places(const godot::Node3D* parent) {
    return parent == nullptr || parent->get_global_transform().basis.determinant() != 0;
}

// Through all that stands below a node, parents first.
enum class Walk { on, past, end };  // past: what stands below this one is left out

// Walk visit(Node& node). Answers Walk::end where one of them ended it.
template <class Visit>
Walk walk_below(const godot::Node& node, const Visit& visit) {
    const int count = node.get_child_count();
    for (int i = 0; i < count; ++i) {
        godot::Node& child = *node.get_child(i);
        Walk next = visit(child);
        if (next == Walk::on) {
            next = walk_below(child, visit);
        }
        if (next == Walk::end) {
            return Walk::end;
        }
    }
    return Walk::on;
}

// void visit(Node& node).
template <class Visit>
void for_each_below(const godot::Node& node, const Visit& visit) {
    walk_below(node, [&visit](godot::Node& one) {
        visit(one);
        return Walk::on;
    });
}

// bool is_it(const Node& node). Null: none is.
template <class Condition>
godot::Node* find_below(const godot::Node& node, const Condition& is_it) {
    godot::Node* found = nullptr;
    walk_below(node, [&](godot::Node& one) {
        found = is_it(one) ? &one : nullptr;
        return found != nullptr ? Walk::end : Walk::on;
    });
    return found;
}

}  // namespace tactus
