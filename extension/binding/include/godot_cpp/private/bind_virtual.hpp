#pragma once

#include <gdextension_interface.h>

#include <godot_cpp/variant/string_name.hpp>

namespace godot::internal {

template <auto Method>
struct VirtualCall;  // core/method_bind.hpp

void bind_virtual_call(const StringName& class_name, const char* method, GDExtensionClassCallVirtual call);

// Tells the engine that a class of ours overrides one of its virtual methods.
template <auto Method>
void bind_virtual(const StringName& class_name, const char* method) {
    bind_virtual_call(class_name, method, &VirtualCall<Method>::call);
}

}  // namespace godot::internal
