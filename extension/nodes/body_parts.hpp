// What children of a body that say how it feels have in common: HapticMesh and HapticSoftBody. Main thread
// only.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/variant/string.hpp>

namespace tactus {

// Rises whenever one of them comes, goes, moves in its body or becomes another one.
std::uint64_t part_changes();
void note_part_changed();

// What each of them does first with what it is notified of.
void keep_part(godot::Node3D& part, int what);

// The first of the body's; null: it has none.
template <class Part>
Part* part_of(const godot::Node& body) {
    for (int i = 0; i < body.get_child_count(); ++i) {
        if (auto* part = godot::Object::cast_to<Part>(body.get_child(i))) {
            return part;
        }
    }
    return nullptr;
}

// Why nobody touches it, where its parent is a body that it can be a part of: it stands in no world. Empty
// where it does.
godot::String problem_of_part(const godot::Node3D& part);

}  // namespace tactus
