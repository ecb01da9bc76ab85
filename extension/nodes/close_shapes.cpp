#include "nodes/close_shapes.hpp"

#include <algorithm>
#include <godot_cpp/classes/world3d.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <tuple>

#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

namespace {

// About one hand. Each takes about a microsecond, and may become a body of the session.
constexpr int max_shapes = 128;
constexpr int max_looks = 4;

auto key_of(const CloseShape& shape) {
    return std::tuple(shape.body.get_id(), shape.index);
}

}  // namespace

void CloseShapes::look(PhysicsDirectSpaceState3D& space, const Vec3& hand, double radius) {
    query_->set_transform(Transform3D(Basis(), to_godot(hand)));
    TypedArray<Dictionary> shapes;
    for (int i = 0; i < max_looks; ++i, radius *= 0.5) {
        sphere_->set_radius(static_cast<real_t>(radius));
        shapes = space.intersect_shape(query_, max_shapes);
        if (shapes.size() < max_shapes) {
            break;
        }
        is_full_ = true;
    }
    for (int64_t i = 0; i < shapes.size(); ++i) {
        const Dictionary shape = shapes[i];
        found_.push_back({static_cast<std::uint64_t>(static_cast<int64_t>(shape["collider_id"])),
                          shape["rid"], static_cast<int>(shape["shape"])});
    }
}

std::span<const CloseShape> CloseShapes::around(const Node3D& world, std::span<const Vec3> hands,
                                                double radius) {
    found_.clear();
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
