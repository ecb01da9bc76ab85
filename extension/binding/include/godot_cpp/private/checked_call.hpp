#pragma once

#include <godot_cpp/core/method_bind.hpp>

namespace godot::internal {

// Calls with Variants after filling in defaults and checking number and types; says in `error` what was
// wrong.
void call_checked(const MethodBind& bind, Wrapped* instance, const GDExtensionConstVariantPtr* given,
                  GDExtensionInt count, GDExtensionVariantPtr result, GDExtensionCallError* error);

}  // namespace godot::internal
