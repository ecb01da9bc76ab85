#pragma once

// Calls with any number of Variants.

#include <godot_cpp/private/ptrcall.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <vector>

namespace godot::internal {

Variant call_vararg_engine_method(GDExtensionMethodBindPtr method, GodotObject* self, const Variant* values,
                                  size_t count);

template <class R, class Invoke>
R call_vararg(const Invoke& invoke, const Variant* values, size_t count) {
    std::vector<const void*> pointers(count);
    for (size_t i = 0; i < count; ++i) {
        pointers[i] = values + i;
    }
    if constexpr (std::is_void_v<R>) {
        invoke(pointers.data(), nullptr);
    } else {
        typename PtrArg<R>::Slot slot{};
        invoke(pointers.data(), &slot);
        return PtrArg<R>::take(slot);
    }
}

template <class R>
R call_vararg_builtin(GDExtensionPtrBuiltInMethod method, const void* self, const Variant* values,
                      size_t count) {
    return call_vararg<R>(
        [&](const void* const* pointers, void* result) {
            method(const_cast<void*>(self), pointers, result, static_cast<int32_t>(count));
        },
        values, count);
}

template <class R>
R call_vararg_utility(GDExtensionPtrUtilityFunction function, const Variant* values, size_t count) {
    return call_vararg<R>([&](const void* const* pointers,
                              void* result) { function(result, pointers, static_cast<int32_t>(count)); },
                          values, count);
}

}  // namespace godot::internal
