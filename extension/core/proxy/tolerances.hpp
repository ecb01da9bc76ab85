// Every small length of the proxy, in one place. docs/tolerances.md says what each protects and what happens
// without it. All of them follow from two lengths of the scene, the proxy's radius and the largest coordinate
// in play, so that a scene scaled by any factor behaves the same.
#pragma once

#include <algorithm>

namespace tactus {

// A proxy on a surface goes this many times as far as the hand at most: on a round one by 1 / (1 - depth / r)
// of it, where the hand is as deep as that below the bend's axis. What goes farther has slipped: off an edge
// that does not hold it, out of static friction, or on from where the work of the last tick had ended.
constexpr double max_sensitivity = 4.0;

struct Tolerances {
    // How far above a surface the proxy rests. Protects the sign: a proxy at rest is outside by more than any
    // rounding error (unit: meters).
    double skin;
    // Sweeps end this far above a surface: between rest and the surface, so that what the proxy already rests
    // on does not stop it, and a new surface does before it is entered (unit: meters).
    double stop;
    // A sweep has arrived when it is this close to its end: what Newton's last step is worth (unit: meters).
    double arrival;
    // Surfaces up to this gap join the contact planes. Larger finds the second wall of a groove an iteration
    // earlier; smaller looks at fewer triangles (unit: meters).
    double reach;
    // Steps below this end the motion: the proxy is where it should be (unit: meters).
    double step;
    // Two contacts whose distances differ by less are the same distance (unit: meters).
    double same;
};

inline Tolerances make_tolerances(double radius, double largest_coordinate) {
    constexpr double rounding_unit = 0x1p-53;
    const double skin = std::max(5e-9 * radius, 512.0 * rounding_unit * largest_coordinate);
    return {skin, 0.5 * skin, 0.125 * skin, 2.0 * skin + 1e-5 * radius, 0.125 * skin, 2e-3 * skin};
}

}  // namespace tactus
