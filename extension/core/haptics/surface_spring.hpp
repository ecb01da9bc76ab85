// How hard a surface pushes back, by how deep the hand is below it.
//
// The slope goes evenly from K at the surface to K' at the depth h, and stays there:
//     F(d) = K d + a d^2               d <= h,  a = (K' - K) / 2h
//     F(d) = K' d - (K' - K) h / 2     beyond
// What bottoms out has K' > K, what buckles K' < K.
//
// With x the way from the proxy to the hand, the hand is given F(|x|) along -x, whatever part of x lies along
// the surface. A central force gives back on a way that leads back to its begin what it took. Two springs,
// across and along, that both stiffen with the depth would give more: shift the hand while it is shallow,
// press, come back. Along the surface acts the share of the force that lies in x, so Coulomb's ratio holds.
//
// No change of x changes F x/|x| by more than max(K, K') of it: that is the stiffness that has to be safe.
#pragma once

#include "core/haptics/touch_material.hpp"

namespace tactus {

struct SurfaceSpring {
    double stiffness = 0.0;  // K (unit: newtons per meter), >= 0
    double deep = 0.0;       // K' (unit: newtons per meter), > 0 where K is
    double depth = 1.0;      // h (unit: meters), > 0

    bool is_linear() const { return deep == stiffness; }
    double steepest() const { return deep > stiffness ? deep : stiffness; }
    double force(double at) const;        // (unit: newtons)
    double slope(double at) const;        // (unit: newtons per meter)
    double energy(double at) const;       // that is stored (unit: joules)
    double depth_of(double force) const;  // (unit: meters)

    // Of the linear springs that hold this force, the one that is as deep, and the one that stores as much.
    double secant(double force) const;
    double as_rich(double force) const;
};

inline SurfaceSpring spring_of(const TouchMaterial& material) {
    return {material.stiffness, material.stiffness * material.stiffening, material.stiffening_depth};
}

// How deep the surface is where it and the pad over it give by `both` together, a pad of `pad_stiffness` (0:
// there is none): where F(d) = k_pad (both - d).
double depth_under_pad(const SurfaceSpring& surface, double pad_stiffness, double both);

// The same, but under the pad nowhere steeper than `limit` (unit: newtons per meter).
SurfaceSpring no_steeper(const SurfaceSpring& surface, double pad_stiffness, double limit);

}  // namespace tactus
