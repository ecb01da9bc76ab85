#include "signatures.hpp"

#include <cstdint>
#include <godot_cpp/classes/object.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/aabb.hpp>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/basis.hpp>
#include <godot_cpp/variant/callable.hpp>
#include <godot_cpp/variant/color.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/packed_byte_array.hpp>
#include <godot_cpp/variant/packed_float32_array.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <godot_cpp/variant/plane.hpp>
#include <godot_cpp/variant/rid.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/string_name.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <godot_cpp/variant/utility_functions.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <type_traits>

using namespace godot;

namespace probe {

namespace {

// What upstream refuses.
template <class A, class B>
constexpr bool adds = requires(A left, B right) { left + right; };
template <class A, class B>
constexpr bool multiplies = requires(A left, B right) { left* right; };
template <class Utilities>
constexpr bool has_is_instance_valid = requires { Utilities::is_instance_valid(Variant()); };

enum class Scoped { value };
enum Plain { PLAIN };
// The one of the two that no constructor of Variant takes as it is.
using OtherInt = std::conditional_t<std::is_same_v<int64_t, long>, long long, long>;

static_assert(adds<String, const char*> && !adds<const String&, const char*>);
static_assert(std::is_constructible_v<Variant, Plain> && !std::is_constructible_v<Variant, Scoped>);
static_assert(std::is_constructible_v<Variant, int64_t> && !std::is_constructible_v<Variant, OtherInt>);
static_assert(!multiplies<Transform3D, AABB> && !multiplies<Transform3D, Vector3>);
static_assert(!multiplies<Basis, Vector3> && !multiplies<Quaternion, Vector3>);
static_assert(!has_is_instance_valid<UtilityFunctions>);
#if __has_include(<godot_cpp/private/class_access.hpp>)
// With upstream, the first compiles and fails when the library is loaded: "Class 'Resource' doesn't exist".
static_assert(!internal::is_own_method<decltype(&Resource::emit_changed)>);
static_assert(internal::is_bindable<Plain> && !internal::is_bindable<Scoped>);
#endif

}  // namespace

void keep(const void* function, std::size_t size) {
    static volatile unsigned char sum;
    for (std::size_t i = 0; i < size; ++i) {
        sum = static_cast<unsigned char>(sum + static_cast<const unsigned char*>(function)[i]);
    }
}

void list_values() {
    constructor<Array>();
    same<Variant& (Array::*)(int64_t)>(&Array::operator[]);
    same<bool (Array::*)() const>(&Array::is_empty);
    same<bool (Array::*)(const Variant&) const>(&Array::has);
    same<const Variant& (Array::*)(int64_t) const>(&Array::operator[]);
    same<int64_t (Array::*)() const>(&Array::size);
    same<int64_t (Array::*)(int64_t)>(&Array::resize);
    same<void (Array::*)(const Array&)>(&Array::assign);
    same<void (Array::*)(const Variant&)>(&Array::push_back);
    same<void (Array::*)(uint32_t, const StringName&, const Variant&)>(&Array::set_typed);

    constructor<Basis, const Quaternion&>();
    same<Vector3 (Basis::*)(int) const>(&Basis::get_column);
    same<void (Basis::*)(int, const Vector3&)>(&Basis::set_column);
    same<Basis (Basis::*)(const Vector3&) const>(&Basis::scaled_local);
    same<real_t (Basis::*)() const>(&Basis::determinant);
    same<Quaternion (Basis::*)() const>(&Basis::get_quaternion);
    same<Quaternion (Basis::*)() const>(&Basis::get_rotation_quaternion);
    same<Vector3 (Basis::*)(const Vector3&) const>(&Basis::xform);
    same<bool (Basis::*)(const Basis&) const>(&Basis::operator==);
    constructor<Basis, const Vector3&, const Vector3&, const Vector3&>();

    constructor<Color, float, float, float>();
    constructor<Color, float, float, float, float>();

    constructor<Quaternion, real_t, real_t, real_t, real_t>();

    constructor<RID>();
    constructor<RID, const RID&>();
    same<bool (RID::*)() const>(&RID::is_valid);
    same<int64_t (RID::*)() const>(&RID::get_id);

    same<Transform3D (Transform3D::*)() const>(&Transform3D::affine_inverse);
    same<Transform3D (Transform3D::*)(const Transform3D&) const>(&Transform3D::operator*);
    same<Vector3 (Transform3D::*)(const Vector3&) const>(&Transform3D::xform);
    same<bool (Transform3D::*)(const Transform3D&) const>(&Transform3D::operator==);
    constructor<Transform3D, const Basis&, const Vector3&>();

    same<real_t (Vector3::*)() const>(&Vector3::length);
    same<real_t (Vector3::*)() const>(&Vector3::length_squared);
    same<Vector3 (Vector3::*)() const>(&Vector3::normalized);
    same<bool (Vector3::*)() const>(&Vector3::is_finite);
    same<Vector3 (Vector3::*)(const Vector3&) const>(&Vector3::operator+);
    same<Vector3 (Vector3::*)(const Vector3&) const>(&Vector3::operator-);
    same<Vector3 (Vector3::*)() const>(&Vector3::operator-);
    same<Vector3 (Vector3::*)(const Vector3&) const>(&Vector3::operator*);
    same<Vector3 (Vector3::*)(real_t) const>(&Vector3::operator*);
    same<bool (Vector3::*)(const Vector3&) const>(&Vector3::operator==);
    constructor<Vector3, real_t, real_t, real_t>();

    constructor<Callable, Object*, const StringName&>();

    constructor<Dictionary>();
    same<Array (Dictionary::*)() const>(&Dictionary::keys);
    same<Dictionary (Dictionary::*)(bool) const>(&Dictionary::duplicate);
    same<Variant& (Dictionary::*)(const Variant&)>(&Dictionary::operator[]);
    same<Variant (Dictionary::*)(const Variant&, const Variant&) const>(&Dictionary::get);
    same<const Variant& (Dictionary::*)(const Variant&) const>(&Dictionary::operator[]);

    constructor<NodePath, const NodePath&>();
    constructor<NodePath, const String&>();
    constructor<NodePath>();
    same<bool (NodePath::*)() const>(&NodePath::is_absolute);
    same<bool (NodePath::*)() const>(&NodePath::is_empty);
    same<int64_t (NodePath::*)() const>(&NodePath::get_name_count);

    same<Object* (*)(uint64_t)>(&ObjectDB::get_instance);

    constructor<PackedByteArray, const PackedByteArray&>();
    constructor<PackedByteArray>();
    same<PackedFloat32Array (PackedByteArray::*)() const>(&PackedByteArray::to_float32_array);
    same<const uint8_t* (PackedByteArray::*)() const>(&PackedByteArray::ptr);
    same<int64_t (PackedByteArray::*)() const>(&PackedByteArray::size);

    constructor<PackedFloat32Array, const PackedFloat32Array&>();
    constructor<PackedFloat32Array>();
    same<bool (PackedFloat32Array::*)() const>(&PackedFloat32Array::is_empty);
    same<const float* (PackedFloat32Array::*)() const>(&PackedFloat32Array::ptr);
    same<int64_t (PackedFloat32Array::*)() const>(&PackedFloat32Array::size);
    same<void (PackedFloat32Array::*)(const PackedFloat32Array&)>(&PackedFloat32Array::append_array);

    constructor<PackedFloat64Array>();
    same<bool (PackedFloat64Array::*)() const>(&PackedFloat64Array::is_empty);
    same<bool (PackedFloat64Array::*)(double)>(&PackedFloat64Array::push_back);
    same<const double* (PackedFloat64Array::*)() const>(&PackedFloat64Array::ptr);
    same<int64_t (PackedFloat64Array::*)() const>(&PackedFloat64Array::size);

    constructor<PackedInt32Array, const PackedInt32Array&>();
    constructor<PackedInt32Array>();
    same<bool (PackedInt32Array::*)() const>(&PackedInt32Array::is_empty);
    same<const int32_t* (PackedInt32Array::*)() const>(&PackedInt32Array::ptr);
    same<int32_t* (PackedInt32Array::*)()>(&PackedInt32Array::ptrw);
    same<int64_t (PackedInt32Array::*)() const>(&PackedInt32Array::size);
    same<int64_t (PackedInt32Array::*)(int64_t)>(&PackedInt32Array::resize);

    constructor<PackedStringArray, const PackedStringArray&>();
    constructor<PackedStringArray>();
    same<bool (PackedStringArray::*)() const>(&PackedStringArray::is_empty);
    same<bool (PackedStringArray::*)(const PackedStringArray&) const>(&PackedStringArray::operator==);
    same<bool (PackedStringArray::*)(const String&)>(&PackedStringArray::push_back);
    same<const String* (PackedStringArray::*)() const>(&PackedStringArray::ptr);
    same<int64_t (PackedStringArray::*)() const>(&PackedStringArray::size);
    same<void (PackedStringArray::*)()>(&PackedStringArray::sort);

    constructor<PackedVector2Array>();
    same<Vector2* (PackedVector2Array::*)()>(&PackedVector2Array::ptrw);
    same<const Vector2* (PackedVector2Array::*)() const>(&PackedVector2Array::ptr);
    same<int64_t (PackedVector2Array::*)() const>(&PackedVector2Array::size);
    same<int64_t (PackedVector2Array::*)(int64_t)>(&PackedVector2Array::resize);

    constructor<PackedVector3Array, const PackedVector3Array&>();
    constructor<PackedVector3Array>();
    same<Vector3* (PackedVector3Array::*)()>(&PackedVector3Array::ptrw);
    same<bool (PackedVector3Array::*)() const>(&PackedVector3Array::is_empty);
    same<bool (PackedVector3Array::*)(const PackedVector3Array&) const>(&PackedVector3Array::operator==);
    same<const Vector3* (PackedVector3Array::*)() const>(&PackedVector3Array::ptr);
    same<int64_t (PackedVector3Array::*)() const>(&PackedVector3Array::size);
    same<int64_t (PackedVector3Array::*)(int64_t)>(&PackedVector3Array::resize);

    constructor<String, const NodePath&>();
    constructor<String, const String&>();
    constructor<String, const StringName&>();
    constructor<String, const char*>();
    constructor<String>();
    same<CharString (String::*)() const>(&String::utf8);
    same<String (*)(const char*, const String&)>(&operator+);
    same<String (*)(const char*, int64_t)>(&String::utf8);
    same<String (*)(double, int64_t)>(&String::num);
    same<String (*)(int64_t, int64_t, bool)>(&String::num_int64);
    same<String (String::*)() const>(&String::get_base_dir);
    same<String (String::*)() const>(&String::get_basename);
    same<String (String::*)() const>(&String::get_extension);
    same<String (String::*)() const>(&String::get_file);
    same<String (String::*)() const>(&String::validate_node_name);
    same<String (String::*)(bool, bool) const>(&String::strip_edges);
    same<String (String::*)(char32_t)>(&String::operator+);
    same<String (String::*)(const PackedStringArray&) const>(&String::join);
    same<String (String::*)(const String&) const>(&String::operator+);
    same<String (String::*)(const String&) const>(&String::path_join);
    same<String (String::*)(const char*)>(&String::operator+);
    same<String (String::*)(int64_t) const>(&String::right);
    same<String (String::*)(int64_t, int64_t) const>(&String::substr);
    same<bool (String::*)() const>(&String::is_empty);
    same<bool (String::*)() const>(&String::is_valid_identifier);
    same<bool (String::*)(const String&) const>(&String::begins_with);
    same<bool (String::*)(const String&) const>(&String::operator!=);
    same<bool (String::*)(const String&) const>(&String::operator==);
    same<int64_t (String::*)(const String&, int64_t) const>(&String::find);
    same<bool (String::*)(const char*) const>(&String::operator!=);
    same<bool (String::*)(const char*) const>(&String::operator==);

    constructor<StringName, const String&>();
    constructor<StringName, const char*>();
    constructor<StringName>();
    same<bool (StringName::*)(const StringName&) const>(&StringName::operator==);

    same<bool (*)(int64_t)>(&UtilityFunctions::is_instance_id_valid);

    constructor<Variant, Variant&&>();
    constructor<Variant, bool>();
    constructor<Variant, const AABB&>();
    constructor<Variant, const Array&>();
    constructor<Variant, const Dictionary&>();
    constructor<Variant, const Object*>();
    constructor<Variant, const PackedByteArray&>();
    constructor<Variant, const PackedFloat64Array&>();
    constructor<Variant, const PackedInt32Array&>();
    constructor<Variant, const RID&>();
    constructor<Variant, const PackedVector3Array&>();
    constructor<Variant, const String&>();
    constructor<Variant, const StringName&>();
    constructor<Variant, const Transform3D&>();
    constructor<Variant, const Variant&>();
    constructor<Variant, const Vector2&>();
    constructor<Variant, const Vector3&>();
    constructor<Variant, const char*>();
    constructor<Variant, double>();
    constructor<Variant, int64_t>();
    same<Variant& (Variant::*)(const Variant&)>(&Variant::operator=);
    constructor<Variant>();
    same<AABB (Variant::*)() const>(&Variant::operator godot::AABB);
    same<Array (Variant::*)() const>(&Variant::operator Array);
    same<Dictionary (Variant::*)() const>(&Variant::operator Dictionary);
    same<Object* (Variant::*)() const>(&Variant::get_validated_object);
    same<Object* (Variant::*)() const>(&Variant::operator Object*);
    same<ObjectID (Variant::*)() const>(&Variant::operator ObjectID);
    same<PackedByteArray (Variant::*)() const>(&Variant::operator PackedByteArray);
    same<PackedFloat32Array (Variant::*)() const>(&Variant::operator PackedFloat32Array);
    same<PackedInt32Array (Variant::*)() const>(&Variant::operator PackedInt32Array);
    same<PackedStringArray (Variant::*)() const>(&Variant::operator PackedStringArray);
    same<PackedVector2Array (Variant::*)() const>(&Variant::operator PackedVector2Array);
    same<PackedVector3Array (Variant::*)() const>(&Variant::operator PackedVector3Array);
    same<Plane (Variant::*)() const>(&Variant::operator Plane);
    same<RID (Variant::*)() const>(&Variant::operator godot::RID);
    same<String (Variant::*)() const>(&Variant::operator String);
    same<Transform3D (Variant::*)() const>(&Variant::operator Transform3D);
    same<Variant::Type (Variant::*)() const>(&Variant::get_type);
    same<Variant& (Variant::*)(Variant&&)>(&Variant::operator=);
    same<Vector3 (Variant::*)() const>(&Variant::operator Vector3);
    same<bool (Variant::*)() const>(&Variant::operator bool);
    same<double (Variant::*)() const>(&Variant::operator double);
    same<int64_t (Variant::*)() const>(&Variant::operator int64_t);
}

}  // namespace probe
