#pragma once

// Between Variant and the C++ types of a method's arguments and result.

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/core/bit_field.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/private/ptrcall.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <type_traits>

namespace godot {

template <class T, class = void>
struct VariantCaster {
    static T cast(const Variant& variant) { return variant; }
};

template <>
struct VariantCaster<Variant> {
    static const Variant& cast(const Variant& variant) { return variant; }
};

template <class T>
struct VariantCaster<T, std::enable_if_t<std::is_enum_v<T>>> {
    static T cast(const Variant& variant) { return static_cast<T>(variant.operator int64_t()); }
};

template <class T>
struct VariantCaster<BitField<T>> {
    static BitField<T> cast(const Variant& variant) { return variant.operator int64_t(); }
};

template <class T>
struct VariantCaster<T*> {
    static T* cast(const Variant& variant) {
        return Object::cast_to<std::remove_const_t<T>>(static_cast<Object*>(variant));
    }
};

template <class T>
struct VariantCaster<Ref<T>> {
    static Ref<T> cast(const Variant& variant) { return Ref<T>(variant); }
};

namespace internal {

template <class T, class = void>
struct VariantMaker {
    static Variant make(const T& value) { return Variant(value); }
};

template <class T>
struct VariantMaker<T, std::enable_if_t<std::is_enum_v<T>>> {
    static Variant make(T value) { return Variant(static_cast<int64_t>(value)); }
};

template <class T>
struct VariantMaker<BitField<T>> {
    static Variant make(BitField<T> value) { return Variant(value.operator int64_t()); }
};

}  // namespace internal
}  // namespace godot
