#pragma once

#include <gdextension_interface.h>

#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/core/type_info.hpp>
#include <string>
#include <utility>
#include <vector>

namespace godot {

// One method of ours as Godot calls it: by Variants (scripts, the editor) or by ptrcall (typed GDScript).
class MethodBind {
public:
    virtual ~MethodBind() = default;
    virtual void call(Wrapped* instance, const Variant* const* arguments, Variant* result) const = 0;
    virtual void ptrcall(Wrapped* instance, const void* const* arguments, void* result) const = 0;

    struct Argument {
        PropertyInfo info;
        GDExtensionClassMethodArgumentMetadata metadata;
    };

    StringName name;
    std::vector<Argument> argument_list;
    std::vector<Variant> defaults;  // of the last arguments
    Argument answer;
    bool has_result = false;
    bool is_const = false;
    bool is_static = false;

protected:
    template <class R, class... A>
    void describe() {
        argument_list.reserve(sizeof...(A));
        (argument_list.push_back({GetTypeInfo<A>::get_class_info(), GetTypeInfo<A>::METADATA}), ...);
        if constexpr (!std::is_void_v<R>) {
            has_result = true;
            answer = {GetTypeInfo<std::remove_cvref_t<R>>::get_class_info(),
                      GetTypeInfo<std::remove_cvref_t<R>>::METADATA};
        }
    }
};

namespace internal {

// `invoke(arguments…)` with every argument taken out of its Variant, the answer put into one.
template <class R, class... A, class Invoke, size_t... I>
void call_with_variants(const Invoke& invoke, const Variant* const* arguments, Variant* result,
                        std::index_sequence<I...>) {
    (void)arguments;
    if constexpr (std::is_void_v<R>) {
        invoke(VariantCaster<A>::cast(*arguments[I])...);
    } else {
        *result =
            VariantMaker<std::remove_cvref_t<R>>::make(invoke(VariantCaster<A>::cast(*arguments[I])...));
    }
}

template <class R, class... A, class Invoke, size_t... I>
void call_with_pointers(const Invoke& invoke, const void* const* arguments, void* result,
                        std::index_sequence<I...>) {
    (void)arguments;
    if constexpr (std::is_void_v<R>) {
        (void)result;
        invoke(PtrArg<A>::decode(arguments[I])...);
    } else {
        PtrArg<std::remove_cvref_t<R>>::store(result, invoke(PtrArg<A>::decode(arguments[I])...));
    }
}

// The class whose member function M points to; a pointer to an inherited one points into the base.
template <class M>
struct MethodPointer;

template <class C, class R, class... A>
struct MethodPointer<R (C::*)(A...)> {
    using Class = C;
};

template <class C, class R, class... A>
struct MethodPointer<R (C::*)(A...) const> {
    using Class = C;
};

// Upstream binds a method to the class its pointer points into, and engine classes are not ours to bind to.
template <class M>
constexpr bool is_own_method = !MethodPointer<M>::Class::is_engine_class;

// godot-cpp makes a Variant of an enum by converting it to int64_t, which an enum class refuses.
template <class T>
constexpr bool is_bindable = !std::is_enum_v<T> || std::is_convertible_v<T, int64_t>;

// F is `R (C::*)(A…)`, the same with const, or `R (*)(A…)`; C is void for static functions.
template <class F, class C, class R, class... A>
class BoundMethod final : public MethodBind {
public:
    static_assert((is_bindable<std::remove_cvref_t<R>> && ... && is_bindable<std::remove_cvref_t<A>>),
                  "an enum class cannot be bound: make it a plain enum of the class");

    explicit BoundMethod(F method) : method_(method) { describe<R, std::remove_cvref_t<A>...>(); }

    void call(Wrapped* instance, const Variant* const* arguments, Variant* result) const override {
        call_with_variants<R, std::remove_cvref_t<A>...>(invoker(instance), arguments, result,
                                                         std::index_sequence_for<A...>());
    }

    void ptrcall(Wrapped* instance, const void* const* arguments, void* result) const override {
        call_with_pointers<R, std::remove_cvref_t<A>...>(invoker(instance), arguments, result,
                                                         std::index_sequence_for<A...>());
    }

private:
    auto invoker(Wrapped* instance) const {
        return [this, instance](auto&&... arguments) -> R {
            (void)this;
            (void)instance;
            if constexpr (std::is_void_v<C>) {
                return method_(std::forward<decltype(arguments)>(arguments)...);
            } else {
                return (static_cast<C*>(instance)->*method_)(std::forward<decltype(arguments)>(arguments)...);
            }
        };
    }

    F method_;
};

template <auto Method, class C, class R, class... A>
void invoke_virtual(Wrapped* instance, const void* const* arguments, void* result) {
    call_with_pointers<R, std::remove_cvref_t<A>...>(
        [instance](auto&&... values) -> R {
            return (static_cast<C*>(instance)->*Method)(std::forward<decltype(values)>(values)...);
        },
        arguments, result, std::index_sequence_for<A...>());
}

template <auto Method>
struct VirtualCall;

template <class C, class R, class... A, R (C::*Method)(A...)>
struct VirtualCall<Method> {
    static void call(GDExtensionClassInstancePtr instance, const GDExtensionConstTypePtr* arguments,
                     GDExtensionTypePtr result) {
        invoke_virtual<Method, C, R, A...>(static_cast<Wrapped*>(instance), arguments, result);
    }
};

template <class C, class R, class... A, R (C::*Method)(A...) const>
struct VirtualCall<Method> {
    static void call(GDExtensionClassInstancePtr instance, const GDExtensionConstTypePtr* arguments,
                     GDExtensionTypePtr result) {
        invoke_virtual<Method, C, R, A...>(static_cast<Wrapped*>(instance), arguments, result);
    }
};

}  // namespace internal

template <class C, class R, class... A>
MethodBind* create_method_bind(R (C::*method)(A...)) {
    return new internal::BoundMethod<R (C::*)(A...), C, R, A...>(method);
}

template <class C, class R, class... A>
MethodBind* create_method_bind(R (C::*method)(A...) const) {
    MethodBind* bind = new internal::BoundMethod<R (C::*)(A...) const, C, R, A...>(method);
    bind->is_const = true;
    return bind;
}

template <class R, class... A>
MethodBind* create_static_method_bind(R (*function)(A...)) {
    MethodBind* bind = new internal::BoundMethod<R (*)(A...), void, R, A...>(function);
    bind->is_static = true;
    return bind;
}

}  // namespace godot
