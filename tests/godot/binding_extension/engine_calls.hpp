#pragma once

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/core/class_db.hpp>

namespace probe {

// Calls the engine from C++, once for each kind of argument and result.
class BindingEngineCalls : public godot::Node {
    GDCLASS(BindingEngineCalls, godot::Node)

public:
    // Each gives back the expectations that did not hold; this node must be in the tree.
    godot::PackedStringArray values();
    godot::PackedStringArray objects();
    godot::PackedStringArray containers();
    godot::PackedStringArray strings();
    godot::PackedStringArray math();
    godot::PackedStringArray utilities();

protected:
    static void _bind_methods();
};

}  // namespace probe
