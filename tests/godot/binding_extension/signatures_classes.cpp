#include "signatures.hpp"

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/audio_stream.hpp>
#include <godot_cpp/classes/audio_stream_generator.hpp>
#include <godot_cpp/classes/audio_stream_generator_playback.hpp>
#include <godot_cpp/classes/audio_stream_player3d.hpp>
#include <godot_cpp/classes/base_material3d.hpp>
#include <godot_cpp/classes/box_shape3d.hpp>
#include <godot_cpp/classes/camera3d.hpp>
#include <godot_cpp/classes/canvas_item.hpp>
#include <godot_cpp/classes/capsule_shape3d.hpp>
#include <godot_cpp/classes/collision_object3d.hpp>
#include <godot_cpp/classes/collision_shape3d.hpp>
#include <godot_cpp/classes/concave_polygon_shape3d.hpp>
#include <godot_cpp/classes/control.hpp>
#include <godot_cpp/classes/convex_polygon_shape3d.hpp>
#include <godot_cpp/classes/curve.hpp>
#include <godot_cpp/classes/curve3d.hpp>
#include <godot_cpp/classes/cylinder_shape3d.hpp>
#include <godot_cpp/classes/dir_access.hpp>
#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/engine_debugger.hpp>
#include <godot_cpp/classes/file_access.hpp>
#include <godot_cpp/classes/gd_extension_manager.hpp>
#include <godot_cpp/classes/generic6_dof_joint3d.hpp>
#include <godot_cpp/classes/geometry_instance3d.hpp>
#include <godot_cpp/classes/height_map_shape3d.hpp>
#include <godot_cpp/classes/hinge_joint3d.hpp>
#include <godot_cpp/classes/image.hpp>
#include <godot_cpp/classes/input.hpp>
#include <godot_cpp/classes/input_event.hpp>
#include <godot_cpp/classes/input_event_mouse.hpp>
#include <godot_cpp/classes/input_event_mouse_button.hpp>
#include <godot_cpp/classes/joint3d.hpp>
#include <godot_cpp/classes/json.hpp>
#include <godot_cpp/classes/material.hpp>
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/object.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/classes/physics_direct_body_state3d.hpp>
#include <godot_cpp/classes/physics_direct_space_state3d.hpp>
#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/physics_shape_query_parameters3d.hpp>
#include <godot_cpp/classes/primitive_mesh.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/classes/rendering_server.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/classes/resource_loader.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/classes/skeleton3d.hpp>
#include <godot_cpp/classes/skin.hpp>
#include <godot_cpp/classes/skin_reference.hpp>
#include <godot_cpp/classes/slider_joint3d.hpp>
#include <godot_cpp/classes/sphere_mesh.hpp>
#include <godot_cpp/classes/sphere_shape3d.hpp>
#include <godot_cpp/classes/static_body3d.hpp>
#include <godot_cpp/classes/texture2d.hpp>
#include <godot_cpp/classes/time.hpp>
#include <godot_cpp/classes/viewport.hpp>
#include <godot_cpp/classes/visual_instance3d.hpp>
#include <godot_cpp/classes/world3d.hpp>
#include <godot_cpp/classes/world_boundary_shape3d.hpp>
#include <godot_cpp/classes/xr_controller3d.hpp>
#include <godot_cpp/classes/xr_node3d.hpp>

using namespace godot;

