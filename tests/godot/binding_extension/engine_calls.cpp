#include "engine_calls.hpp"

#include <godot_cpp/classes/box_mesh.hpp>
#include <godot_cpp/classes/box_shape3d.hpp>
#include <godot_cpp/classes/camera3d.hpp>
#include <godot_cpp/classes/convex_polygon_shape3d.hpp>
#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/file_access.hpp>
#include <godot_cpp/classes/height_map_shape3d.hpp>
#include <godot_cpp/classes/image.hpp>
#include <godot_cpp/classes/json.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/os.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/classes/time.hpp>
#include <godot_cpp/classes/window.hpp>
#include <godot_cpp/classes/world_boundary_shape3d.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

using namespace godot;

namespace probe {

namespace {

#define EXPECT(m_condition)               \
    if (!(m_condition)) {                 \
        failures.push_back(#m_condition); \
    } else                                \
        ((void)0)

}  // namespace

PackedStringArray BindingEngineCalls::values() {
    PackedStringArray failures;
    set_process(true);
    EXPECT(is_processing());
    set_process_priority(-7);
    EXPECT(get_process_priority() == -7);
    set_process_mode(PROCESS_MODE_ALWAYS);
    EXPECT(get_process_mode() == PROCESS_MODE_ALWAYS);

    RigidBody3D* body = memnew(RigidBody3D);
    add_child(body);
    body->set_mass(2.5f);
    EXPECT(body->get_mass() == 2.5f);
    body->set_collision_layer(0xF0000001u);
    EXPECT(body->get_collision_layer() == 0xF0000001u);
    body->set_position(Vector3(1, 2, 3));
    EXPECT(body->get_position() == Vector3(1, 2, 3));
    const Transform3D pose(Basis(Vector3(0, 1, 0), 0.5f), Vector3(4, 5, 6));
    body->set_global_transform(pose);
    EXPECT(body->get_global_transform().is_equal_approx(pose));
    EXPECT(body->get_quaternion().is_equal_approx(Quaternion(Vector3(0, 1, 0), 0.5f)));
    EXPECT(body->get_basis().is_equal_approx(pose.basis));
    EXPECT(body->get_rid().is_valid());
    EXPECT(PhysicsServer3D::get_singleton()->body_get_collision_layer(body->get_rid()) == 0xF0000001u);
    const Variant mass =
        PhysicsServer3D::get_singleton()->body_get_param(body->get_rid(), PhysicsServer3D::BODY_PARAM_MASS);
    EXPECT(static_cast<double>(mass) == 2.5);
    memdelete(body);

    const Ref<Image> image = Image::create_empty(4, 2, false, Image::FORMAT_RGBA8);
    image->fill(Color(1, 0, 0));
    image->fill_rect(Rect2i(0, 0, 1, 1), Color(0, 1, 0, 1));
    EXPECT(image->get_size() == Vector2i(4, 2));
    EXPECT(image->get_pixel(1, 1) == Color(1, 0, 0));
    EXPECT(image->get_pixel(0, 0) == Color(0, 1, 0));
    EXPECT(image->get_format() == Image::FORMAT_RGBA8);
    return failures;
}

PackedStringArray BindingEngineCalls::objects() {
    PackedStringArray failures;
    MeshInstance3D* instance = memnew(MeshInstance3D);
    Ref<BoxMesh> box;
    box.instantiate();
    EXPECT(box->get_reference_count() == 1);
    instance->set_mesh(box);
    EXPECT(box->get_reference_count() == 2);
    EXPECT(instance->get_mesh() == box);
    EXPECT(Object::cast_to<BoxMesh>(instance->get_mesh().ptr()) == box.ptr());
    EXPECT(Object::cast_to<Camera3D>(instance) == nullptr);
    EXPECT(box->get_reference_count() == 2);

    EXPECT(instance->get_parent() == nullptr);
    add_child(instance);
    EXPECT(instance->get_parent() == this);
    EXPECT(get_child(0) == instance);
    instance->set_name("mesh");
    EXPECT(get_node<MeshInstance3D>("mesh") == instance);
    EXPECT(get_node<Camera3D>("mesh") == nullptr);
    EXPECT(get_node_or_null(NodePath("nobody")) == nullptr);
    EXPECT(get_tree()->get_root()->is_ancestor_of(this));
    EXPECT(get_viewport() == get_tree()->get_root());
    EXPECT(get_window()->get_class() == "Window");
    EXPECT(ObjectDB::get_instance(instance->get_instance_id()) == instance);

    const uint64_t id = instance->get_instance_id();
    const Variant holder = instance;
    memdelete(instance);
    EXPECT(ObjectDB::get_instance(id) == nullptr);
    EXPECT(holder.get_validated_object() == nullptr);
    EXPECT(box->get_reference_count() == 1);

    // A class that the binding does not know is seen as its nearest base.
    Object* label = get_parent()->get_node_or_null(NodePath("unlisted"));
    EXPECT(label != nullptr && label->get_class() == "SpotLight3D");
    EXPECT(Object::cast_to<VisualInstance3D>(label) != nullptr);
    return failures;
}

PackedStringArray BindingEngineCalls::containers() {
    PackedStringArray failures;
    Ref<ConvexPolygonShape3D> convex;
    convex.instantiate();
    const PackedVector3Array points{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)};
    convex->set_points(points);
    EXPECT(convex->get_points() == points);

