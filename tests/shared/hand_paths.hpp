// Ways of the hand that benches share: a position for each millisecond.
#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus::shared {

// In and out of a sphere of radius 1 around the origin while circling it once in ten seconds, for a proxy of
// the given radius: at distance 1 + radius - 0.1 sin(2 pi 0.7 t).
std::vector<Vec3> around_sphere(double radius, int ticks);

// The same around a box: in and out by 0.1 along the ray from the origin, on a circle that leans to all axes.
std::vector<Vec3> around_box(const Vec3& half_extents, double radius, int ticks);

// Over a terrain of shared/meshes.hpp, up to 0.1 below and 0.02 above where a proxy of that radius would
// rest.
std::vector<Vec3> over_terrain(const TriangleMesh& terrain, int cells, double size, double radius, int ticks);

}  // namespace tactus::shared
