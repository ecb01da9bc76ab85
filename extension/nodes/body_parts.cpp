#include "nodes/body_parts.hpp"

#include "nodes/haptic_world.hpp"
#include "nodes/scene_warnings.hpp"

namespace tactus {

using namespace godot;

namespace {

std::uint64_t change_count = 0;

}  // namespace

std::uint64_t part_changes() {
    return change_count;
}

void note_part_changed() {
    ++change_count;
}

void keep_part(Node3D& part, int what) {
    switch (what) {
        case Node3D::NOTIFICATION_ENTER_TREE:
            part.set_notify_local_transform(true);
            watch_warnings(part);
            note_part_changed();
            break;
        case Node3D::NOTIFICATION_EXIT_TREE:
        case Node3D::NOTIFICATION_LOCAL_TRANSFORM_CHANGED:
            note_part_changed();
            break;
        default:
            break;
    }
}

String problem_of_part(const Node3D& part) {
    return part.is_inside_tree() && HapticWorld::above(&part) == nullptr
               ? String("its body stands outside of every HapticWorld: put the body below one")
               : String();
}

}  // namespace tactus
