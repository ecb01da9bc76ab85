#include "nodes/seen_bodies.hpp"

#include <algorithm>
#include <godot_cpp/classes/box_shape3d.hpp>
#include <godot_cpp/classes/collision_shape3d.hpp>
#include <godot_cpp/classes/convex_polygon_shape3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <utility>

#include "nodes/conversions.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

const Color known_color(0.25f, 0.65f, 0.35f, 1.0f);
const Color unknown_color(0.85f, 0.6f, 0.2f, 1.0f);

constexpr float point_size = 3.0f;  // of the cloud (unit: pixels)

// Of the support (unit: meters).
constexpr float support_size = 2.0f;
constexpr float support_thickness = 0.04f;

// More than the noise of a camera, and less than a hand feels of a stiff body (unit: meters, radians).
constexpr MotionThreshold corrected{.position = 5e-5, .angle = 1e-3};

Ref<ConvexPolygonShape3D> hull_shape(const TriangleMesh& mesh) {
    Ref<ConvexPolygonShape3D> shape;
    shape.instantiate();
    shape->set_points(packed(mesh.vertices));
    return shape;
}

MeshInstance3D* picture(const TriangleMesh& mesh, const Color& color) {
    auto* const drawn = memnew(MeshInstance3D);
    drawn->set_mesh(drawn_mesh({mesh}));
    drawn->set_material_override(lit_material(color));
    return drawn;
}

}  // namespace

Node3D* SeenBodies::make(const SeenForm& form) const {
    MeshInstance3D* const drawn =
        looks_.show_objects ? picture(*form.mesh, form.is_known() ? known_color : unknown_color) : nullptr;
    Node3D* made = drawn;
    if (looks_.objects != SeenAs::pictures && (form.is_known() || !looks_.touch_cloud)) {
        auto* const body = memnew(RigidBody3D);
        body->set_mass(form.mass);
        body->set_freeze_mode(RigidBody3D::FREEZE_MODE_KINEMATIC);
        body->set_freeze_enabled(looks_.objects == SeenAs::held_bodies);
        if (drawn != nullptr) {
            body->add_child(drawn);
        }
        if (form.is_known()) {
            auto* const touched = memnew(HapticMesh);
            touched->set("library_mesh", to_godot(form.known));
            body->add_child(touched);
        } else {
            auto* const shape = memnew(CollisionShape3D);
            shape->set_shape(hull_shape(*form.mesh));
            body->add_child(shape);
        }
        made = body;
    }
    if (made != nullptr) {
        made->set_name(to_godot(form.name));
        made->set_as_top_level(true);
    }
    return made;
}

void SeenBodies::lead(const SightedObject& object, double age) const {
    if (Node3D* const node = node_of(object.id)) {
        node->set_global_transform(to_godot(pose_after(object, age)));
    }
}

// What is pushed belongs to the loop, which is told at once; its node follows. All else goes where its node
// is put: that is a motion, which pushes, as far as it was seen to move. Where it was seen to be elsewhere no
// way leads: the loop is told of that, too, and a hand is let out of it gently.
void SeenBodies::place(HapticWorld* world, const SightedObject& object, double age, double since_last) {
    Node3D* const node = node_of(object.id);
    if (node == nullptr) {
        return;
    }
    const BodyMotion seen{object.pose, object.linear_velocity, object.angular_velocity};
    const auto [led, is_new] = led_.try_emplace(object.id, seen);
    const BodyMotion before = std::exchange(led->second, seen);
    const Pose expected = carried_on(pose_of(node->get_global_transform()), before.linear_velocity,
                                     before.angular_velocity, since_last);
    const bool is_free = looks_.objects == SeenAs::free_bodies;
    const bool is_corrected = !is_new && poses_differ(expected, pose_after(object, age), corrected);
    // What it has moved by since then is led.
    const double told_age = is_free ? age : std::max(0.0, age - since_last);
    const bool is_told =
        world != nullptr && (is_free || is_corrected) && world->see(node, {seen, told_age, object.chance});
    if (!is_told || !is_free) {
        lead(object, age);
    }
}

