// A Godot curve as places along it.
#pragma once

#include <godot_cpp/classes/curve3d.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

// So near each other that what lies between is as good as straight; no two are one place. Empty where there
// is no curve of two points.
std::vector<Vec3> places_along(const godot::Ref<godot::Curve3D>& curve);

// As few as it takes for straight lines between them to be no farther from the curve than that (unit:
// meters).
std::vector<Vec3> places_near(const godot::Ref<godot::Curve3D>& curve, double tolerance);

}  // namespace tactus
