#include <array>
#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/private/interface.hpp>
#include <godot_cpp/private/ptrcall.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace godot {

using internal::interface;
using internal::PtrArg;

namespace {

// The engine's conversions between a Variant and each of its types.
struct Conversions {
    std::array<GDExtensionVariantFromTypeConstructorFunc, Variant::VARIANT_MAX> from{};
    std::array<GDExtensionTypeFromVariantConstructorFunc, Variant::VARIANT_MAX> to{};

    Conversions() {
        for (int type = Variant::BOOL; type < Variant::VARIANT_MAX; ++type) {
            const auto index = static_cast<size_t>(type);
            from[index] =
                interface.get_variant_from_type_constructor(static_cast<GDExtensionVariantType>(type));
            to[index] = interface.get_variant_to_type_constructor(static_cast<GDExtensionVariantType>(type));
        }
    }
};

const Conversions& conversions() {
    static const Conversions table;
    return table;
}

template <class T>
void put(void* variant, Variant::Type type, const T& value) {
    auto&& encoded = PtrArg<T>::encode(value);
    conversions().from[type](variant, const_cast<void*>(static_cast<const void*>(&encoded)));
}

// The engine writes into raw memory: what the default constructor left there has to go first.
template <class T>
T take(const Variant& variant, Variant::Type type) {
    T value;
    value.~T();
    conversions().to[type](&value, variant._native_ptr());
    return value;
}

}  // namespace

Variant::Variant() {
    interface.variant_new_nil(opaque_);
}

Variant::Variant(const Variant& other) {
    interface.variant_new_copy(opaque_, other.opaque_);
}

Variant::Variant(Variant&& other) noexcept : Variant() {
    std::swap(opaque_, other.opaque_);
}

Variant::~Variant() {
    interface.variant_destroy(opaque_);
}

Variant& Variant::operator=(const Variant& other) {
    Variant copy(other);
    std::swap(opaque_, copy.opaque_);
    return *this;
}

Variant& Variant::operator=(Variant&& other) noexcept {
    std::swap(opaque_, other.opaque_);
    return *this;
}

Variant::Variant(const char* text) : Variant(String(text)) {}

Variant::Variant(bool value) {
    put(opaque_, BOOL, value);
}

Variant::Variant(int64_t value) {
    put(opaque_, INT, value);
}

Variant::Variant(double value) {
    put(opaque_, FLOAT, value);
}

Variant::Variant(const Object* object) {
    put<Object*>(opaque_, OBJECT, const_cast<Object*>(object));
}

Variant::operator bool() const {
    return booleanize();
}

Variant::operator int64_t() const {
    int64_t value = 0;
    conversions().to[INT](&value, _native_ptr());
    return value;
}

Variant::operator double() const {
    double value = 0;
    conversions().to[FLOAT](&value, _native_ptr());
    return value;
}

Variant::operator ObjectID() const {
    if (get_type() == INT) {
        return ObjectID(operator uint64_t());
    }
    return get_type() == OBJECT ? ObjectID(interface.variant_get_object_instance_id(opaque_)) : ObjectID();
}

Variant::operator Object*() const {
    Object* const object = get_validated_object();
    if (object == nullptr && static_cast<uint64_t>(operator ObjectID()) != 0 && get_type() == OBJECT) {
        ERR_PRINT(
            "A Variant of a freed object was read as Object*, which crashes with godot-cpp: read it by "
            "get_validated_object().");
    }
    return object;
}

Object* Variant::get_validated_object() const {
    return get_type() == OBJECT ? ObjectDB::get_instance(operator ObjectID()) : nullptr;
}

#define GODOT_BINDING_VARIANT(m_class, m_type) \
    Variant::Variant(const m_class& value) {   \
        put(opaque_, m_type, value);           \
    }                                          \
    Variant::operator m_class() const {        \
        return take<m_class>(*this, m_type);   \
    }

GODOT_BINDING_VARIANT(String, STRING)
GODOT_BINDING_VARIANT(StringName, STRING_NAME)
GODOT_BINDING_VARIANT(NodePath, NODE_PATH)
GODOT_BINDING_VARIANT(godot::RID, RID)
GODOT_BINDING_VARIANT(Callable, CALLABLE)
GODOT_BINDING_VARIANT(Signal, SIGNAL)
GODOT_BINDING_VARIANT(Dictionary, DICTIONARY)
GODOT_BINDING_VARIANT(Array, ARRAY)
GODOT_BINDING_VARIANT(Vector2, VECTOR2)
GODOT_BINDING_VARIANT(Vector2i, VECTOR2I)
GODOT_BINDING_VARIANT(Vector3, VECTOR3)
GODOT_BINDING_VARIANT(Vector3i, VECTOR3I)
GODOT_BINDING_VARIANT(Vector4, VECTOR4)
GODOT_BINDING_VARIANT(Vector4i, VECTOR4I)
GODOT_BINDING_VARIANT(Rect2, RECT2)
GODOT_BINDING_VARIANT(Rect2i, RECT2I)
GODOT_BINDING_VARIANT(Transform2D, TRANSFORM2D)
GODOT_BINDING_VARIANT(Plane, PLANE)
GODOT_BINDING_VARIANT(Quaternion, QUATERNION)
GODOT_BINDING_VARIANT(godot::AABB, AABB)
GODOT_BINDING_VARIANT(Basis, BASIS)
GODOT_BINDING_VARIANT(Transform3D, TRANSFORM3D)
GODOT_BINDING_VARIANT(Projection, PROJECTION)
GODOT_BINDING_VARIANT(Color, COLOR)
GODOT_BINDING_VARIANT(PackedByteArray, PACKED_BYTE_ARRAY)
GODOT_BINDING_VARIANT(PackedInt32Array, PACKED_INT32_ARRAY)
GODOT_BINDING_VARIANT(PackedInt64Array, PACKED_INT64_ARRAY)
GODOT_BINDING_VARIANT(PackedFloat32Array, PACKED_FLOAT32_ARRAY)
GODOT_BINDING_VARIANT(PackedFloat64Array, PACKED_FLOAT64_ARRAY)
GODOT_BINDING_VARIANT(PackedStringArray, PACKED_STRING_ARRAY)
GODOT_BINDING_VARIANT(PackedVector2Array, PACKED_VECTOR2_ARRAY)
GODOT_BINDING_VARIANT(PackedVector3Array, PACKED_VECTOR3_ARRAY)
GODOT_BINDING_VARIANT(PackedColorArray, PACKED_COLOR_ARRAY)
GODOT_BINDING_VARIANT(PackedVector4Array, PACKED_VECTOR4_ARRAY)

