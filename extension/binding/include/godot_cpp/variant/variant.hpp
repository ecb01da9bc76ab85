#pragma once

#include <gdextension_interface.h>

#include <godot_cpp/core/object_id.hpp>
#include <godot_cpp/private/sizes.hpp>
#include <godot_cpp/variant/builtin_types.hpp>
#include <type_traits>

namespace godot {

class Object;

class Variant {
public:
    enum Type {
        NIL,
        BOOL,
        INT,
        FLOAT,
        STRING,
        VECTOR2,
        VECTOR2I,
        RECT2,
        RECT2I,
        VECTOR3,
        VECTOR3I,
        TRANSFORM2D,
        VECTOR4,
        VECTOR4I,
        PLANE,
        QUATERNION,
        AABB,
        BASIS,
        TRANSFORM3D,
        PROJECTION,
        COLOR,
        STRING_NAME,
        NODE_PATH,
        RID,
        OBJECT,
        CALLABLE,
        SIGNAL,
        DICTIONARY,
        ARRAY,
        PACKED_BYTE_ARRAY,
        PACKED_INT32_ARRAY,
        PACKED_INT64_ARRAY,
        PACKED_FLOAT32_ARRAY,
        PACKED_FLOAT64_ARRAY,
        PACKED_STRING_ARRAY,
        PACKED_VECTOR2_ARRAY,
        PACKED_VECTOR3_ARRAY,
        PACKED_COLOR_ARRAY,
        PACKED_VECTOR4_ARRAY,
        VARIANT_MAX
    };
    static_assert(static_cast<int>(VARIANT_MAX) == static_cast<int>(GDEXTENSION_VARIANT_TYPE_VARIANT_MAX));

    enum Operator {
        OP_EQUAL,
        OP_NOT_EQUAL,
        OP_LESS,
        OP_LESS_EQUAL,
        OP_GREATER,
        OP_GREATER_EQUAL,
        OP_ADD,
        OP_SUBTRACT,
        OP_MULTIPLY,
        OP_DIVIDE,
        OP_NEGATE,
        OP_POSITIVE,
        OP_MODULE,
        OP_POWER,
        OP_SHIFT_LEFT,
        OP_SHIFT_RIGHT,
        OP_BIT_AND,
        OP_BIT_OR,
        OP_BIT_XOR,
        OP_BIT_NEGATE,
        OP_AND,
        OP_OR,
        OP_XOR,
        OP_NOT,
        OP_IN,
        OP_MAX
    };

    Variant();
    Variant(std::nullptr_t) : Variant() {}
    Variant(const Variant& other);
    Variant(Variant&& other) noexcept;
    ~Variant();
    Variant& operator=(const Variant& other);
    Variant& operator=(Variant&& other) noexcept;

    Variant(bool value);
    Variant(int64_t value);
    Variant(int32_t value) : Variant(static_cast<int64_t>(value)) {}
    Variant(int16_t value) : Variant(static_cast<int64_t>(value)) {}
    Variant(int8_t value) : Variant(static_cast<int64_t>(value)) {}
    Variant(uint64_t value) : Variant(static_cast<int64_t>(value)) {}
    Variant(uint32_t value) : Variant(static_cast<int64_t>(value)) {}
    Variant(uint16_t value) : Variant(static_cast<int64_t>(value)) {}
    Variant(uint8_t value) : Variant(static_cast<int64_t>(value)) {}
    Variant(double value);
    Variant(float value) : Variant(static_cast<double>(value)) {}
    Variant(const ObjectID& value) : Variant(static_cast<int64_t>(value)) {}
    Variant(const char* text);
    Variant(const char32_t* text) : Variant(String(text)) {}
    Variant(const Object* object);
    Variant(const String& value);
    Variant(const StringName& value);
    Variant(const NodePath& value);
    Variant(const godot::RID& value);
    Variant(const Callable& value);
    Variant(const Signal& value);
    Variant(const Dictionary& value);
    Variant(const Array& value);
    Variant(const Vector2& value);
    Variant(const Vector2i& value);
    Variant(const Vector3& value);
    Variant(const Vector3i& value);
    Variant(const Vector4& value);
    Variant(const Vector4i& value);
    Variant(const Rect2& value);
    Variant(const Rect2i& value);
    Variant(const Transform2D& value);
    Variant(const Plane& value);
    Variant(const Quaternion& value);
    Variant(const godot::AABB& value);
    Variant(const Basis& value);
    Variant(const Transform3D& value);
    Variant(const Projection& value);
    Variant(const Color& value);
    Variant(const PackedByteArray& value);
    Variant(const PackedInt32Array& value);
    Variant(const PackedInt64Array& value);
    Variant(const PackedFloat32Array& value);
    Variant(const PackedFloat64Array& value);
    Variant(const PackedStringArray& value);
    Variant(const PackedVector2Array& value);
    Variant(const PackedVector3Array& value);
    Variant(const PackedColorArray& value);
    Variant(const PackedVector4Array& value);