    Ref<HeightMapShape3D> heights;
    heights.instantiate();
    heights->set_map_width(2);
    heights->set_map_depth(2);
    heights->set_map_data(PackedFloat32Array{0, 1, 2, 3});
    EXPECT(heights->get_map_data()[3] == 3.0f);

    Ref<WorldBoundaryShape3D> ground;
    ground.instantiate();
    ground->set_plane(Plane(0, 1, 0, -2));
    EXPECT(ground->get_plane() == Plane(0, 1, 0, -2));

    Ref<BoxMesh> box;
    box.instantiate();
    box->set_size(Vector3(1, 2, 3));
    EXPECT(box->get_aabb() == AABB(Vector3(-0.5f, -1, -1.5f), Vector3(1, 2, 3)));
    const Array surface = box->get_mesh_arrays();
    EXPECT(surface.size() == Mesh::ARRAY_MAX);
    const PackedVector3Array vertices = surface[Mesh::ARRAY_VERTEX];
    EXPECT(vertices.size() == 24);
    EXPECT(box->get_faces().size() == 36);

    Node* child = memnew(Node);
    add_child(child);
    const TypedArray<Node> children = get_children();
    EXPECT(children.size() == 1);
    EXPECT(Object::cast_to<Node>(children[0]) == child);
    memdelete(child);

    const Dictionary parsed = JSON::parse_string("{\"a\": [1, 2.5, null]}");
    const Array list = parsed["a"];
    EXPECT(list.size() == 3);
    EXPECT(static_cast<double>(list[1]) == 2.5);
    EXPECT(list[2].get_type() == Variant::NIL);
    EXPECT(JSON::stringify(parsed) == "{\"a\":[1.0,2.5,null]}");
    int64_t total = 0;
    for (const Variant& number : Array{1, 2, 3}) {
        total += static_cast<int64_t>(number);
    }
    EXPECT(total == 6);
    EXPECT(Time::get_singleton()->get_datetime_dict_from_unix_time(0)["year"] == Variant(1970));

    const Ref<FileAccess> file = FileAccess::open("user://binding_probe.bin", FileAccess::WRITE_READ);
    file->store_buffer(PackedByteArray{1, 2, 250});
    file->seek(0);
    EXPECT(file->get_buffer(3) == (PackedByteArray{1, 2, 250}));