Variant::Type Variant::get_type() const {
    return static_cast<Type>(interface.variant_get_type(opaque_));
}

bool Variant::booleanize() const {
    return interface.variant_booleanize(opaque_) != 0;
}

String Variant::stringify() const {
    String text;
    interface.variant_stringify(opaque_, text._native_ptr());
    return text;
}

uint32_t Variant::hash() const {
    return static_cast<uint32_t>(interface.variant_hash(opaque_));
}

bool Variant::hash_compare(const Variant& other) const {
    return interface.variant_hash_compare(opaque_, other.opaque_) != 0;
}

Variant Variant::duplicate(bool deep) const {
    Variant result;
    interface.variant_duplicate(opaque_, result.opaque_, deep);
    return result;
}

void Variant::callp(const StringName& method, const Variant** arguments, int argument_count, Variant& result,
                    GDExtensionCallError& error) {
    Variant answer;
    interface.variant_call(opaque_, method._native_ptr(), reinterpret_cast<const void**>(arguments),
                           argument_count, answer.opaque_, &error);
    result = std::move(answer);
}

void Variant::evaluate(const Operator& op, const Variant& a, const Variant& b, Variant& result, bool& valid) {
    Variant answer;
    GDExtensionBool is_valid = 0;
    interface.variant_evaluate(static_cast<GDExtensionVariantOperator>(op), a.opaque_, b.opaque_,
                               answer.opaque_, &is_valid);
    valid = is_valid != 0;
    result = std::move(answer);
}

bool Variant::operator==(const Variant& other) const {
    Variant result;
    bool valid = false;
    evaluate(OP_EQUAL, *this, other, result, valid);
    return valid && result.booleanize();
}

bool Variant::operator<(const Variant& other) const {
    Variant result;
    bool valid = false;
    evaluate(OP_LESS, *this, other, result, valid);
    return valid && result.booleanize();
}

Variant Variant::get(const Variant& key, bool* valid) const {
    Variant result;
    GDExtensionBool is_valid = 0;
    interface.variant_get(opaque_, key.opaque_, result.opaque_, &is_valid);
    if (valid != nullptr) {
        *valid = is_valid != 0;
    }
    return result;
}

void Variant::set(const Variant& key, const Variant& value, bool* valid) {
    GDExtensionBool is_valid = 0;
    interface.variant_set(opaque_, key.opaque_, value.opaque_, &is_valid);
    if (valid != nullptr) {
        *valid = is_valid != 0;
    }
}

Variant Variant::get_named(const StringName& name, bool& valid) const {
    Variant result;
    GDExtensionBool is_valid = 0;
    interface.variant_get_named(opaque_, name._native_ptr(), result.opaque_, &is_valid);
    valid = is_valid != 0;
    return result;
}

void Variant::set_named(const StringName& name, const Variant& value, bool& valid) {
    GDExtensionBool is_valid = 0;
    interface.variant_set_named(opaque_, name._native_ptr(), value.opaque_, &is_valid);
    valid = is_valid != 0;
}

bool Variant::has_method(const StringName& method) const {
    return interface.variant_has_method(opaque_, method._native_ptr()) != 0;
}

bool Variant::has_key(const Variant& key, bool* valid) const {
    GDExtensionBool is_valid = 0;
    const bool found = interface.variant_has_key(opaque_, key.opaque_, &is_valid) != 0;
    if (valid != nullptr) {
        *valid = is_valid != 0;
    }
    return found;
}

String Variant::get_type_name(Type type) {
    String name;
    name.~String();
    interface.variant_get_type_name(static_cast<GDExtensionVariantType>(type), name._native_ptr());
    return name;
}

bool Variant::can_convert(Type from, Type to) {
    return interface.variant_can_convert(static_cast<GDExtensionVariantType>(from),
                                         static_cast<GDExtensionVariantType>(to)) != 0;
}

bool Variant::can_convert_strict(Type from, Type to) {
    return interface.variant_can_convert_strict(static_cast<GDExtensionVariantType>(from),
                                                static_cast<GDExtensionVariantType>(to)) != 0;
}

}  // namespace godot