    operator bool() const;
    operator int64_t() const;
    operator int32_t() const { return static_cast<int32_t>(operator int64_t()); }
    operator int16_t() const { return static_cast<int16_t>(operator int64_t()); }
    operator int8_t() const { return static_cast<int8_t>(operator int64_t()); }
    operator uint64_t() const { return static_cast<uint64_t>(operator int64_t()); }
    operator uint32_t() const { return static_cast<uint32_t>(operator int64_t()); }
    operator uint16_t() const { return static_cast<uint16_t>(operator int64_t()); }
    operator uint8_t() const { return static_cast<uint8_t>(operator int64_t()); }
    operator double() const;
    operator float() const { return static_cast<float>(operator double()); }
    operator ObjectID() const;
    // Only while the object is alive: godot-cpp gives a pointer to freed memory here. For one that has been
    // freed, this reports an error and gives null; get_validated_object() gives null without one.
    operator Object*() const;
    operator String() const;
    operator StringName() const;
    operator NodePath() const;
    operator godot::RID() const;
    operator Callable() const;
    operator Signal() const;
    operator Dictionary() const;
    operator Array() const;
    operator Vector2() const;
    operator Vector2i() const;
    operator Vector3() const;
    operator Vector3i() const;
    operator Vector4() const;
    operator Vector4i() const;
    operator Rect2() const;
    operator Rect2i() const;
    operator Transform2D() const;
    operator Plane() const;
    operator Quaternion() const;
    operator godot::AABB() const;
    operator Basis() const;
    operator Transform3D() const;
    operator Projection() const;
    operator Color() const;
    operator PackedByteArray() const;
    operator PackedInt32Array() const;
    operator PackedInt64Array() const;
    operator PackedFloat32Array() const;
    operator PackedFloat64Array() const;
    operator PackedStringArray() const;
    operator PackedVector2Array() const;
    operator PackedVector3Array() const;
    operator PackedColorArray() const;
    operator PackedVector4Array() const;

    Type get_type() const;
    // Null when this holds no object, or one that has been freed since.
    Object* get_validated_object() const;
    bool booleanize() const;
    String stringify() const;
    uint32_t hash() const;
    bool hash_compare(const Variant& other) const;
    Variant duplicate(bool deep = false) const;
    void clear() { *this = Variant(); }

    void callp(const StringName& method, const Variant** arguments, int argument_count, Variant& result,
               GDExtensionCallError& error);
    template <class... A>
    Variant call(const StringName& method, const A&... arguments) {
        Variant values[sizeof...(A) + 1] = {Variant(arguments)..., Variant()};
        const Variant* pointers[sizeof...(A) + 1];
        for (size_t i = 0; i <= sizeof...(A); ++i) {
            pointers[i] = &values[i];
        }
        Variant result;
        GDExtensionCallError error{};
        callp(method, pointers, static_cast<int>(sizeof...(A)), result, error);
        return result;
    }

    static void evaluate(const Operator& op, const Variant& a, const Variant& b, Variant& result,
                         bool& valid);
    bool operator==(const Variant& other) const;
    bool operator!=(const Variant& other) const { return !(*this == other); }
    bool operator<(const Variant& other) const;

