// How the surface that is touched has moved: with its body, and where the body gives, in it.
#pragma once

#include "core/haptics/contact.hpp"
#include "core/haptics/touch_scene.hpp"

namespace tactus {

// Of the point that is touched, since the last tick, in the world (unit: meters).
Vec3 way_of_surface(const TouchScene& scene, const Touch& touch);

}  // namespace tactus
