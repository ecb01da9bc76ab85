// Which shapes of Godot's own physics are close to the hands of a world. Main thread, in a physics frame.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/physics_direct_space_state3d.hpp>
#include <godot_cpp/classes/physics_shape_query_parameters3d.hpp>
#include <godot_cpp/classes/sphere_shape3d.hpp>
#include <godot_cpp/variant/rid.hpp>
#include <span>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

// A shape of a body; areas are none.
struct CloseShape {
    std::uint64_t owner = 0;  // id of the object that the body belongs to; 0: none does
    godot::RID body;
    int index = 0;  // among the shapes of its body
};

class CloseShapes {
public:
    // Those of the world's space within `radius` of a hand (unit: meters), each once. About a hand that has
    // too many of them, the radius is halved until they are few enough, three times at most. Valid until the
    // next call.
    std::span<const CloseShape> around(const godot::Node3D& world, std::span<const Vec3> hands,
                                       double radius);
    // Whether some were left out in the last call.
    bool is_full() const { return is_full_; }

private:
    void set_radius(double radius);
    void look(godot::PhysicsDirectSpaceState3D& space, const Vec3& hand, double radius);
    bool set_crowds_apart(const std::vector<CloseShape>& shapes);

    godot::Ref<godot::SphereShape3D> sphere_;  // null until it is needed
    double radius_ = 0.0;                      // of the sphere, as Godot's physics has it (unit: meters)
    godot::Ref<godot::PhysicsShapeQueryParameters3D> query_;
    std::vector<CloseShape> found_;
    godot::TypedArray<godot::RID> crowds_;  // bodies that are found already, and often
    bool is_full_ = false;
};

}  // namespace tactus
