// The turn of a soft body as a whole, in a step that asks for the ways d of its nodes by the forces r on
// them.
//
// No elastic force resists it, but the matrix W that bounds them does, as if it were a change of shape. So
// the step solves it apart, with the inertia that the body has. A turn by the small angle a about a pivot
// moves a node at q from there by z(a) = a x q:
//
//     a  = J^-1 dt^2 sum q x r                     what the forces turn a rigid body by
//     (M / dt^2 + W) d = r - M z(a) / dt^2         what is left of them changes its shape
//     x' = x + d + z(a - J^-1 sum q x M d)         and that turns nothing
//
// From r to the ways this is one symmetric positive definite map, as the inverse of M / dt^2 + W is, and the
// angular momentum is kept. J is the inertia, and what bounds the second derivative of the energy of a body
// under stress along z: it goes straight on, and so stretches what is pulled.
#pragma once

#include <span>
#include <vector>

#include "core/math/lanes.hpp"
#include "core/math/types.hpp"
#include "core/soft/soft_model.hpp"

namespace tactus {

// x, y, z and 0 of a node.
inline Lanes row_of(const Vec3& v) {
    return Lanes{v.x, v.y, v.z, 0.0};
}
inline Vec3 vector_of(const Lanes& row) {
    return {row[0], row[1], row[2]};
}

class WholeTurn {
public:
    // `places` of the nodes; they outlive it.
    WholeTurn(const SoftModel& model, std::span<const Lanes> places);

    // What the body turns by as a whole where its nodes go such ways (unit: radians), and the way of a node
    // by that (unit: meters).
    Vec3 angle_of(std::span<const Lanes> ways) const { return is_free() ? by_ways(ways) : Vec3(0.0); }
    Vec3 way(const Vec3& angle, std::size_t node) const;

    // From here on under these elastic forces on the nodes. `stretch`: by how much of a way they see.
    void put_under_stress(std::span<const Lanes> elastic, double stretch);

    // Forces on the nodes become their ways (unit: meters).
    void solve(std::vector<Lanes>& rows) const;

private:
    bool is_free() const { return model_.free_turn.about != FreeTurn::About::nothing; }
    // J^-1 dt^2 sum q x r, in radians about each axis.
    Vec3 by_forces(std::span<const Lanes> forces) const;
    // J^-1 sum q x M d.
    Vec3 by_ways(std::span<const Lanes> ways) const;
    void set_inertia(const Mat3& inertia);

    const SoftModel& model_;
    std::span<const Lanes> places_;
    Vec3 pivot_{0.0};
    Mat3 inertia_{0.0};    // (unit: kilogram square meters)
    Mat3 by_moment_{0.0};  // J^-1 along what is free to turn, else 0 (unit: 1 / (kilogram square meters))
};

}  // namespace tactus
