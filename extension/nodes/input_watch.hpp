// What Godot tells of input, heard for a device. Main thread only.
#pragma once

#include <godot_cpp/classes/input_event.hpp>
#include <godot_cpp/classes/node.hpp>

namespace tactus {

class HapticDevice;

// A child of the device that the scene does not see. A virtual method of the device itself would be replaced
// by the one of a script that the device has.
class InputWatch : public godot::Node {
    GDCLASS(InputWatch, godot::Node)

public:
    // Once; in the editor never.
    static void put_into(HapticDevice& device);

    void _unhandled_input(const godot::Ref<godot::InputEvent>& event) override;

protected:
    static void _bind_methods() {}
};

}  // namespace tactus
