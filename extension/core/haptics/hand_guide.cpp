#include "core/haptics/hand_guide.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tactus {

namespace {

using Form = HandGuide::Form;

constexpr double least_length = 1e-6;  // between two points that show a direction (unit: meters)
constexpr double farthest = 1e9;       // (unit: meters)
constexpr double stiffest = 1e6;       // (unit: newtons per meter)

std::size_t points_needed(Form form) {
    constexpr std::size_t needed[] = {0, 1, 2, 3, 2};
    return needed[static_cast<std::size_t>(form)];
}

Vec3 across(const HandGuide& guide) {
    return glm::cross(guide.points[1] - guide.points[0], guide.points[2] - guide.points[0]);
}

// Of the line from a to b, as far as those shares of it.
Vec3 nearest_on_line(const Vec3& a, const Vec3& b, const Vec3& hand, double first, double last) {
    const Vec3 way = b - a;
    const double squared = glm::dot(way, way);
    const double share = squared > 0.0 ? glm::dot(hand - a, way) / squared : 0.0;
    return a + way * std::clamp(share, first, last);
}

}  // namespace

std::string check_guide(const HandGuide& guide) {
    if (guide.count > HandGuide::max_points) {
        return "a guide has at most 16 points: leave some out, or use several";
    }
    if (guide.count < points_needed(guide.form)) {
        return "the guide has too few points: give a point one, a line or a way two, a plane three";
    }
    if (!(guide.stiffness >= 0.0 && guide.stiffness <= stiffest) ||
        !(guide.range > 0.0 && guide.range <= farthest)) {
        return "the guide's stiffness is below 0 or its range is no positive length: set them anew";
    }
    for (std::size_t i = 0; i < guide.count; ++i) {
        const Vec3 size = glm::abs(guide.points[i]);
        if (!(size.x <= farthest && size.y <= farthest && size.z <= farthest)) {
            return "point " + std::to_string(i) + " of the guide is not a place within 1e9 m: set it anew";
        }
    }
    if (guide.form == Form::line && glm::distance(guide.points[0], guide.points[1]) < least_length) {
        return "the two points of the guide's line are one place: move one of them away";
    }
    const double longest = std::max(glm::distance(guide.points[0], guide.points[1]), least_length);
    if (guide.form == Form::plane && glm::length(across(guide)) < least_length * longest) {
        return "the three points of the guide's plane lie on a line: move one of them away from it";
    }
    return {};
}

Vec3 guided_place(const HandGuide& guide, const Vec3& hand) {
    constexpr double endless = std::numeric_limits<double>::max();
    const auto& p = guide.points;
    switch (guide.form) {
        case Form::point:
            return p[0];
        case Form::line:
            return nearest_on_line(p[0], p[1], hand, -endless, endless);
        case Form::plane: {
            const Vec3 normal = glm::normalize(across(guide));
            return hand - normal * glm::dot(hand - p[0], normal);
        }
        case Form::way:
        case Form::none:
            break;
    }
    Vec3 nearest = hand;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < guide.count; ++i) {
        const Vec3 place = nearest_on_line(p[i], p[i + 1], hand, 0.0, 1.0);
        const double distance = glm::distance(place, hand);
        if (distance < least) {
            least = distance;
            nearest = place;
        }
    }
    return nearest;
}

Vec3 guide_force(const Vec3& offset, double range, double stiffness) {
    return offset * (-stiffness * std::max(0.0, 1.0 - glm::length(offset) / range));
}

}  // namespace tactus
