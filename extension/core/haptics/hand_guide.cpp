#include "core/haptics/hand_guide.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

namespace tactus {

namespace {

using Form = HandGuide::Form;

constexpr double least_length = 1e-6;  // between two points that show a direction (unit: meters)
constexpr double stiffest = 1e6;       // (unit: newtons per meter)

std::size_t points_needed(Form form) {
    constexpr std::size_t needed[] = {0, 1, 2, 3, 0};
    return needed[static_cast<std::size_t>(form)];
}

Vec3 across(const HandGuide& guide) {
    return glm::cross(guide.points[1] - guide.points[0], guide.points[2] - guide.points[0]);
}

bool is_frame(const Pose& frame) {
    const Quat& q = frame.rotation;
    return is_guide_place(frame.position) && std::abs(glm::dot(q, q) - 1.0) < 1e-6;
}

std::string check_points(const HandGuide& guide) {
    if (guide.count > HandGuide::max_points || guide.count < points_needed(guide.form)) {
        return "the guide has too few points: give a point one, a line or a path two, a plane three";
    }
    const std::span<const Vec3> points(guide.points);
    if (std::string problem = check_guide_points(points.first(guide.count)); !problem.empty()) {
        return problem;
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

}  // namespace

bool is_same_guide(const HandGuide& a, const HandGuide& b) {
    return a.form == b.form && a.mode == b.mode && a.count == b.count && a.points == b.points &&
           a.way == b.way && a.stiffness == b.stiffness && a.range == b.range;
}

std::string check_guide(const HandGuide& guide) {
    if (!(guide.stiffness >= 0.0 && guide.stiffness <= stiffest) ||
        !(guide.range > 0.0 && guide.range <= farthest_guide)) {
        return "the guide's stiffness is below 0 or its range is no positive length: set them anew";
    }
    if (!is_frame(guide.frame)) {
        return "the guide's frame is no place: reset the transform of the node above it";
    }
    if (guide.form == Form::way) {
        return guide.way ? check_way(*guide.way) : check_way({});
    }
    return check_points(guide);
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
            return nearest_on_way(*guide.way, hand);
        case Form::none:
            break;
    }
    return hand;
}

Vec3 guide_force(HandGuide::Mode mode, const Vec3& offset, double range, double stiffness) {
    const double distance = glm::length(offset);
    switch (mode) {
        case HandGuide::Mode::attract:
            return offset * (-stiffness * std::max(0.0, 1.0 - distance / range));
        case HandGuide::Mode::hold:
            return offset * -stiffness;
        case HandGuide::Mode::forbid:
            break;
    }
    // K (R - d) min(1, 2 d / R) / d, without a division by nothing.
    const double depth = std::max(0.0, range - distance);
    return offset * (stiffness * depth * (2.0 * distance < range ? 2.0 / range : 1.0 / distance));
}

double steepest(const HandGuide& guide) {
    const double steep = guide.mode == HandGuide::Mode::forbid ? 2.0 : 1.0;
    return guide.form == HandGuide::Form::none ? 0.0 : steep * guide.stiffness;
}

}  // namespace tactus
