#include "echo.hpp"

using namespace godot;

namespace probe {

namespace {

template <class T>
void send(const Callable& echo, const char* name, const T& value, PackedStringArray& changed) {
    const T back = VariantCaster<T>::cast(echo.call(value));
    if (!(back == value)) {
        changed.push_back(name);
    }
}

void send_numbers(const Callable& echo, PackedStringArray& changed) {
    send(echo, "bool", true, changed);
    send(echo, "int", INT64_MIN, changed);
    send(echo, "uint8", uint8_t{255}, changed);
    send(echo, "float", 0.1, changed);
    send(echo, "float32", 0.1f, changed);
}

void send_math(const Callable& echo, PackedStringArray& changed) {
    send(echo, "Vector2", Vector2(1.5f, -2), changed);
    send(echo, "Vector2i", Vector2i(1, -2), changed);
    send(echo, "Rect2", Rect2(1, 2, 3, 4.5f), changed);
    send(echo, "Rect2i", Rect2i(1, 2, 3, 4), changed);
    send(echo, "Vector3", Vector3(1, 2, 3.25f), changed);
    send(echo, "Vector3i", Vector3i(1, 2, -3), changed);
    send(echo, "Transform2D", Transform2D(1, 2, 3, 4, 5, 6), changed);
    send(echo, "Vector4", Vector4(1, 2, 3, 4), changed);
    send(echo, "Vector4i", Vector4i(1, 2, 3, 4), changed);
    send(echo, "Plane", Plane(0, 1, 0, 5), changed);
    send(echo, "Quaternion", Quaternion(0, 0.6f, 0, 0.8f), changed);
    send(echo, "AABB", AABB(Vector3(1, 2, 3), Vector3(4, 5, 6)), changed);
    send(echo, "Basis", Basis(1, 2, 3, 4, 5, 6, 7, 8, 9), changed);
    send(echo, "Transform3D", Transform3D(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12), changed);
    send(echo, "Projection", Projection(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16), changed);
    send(echo, "Color", Color(0.1f, 0.2f, 0.3f, 0.4f), changed);
}

void send_handles(const Callable& echo, PackedStringArray& changed) {
    send(echo, "String", String::utf8("Schüssel ✓"), changed);
    send(echo, "StringName", StringName("stiffness"), changed);
    send(echo, "NodePath", NodePath("../A:position:x"), changed);
    send(echo, "Callable", echo, changed);
    send(echo, "Array", Array{1, "two", Vector3(3, 3, 3)}, changed);
    Dictionary dictionary;
    dictionary["key"] = 5;
    send(echo, "Dictionary", dictionary, changed);
    Ref<Resource> resource;
    resource.instantiate();
    send(echo, "RID", resource->get_rid(), changed);
    send(echo, "Signal", Signal(resource.ptr(), "changed"), changed);
    send(echo, "Resource", resource, changed);
    send<Object*>(echo, "Object", resource.ptr(), changed);
    send<Object*>(echo, "null", nullptr, changed);
    send(echo, "Variant", Variant(), changed);
}

void send_packed(const Callable& echo, PackedStringArray& changed) {
    send(echo, "PackedByteArray", PackedByteArray{0, 127, 255}, changed);
    send(echo, "PackedInt32Array", PackedInt32Array{INT32_MIN, 0, INT32_MAX}, changed);
    send(echo, "PackedInt64Array", PackedInt64Array{INT64_MIN, 0, INT64_MAX}, changed);
    send(echo, "PackedFloat32Array", PackedFloat32Array{0.5f, -1.0f}, changed);
    send(echo, "PackedFloat64Array", PackedFloat64Array{0.1, -1e300}, changed);
    send(echo, "PackedStringArray", PackedStringArray{"a", "", "c"}, changed);
    send(echo, "PackedVector2Array", PackedVector2Array{Vector2(1, 2)}, changed);
    send(echo, "PackedVector3Array", PackedVector3Array{Vector3(1, 2, 3), Vector3(4, 5, 6)}, changed);
    send(echo, "PackedColorArray", PackedColorArray{Color(1, 0, 0)}, changed);
    send(echo, "PackedVector4Array", PackedVector4Array{Vector4(1, 2, 3, 4)}, changed);
    send(echo, "empty PackedByteArray", PackedByteArray(), changed);
}

}  // namespace

PackedStringArray BindingEcho::send_through(const Callable& echo) const {
    PackedStringArray changed;
    send_numbers(echo, changed);
    send_math(echo, changed);
    send_handles(echo, changed);
    send_packed(echo, changed);
    return changed;
}

String BindingEcho::join(const String& left, int32_t right, bool upper) {
    const String joined = vformat("%s-%d", left, right);
    return upper ? joined.to_upper() : joined;
}

PackedVector3Array BindingEcho::moved(const PackedVector3Array& points, const Vector3& by) const {
    PackedVector3Array result = points;
    for (Vector3& point : result) {
        point += by;
    }
    return result;
}

double BindingEcho::sum(const PackedFloat32Array& values) const {
    double total = 0.0;
    for (const float value : values) {
        total += static_cast<double>(value);
    }
    return total;
}

void BindingEcho::_bind_methods() {
    ClassDB::bind_method(D_METHOD("echo_bool", "value"), &BindingEcho::echo<bool>);
    ClassDB::bind_method(D_METHOD("echo_int", "value"), &BindingEcho::echo<int64_t>);
    ClassDB::bind_method(D_METHOD("echo_int32", "value"), &BindingEcho::echo<int32_t>);
    ClassDB::bind_method(D_METHOD("echo_uint8", "value"), &BindingEcho::echo<uint8_t>);
    ClassDB::bind_method(D_METHOD("echo_float", "value"), &BindingEcho::echo<double>);
    ClassDB::bind_method(D_METHOD("echo_float32", "value"), &BindingEcho::echo<float>);
    ClassDB::bind_method(D_METHOD("echo_string", "value"), &BindingEcho::echo<String>);
    ClassDB::bind_method(D_METHOD("echo_vector2", "value"), &BindingEcho::echo<Vector2>);
    ClassDB::bind_method(D_METHOD("echo_vector2i", "value"), &BindingEcho::echo<Vector2i>);
    ClassDB::bind_method(D_METHOD("echo_rect2", "value"), &BindingEcho::echo<Rect2>);
    ClassDB::bind_method(D_METHOD("echo_rect2i", "value"), &BindingEcho::echo<Rect2i>);
    ClassDB::bind_method(D_METHOD("echo_vector3", "value"), &BindingEcho::echo<Vector3>);
    ClassDB::bind_method(D_METHOD("echo_vector3i", "value"), &BindingEcho::echo<Vector3i>);
    ClassDB::bind_method(D_METHOD("echo_transform2d", "value"), &BindingEcho::echo<Transform2D>);
    ClassDB::bind_method(D_METHOD("echo_vector4", "value"), &BindingEcho::echo<Vector4>);
    ClassDB::bind_method(D_METHOD("echo_vector4i", "value"), &BindingEcho::echo<Vector4i>);
    ClassDB::bind_method(D_METHOD("echo_plane", "value"), &BindingEcho::echo<Plane>);
    ClassDB::bind_method(D_METHOD("echo_quaternion", "value"), &BindingEcho::echo<Quaternion>);
    ClassDB::bind_method(D_METHOD("echo_aabb", "value"), &BindingEcho::echo<AABB>);
    ClassDB::bind_method(D_METHOD("echo_basis", "value"), &BindingEcho::echo<Basis>);
    ClassDB::bind_method(D_METHOD("echo_transform3d", "value"), &BindingEcho::echo<Transform3D>);
    ClassDB::bind_method(D_METHOD("echo_projection", "value"), &BindingEcho::echo<Projection>);
    ClassDB::bind_method(D_METHOD("echo_color", "value"), &BindingEcho::echo<Color>);
    ClassDB::bind_method(D_METHOD("echo_string_name", "value"), &BindingEcho::echo<StringName>);
    ClassDB::bind_method(D_METHOD("echo_node_path", "value"), &BindingEcho::echo<NodePath>);
    ClassDB::bind_method(D_METHOD("echo_rid", "value"), &BindingEcho::echo<RID>);
    ClassDB::bind_method(D_METHOD("echo_callable", "value"), &BindingEcho::echo<Callable>);
    ClassDB::bind_method(D_METHOD("echo_signal", "value"), &BindingEcho::echo<Signal>);
    ClassDB::bind_method(D_METHOD("echo_dictionary", "value"), &BindingEcho::echo<Dictionary>);
    ClassDB::bind_method(D_METHOD("echo_array", "value"), &BindingEcho::echo<Array>);
    ClassDB::bind_method(D_METHOD("echo_packed_byte_array", "value"), &BindingEcho::echo<PackedByteArray>);
    ClassDB::bind_method(D_METHOD("echo_packed_int32_array", "value"), &BindingEcho::echo<PackedInt32Array>);
    ClassDB::bind_method(D_METHOD("echo_packed_int64_array", "value"), &BindingEcho::echo<PackedInt64Array>);
    ClassDB::bind_method(D_METHOD("echo_packed_float32_array", "value"),
                         &BindingEcho::echo<PackedFloat32Array>);
    ClassDB::bind_method(D_METHOD("echo_packed_float64_array", "value"),
                         &BindingEcho::echo<PackedFloat64Array>);
    ClassDB::bind_method(D_METHOD("echo_packed_string_array", "value"),
                         &BindingEcho::echo<PackedStringArray>);
    ClassDB::bind_method(D_METHOD("echo_packed_vector2_array", "value"),
                         &BindingEcho::echo<PackedVector2Array>);
    ClassDB::bind_method(D_METHOD("echo_packed_vector3_array", "value"),
                         &BindingEcho::echo<PackedVector3Array>);
    ClassDB::bind_method(D_METHOD("echo_packed_color_array", "value"), &BindingEcho::echo<PackedColorArray>);
    ClassDB::bind_method(D_METHOD("echo_packed_vector4_array", "value"),
                         &BindingEcho::echo<PackedVector4Array>);
    ClassDB::bind_method(D_METHOD("echo_variant", "value"), &BindingEcho::echo<Variant>);
    ClassDB::bind_method(D_METHOD("echo_int_array", "value"), &BindingEcho::echo<TypedArray<int64_t>>);
    ClassDB::bind_method(D_METHOD("echo_node_array", "value"), &BindingEcho::echo<TypedArray<Node>>);
    ClassDB::bind_method(D_METHOD("echo_enum", "value"), &BindingEcho::echo_enum);
    ClassDB::bind_method(D_METHOD("echo_object", "value"), &BindingEcho::echo_object);
    ClassDB::bind_method(D_METHOD("echo_node", "value"), &BindingEcho::echo_node);
    ClassDB::bind_method(D_METHOD("echo_resource", "value"), &BindingEcho::echo_resource);
    ClassDB::bind_method(D_METHOD("send_through", "echo"), &BindingEcho::send_through);
    ClassDB::bind_method(D_METHOD("moved", "points", "by"), &BindingEcho::moved);
    ClassDB::bind_method(D_METHOD("sum", "values"), &BindingEcho::sum);
    ClassDB::bind_static_method("BindingEcho", D_METHOD("join", "left", "right", "upper"), &BindingEcho::join,
                                DEFVAL(7), DEFVAL(false));
    BIND_ENUM_CONSTANT(FLAVOUR_SWEET);
    BIND_ENUM_CONSTANT(FLAVOUR_SOUR);
    BIND_ENUM_CONSTANT(FLAVOUR_BITTER);
}

}  // namespace probe
