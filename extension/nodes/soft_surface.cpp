#include "nodes/soft_surface.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <godot_cpp/classes/collision_object3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <utility>

#include "core/mesh/same_places.hpp"
#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/mesh_source.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

// Each is asked for in every frame, which takes about 0.03 us.
constexpr std::size_t max_vertices = 10'000;

constexpr double largest = 100.0;  // (unit: meters)

// A hand pushes this share of the vertices, those next to the contact: one alone would be thrown through its
// neighbors within a frame.
constexpr double patch_share = 0.1;
constexpr std::size_t least_patch = 3;

// Of the stiffness at which a spring between the hand and the patch would begin to swing.
constexpr double stiffness_share = 0.25;

PhysicsServer3D& physics_server() {
    return *PhysicsServer3D::get_singleton();
}

std::uint64_t id_of(const Ref<Mesh>& mesh) {
    return mesh.is_valid() ? static_cast<std::uint64_t>(mesh->get_instance_id()) : 0;
}

// Godot's physics has the first surface alone.
std::optional<SurfaceCorners> surface_of(const MeshInstance3D& body) {
    const Ref<Mesh> mesh = body.get_mesh();
    return mesh.is_valid() && mesh->get_surface_count() > 0 ? corners_of(mesh, 0) : std::nullopt;
}

// Godot Physics takes an impulse by its own number of the vertex, which is that of the first corner at its
// place; Jolt Physics by a corner.
bool counts_corners() {
    return String(ProjectSettings::get_singleton()->get_setting("physics/3d/physics_engine", ""))
        .begins_with("Jolt");
}

}  // namespace

bool is_soft_body(const Node& node) {
    return node.is_class("SoftBody3D");
}

SoftSurface::SoftSurface(MeshInstance3D& body)
    : owner_(body.get_instance_id()), mesh_(id_of(body.get_mesh())), rid_(body.call("get_physics_rid")) {
    read_mesh(body);
}

void SoftSurface::come_close() {
    place_ = Vec3(0.0);
    read();
    for (const Vec3& vertex : now_->vertices) {
        place_ += vertex / static_cast<double>(now_->vertices.size());
    }
    place_triangles();
}

// The same vertices as in Godot's physics: corners at one place are one.
void SoftSurface::read_mesh(const MeshInstance3D& body) {
    const std::optional<SurfaceCorners> read = surface_of(body);
    now_ = std::make_shared<TriangleMesh>();
    if (!read || read->indices.is_empty()) {
        problem_ = "a SoftBody3D without a mesh of indexed triangles is not felt";
        return;
    }
    const auto shape = std::make_shared<TriangleMesh>();
    shape->vertices = from_godot(read->corners);
    corner_count_ = read->corners.size();
    for (int64_t i = 0; i + 2 < read->indices.size(); i += 3) {
        const auto corner = [&](int64_t k) { return static_cast<std::uint32_t>(read->indices[i + k]); };
        shape->triangles.push_back({corner(0), corner(2), corner(1)});
    }
    const std::vector<std::uint32_t> merged = merge_places(*shape);
    for (std::size_t corner = 0; corner < merged.size(); ++corner) {
        if (merged[corner] == corners_.size()) {
            corners_.push_back(static_cast<std::int32_t>(corner));
        }
    }
    now_ = shape;
    if (corners_.size() > max_vertices) {
        problem_ = "a SoftBody3D of more than " + std::to_string(max_vertices) +
                   " vertices is not felt: give it a simpler mesh";
    } else if (has_physics_thread()) {
        problem_ =
            "a SoftBody3D is not felt where Godot's physics has a thread of its own: switch off the project "
            "setting 'physics/3d/run_on_separate_thread'";
    }
}

bool SoftSurface::is_of(const MeshInstance3D& body) {
    const std::uint64_t mesh = id_of(body.get_mesh());
    if (std::exchange(mesh_, mesh) == mesh) {
        return true;
    }
    const std::optional<SurfaceCorners> now = surface_of(body);
    return now && now->corners.size() == corner_count_;
}

// Else Godot's Jolt answers every question with an error. A switched-off body loses its mesh there.
bool SoftSurface::is_in_physics() const {
    const auto* const owner = node_of_id<Node>(owner_);
    if (owner == nullptr || !owner->is_inside_tree()) {
        return false;
    }
    const bool is_removed =
        static_cast<int>(owner->get("disable_mode")) == CollisionObject3D::DISABLE_MODE_REMOVE &&
        is_disabled(*owner);
    return !is_removed && physics_server().soft_body_get_space(rid_).is_valid();
}

