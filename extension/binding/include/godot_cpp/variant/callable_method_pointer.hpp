#pragma once

// callable_mp(object, &Class::method): a Callable straight to a C++ method. Two of them are equal when object
// and method are, so what was connected can be disconnected. A call after the object's end is an error, not a
// crash.

#include <godot_cpp/core/method_bind.hpp>
#include <godot_cpp/core/object.hpp>
#include <memory>

namespace godot {

namespace internal {

struct MethodTarget {
    uint64_t object_id = 0;  // 0 for static functions
    Wrapped* instance = nullptr;
    std::unique_ptr<MethodBind> bind;
    const void* kind = nullptr;  // one address per type of function pointer
    alignas(void*) unsigned char pointer[2 * sizeof(void*)] = {};
};

template <class F>
struct FunctionKind {
    static inline const char tag = 0;
};

Callable make_callable(std::unique_ptr<MethodTarget> target);

template <class F>
std::unique_ptr<MethodTarget> method_target(F function, MethodBind* bind) {
    static_assert(sizeof(F) <= sizeof(MethodTarget::pointer));
    auto target = std::make_unique<MethodTarget>();
    target->bind.reset(bind);
    target->kind = &FunctionKind<F>::tag;
    __builtin_memcpy(target->pointer, &function, sizeof(F));
    return target;
}

}  // namespace internal

template <class T, class F>
Callable callable_mp(T* object, F method) {
    auto target = internal::method_target(method, create_method_bind(method));
    target->object_id = object->get_instance_id();
    target->instance = object;
    return internal::make_callable(std::move(target));
}

template <class F>
Callable callable_mp_static(F function) {
    return internal::make_callable(internal::method_target(function, create_static_method_bind(function)));
}

}  // namespace godot
