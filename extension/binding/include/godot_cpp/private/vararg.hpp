#pragma once

// Calls of built-in and utility functions with any number of Variants.

#include <godot_cpp/private/lazy.hpp>
#include <godot_cpp/private/ptrcall.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <vector>

namespace godot::internal {

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
R call_vararg_builtin(BuiltinMethod& method, void* self, const Variant* values, size_t count) {
    return call_vararg<R>(
        [&](const void* const* pointers, void* result) {
            method.call(self, pointers, result, static_cast<int32_t>(count));
        },
        values, count);
}

template <class R>
R call_vararg_utility(UtilityFunction& function, const Variant* values, size_t count) {
    return call_vararg<R>([&](const void* const* pointers,
                              void* result) { function.call(pointers, result, static_cast<int32_t>(count)); },
                          values, count);
}

}  // namespace godot::internal
