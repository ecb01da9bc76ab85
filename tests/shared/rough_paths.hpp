// Ways of the hand over any mesh of about the size 1: a position for each millisecond, the first of them
// where a sphere of the given radius has room.
#pragma once

#include <span>
#include <vector>

#include "shared/judge_tree.hpp"

namespace tactus::shared {

// Around the mesh once in ten seconds, pressed in by up to a tenth of the size.
std::vector<Vec3> pressed_orbit(const JudgeTree& mesh, double radius, int ticks);

// From one random goal in the mesh's box to the next at 10 sizes a second, through whatever is in between.
// Starts inside where there is room for the sphere.
std::vector<Vec3> fast_walk(const JudgeTree& mesh, double radius, int ticks);

// Along the sharpest edges, a third of the radius behind them, at a fifth of the size a second.
std::vector<Vec3> slow_scan(const JudgeTree& mesh, double radius, int ticks);

struct RoughPath {
    const char* name;
    std::vector<Vec3> (*make)(const JudgeTree& mesh, double radius, int ticks);
};

std::span<const RoughPath> rough_paths();

}  // namespace tactus::shared
