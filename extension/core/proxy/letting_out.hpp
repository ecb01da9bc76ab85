// A proxy never starts inside a surface: bodies that come to stand where it is let it out before they are
// touched (see PassedBodies).
#pragma once

#include <span>

#include "core/haptics/contact.hpp"
#include "core/proxy/passed_bodies.hpp"

namespace tactus {

struct TouchingSphere {
    Vec3 center{0.0};                 // in the world (unit: meters)
    double radius = 0.0;              // (unit: meters)
    std::uint32_t mask = 0;           // layers it touches
    std::span<const Touch> touching;  // what it rested on last
};

// A body that the sphere rested on, or that moving bodies press it into, may overlap it by this share of the
// radius: the sphere is lifted off again. Beyond, the centre could end up on the other side.
constexpr double max_overlap_share = 0.5;

// Passes the bodies that the sphere overlaps since the scene's revision `since` (0: it has not seen the
// scene); all of them, whenever they
// came, with `all`: when the sphere itself has changed. False where there are too many.
bool let_out(const TouchScene& scene, std::uint64_t since, bool all, const TouchingSphere& sphere,
             PassedBodies& passed, WorkBudget& work);

// Passes the moving bodies that overlap the sphere by more than their share, having left it no room. False
// where there are too many.
bool let_out_of_squeeze(const TouchScene& scene, const TouchingSphere& sphere, PassedBodies& passed,
                        WorkBudget& work);

// True where the point is inside a body that is touched from outside only.
bool is_inside_one_sided(const TouchScene& scene, const Vec3& point, std::uint32_t mask, WorkBudget& work);

}  // namespace tactus
