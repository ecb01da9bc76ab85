// What there is to touch, all in all, and whether a fingertip can touch it.
#pragma once

#include <cstdint>
#include <string>

#include "world/body_form.hpp"

namespace tactus {

struct SceneFacts {
    std::size_t bodies = 0;
    std::uint32_t layers = 0;  // that any of them is in
    double smallest = 0.0;     // reach of a body (unit: meters); planes are left out
    double largest = 0.0;

    void add(std::uint32_t layers_of_body, double reach);
};

// Why this fingertip will not touch what there is, and what to do; empty where it can.
std::string problem_of_fingertip(double radius, std::uint32_t mask, const SceneFacts& facts);

// Of a body that is not built yet: its largest distance from its own place (unit: meters).
double reach_of(const BodyForm& form);

// Whether a ball stands in the solids of such a body, by more than a tenth of its radius. Meshes are not
// looked at.
bool is_inside(const BodyForm& form, const Pose& body, const Vec3& center, double radius);

}  // namespace tactus