    PackedStringArray words;
    words.push_back("b");
    words.append("a");
    words.sort();
    EXPECT(String(",").join(words) == "a,b");
    PackedVector3Array shared = points;
    shared.ptrw()[0] = Vector3(9, 9, 9);
    EXPECT(points[0] == Vector3());
    EXPECT(shared[0] == Vector3(9, 9, 9));
    return failures;
}

PackedStringArray BindingEngineCalls::strings() {
    PackedStringArray failures;
    const String text = String::utf8("Kraft ≤ 5 N");
    EXPECT(text.length() == 11);
    EXPECT(text[6] == U'≤');
    EXPECT(String::utf8(text.utf8().get_data()) == text);
    EXPECT(text.utf8().length() == 13);
    EXPECT(text.begins_with("Kraft"));
    EXPECT(text.substr(0, 5) + "!" == "Kraft!");
    EXPECT("a" + String("b") == "ab");
    EXPECT(String("a") < String("b"));
    String grown = "x";
    grown += "y";
    grown += String("z");
    EXPECT(grown == "xyz");
    EXPECT(String("%s has %d of %.2f") % (Array{"box", 3, 0.5}) == "box has 3 of 0.50");
    EXPECT(vformat("%s|%d", Vector3(1, 2, 3), 4) == "(1.0, 2.0, 3.0)|4");
    EXPECT(itos(-5) == "-5");
    EXPECT(String::num(0.5) == "0.5");
    EXPECT(String("3.5").to_float() == 3.5);
    EXPECT(String("12").to_int() == 12);
    EXPECT(String("a/b/c.obj").get_file() == "c.obj");
    EXPECT(String("a,b").split(",").size() == 2);
    EXPECT(StringName("same") == StringName(String("same")));
    EXPECT(String(StringName("same")) == "same");
    EXPECT(NodePath("A/B:x").get_name_count() == 2);
    EXPECT(String(NodePath("A/B")) == "A/B");
    EXPECT(String().is_empty());
    return failures;
}

PackedStringArray BindingEngineCalls::math() {
    PackedStringArray failures;
    const Basis turned(Vector3(1, 2, 3).normalized(), 0.7f);
    const Transform3D pose(turned.scaled_local(Vector3(1, 2, 3)), Vector3(4, 5, 6));
    const Variant engine_pose = pose;
    const Vector3 point(0.3f, -0.4f, 0.5f);
    Variant by_engine;
    bool valid = false;
    Variant::evaluate(Variant::OP_MULTIPLY, engine_pose, point, by_engine, valid);
    EXPECT(pose.xform(point).is_equal_approx(by_engine));
    EXPECT(pose.affine_inverse().is_equal_approx(Variant(pose).call("affine_inverse")));
    EXPECT(turned.get_quaternion().is_equal_approx(Variant(turned).call("get_rotation_quaternion")));
    EXPECT(pose.basis.orthonormalized().is_equal_approx(Variant(pose.basis).call("orthonormalized")));
    EXPECT(pose.basis.get_scale().is_equal_approx(Variant(pose.basis).call("get_scale")));
    EXPECT(Basis(turned.get_quaternion()).is_equal_approx(turned));
    EXPECT(Basis::from_euler(turned.get_euler()).is_equal_approx(turned));
    EXPECT(Basis::looking_at(Vector3(1, 2, 3))
               .is_equal_approx(Variant(Basis()).call("looking_at", Vector3(1, 2, 3))));
    EXPECT(turned.transposed().is_equal_approx(turned.inverse()));
    const Quaternion a(Vector3(0, 1, 0), 0.2f);
    const Quaternion b(Vector3(1, 0, 0), 1.2f);
    EXPECT(a.slerp(b, 0.3f).is_equal_approx(Variant(a).call("slerp", b, 0.3)));
    EXPECT((a * b).is_equal_approx(Quaternion(Basis(a) * Basis(b))));
    EXPECT(Vector3(1, 0, 0).rotated(Vector3(0, 0, 1), real_t(Math_PI / 2)).is_equal_approx(Vector3(0, 1, 0)));
    EXPECT(pose.interpolate_with(Transform3D(), 0.25f)
               .is_equal_approx(Variant(pose).call("interpolate_with", Transform3D(), 0.25)));
    EXPECT(Color::html("#ff0000") == Color(1, 0, 0));
    EXPECT(Color(0, 1, 0).to_html(false) == "00ff00");
    return failures;
}

PackedStringArray BindingEngineCalls::utilities() {
    PackedStringArray failures;
    EXPECT(UtilityFunctions::str("a", 1, Vector2(1, 2)) == "a1(1.0, 2.0)");
    EXPECT(UtilityFunctions::type_of(Vector3()) == Variant::VECTOR3);
    EXPECT(static_cast<int64_t>(UtilityFunctions::str_to_var("5")) == 5);
    EXPECT(UtilityFunctions::lerpf(0, 10, 0.5) == 5.0);
    EXPECT(UtilityFunctions::is_instance_id_valid(static_cast<int64_t>(get_instance_id())));
    EXPECT(Engine::get_singleton()->get_version_info().has("major"));
    EXPECT(!Engine::get_singleton()->is_editor_hint());
    EXPECT(OS::get_singleton()->get_name() == "Linux");
    EXPECT(static_cast<bool>(call("has_method", "values")));
    EXPECT(static_cast<int64_t>(callv("get_child_count", Array())) == get_child_count());
    EXPECT(Callable(this, "get_child_count").call() == Variant(get_child_count()));
    EXPECT(Callable(this, "set_name").bind("renamed").is_valid());
    EXPECT(Variant(Array{1, 2}).call("size") == Variant(2));
    set_meta("weight", 5);
    EXPECT(get_meta("weight") == Variant(5));
    EXPECT(get_meta("nothing", "default") == Variant("default"));
    add_user_signal("done");
    EXPECT(emit_signal("done") == OK);
    EXPECT(Signal(this, "done").get_name() == StringName("done"));
    return failures;
}

void BindingEngineCalls::_bind_methods() {
    ClassDB::bind_method(D_METHOD("values"), &BindingEngineCalls::values);
    ClassDB::bind_method(D_METHOD("objects"), &BindingEngineCalls::objects);
    ClassDB::bind_method(D_METHOD("containers"), &BindingEngineCalls::containers);
    ClassDB::bind_method(D_METHOD("strings"), &BindingEngineCalls::strings);
    ClassDB::bind_method(D_METHOD("math"), &BindingEngineCalls::math);
    ClassDB::bind_method(D_METHOD("utilities"), &BindingEngineCalls::utilities);
}

}  // namespace probe
