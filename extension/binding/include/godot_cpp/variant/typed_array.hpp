#pragma once

#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <type_traits>

namespace godot {

class Object;

// An Array whose element type the engine knows and checks. T is an engine or own class, or a built-in type.
template <class T>
class TypedArray : public Array {
public:
    TypedArray() { type_this(); }
    TypedArray(const Variant& value) : TypedArray(value.operator Array()) {}
    TypedArray(const Array& array) : Array() {
        type_this();
        assign(array);
    }

    static StringName element_name() {
        if constexpr (internal::variant_type_of<T>() != Variant::NIL) {
            return Variant::get_type_name(internal::variant_type_of<T>());
        } else if constexpr (std::is_same_v<T, bool>) {
            return "bool";
        } else if constexpr (std::is_integral_v<T>) {
            return "int";
        } else if constexpr (std::is_floating_point_v<T>) {
            return "float";
        } else {
            return T::get_class_static();
        }
    }

private:
    void type_this() {
        if constexpr (internal::variant_type_of<T>() != Variant::NIL) {
            set_typed(internal::variant_type_of<T>(), StringName(), Variant());
        } else if constexpr (std::is_same_v<T, bool>) {
            set_typed(Variant::BOOL, StringName(), Variant());
        } else if constexpr (std::is_integral_v<T>) {
            set_typed(Variant::INT, StringName(), Variant());
        } else if constexpr (std::is_floating_point_v<T>) {
            set_typed(Variant::FLOAT, StringName(), Variant());
        } else {
            set_typed(Variant::OBJECT, T::get_class_static(), Variant());
        }
    }
};

}  // namespace godot
