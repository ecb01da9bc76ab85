#pragma once

// What the engine is told about the type of an argument, a result or a property.

#include <gdextension_interface.h>

#include <godot_cpp/core/bit_field.hpp>
#include <godot_cpp/core/property_info.hpp>
#include <type_traits>

namespace godot {

template <class T>
class Ref;
template <class T>
class TypedArray;

namespace internal {

// "tactus::HapticWorld::Clock" is "HapticWorld.Clock" to Godot.
StringName enum_class_name(const char* qualified_name);

template <Variant::Type type,
          GDExtensionClassMethodArgumentMetadata metadata = GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE>
struct PlainTypeInfo {
    static constexpr Variant::Type VARIANT_TYPE = type;
    static constexpr GDExtensionClassMethodArgumentMetadata METADATA = metadata;
    static PropertyInfo get_class_info() { return PropertyInfo(type, StringName()); }
};

template <class T>
constexpr GDExtensionClassMethodArgumentMetadata integer_metadata() {
    constexpr bool is_signed = std::is_signed_v<T>;
    switch (sizeof(T)) {
        case 1:
            return is_signed ? GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT8
                             : GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_UINT8;
        case 2:
            return is_signed ? GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT16
                             : GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_UINT16;
        case 4:
            return is_signed ? GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT32
                             : GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_UINT32;
        default:
            return is_signed ? GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT64
                             : GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_UINT64;
    }
}

}  // namespace internal

template <class T, class = void>
struct GetTypeInfo : internal::PlainTypeInfo<internal::variant_type_of<T>()> {
    static_assert(internal::variant_type_of<T>() != Variant::NIL,
                  "Godot knows no such type; an enum needs VARIANT_ENUM_CAST or VARIANT_BITFIELD_CAST");
};

template <>
struct GetTypeInfo<Variant> : internal::PlainTypeInfo<Variant::NIL> {
    static PropertyInfo get_class_info() {
        return PropertyInfo(Variant::NIL, StringName(), PROPERTY_HINT_NONE, "",
                            PROPERTY_USAGE_DEFAULT | PROPERTY_USAGE_NIL_IS_VARIANT);
    }
};

template <>
struct GetTypeInfo<bool> : internal::PlainTypeInfo<Variant::BOOL> {};

template <class T>
struct GetTypeInfo<T, std::enable_if_t<std::is_integral_v<T>>>
    : internal::PlainTypeInfo<Variant::INT, internal::integer_metadata<T>()> {};

template <>
struct GetTypeInfo<float>
    : internal::PlainTypeInfo<Variant::FLOAT, GDEXTENSION_METHOD_ARGUMENT_METADATA_REAL_IS_FLOAT> {};

template <>
struct GetTypeInfo<double>
    : internal::PlainTypeInfo<Variant::FLOAT, GDEXTENSION_METHOD_ARGUMENT_METADATA_REAL_IS_DOUBLE> {};

template <class T>
struct GetTypeInfo<T*> : internal::PlainTypeInfo<Variant::OBJECT> {
    static PropertyInfo get_class_info() {
        return PropertyInfo(Variant::OBJECT, StringName(), PROPERTY_HINT_NONE, "", PROPERTY_USAGE_DEFAULT,
                            std::remove_const_t<T>::get_class_static());
    }
};

template <class T>
struct GetTypeInfo<Ref<T>> : internal::PlainTypeInfo<Variant::OBJECT> {
    static PropertyInfo get_class_info() {
        return PropertyInfo(Variant::OBJECT, StringName(), PROPERTY_HINT_RESOURCE_TYPE,
                            T::get_class_static());
    }
};

template <class T>
struct GetTypeInfo<TypedArray<T>> : internal::PlainTypeInfo<Variant::ARRAY> {
    static PropertyInfo get_class_info() {
        return PropertyInfo(Variant::ARRAY, StringName(), PROPERTY_HINT_ARRAY_TYPE,
                            TypedArray<T>::element_name());
    }
};

namespace internal {

template <uint32_t usage>
struct EnumTypeInfo : PlainTypeInfo<Variant::INT, GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT64> {
    static PropertyInfo info(const char* qualified_name) {
        return PropertyInfo(Variant::INT, StringName(), PROPERTY_HINT_NONE, "",
                            PROPERTY_USAGE_DEFAULT | usage, enum_class_name(qualified_name));
    }
};

}  // namespace internal

template <class T>
StringName _gde_constant_get_enum_name(T, const char*) {
    return GetTypeInfo<T>::get_class_info().class_name;
}

}  // namespace godot

// Stands after the class, outside every namespace.
#define VARIANT_ENUM_CAST(m_enum)                                                       \
    namespace godot {                                                                   \
    template <>                                                                         \
    struct GetTypeInfo<m_enum> : internal::EnumTypeInfo<PROPERTY_USAGE_CLASS_IS_ENUM> { \
        static PropertyInfo get_class_info() {                                          \
            return info(#m_enum);                                                       \
        }                                                                               \
    };                                                                                  \
    }

#define VARIANT_BITFIELD_CAST(m_enum)                                                       \
    namespace godot {                                                                       \
    template <>                                                                             \
    struct GetTypeInfo<m_enum> : internal::EnumTypeInfo<PROPERTY_USAGE_CLASS_IS_BITFIELD> { \
        static PropertyInfo get_class_info() {                                              \
            return info(#m_enum);                                                           \
        }                                                                                   \
    };                                                                                      \
    template <>                                                                             \
    struct GetTypeInfo<BitField<m_enum>> : GetTypeInfo<m_enum> {};                          \
    }
