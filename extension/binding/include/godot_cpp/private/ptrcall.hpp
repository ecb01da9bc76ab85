#pragma once

// The two directions of a "ptrcall": how a C++ value becomes the memory the engine expects, and back.
//
//   C++                              engine
//   bool                             uint8_t
//   any integer, enum, BitField      int64_t
//   float, double                    double
//   Node*, Ref<Resource>             the engine's object pointer
//   everything else                  the value itself, in place

#include <gdextension_interface.h>

#include <godot_cpp/core/defs.hpp>
#include <type_traits>
#include <utility>

namespace godot {

class Object;
class Wrapped;

template <class T>
class Ref;

namespace internal {

Object* get_object_instance_binding(GodotObject* object);
GodotObject* object_of_ref(const void* ref);
void store_in_ref(void* ref, GodotObject* object);

template <class T, class = void>
struct PtrArg {
    using Slot = T;
    static const T& encode(const T& value) { return value; }
    static T take(Slot& slot) { return std::move(slot); }
    static const T& decode(const void* memory) { return *static_cast<const T*>(memory); }
    static void store(void* memory, const T& value) { *static_cast<T*>(memory) = value; }
};

template <class T, class Wire>
struct ConvertedPtrArg {
    using Slot = Wire;
    static Wire encode(T value) { return static_cast<Wire>(value); }
    static T take(Slot slot) { return static_cast<T>(slot); }
    static T decode(const void* memory) { return static_cast<T>(*static_cast<const Wire*>(memory)); }
    static void store(void* memory, T value) { *static_cast<Wire*>(memory) = static_cast<Wire>(value); }
};

template <>
struct PtrArg<bool> {
    using Slot = uint8_t;
    static uint8_t encode(bool value) { return value ? 1 : 0; }
    static bool take(Slot slot) { return slot != 0; }
    static bool decode(const void* memory) { return *static_cast<const uint8_t*>(memory) != 0; }
    static void store(void* memory, bool value) { *static_cast<uint8_t*>(memory) = encode(value); }
};

template <class T>
struct PtrArg<T, std::enable_if_t<(std::is_integral_v<T> && !std::is_same_v<T, bool>) || std::is_enum_v<T>>>
    : ConvertedPtrArg<T, int64_t> {};

template <class T>
struct PtrArg<T, std::enable_if_t<std::is_floating_point_v<T>>> : ConvertedPtrArg<T, double> {};

template <class T>
struct PtrArg<T*> {
    using Plain = std::remove_const_t<T>;
    using Slot = GodotObject*;
    static GodotObject* encode(const Plain* object) { return object != nullptr ? object->_owner : nullptr; }
    static Plain* take(GodotObject* slot) { return dynamic_cast<Plain*>(get_object_instance_binding(slot)); }
    static Plain* decode(const void* memory) { return take(*static_cast<GodotObject* const*>(memory)); }
    static void store(void* memory, const Plain* object) {
        *static_cast<GodotObject**>(memory) = encode(object);
    }
};

template <class T>
struct PtrArg<Ref<T>> {
    using Slot = GodotObject*;
    static GodotObject* encode(const Ref<T>& ref) { return ref.is_valid() ? ref.ptr()->_owner : nullptr; }
    // The engine hands over one reference together with the pointer.
    static Ref<T> take(GodotObject* slot) { return Ref<T>::adopt(get_object_instance_binding(slot)); }
    static Ref<T> decode(const void* memory) {
        return Ref<T>(dynamic_cast<T*>(get_object_instance_binding(object_of_ref(memory))));
    }
    static void store(void* memory, const Ref<T>& ref) { store_in_ref(memory, encode(ref)); }
};

// Calls `invoke(arguments, result)` with the encoded arguments as the array of pointers that every ptrcall
// takes.
template <class Invoke, class... Encoded>
void with_pointers(const Invoke& invoke, const Encoded&... encoded) {
    const void* pointers[sizeof...(Encoded) + 1] = {static_cast<const void*>(&encoded)..., nullptr};
    invoke(static_cast<const void* const*>(pointers));
}

template <class R, class Invoke, class... A>
R call_encoded(const Invoke& invoke, const A&... arguments) {
    if constexpr (std::is_void_v<R>) {
        with_pointers([&](const void* const* pointers) { invoke(pointers, nullptr); },
                      PtrArg<A>::encode(arguments)...);
    } else {
        typename PtrArg<R>::Slot slot{};
        with_pointers([&](const void* const* pointers) { invoke(pointers, &slot); },
                      PtrArg<A>::encode(arguments)...);
        return PtrArg<R>::take(slot);
    }
}

GDExtensionMethodBindPtr find_engine_method(const char* class_name, const char* method_name, int64_t hash);
void ptrcall_engine_method(GDExtensionMethodBindPtr method, GodotObject* self, const void* const* arguments,
                           void* result);
GDExtensionPtrBuiltInMethod find_builtin_method(GDExtensionVariantType type, const char* method_name,
                                                int64_t hash);
GDExtensionPtrUtilityFunction find_utility_function(const char* name, int64_t hash);
GDExtensionPtrOperatorEvaluator find_operator(GDExtensionVariantOperator op, GDExtensionVariantType left,
                                              GDExtensionVariantType right);
GDExtensionPtrConstructor find_constructor(GDExtensionVariantType type, int32_t index);
GDExtensionPtrDestructor find_destructor(GDExtensionVariantType type);
GodotObject* find_singleton(const char* name);

template <class R, class... A>
R call_engine_method(GDExtensionMethodBindPtr method, GodotObject* self, const A&... arguments) {
    return call_encoded<R>([&](const void* const* pointers,
                               void* result) { ptrcall_engine_method(method, self, pointers, result); },
                           arguments...);
}

template <class R, class... A>
R call_builtin_method(GDExtensionPtrBuiltInMethod method, const void* self, const A&... arguments) {
    return call_encoded<R>(
        [&](const void* const* pointers, void* result) {
            method(const_cast<void*>(self), pointers, result, static_cast<int32_t>(sizeof...(A)));
        },
        arguments...);
}

template <class R, class... A>
R call_utility_function(GDExtensionPtrUtilityFunction function, const A&... arguments) {
    return call_encoded<R>(
        [&](const void* const* pointers, void* result) {
            function(result, pointers, static_cast<int32_t>(sizeof...(A)));
        },
        arguments...);
}

template <class... A>
void call_constructor(GDExtensionPtrConstructor constructor, void* memory, const A&... arguments) {
    with_pointers([&](const void* const* pointers) { constructor(memory, pointers); },
                  PtrArg<A>::encode(arguments)...);
}

template <class R, class L, class T>
R call_operator(GDExtensionPtrOperatorEvaluator evaluator, const L& left, const T& right) {
    typename PtrArg<R>::Slot slot{};
    const auto& encoded = PtrArg<T>::encode(right);
    evaluator(&left, &encoded, &slot);
    return PtrArg<R>::take(slot);
}

}  // namespace internal
}  // namespace godot
