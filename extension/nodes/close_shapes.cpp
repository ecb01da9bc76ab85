#include "nodes/close_shapes.hpp"

#include <algorithm>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/world3d.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <tuple>
#include <utility>

#include "nodes/conversions.hpp"
#include "nodes/soft_surface.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

// About one hand. Each takes about a microsecond, and may become a body of the session.
constexpr int max_shapes = 128;
constexpr int max_looks = 4;

auto key_of(const CloseShape& shape) {
    return std::tuple(shape.body.get_id(), shape.index);
}

// The others of such a body need not be looked for.
bool is_all_of_its_body(const CloseShape& shape) {
    const auto* const owner = node_of_id<Node>(shape.owner);
    return (owner != nullptr && is_soft_body(*owner)) ||
           PhysicsServer3D::get_singleton()->body_get_shape_count(shape.body) == 1;
}

std::vector<CloseShape> close_shapes(const TypedArray<Dictionary>& hits) {
    std::vector<CloseShape> shapes;
    for (int64_t i = 0; i < hits.size(); ++i) {
        const Dictionary hit = hits[i];
        shapes.push_back({static_cast<std::uint64_t>(static_cast<int64_t>(hit["collider_id"])), hit["rid"],
                          static_cast<int>(hit["shape"])});
    }
    std::ranges::sort(shapes, {}, key_of);
    return shapes;
}

}  // namespace

// Godot's physics may run in a thread of its own, where a query meets the sphere as it is there by then. What
// returns a value waits for all that was sent before.
void CloseShapes::set_radius(double radius) {
    if (std::exchange(radius_, radius) != radius) {
        sphere_->set_radius(static_cast<real_t>(radius));
        PhysicsServer3D::get_singleton()->shape_get_type(sphere_->get_rid());
    }
}

void CloseShapes::look(PhysicsDirectSpaceState3D& space, const Vec3& hand, double radius) {
    query_->set_transform(Transform3D(Basis(), to_godot(hand)));
    std::vector<CloseShape> shapes;
    for (int i = 0; i < max_looks; ++i) {
        set_radius(radius);
        query_->set_exclude(crowds_);
        shapes = close_shapes(space.intersect_shape(query_, max_shapes));
        if (shapes.size() < max_shapes) {
            break;
        }
        if (!set_crowds_apart(shapes)) {
            is_full_ = true;
            radius *= 0.5;
        }
    }
    found_.insert(found_.end(), shapes.begin(), shapes.end());
}

// Godot's Jolt finds a mesh once for each of its triangles: the next look leaves it out. Returns whether
// there is any.
bool CloseShapes::set_crowds_apart(const std::vector<CloseShape>& shapes) {
    const int64_t before = crowds_.size();
    for (std::size_t i = 1; i < shapes.size(); ++i) {
        const bool is_second = key_of(shapes[i]) == key_of(shapes[i - 1]) &&
                               (i == 1 || key_of(shapes[i]) != key_of(shapes[i - 2]));
        if (is_second && is_all_of_its_body(shapes[i])) {
            crowds_.push_back(shapes[i].body);
            found_.push_back(shapes[i]);
        }
    }
    return crowds_.size() > before;
}

std::span<const CloseShape> CloseShapes::around(const Node3D& world, std::span<const Vec3> hands,
                                                double radius) {
    found_.clear();
    crowds_.resize(0);
    is_full_ = false;
    const Ref<World3D> around = world.get_world_3d();
    if (hands.empty() || around.is_null()) {
        return {};
    }
    PhysicsDirectSpaceState3D* const space = around->get_direct_space_state();
    if (space == nullptr) {
        return {};
    }
    if (query_.is_null()) {
        sphere_.instantiate();
        query_.instantiate();
        query_->set_shape(sphere_);
    }
    for (const Vec3& hand : hands) {
        look(*space, hand, radius);
    }
    std::ranges::sort(found_, {}, key_of);
    const auto twice = std::ranges::unique(found_, {}, key_of);
    found_.erase(twice.begin(), twice.end());
    return found_;
}

}  // namespace tactus
