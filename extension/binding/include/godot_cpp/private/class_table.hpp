#pragma once

#include <gdextension_interface.h>

#include <cstddef>

namespace godot::internal {

// The engine classes that have a wrapper here, by name in alphabetical order.
struct EngineClass {
    const char* name;
    const GDExtensionInstanceBindingCallbacks* callbacks;
};

extern const EngineClass engine_classes[];
extern const size_t engine_class_count;

}  // namespace godot::internal