    Variant get(const Variant& key, bool* valid = nullptr) const;
    void set(const Variant& key, const Variant& value, bool* valid = nullptr);
    Variant get_named(const StringName& name, bool& valid) const;
    void set_named(const StringName& name, const Variant& value, bool& valid);
    bool has_method(const StringName& method) const;
    bool has_key(const Variant& key, bool* valid = nullptr) const;

    static String get_type_name(Type type);
    static bool can_convert(Type from, Type to);
    static bool can_convert_strict(Type from, Type to);

    void* _native_ptr() const { return const_cast<uint8_t*>(opaque_); }

private:
    alignas(8) uint8_t opaque_[internal::size_of_variant];
};

namespace internal {

// The Variant type that holds a T; NIL for what has none of its own.
template <class T>
constexpr Variant::Type variant_type_of() {
    return Variant::NIL;
}

#define GODOT_BINDING_VARIANT_TYPE(m_class, m_type)      \
    template <>                                          \
    constexpr Variant::Type variant_type_of<m_class>() { \
        return Variant::m_type;                          \
    }

GODOT_BINDING_VARIANT_TYPE(String, STRING)
GODOT_BINDING_VARIANT_TYPE(Vector2, VECTOR2)
GODOT_BINDING_VARIANT_TYPE(Vector2i, VECTOR2I)
GODOT_BINDING_VARIANT_TYPE(Rect2, RECT2)
GODOT_BINDING_VARIANT_TYPE(Rect2i, RECT2I)
GODOT_BINDING_VARIANT_TYPE(Vector3, VECTOR3)
GODOT_BINDING_VARIANT_TYPE(Vector3i, VECTOR3I)
GODOT_BINDING_VARIANT_TYPE(Transform2D, TRANSFORM2D)
GODOT_BINDING_VARIANT_TYPE(Vector4, VECTOR4)
GODOT_BINDING_VARIANT_TYPE(Vector4i, VECTOR4I)
GODOT_BINDING_VARIANT_TYPE(Plane, PLANE)
GODOT_BINDING_VARIANT_TYPE(Quaternion, QUATERNION)
GODOT_BINDING_VARIANT_TYPE(godot::AABB, AABB)
GODOT_BINDING_VARIANT_TYPE(Basis, BASIS)
GODOT_BINDING_VARIANT_TYPE(Transform3D, TRANSFORM3D)
GODOT_BINDING_VARIANT_TYPE(Projection, PROJECTION)
GODOT_BINDING_VARIANT_TYPE(Color, COLOR)
GODOT_BINDING_VARIANT_TYPE(StringName, STRING_NAME)
GODOT_BINDING_VARIANT_TYPE(NodePath, NODE_PATH)
GODOT_BINDING_VARIANT_TYPE(godot::RID, RID)
GODOT_BINDING_VARIANT_TYPE(Callable, CALLABLE)
GODOT_BINDING_VARIANT_TYPE(Signal, SIGNAL)
GODOT_BINDING_VARIANT_TYPE(Dictionary, DICTIONARY)
GODOT_BINDING_VARIANT_TYPE(Array, ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedByteArray, PACKED_BYTE_ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedInt32Array, PACKED_INT32_ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedInt64Array, PACKED_INT64_ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedFloat32Array, PACKED_FLOAT32_ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedFloat64Array, PACKED_FLOAT64_ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedStringArray, PACKED_STRING_ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedVector2Array, PACKED_VECTOR2_ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedVector3Array, PACKED_VECTOR3_ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedColorArray, PACKED_COLOR_ARRAY)
GODOT_BINDING_VARIANT_TYPE(PackedVector4Array, PACKED_VECTOR4_ARRAY)

#undef GODOT_BINDING_VARIANT_TYPE

}  // namespace internal

// "%d bodies at %s": the engine's own format strings.
template <class... A>
String vformat(const String& text, const A&... arguments) {
    Array values;
    (values.push_back(Variant(arguments)), ...);
    return text % values;
}

}  // namespace godot