bool SoftSurface::is_close(std::span<const Vec3> hands, double radius) const {
    if (!problem_.empty()) {
        return true;
    }
    if (!is_in_physics()) {
        return false;
    }
    const AABB bounds = physics_server().soft_body_get_bounds(rid_);
    const Vec3 low = from_godot(bounds.position), high = from_godot(bounds.get_end());
    if (!(glm::distance(low, high) < largest)) {
        return false;  // Godot's physics has torn it apart
    }
    return std::ranges::any_of(
        hands, [&](const Vec3& hand) { return glm::distance(glm::clamp(hand, low, high), hand) < radius; });
}

bool SoftSurface::read() {
    if (!problem_.empty()) {
        return false;
    }
    auto next = std::make_shared<TriangleMesh>();
    next->vertices.reserve(corners_.size());
    for (const std::int32_t corner : corners_) {
        next->vertices.push_back(
            from_godot(physics_server().soft_body_get_point_global_position(rid_, corner)));
    }
    if (next->vertices == now_->vertices) {
        return false;
    }
    next->triangles = now_->triangles;
    now_ = std::move(next);
    place_triangles();
    return true;
}

void SoftSurface::place_triangles() {
    source_.succeed_by(std::make_shared<TriangleSource>(
        [now = now_, place = place_] {
            TriangleMesh placed = *now;
            for (Vec3& vertex : placed.vertices) {
                vertex -= place;
            }
            return placed;
        },
        now_->triangles.size()));
}

BodyForm SoftSurface::form() const {
    BodyForm form;
    if (problem_.empty()) {
        MeshDraft draft;
        draft.source = source_.get();
        draft.owner = "'" + from_godot(String(node_of_id<Node>(owner_)->get_name())) + "': ";
        form.meshes.push_back(std::move(draft));
    } else {
        form.problems.push_back(problem_);
    }
    form.touchable = problem_.empty();
    form.only_touched = true;
    return form;
}

std::uint32_t SoftSurface::layer() const {
    return static_cast<std::uint32_t>(physics_server().soft_body_get_collision_layer(rid_));
}

std::uint32_t SoftSurface::mask() const {
    return static_cast<std::uint32_t>(physics_server().soft_body_get_collision_mask(rid_));
}

std::size_t SoftSurface::patch_size() const {
    const auto share = static_cast<std::size_t>(patch_share * static_cast<double>(corners_.size()));
    return std::min(corners_.size(), std::max(least_patch, share));
}

// Jolt Physics has 1 kg for each vertex of a body whose mass no one has set.
double SoftSurface::vertex_mass() const {
    const double told = physics_server().soft_body_get_total_mass(rid_);
    return told > 0.0 ? told / static_cast<double>(corners_.size()) : 1.0;
}

void SoftSurface::soften(TouchMaterial& touch, double frame_seconds) const {
    if (corners_.empty()) {
        return;
    }
    const double stiffest =
        stiffness_share * static_cast<double>(patch_size()) * vertex_mass() / (frame_seconds * frame_seconds);
    touch.stiffness = std::min(touch.stiffness, stiffest);
    touch.damping = std::min(touch.damping, stiffest * frame_seconds);
    touch.stiffening = std::min(touch.stiffening, 1.0);
}

void SoftSurface::push(const Vec3& point, const Vec3& impulse) {
    auto* const owner = node_of_id<Node>(owner_);
    if (!is_in_physics() || !owner->has_method("apply_impulse") || corners_.empty()) {
        return;
    }
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        near.emplace_back(glm::distance(now_->vertices[i], point), i);
    }
    const std::size_t count = patch_size();
    std::ranges::nth_element(near, near.begin() + static_cast<std::ptrdiff_t>(count) - 1);
    const Vector3 each = to_godot(impulse / static_cast<double>(count));
    const bool by_corner = counts_corners();
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t vertex = near[k].second;
        // Godot's Jolt refuses, with an error, to push what it takes for a pinned one.
        if (!physics_server().soft_body_is_point_pinned(rid_, corners_[vertex])) {
            owner->call("apply_impulse", by_corner ? corners_[vertex] : static_cast<std::int32_t>(vertex),
                        each);
        }
    }
}

}  // namespace tactus
