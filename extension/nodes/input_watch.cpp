#include "nodes/input_watch.hpp"

#include <godot_cpp/core/object.hpp>

#include "nodes/haptic_device.hpp"
#include "nodes/scene_warnings.hpp"

namespace tactus {

using namespace godot;

void InputWatch::put_into(HapticDevice& device) {
    if (is_edited()) {
        return;
    }
    for (int i = 0; i < device.get_child_count(true); ++i) {
        if (Object::cast_to<InputWatch>(device.get_child(i, true)) != nullptr) {
            return;
        }
    }
    device.add_child(memnew(InputWatch), false, INTERNAL_MODE_BACK);
}

void InputWatch::_unhandled_input(const Ref<InputEvent>& event) {
    if (auto* device = Object::cast_to<HapticDevice>(get_parent()); device != nullptr && event.is_valid()) {
        device->take_input(*event.ptr());
    }
}

}  // namespace tactus
