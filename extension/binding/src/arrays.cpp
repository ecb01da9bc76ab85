#include <algorithm>
#include <godot_cpp/private/interface.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace godot {

using internal::interface;

Array::Array(std::initializer_list<Variant> values) : Array() {
    for (const Variant& value : values) {
        push_back(value);
    }
}

const Variant& Array::operator[](int64_t index) const {
    return *static_cast<const Variant*>(interface.array_operator_index_const(opaque_, index));
}

Variant& Array::operator[](int64_t index) {
    return *static_cast<Variant*>(interface.array_operator_index(opaque_, index));
}

void Array::set_typed(uint32_t type, const StringName& class_name, const Variant& script) {
    interface.array_set_typed(opaque_, static_cast<GDExtensionVariantType>(type), class_name._native_ptr(),
                              script._native_ptr());
}

const Variant* Array::begin() const {
    return is_empty() ? nullptr : &(*this)[0];
}

const Variant* Array::end() const {
    return begin() + size();
}

Variant* Array::begin() {
    return is_empty() ? nullptr : &(*this)[0];
}

Variant* Array::end() {
    return begin() + size();
}

const Variant& Dictionary::operator[](const Variant& key) const {
    return *static_cast<const Variant*>(
        interface.dictionary_operator_index_const(opaque_, key._native_ptr()));
}

Variant& Dictionary::operator[](const Variant& key) {
    return *static_cast<Variant*>(interface.dictionary_operator_index(opaque_, key._native_ptr()));
}

#define GODOT_BINDING_PACKED_ARRAY(m_class, m_element, m_index)                                             \
    m_class::m_class(std::initializer_list<m_element> values) : m_class() {                                 \
        resize(static_cast<int64_t>(values.size()));                                                        \
        std::copy(values.begin(), values.end(), ptrw());                                                    \
    }                                                                                                       \
    const m_element* m_class::ptr() const {                                                                 \
        return is_empty()                                                                                   \
                   ? nullptr                                                                                \
                   : reinterpret_cast<const m_element*>(interface.packed_##m_index##_const(opaque_, 0));    \
    }                                                                                                       \
    m_element* m_class::ptrw() {                                                                            \
        return is_empty() ? nullptr : reinterpret_cast<m_element*>(interface.packed_##m_index(opaque_, 0)); \
    }

GODOT_BINDING_PACKED_ARRAY(PackedByteArray, uint8_t, byte_array_operator_index)
GODOT_BINDING_PACKED_ARRAY(PackedInt32Array, int32_t, int32_array_operator_index)
GODOT_BINDING_PACKED_ARRAY(PackedInt64Array, int64_t, int64_array_operator_index)
GODOT_BINDING_PACKED_ARRAY(PackedFloat32Array, float, float32_array_operator_index)
GODOT_BINDING_PACKED_ARRAY(PackedFloat64Array, double, float64_array_operator_index)
GODOT_BINDING_PACKED_ARRAY(PackedStringArray, String, string_array_operator_index)
GODOT_BINDING_PACKED_ARRAY(PackedVector2Array, Vector2, vector2_array_operator_index)
GODOT_BINDING_PACKED_ARRAY(PackedVector3Array, Vector3, vector3_array_operator_index)
GODOT_BINDING_PACKED_ARRAY(PackedColorArray, Color, color_array_operator_index)
GODOT_BINDING_PACKED_ARRAY(PackedVector4Array, Vector4, vector4_array_operator_index)

}  // namespace godot