void SeenBodies::go_on(const Sight& sight, double age) {
    for (const SightedObject& object : sight.objects) {
        if (moves(object) && looks_.objects != SeenAs::free_bodies) {
            lead(object, age);
        }
    }
}

void SeenBodies::update(Node3D& sensor, const Sight& sight, const SeenLibrary& library, const Looks& looks,
                        double age, double since_last) {
    const Looks before = std::exchange(looks_, looks);
    if (before.objects != looks.objects || before.show_objects != looks.show_objects ||
        before.touch_cloud != looks.touch_cloud) {
        clear();
    }
    const auto show = [&](const SightedObject& object) -> std::uint64_t {
        Node3D* const node = make(library.form_of(object));
        if (node == nullptr) {
            return 0;
        }
        node->set_transform(to_godot(object.pose));
        sensor.add_child(node, true);
        return node->get_instance_id();
    };
    roll_.update(sight, show, free_later);
    HapticWorld* const world = HapticWorld::above(&sensor);
    for (const SightedObject& object : sight.objects) {
        place(world, object, age, since_last);
    }
    std::erase_if(led_, [&](const auto& one) { return object_of(sight, one.first) == nullptr; });
    hold_support(sensor, world, sight.plane, looks.objects != SeenAs::pictures || looks.touch_cloud);
    if (looks.touch_cloud) {
        touched_cloud_.update(sensor, sight.surface, looks.show_objects);
    } else {
        touched_cloud_.clear();
    }
    draw_cloud(sensor, sight, looks.show_cloud);
}

// What the objects stand on is a slab, and is put elsewhere only where it is seen to be: its noise would
// shake all that stands on it.
void SeenBodies::hold_support(Node3D& sensor, HapticWorld* world, const SupportPlane& plane, bool is_wanted) {
    auto* slab = node_of_id<Node3D>(support_);
    if (!is_wanted || !plane.is_found) {
        if (!is_wanted) {
            free_later(std::exchange(support_, 0));
        }
        return;
    }
    const bool is_new = slab == nullptr;
    if (is_new) {
        Ref<BoxShape3D> box;
        box.instantiate();
        box->set_size(Vector3(support_size, support_thickness, support_size));
        slab = new_still_body("support", box);
        sensor.add_child(slab, true);
        support_ = slab->get_instance_id();
    }
    if (!is_new && !is_elsewhere(plane, support_plane_)) {
        return;
    }
    support_plane_ = plane;
    const Pose place = slab_under(plane, support_thickness);
    if (world != nullptr && !is_new) {
        BodySighting sighting;
        sighting.motion.pose = place;
        world->see(slab, sighting);
    }
    slab->set_global_transform(to_godot(place));
}

void SeenBodies::draw_cloud(Node3D& sensor, const Sight& sight, bool is_wanted) {
    auto* drawn = node_of_id<MeshInstance3D>(cloud_);
    if (!is_wanted) {
        free_later(std::exchange(cloud_, 0));
        return;
    }
    if (drawn == nullptr) {
        drawn = add_picture(sensor, Ref<Mesh>(), point_material(cloud_color, point_size));
        cloud_ = drawn->get_instance_id();
    }
    Ref<ArrayMesh> mesh;
    mesh.instantiate();
    add_surface(**mesh, Mesh::PRIMITIVE_POINTS, {packed(sight.cloud)});
    drawn->set_mesh(mesh);
}

Node3D* SeenBodies::node_of(std::uint64_t object) const {
    return node_of_id<Node3D>(roll_.node_of(object));
}

void SeenBodies::clear() {
    roll_.hide_all(free_later);
    led_.clear();
    free_later(std::exchange(cloud_, 0));
    free_later(std::exchange(support_, 0));
    touched_cloud_.clear();
}

}  // namespace tactus
