// A cell of a lattice as one element that bends without locking.
//
// A box with edges a, b, c and local places xi = (xi, eta, zeta) in [-1, 1]^3 moves as
//
//     u = mean + F-part + p1 eta zeta + p2 xi zeta + p3 xi eta + p4 xi eta zeta,
//
// which the Walsh-Hadamard transform of its corners gives all at once. The mean deformation F has the energy
// of a tetrahedron's. The other four are bending: u_x in xi eta is a beam that bends, with the strain e_xx =
// (2/a) p3x eta and a shear (2/b) p3x xi that a real beam does not have. That shear is what makes linear
// elements lock; it is left out (assumed strains, after Belytschko and Bindeman, "Assumed strain
// stabilization of the eight node hexahedral element", 1993). Where e_xx goes with zeta and e_yy too, the two
// bend a plate: plane stress. u_x in eta zeta twists. All in the frame of the element's rotation.
#pragma once

#include <algorithm>
#include <bit>

#include "core/soft/soft_model.hpp"

namespace tactus {

// Amplitudes of the four shapes, or what they are pushed by.
struct CellBending {
    LanesVec3 yz, xz, xy, xyz;
};

class CellMaterial {
public:
    CellMaterial(const SoftMaterial& m, const Vec3& spacing)
        : shear(m.stiffness / (1.0 + m.poisson_ratio)),
          bulk(shear * m.poisson_ratio / (1.0 - 2.0 * m.poisson_ratio)),
          rate(2.0 / spacing),
          poisson(m.poisson_ratio),
          plate(m.stiffness / (1.0 - m.poisson_ratio * m.poisson_ratio) / 3.0),
          twist(0.5 * shear / 3.0),
          ripple(m.stiffness / 9.0) {}

    double shear, bulk;           // 2 mu, lambda (unit: pascals)
    Vec3 rate;                    // d xi / dx (unit: 1/meters)
    double poisson;               // (dimensionless)
    double plate, twist, ripple;  // by the mean of the square of a place, 1/3 or 1/9 (unit: pascals)

    // Of a corner: d (mean u) / d x (unit: 1/meters).
    Vec3 gradient_of(std::size_t corner) const {
        return rate * Vec3(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0) / 8.0;
    }

    // Bounds the second derivative of the bending energy by volume, for each of x, y and z (unit: Pa / m^2).
    double bending_bound(std::size_t a, std::size_t b) const {
        const double steepest = std::max({rate.x, rate.y, rate.z});
        const double square = steepest * steepest;
        const double bend = std::max(plate * (1.0 + poisson), 4.0 * twist) * square;
        double sum = 0.0;
        for (const std::size_t shape : {3u, 5u, 6u, 7u}) {
            const double stiffness = shape == 7u ? ripple * square : bend;
            sum += stiffness * sign(a, shape) * sign(b, shape) / 64.0;
        }
        return sum;
    }

    // dE/dp by volume.
    CellBending push_of(const CellBending& p) const {
        const Lanes x = splat(rate.x), y = splat(rate.y), z = splat(rate.z);
        const auto pair = [this](Lanes a, Lanes b) {
            return splat(plate) * multiply_add(splat(poisson), b, a);
        };
        const Lanes xz = p.xz.x * x, yz = p.yz.y * y, xy = p.xy.x * x, zy = p.yz.z * z, yx = p.xy.y * y,
                    zx = p.xz.z * z;
        const Lanes along_z = splat(twist) * multiply_add(p.yz.x, y, p.xz.y * x);
        const Lanes along_y = splat(twist) * multiply_add(p.yz.x, z, p.xy.z * x);
        const Lanes along_x = splat(twist) * multiply_add(p.xz.y, z, p.xy.z * y);
        const LanesVec3 most{x * x * splat(ripple), y * y * splat(ripple), z * z * splat(ripple)};
        return {{multiply_add(along_z, y, along_y * z), pair(yz, xz) * y, pair(zy, xy) * z},
                {pair(xz, yz) * x, multiply_add(along_z, x, along_x * z), pair(zx, yx) * z},
                {pair(xy, zy) * x, pair(yx, zx) * y, multiply_add(along_y, x, along_x * y)},
                {p.xyz.x * most.x, p.xyz.y * most.y, p.xyz.z * most.z}};
    }

private:
    static double sign(std::size_t corner, std::size_t shape) {
        return std::popcount(corner & shape) % 2 == 0 ? 1.0 : -1.0;
    }
};

// Sum over the corners i of (-1)^(bits that i and m share), for each m; again, eight times what it was.
inline void transform_corners(std::array<LanesVec3, 8>& t) {
    const auto pair = [&t](std::size_t i, std::size_t j) {
        const LanesVec3 a = t[i], b = t[j];
        t[i] = a + b;
        t[j] = a - b;
    };
    pair(0, 1), pair(2, 3), pair(4, 5), pair(6, 7);
    pair(0, 2), pair(1, 3), pair(4, 6), pair(5, 7);
    pair(0, 4), pair(1, 5), pair(2, 6), pair(3, 7);
}

}  // namespace tactus
