// The torque by which a soft fingertip holds a surface against turning about the normal.
//
// Hertz: a ball of radius R, pressed with the force N against a flat surface, touches it in a disc of radius
//     a = (3 N R / (4 E))^(1/3)                                    (E: effective modulus of finger and
//     surface)
// with the pressure p(r) = 3 N / (2 pi a^2) (1 - r^2 / a^2)^(1/2). Where all of it slips in a turn, Coulomb's
// friction holds back with
//     T = integral of mu p(r) r over the disc = 3 pi / 16 mu N a.
// A disc that carries the share f of mu N along the surface turns about a point beside its middle when it
// slips, and has less left: the integral over it gives, within 0.6 % of T,
//     t = T (1 - f^2 / 4) (1 - f^2)^(1/2),
// which lies inside the ellipse of Howe and Cutkosky (1996).
//
// Up to that the finger sticks. Here it sticks by a spring of stiffness K that reaches the limit within
// `break_away` and slips beyond: Coulomb's friction but for that angle, without drift, and its energy K z^2 /
// 2 changes by work and by what slip takes alone. K grows with the limit and never shrinks while the contact
// lasts; when it grows, the torque K z stays and the energy shrinks. So no trembling of N makes energy, and
// none loosens the hold.
#pragma once

#include <array>

#include "core/math/types.hpp"

namespace tactus {

struct SoftFinger {
    double modulus = 0.0;    // E (unit: pascals), >= 0; 0: a point, which holds nothing against turning
    double radius = 0.008;   // R (unit: meters), > 0
    double stiffness = 0.0;  // of the pad along the normal, in series with the surface's; 0: it gives nothing
                             // (unit: newtons per meter), >= 0

    bool is_soft() const { return modulus > 0.0; }
    bool operator==(const SoftFinger&) const = default;
};

// a (unit: meters). `pressing` is N (unit: newtons), >= 0.
double patch_radius(const SoftFinger& finger, double pressing);

// What of T is left (unit: newton meters) beside the force `along` the surface (unit: newtons).
double torsion_limit(const SoftFinger& finger, double friction, double pressing, double along);

// What one contact is held by.
struct Torsion {
    static constexpr double break_away = 0.002;  // (unit: radians)

    int body = -1;               // slot in the TouchScene
    Vec3 normal{0.0, 1.0, 0.0};  // unit, in the world
    double stiffness = 0.0;      // K (unit: newton meters per radian)
    double twist = 0.0;          // z: of the body beyond the finger, about the normal (unit: radians)
    double limit = 0.0;          // of the torque now (unit: newton meters)
    double finger_spin = 0.0;    // about the normal (unit: radians per second)
    bool slips = false;
};

struct TorsionLimits {
    double at_rest = 0.0;   // (unit: newton meters)
    double slipping = 0.0;  // likewise, <= at_rest
};

// The body has turned by `turned` (unit: radians) beyond the finger since the tick before.
void turn_in_grip(Torsion& torsion, const TorsionLimits& limits, double turned);

// Those of one pointer.
struct TorsionList {
    static constexpr int capacity = 3;

    std::array<Torsion, capacity> items;
    int count = 0;

    // What held the body about nearly this normal; a new one where nothing did.
    Torsion grip_of(int body, const Vec3& normal) const;
    void add(const Torsion& torsion) { items[static_cast<std::size_t>(count++)] = torsion; }
};

}  // namespace tactus