namespace probe {

void list_classes() {
    same<Mesh::BlendShapeMode (ArrayMesh::*)() const>(&ArrayMesh::get_blend_shape_mode);
    same<Mesh::PrimitiveType (ArrayMesh::*)(int32_t) const>(&ArrayMesh::surface_get_primitive_type);
    same<void (ArrayMesh::*)()>(&ArrayMesh::clear_surfaces);
    same<void (ArrayMesh::*)(Mesh::PrimitiveType, const Array&, const TypedArray<Array>&, const Dictionary&,
                             BitField<Mesh::ArrayFormat>)>(&ArrayMesh::add_surface_from_arrays);

    same<Dictionary (AudioStream::*)() const>(&AudioStream::_get_tags);
    same<Ref<AudioStreamPlayback> (AudioStream::*)() const>(&AudioStream::_instantiate_playback);
    same<String (AudioStream::*)() const>(&AudioStream::_get_stream_name);
    same<TypedArray<Dictionary> (AudioStream::*)() const>(&AudioStream::_get_parameter_list);
    same<bool (AudioStream::*)() const>(&AudioStream::_has_loop);
    same<bool (AudioStream::*)() const>(&AudioStream::_is_monophonic);
    same<double (AudioStream::*)() const>(&AudioStream::_get_bpm);
    same<double (AudioStream::*)() const>(&AudioStream::_get_length);
    same<int32_t (AudioStream::*)() const>(&AudioStream::_get_bar_beats);
    same<int32_t (AudioStream::*)() const>(&AudioStream::_get_beat_count);

    same<void (AudioStreamGenerator::*)(float)>(&AudioStreamGenerator::set_buffer_length);
    same<void (AudioStreamGenerator::*)(float)>(&AudioStreamGenerator::set_mix_rate);

    same<bool (AudioStreamGeneratorPlayback::*)(const PackedVector2Array&)>(
        &AudioStreamGeneratorPlayback::push_buffer);
    same<int32_t (AudioStreamGeneratorPlayback::*)() const>(
        &AudioStreamGeneratorPlayback::get_frames_available);

    same<Ref<AudioStreamPlayback> (AudioStreamPlayer3D::*)()>(&AudioStreamPlayer3D::get_stream_playback);
    same<void (AudioStreamPlayer3D::*)(const Ref<AudioStream>&)>(&AudioStreamPlayer3D::set_stream);
    same<void (AudioStreamPlayer3D::*)(float)>(&AudioStreamPlayer3D::play);
    same<void (AudioStreamPlayer3D::*)(float)>(&AudioStreamPlayer3D::set_volume_db);

    same<void (BaseMaterial3D::*)(BaseMaterial3D::CullMode)>(&BaseMaterial3D::set_cull_mode);
    same<void (BaseMaterial3D::*)(BaseMaterial3D::Flags, bool)>(&BaseMaterial3D::set_flag);
    same<void (BaseMaterial3D::*)(float)>(&BaseMaterial3D::set_point_size);
    same<void (BaseMaterial3D::*)(BaseMaterial3D::ShadingMode)>(&BaseMaterial3D::set_shading_mode);
    same<void (BaseMaterial3D::*)(BaseMaterial3D::Transparency)>(&BaseMaterial3D::set_transparency);
    same<void (BaseMaterial3D::*)(const Color&)>(&BaseMaterial3D::set_albedo);

    same<Vector3 (BoxShape3D::*)() const>(&BoxShape3D::get_size);
    same<void (BoxShape3D::*)(const Vector3&)>(&BoxShape3D::set_size);

    same<Transform3D (Camera3D::*)() const>(&Camera3D::get_camera_transform);
    same<Vector3 (Camera3D::*)(const Vector2&) const>(&Camera3D::project_ray_normal);
    same<Vector3 (Camera3D::*)(const Vector2&) const>(&Camera3D::project_ray_origin);

    same<Rect2 (CanvasItem::*)() const>(&CanvasItem::get_viewport_rect);
    same<bool (CanvasItem::*)() const>(&CanvasItem::is_visible_in_tree);

    same<float (CapsuleShape3D::*)() const>(&CapsuleShape3D::get_height);
    same<float (CapsuleShape3D::*)() const>(&CapsuleShape3D::get_radius);

    same<CollisionObject3D::DisableMode (CollisionObject3D::*)() const>(&CollisionObject3D::get_disable_mode);
    same<Object* (CollisionObject3D::*)(uint32_t) const>(&CollisionObject3D::shape_owner_get_owner);
    same<PackedInt32Array (CollisionObject3D::*)()>(&CollisionObject3D::get_shape_owners);
    same<RID (CollisionObject3D::*)() const>(&CollisionObject3D::get_rid);
    same<Ref<Shape3D> (CollisionObject3D::*)(uint32_t, int32_t) const>(
        &CollisionObject3D::shape_owner_get_shape);
    same<Transform3D (CollisionObject3D::*)(uint32_t) const>(&CollisionObject3D::shape_owner_get_transform);
    same<bool (CollisionObject3D::*)(uint32_t) const>(&CollisionObject3D::is_shape_owner_disabled);
    same<int32_t (CollisionObject3D::*)(uint32_t) const>(&CollisionObject3D::shape_owner_get_shape_count);
    same<uint32_t (CollisionObject3D::*)() const>(&CollisionObject3D::get_collision_layer);
    same<uint32_t (CollisionObject3D::*)() const>(&CollisionObject3D::get_collision_mask);
    same<void (CollisionObject3D::*)()>(&CollisionObject3D::_mouse_enter);
    same<void (CollisionObject3D::*)()>(&CollisionObject3D::_mouse_exit);
    same<void (CollisionObject3D::*)(Camera3D*, const Ref<InputEvent>&, const Vector3&, const Vector3&,
                                     int32_t)>(&CollisionObject3D::_input_event);

    same<void (CollisionShape3D::*)(const Ref<Shape3D>&)>(&CollisionShape3D::set_shape);

    same<PackedVector3Array (ConcavePolygonShape3D::*)() const>(&ConcavePolygonShape3D::get_faces);

    same<Control::MouseFilter (Control::*)() const>(&Control::get_mouse_filter);
    same<Rect2 (Control::*)() const>(&Control::get_global_rect);

    same<PackedVector3Array (ConvexPolygonShape3D::*)() const>(&ConvexPolygonShape3D::get_points);
    same<void (ConvexPolygonShape3D::*)(const PackedVector3Array&)>(&ConvexPolygonShape3D::set_points);

    same<float (Curve::*)() const>(&Curve::get_max_domain);
    same<float (Curve::*)(float) const>(&Curve::sample);

    same<PackedVector3Array (Curve3D::*)(int32_t, float) const>(&Curve3D::tessellate_even_length);
    same<Vector3 (Curve3D::*)(int32_t, float) const>(&Curve3D::sample);
    same<int32_t (Curve3D::*)() const>(&Curve3D::get_point_count);

    same<float (CylinderShape3D::*)() const>(&CylinderShape3D::get_height);
    same<float (CylinderShape3D::*)() const>(&CylinderShape3D::get_radius);

    same<PackedStringArray (*)(const String&)>(&DirAccess::get_files_at);

    same<Engine* (*)()>(&Engine::get_singleton);
    same<bool (Engine::*)() const>(&Engine::is_editor_hint);
    same<double (Engine::*)()>(&Engine::get_time_scale);
    same<int32_t (Engine::*)() const>(&Engine::get_physics_ticks_per_second);

    same<EngineDebugger* (*)()>(&EngineDebugger::get_singleton);
    same<bool (EngineDebugger::*)()>(&EngineDebugger::is_active);

    same<PackedByteArray (*)(const String&)>(&FileAccess::get_file_as_bytes);
    same<PackedByteArray (FileAccess::*)(int64_t) const>(&FileAccess::get_buffer);
    same<Ref<FileAccess> (*)(const String&, FileAccess::ModeFlags)>(&FileAccess::open);
    same<String (*)(const String&)>(&FileAccess::get_file_as_string);
    same<bool (*)(const String&)>(&FileAccess::file_exists);
    same<uint64_t (FileAccess::*)() const>(&FileAccess::get_length);

    same<GDExtensionManager* (*)()>(&GDExtensionManager::get_singleton);
    same<PackedStringArray (GDExtensionManager::*)() const>(&GDExtensionManager::get_loaded_extensions);

    same<bool (Generic6DOFJoint3D::*)(Generic6DOFJoint3D::Flag) const>(&Generic6DOFJoint3D::get_flag_x);
    same<bool (Generic6DOFJoint3D::*)(Generic6DOFJoint3D::Flag) const>(&Generic6DOFJoint3D::get_flag_y);
    same<bool (Generic6DOFJoint3D::*)(Generic6DOFJoint3D::Flag) const>(&Generic6DOFJoint3D::get_flag_z);
    same<float (Generic6DOFJoint3D::*)(Generic6DOFJoint3D::Param) const>(&Generic6DOFJoint3D::get_param_x);
    same<float (Generic6DOFJoint3D::*)(Generic6DOFJoint3D::Param) const>(&Generic6DOFJoint3D::get_param_y);
    same<float (Generic6DOFJoint3D::*)(Generic6DOFJoint3D::Param) const>(&Generic6DOFJoint3D::get_param_z);

    same<void (GeometryInstance3D::*)(GeometryInstance3D::ShadowCastingSetting)>(
        &GeometryInstance3D::set_cast_shadows_setting);
    same<void (GeometryInstance3D::*)(const Ref<Material>&)>(&GeometryInstance3D::set_material_override);

    same<PackedFloat32Array (HeightMapShape3D::*)() const>(&HeightMapShape3D::get_map_data);
    same<int32_t (HeightMapShape3D::*)() const>(&HeightMapShape3D::get_map_depth);
    same<int32_t (HeightMapShape3D::*)() const>(&HeightMapShape3D::get_map_width);

    same<bool (HingeJoint3D::*)(HingeJoint3D::Flag) const>(&HingeJoint3D::get_flag);
    same<float (HingeJoint3D::*)(HingeJoint3D::Param) const>(&HingeJoint3D::get_param);

    same<Error (Image::*)()>(&Image::decompress);
    same<PackedByteArray (Image::*)() const>(&Image::get_data);
    same<bool (Image::*)() const>(&Image::is_compressed);
    same<bool (Image::*)() const>(&Image::is_empty);
    same<int32_t (Image::*)() const>(&Image::get_height);
    same<int32_t (Image::*)() const>(&Image::get_width);
    same<void (Image::*)()>(&Image::clear_mipmaps);
    same<void (Image::*)(Image::Format)>(&Image::convert);

    same<BitField<MouseButtonMask> (Input::*)() const>(&Input::get_mouse_button_mask);
    same<Input* (*)()>(&Input::get_singleton);
    same<String (Input::*)(int32_t)>(&Input::get_joy_name);
    same<TypedArray<int64_t> (Input::*)()>(&Input::get_connected_joypads);
    same<bool (Input::*)(Key) const>(&Input::is_physical_key_pressed);
    same<bool (Input::*)(int32_t, JoyButton) const>(&Input::is_joy_button_pressed);
    same<float (Input::*)(int32_t, JoyAxis) const>(&Input::get_joy_axis);
    same<void (Input::*)(int32_t)>(&Input::stop_joy_vibration);
    same<void (Input::*)(int32_t, float, float, float)>(&Input::start_joy_vibration);

    same<bool (InputEvent::*)() const>(&InputEvent::is_pressed);

    same<Vector2 (InputEventMouse::*)() const>(&InputEventMouse::get_position);

    same<MouseButton (InputEventMouseButton::*)() const>(&InputEventMouseButton::get_button_index);

    same<Variant (*)(const String&)>(&JSON::parse_string);

    same<NodePath (Joint3D::*)() const>(&Joint3D::get_node_a);
    same<NodePath (Joint3D::*)() const>(&Joint3D::get_node_b);
    same<bool (Joint3D::*)() const>(&Joint3D::get_exclude_nodes_from_collision);

    same<RID (Material::*)() const>(&Material::_get_shader_rid);
    same<bool (Material::*)() const>(&Material::_can_do_next_pass);
    same<bool (Material::*)() const>(&Material::_can_use_render_priority);
    same<void (Material::*)(const Ref<Material>&)>(&Material::set_next_pass);

    same<AABB (Mesh::*)() const>(&Mesh::_get_aabb);
    same<Array (Mesh::*)(int32_t) const>(&Mesh::_surface_get_arrays);
    same<Array (Mesh::*)(int32_t) const>(&Mesh::surface_get_arrays);
    same<Dictionary (Mesh::*)(int32_t) const>(&Mesh::_surface_get_lods);
    same<PackedVector3Array (Mesh::*)() const>(&Mesh::get_faces);
    same<Ref<Material> (Mesh::*)(int32_t) const>(&Mesh::_surface_get_material);
    same<StringName (Mesh::*)(int32_t) const>(&Mesh::_get_blend_shape_name);
    same<TypedArray<Array> (Mesh::*)(int32_t) const>(&Mesh::_surface_get_blend_shape_arrays);
    same<TypedArray<Array> (Mesh::*)(int32_t) const>(&Mesh::surface_get_blend_shape_arrays);
    same<int32_t (Mesh::*)() const>(&Mesh::_get_blend_shape_count);
    same<int32_t (Mesh::*)() const>(&Mesh::_get_surface_count);
    same<int32_t (Mesh::*)() const>(&Mesh::get_surface_count);
    same<int32_t (Mesh::*)(int32_t) const>(&Mesh::_surface_get_array_index_len);
    same<int32_t (Mesh::*)(int32_t) const>(&Mesh::_surface_get_array_len);
    same<uint32_t (Mesh::*)(int32_t) const>(&Mesh::_surface_get_format);
    same<uint32_t (Mesh::*)(int32_t) const>(&Mesh::_surface_get_primitive_type);
    same<void (Mesh::*)(int32_t, const Ref<Material>&)>(&Mesh::_surface_set_material);
    same<void (Mesh::*)(int32_t, const StringName&)>(&Mesh::_set_blend_shape_name);

    same<NodePath (MeshInstance3D::*)()>(&MeshInstance3D::get_skeleton_path);
    same<Ref<Mesh> (MeshInstance3D::*)() const>(&MeshInstance3D::get_mesh);
    same<Ref<SkinReference> (MeshInstance3D::*)() const>(&MeshInstance3D::get_skin_reference);
    same<float (MeshInstance3D::*)(int32_t) const>(&MeshInstance3D::get_blend_shape_value);
    same<int32_t (MeshInstance3D::*)() const>(&MeshInstance3D::get_blend_shape_count);
    same<void (MeshInstance3D::*)(const Ref<Mesh>&)>(&MeshInstance3D::set_mesh);

    same<Node* (Node::*)() const>(&Node::get_parent);
    same<Node* (Node::*)(const NodePath&) const>(&Node::get_node_or_null);
    same<Node* (Node::*)(int32_t, bool) const>(&Node::get_child);
    same<Node::ProcessMode (Node::*)() const>(&Node::get_process_mode);
    same<NodePath (Node::*)() const>(&Node::get_path);
    same<NodePath (Node::*)(Node*, bool) const>(&Node::get_path_to);
    same<PackedStringArray (Node::*)() const>(&Node::_get_accessibility_configuration_warnings);
    same<PackedStringArray (Node::*)() const>(&Node::_get_configuration_warnings);
    same<RID (Node::*)() const>(&Node::_get_focused_accessibility_element);
    same<SceneTree* (Node::*)() const>(&Node::get_tree);
    same<StringName (Node::*)() const>(&Node::get_name);
    same<TypedArray<Node> (Node::*)(const String&, const String&, bool, bool) const>(&Node::find_children);
    same<Viewport* (Node::*)() const>(&Node::get_viewport);
    same<bool (Node::*)() const>(&Node::can_process);
    same<bool (Node::*)() const>(&Node::is_inside_tree);
    same<bool (Node::*)(Node*) const>(&Node::is_ancestor_of);
    same<double (Node::*)() const>(&Node::get_process_delta_time);
    same<double (Node::*)() const>(&Node::get_physics_process_delta_time);
    same<int32_t (Node::*)(bool) const>(&Node::get_child_count);
    same<void (Node::*)()>(&Node::_enter_tree);
    same<void (Node::*)()>(&Node::_exit_tree);
    same<void (Node::*)()>(&Node::_ready);
    same<void (Node::*)()>(&Node::queue_free);
    same<void (Node::*)()>(&Node::update_configuration_warnings);
    same<void (Node::*)(Node*, bool, Node::InternalMode)>(&Node::add_child);
    same<void (Node::*)(bool)>(&Node::set_process);
    same<void (Node::*)(bool)>(&Node::set_process_internal);
    same<void (Node::*)(bool)>(&Node::set_physics_process_internal);
    same<void (Node::*)(const Ref<InputEvent>&)>(&Node::_input);
    same<void (Node::*)(const Ref<InputEvent>&)>(&Node::_shortcut_input);
    same<void (Node::*)(const Ref<InputEvent>&)>(&Node::_unhandled_input);
    same<void (Node::*)(const Ref<InputEvent>&)>(&Node::_unhandled_key_input);
    same<void (Node::*)(const StringName&)>(&Node::set_name);
    same<void (Node::*)(double)>(&Node::_physics_process);
    same<void (Node::*)(double)>(&Node::_process);
    same<void (Node::*)(int32_t)>(&Node::set_process_priority);

    same<Node3D* (Node3D::*)() const>(&Node3D::get_parent_node_3d);
    same<Ref<World3D> (Node3D::*)() const>(&Node3D::get_world_3d);
    same<Transform3D (Node3D::*)() const>(&Node3D::get_global_transform);
    same<Transform3D (Node3D::*)() const>(&Node3D::get_transform);
    same<Vector3 (Node3D::*)() const>(&Node3D::get_global_position);
    same<bool (Node3D::*)() const>(&Node3D::is_visible_in_tree);
    same<void (Node3D::*)(bool)>(&Node3D::set_as_top_level);
    same<void (Node3D::*)(bool)>(&Node3D::set_notify_local_transform);
    same<void (Node3D::*)(bool)>(&Node3D::set_notify_transform);
    same<void (Node3D::*)(bool)>(&Node3D::set_visible);
    same<void (Node3D::*)(const Transform3D&)>(&Node3D::set_global_transform);
    same<void (Node3D::*)(const Transform3D&)>(&Node3D::set_transform);
    same<void (Node3D::*)(const Vector3&)>(&Node3D::set_global_position);
    same<void (Node3D::*)(const Vector3&)>(&Node3D::set_position);
    same<void (Node3D::*)(const Vector3&)>(&Node3D::set_scale);

    same<Error (Object::*)(const StringName&, const Callable&, uint32_t)>(&Object::connect);
    same<String (Object::*)() const>(&Object::get_class);
    same<TypedArray<Dictionary> (Object::*)(const StringName&) const>(&Object::get_signal_connection_list);
    same<Variant (Object::*)() const>(&Object::get_script);
    same<Variant (Object::*)(const StringName&) const>(&Object::get);
    same<void (Object::*)(const StringName&, const Variant&)>(&Object::set_meta);
    same<Variant (Object::*)(const StringName&, const Array&)>(&Object::callv);
    same<bool (Object::*)(const String&) const>(&Object::is_class);
    same<bool (Object::*)(const StringName&) const>(&Object::has_method);
    same<bool (Object::*)(const StringName&, const Callable&) const>(&Object::is_connected);
    same<uint64_t (Object::*)() const>(&Object::get_instance_id);
    same<void (Object::*)()>(&Object::notify_property_list_changed);
    same<void (Object::*)(const StringName&, const Callable&)>(&Object::disconnect);
    same<void (Object::*)(const StringName&, const Variant&)>(&Object::set);
    same<void (Object::*)(const Variant&)>(&Object::set_script);

    same<TypedArray<PhysicsBody3D> (PhysicsBody3D::*)()>(&PhysicsBody3D::get_collision_exceptions);
    same<bool (PhysicsBody3D::*)(PhysicsServer3D::BodyAxis) const>(&PhysicsBody3D::get_axis_lock);

    same<Transform3D (PhysicsDirectBodyState3D::*)() const>(&PhysicsDirectBodyState3D::get_transform);
    same<Vector3 (PhysicsDirectBodyState3D::*)() const>(&PhysicsDirectBodyState3D::get_angular_velocity);
    same<Vector3 (PhysicsDirectBodyState3D::*)() const>(&PhysicsDirectBodyState3D::get_linear_velocity);

    same<bool (PhysicsMaterial::*)() const>(&PhysicsMaterial::is_absorbent);
    same<bool (PhysicsMaterial::*)() const>(&PhysicsMaterial::is_rough);
    same<float (PhysicsMaterial::*)() const>(&PhysicsMaterial::get_bounce);
    same<float (PhysicsMaterial::*)() const>(&PhysicsMaterial::get_friction);
    same<void (PhysicsMaterial::*)(float)>(&PhysicsMaterial::set_bounce);
    same<void (PhysicsMaterial::*)(float)>(&PhysicsMaterial::set_friction);

    same<TypedArray<Dictionary> (PhysicsDirectSpaceState3D::*)(
        const Ref<PhysicsShapeQueryParameters3D>&, int32_t)>(&PhysicsDirectSpaceState3D::intersect_shape);

    same<PhysicsServer3D* (*)()>(&PhysicsServer3D::get_singleton);
    same<PhysicsDirectBodyState3D* (PhysicsServer3D::*)(const RID&)>(&PhysicsServer3D::body_get_direct_state);
    same<PhysicsServer3D::BodyMode (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::body_get_mode);
    same<Variant (PhysicsServer3D::*)(const RID&, PhysicsServer3D::BodyParameter) const>(
        &PhysicsServer3D::body_get_param);
    same<PhysicsServer3D::ShapeType (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::shape_get_type);
    same<RID (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::body_get_space);
    same<RID (PhysicsServer3D::*)(const RID&, int32_t) const>(&PhysicsServer3D::body_get_shape);
    same<Transform3D (PhysicsServer3D::*)(const RID&, int32_t) const>(
        &PhysicsServer3D::body_get_shape_transform);
    same<Variant (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::shape_get_data);
    same<Variant (PhysicsServer3D::*)(const RID&, PhysicsServer3D::BodyState) const>(
        &PhysicsServer3D::body_get_state);
    same<int32_t (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::body_get_shape_count);
    same<uint32_t (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::body_get_collision_layer);
    same<uint32_t (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::body_get_collision_mask);
    same<void (PhysicsServer3D::*)(const RID&, PhysicsServer3D::BodyMode)>(&PhysicsServer3D::body_set_mode);
    same<void (PhysicsServer3D::*)(const RID&, const Vector3&)>(&PhysicsServer3D::body_apply_central_impulse);
    same<void (PhysicsServer3D::*)(const RID&, const Vector3&)>(&PhysicsServer3D::body_apply_torque_impulse);
    same<AABB (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::soft_body_get_bounds);
    same<uint32_t (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::soft_body_get_collision_layer);
    same<uint32_t (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::soft_body_get_collision_mask);
    same<Vector3 (PhysicsServer3D::*)(const RID&, int32_t) const>(
        &PhysicsServer3D::soft_body_get_point_global_position);
    same<RID (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::soft_body_get_space);
    same<float (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::soft_body_get_total_mass);
    same<bool (PhysicsServer3D::*)(const RID&, int32_t) const>(&PhysicsServer3D::soft_body_is_point_pinned);

    same<void (PhysicsShapeQueryParameters3D::*)(const TypedArray<RID>&)>(
        &PhysicsShapeQueryParameters3D::set_exclude);
    same<void (PhysicsShapeQueryParameters3D::*)(const Ref<Resource>&)>(
        &PhysicsShapeQueryParameters3D::set_shape);
    same<void (PhysicsShapeQueryParameters3D::*)(const Transform3D&)>(
        &PhysicsShapeQueryParameters3D::set_transform);

    same<Array (PrimitiveMesh::*)() const>(&PrimitiveMesh::_create_mesh_array);

    same<ProjectSettings* (*)()>(&ProjectSettings::get_singleton);
    same<String (ProjectSettings::*)(const String&) const>(&ProjectSettings::globalize_path);
    same<Variant (ProjectSettings::*)(const String&, const Variant&) const>(&ProjectSettings::get_setting);
    same<bool (ProjectSettings::*)(const String&) const>(&ProjectSettings::has_setting);
    same<void (ProjectSettings::*)(const Dictionary&)>(&ProjectSettings::add_property_info);
    same<void (ProjectSettings::*)(const String&, bool)>(&ProjectSettings::set_as_basic);
    same<void (ProjectSettings::*)(const String&, const Variant&)>(&ProjectSettings::set_initial_value);
    same<void (ProjectSettings::*)(const String&, const Variant&)>(&ProjectSettings::set_setting);

    same<Dictionary (RenderingServer::*)(const RID&, int32_t)>(&RenderingServer::mesh_get_surface);
    same<RenderingServer* (*)()>(&RenderingServer::get_singleton);

    same<RID (Resource::*)() const>(&Resource::_get_rid);
    same<RID (Resource::*)() const>(&Resource::get_rid);
    same<Ref<Resource> (Resource::*)(bool) const>(&Resource::duplicate);
    same<String (Resource::*)() const>(&Resource::get_path);
    same<void (Resource::*)()>(&Resource::_reset_state);
    same<void (Resource::*)()>(&Resource::_setup_local_to_scene);
    same<void (Resource::*)()>(&Resource::emit_changed);
    same<void (Resource::*)(const String&) const>(&Resource::_set_path_cache);

    same<ResourceLoader* (*)()>(&ResourceLoader::get_singleton);
    same<Ref<Resource> (ResourceLoader::*)(const String&, const String&, ResourceLoader::CacheMode)>(
        &ResourceLoader::load);
    same<bool (ResourceLoader::*)(const String&, const String&)>(&ResourceLoader::exists);

    same<Ref<PhysicsMaterial> (RigidBody3D::*)() const>(&RigidBody3D::get_physics_material_override);
    same<RigidBody3D::CenterOfMassMode (RigidBody3D::*)() const>(&RigidBody3D::get_center_of_mass_mode);
    same<RigidBody3D::DampMode (RigidBody3D::*)() const>(&RigidBody3D::get_angular_damp_mode);
    same<RigidBody3D::DampMode (RigidBody3D::*)() const>(&RigidBody3D::get_linear_damp_mode);
    same<RigidBody3D::FreezeMode (RigidBody3D::*)() const>(&RigidBody3D::get_freeze_mode);
    same<Vector3 (RigidBody3D::*)() const>(&RigidBody3D::get_angular_velocity);
    same<Vector3 (RigidBody3D::*)() const>(&RigidBody3D::get_center_of_mass);
    same<Vector3 (RigidBody3D::*)() const>(&RigidBody3D::get_constant_force);
    same<Vector3 (RigidBody3D::*)() const>(&RigidBody3D::get_constant_torque);
    same<Vector3 (RigidBody3D::*)() const>(&RigidBody3D::get_inertia);
    same<Vector3 (RigidBody3D::*)() const>(&RigidBody3D::get_linear_velocity);
    same<bool (RigidBody3D::*)() const>(&RigidBody3D::is_able_to_sleep);
    same<bool (RigidBody3D::*)() const>(&RigidBody3D::is_freeze_enabled);
    same<bool (RigidBody3D::*)() const>(&RigidBody3D::is_lock_rotation_enabled);
    same<bool (RigidBody3D::*)() const>(&RigidBody3D::is_using_continuous_collision_detection);
    same<float (RigidBody3D::*)() const>(&RigidBody3D::get_angular_damp);
    same<float (RigidBody3D::*)() const>(&RigidBody3D::get_gravity_scale);
    same<float (RigidBody3D::*)() const>(&RigidBody3D::get_linear_damp);
    same<float (RigidBody3D::*)() const>(&RigidBody3D::get_mass);
    same<void (RigidBody3D::*)(RigidBody3D::FreezeMode)>(&RigidBody3D::set_freeze_mode);
    same<void (RigidBody3D::*)(bool)>(&RigidBody3D::set_freeze_enabled);
    same<void (RigidBody3D::*)(const Vector3&)>(&RigidBody3D::set_angular_velocity);
    same<void (RigidBody3D::*)(const Vector3&)>(&RigidBody3D::set_linear_velocity);
    same<void (RigidBody3D::*)(bool)>(&RigidBody3D::set_sleeping);
    same<void (RigidBody3D::*)(const Vector3&)>(&RigidBody3D::apply_torque);
    same<void (RigidBody3D::*)(const Vector3&)>(&RigidBody3D::apply_torque_impulse);
    same<void (RigidBody3D::*)(const Vector3&, const Vector3&)>(&RigidBody3D::apply_force);
    same<void (RigidBody3D::*)(const Vector3&, const Vector3&)>(&RigidBody3D::apply_impulse);
    same<void (RigidBody3D::*)(float)>(&RigidBody3D::set_mass);

    same<Node* (SceneTree::*)() const>(&SceneTree::get_edited_scene_root);
    same<Window* (SceneTree::*)() const>(&SceneTree::get_root);
    same<bool (SceneTree::*)() const>(&SceneTree::is_paused);

    same<Transform3D (Skeleton3D::*)(int32_t) const>(&Skeleton3D::get_bone_global_pose);
    same<int32_t (Skeleton3D::*)() const>(&Skeleton3D::get_bone_count);
    same<int32_t (Skeleton3D::*)(const String&) const>(&Skeleton3D::find_bone);

    same<StringName (Skin::*)(int32_t) const>(&Skin::get_bind_name);
    same<Transform3D (Skin::*)(int32_t) const>(&Skin::get_bind_pose);
    same<int32_t (Skin::*)() const>(&Skin::get_bind_count);
    same<int32_t (Skin::*)(int32_t) const>(&Skin::get_bind_bone);

    same<Ref<Skin> (SkinReference::*)() const>(&SkinReference::get_skin);

    same<float (SliderJoint3D::*)(SliderJoint3D::Param) const>(&SliderJoint3D::get_param);

    same<void (SphereMesh::*)(float)>(&SphereMesh::set_height);
    same<void (SphereMesh::*)(float)>(&SphereMesh::set_radius);

    same<float (SphereShape3D::*)() const>(&SphereShape3D::get_radius);
    same<void (SphereShape3D::*)(float)>(&SphereShape3D::set_radius);

    same<Ref<PhysicsMaterial> (StaticBody3D::*)() const>(&StaticBody3D::get_physics_material_override);

    same<Ref<Image> (Texture2D::*)() const>(&Texture2D::get_image);

    same<Time* (*)()>(&Time::get_singleton);
    same<uint64_t (Time::*)() const>(&Time::get_ticks_msec);

    same<Camera3D* (Viewport::*)() const>(&Viewport::get_camera_3d);
    same<Control* (Viewport::*)() const>(&Viewport::gui_get_hovered_control);

    same<AABB (VisualInstance3D::*)() const>(&VisualInstance3D::_get_aabb);

    same<PhysicsDirectSpaceState3D* (World3D::*)()>(&World3D::get_direct_space_state);
    same<RID (World3D::*)() const>(&World3D::get_space);
    same<bool (PhysicsServer3D::*)(const RID&) const>(&PhysicsServer3D::space_is_active);

    same<Plane (WorldBoundaryShape3D::*)() const>(&WorldBoundaryShape3D::get_plane);

    same<bool (XRController3D::*)(const StringName&) const>(&XRController3D::is_button_pressed);

    same<void (XRNode3D::*)(const String&, double, double, double, double)>(&XRNode3D::trigger_haptic_pulse);
}

}  // namespace probe
