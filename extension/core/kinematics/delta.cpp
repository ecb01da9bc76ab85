#include "core/kinematics/delta.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace tactus {

namespace {

// A leg is singular below these: sines of angles, and the volume of three unit vectors. A force near the
// limit asks for torques some ten times those in the middle.
constexpr double straight_limit = 0.10;
constexpr double sideways_limit = 0.15;
constexpr double loose_limit = 0.05;

constexpr int max_newton_steps = 30;
constexpr double newton_done = 1e-13;  // (unit: meters): some thousand times what a double resolves there
constexpr double longest_step = 0.03;  // a cold start is led, not thrown (unit: meters)
constexpr double max_lean = 0.999;     // of the rods while Newton is on its way

struct LegFrame {
    Vec3 outwards, sideways;
};

using LegFrames = std::array<LegFrame, 3>;

LegFrame leg_frame(double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {{c, s, 0.0}, {-s, c, 0.0}};
}

LegFrames leg_frames(const DeltaGeometry& g) {
    return {leg_frame(g.leg_angles[0]), leg_frame(g.leg_angles[1]), leg_frame(g.leg_angles[2])};
}

// The end of the parallelogram in the plane of the upper arm, and how far it leans out of it.
struct LegEnd {
    double u, w, lean;  // Pu + c, Pw, Pv + f (unit: meters)
};

LegEnd leg_end(const DeltaGeometry& g, const LegFrame& frame, const Vec3& place) {
    return {glm::dot(frame.outwards, place) - g.base_out + g.platform_out, place.z,
            glm::dot(frame.sideways, place) - g.base_sideways + g.platform_sideways};
}

Vec3 rod_along(const LegFrame& frame, double cos_2, double sin_2, double cos_3, double sin_3) {
    return frame.outwards * (cos_2 * sin_3) + frame.sideways * cos_3 + Vec3(0.0, 0.0, sin_2 * sin_3);
}

double volume_of(const std::array<Vec3, 3>& rods) {
    return glm::dot(rods[0], glm::cross(rods[1], rods[2]));
}

// The x with rods[i] . x = along[i].
Vec3 meeting(const std::array<Vec3, 3>& rods, const Vec3& along, double volume) {
    return (glm::cross(rods[1], rods[2]) * along.x + glm::cross(rods[2], rods[0]) * along.y +
            glm::cross(rods[0], rods[1]) * along.z) /
           volume;
}

void note(DeltaPose& pose, DeltaState singularity, double measure, double limit) {
    const double clearance = measure / limit - 1.0;
    if (clearance < pose.clearance) {
        pose.clearance = std::max(0.0, clearance);
        if (clearance <= 0.0 && pose.state < singularity) {
            pose.state = singularity;
        }
    }
}

}  // namespace

// With the end at distance rho and direction alpha from the shoulder, and the length L of the parallelogram,
//     a^2 + rho^2 - 2 a rho cos(theta1 - alpha) = L^2,
// whose root theta1 < alpha has the elbow outwards.
DeltaPose delta_pose(const DeltaGeometry& g, const Vec3& place) {
    const LegFrames frames = leg_frames(g);
    DeltaPose pose;
    pose.state = DeltaState::sound;
    pose.clearance = 1.0;
    for (int i = 0; i < 3; ++i) {
        const LegFrame& frame = frames[static_cast<std::size_t>(i)];
        const LegEnd end = leg_end(g, frame, place);
        const double cos_3 = end.lean / g.rod_length;
        if (!(std::abs(cos_3) < 1.0)) {
            return {};
        }
        const double sin_3 = std::sqrt(1.0 - cos_3 * cos_3);
        const double length = g.bars + g.rod_length * sin_3;
        const double squared = end.u * end.u + end.w * end.w;
        const double rho = std::sqrt(squared);
        const double cosine =
            (g.upper_arm * g.upper_arm + squared - length * length) / (2.0 * g.upper_arm * rho);
        if (!(std::abs(cosine) <= 1.0)) {
            return {};
        }
        const double sine = std::sqrt(1.0 - cosine * cosine);
        const double cos_1 = (end.u * cosine + end.w * sine) / rho;
        const double sin_1 = (end.w * cosine - end.u * sine) / rho;
        const double theta_1 = std::atan2(sin_1, cos_1);
        const double cos_2 = (end.u - g.upper_arm * cos_1) / length;
        const double sin_2 = (end.w - g.upper_arm * sin_1) / length;
        const double bend = sin_2 * cos_1 - cos_2 * sin_1;  // sin(theta2 - theta1)
        pose.angles[i] = theta_1;
        pose.rods[static_cast<std::size_t>(i)] = rod_along(frame, cos_2, sin_2, cos_3, sin_3);
        pose.levers[i] = g.upper_arm * sin_3 * bend;
        if (theta_1 < g.lowest_angle || theta_1 > g.highest_angle) {
            pose.state = std::max(pose.state, DeltaState::beyond_stops);
        }
        note(pose, DeltaState::leg_straight, std::abs(bend), straight_limit);
        note(pose, DeltaState::leg_sideways, sin_3, sideways_limit);
    }
    pose.volume = volume_of(pose.rods);
    note(pose, DeltaState::platform_loose, std::abs(pose.volume), loose_limit);
    return pose;
}

// Newton on the length of each leg: from the elbow to the platform's joint it is
//     sqrt((u - a cos theta1)^2 + (w - a sin theta1)^2) - L(lean) = 0,
// whose gradient is rod / sin(theta3).
DeltaPlace delta_place(const DeltaGeometry& g, const Vec3& angles, const Vec3& start) {
    const LegFrames frames = leg_frames(g);
    const Vec3 elbow_u = g.upper_arm * glm::cos(angles);
    const Vec3 elbow_w = g.upper_arm * glm::sin(angles);
    DeltaPlace found;
    found.place = start;
    while (found.steps < max_newton_steps) {
        std::array<Vec3, 3> rods;
        Vec3 excess;
        for (int i = 0; i < 3; ++i) {
            const LegFrame& frame = frames[static_cast<std::size_t>(i)];
            const LegEnd end = leg_end(g, frame, found.place);
            const double cos_3 = std::clamp(end.lean / g.rod_length, -max_lean, max_lean);
            const double sin_3 = std::sqrt(1.0 - cos_3 * cos_3);
            const double u = end.u - elbow_u[i];
            const double w = end.w - elbow_w[i];
            const double length = std::sqrt(u * u + w * w);
            rods[static_cast<std::size_t>(i)] = rod_along(frame, u / length, w / length, cos_3, sin_3);
            excess[i] = sin_3 * (length - g.bars - g.rod_length * sin_3);
        }
        const double volume = volume_of(rods);
        Vec3 step = meeting(rods, excess, volume);
        const double way = glm::length(step);
        if (!std::isfinite(way)) {
            return found;
        }
        if (way > longest_step) {
            step *= longest_step / way;
        }
        found.place -= step;
        ++found.steps;
        if (way < newton_done) {
            found.found = true;
            return found;
        }
    }
    return found;
}

// With all legs alike, on the axis; where the upper arms are half of their way up.
Vec3 delta_centre(const DeltaGeometry& g) {
    const double theta = g.lowest_angle + 0.5 * (g.highest_angle - g.lowest_angle);
    const double lean = g.platform_sideways - g.base_sideways;
    const double length = g.bars + std::sqrt(g.rod_length * g.rod_length - lean * lean);
    const double u = g.platform_out - g.base_out - g.upper_arm * std::cos(theta);
    return {0.0, 0.0, g.upper_arm * std::sin(theta) + std::sqrt(length * length - u * u)};
}

Mat3 delta_jacobian(const DeltaPose& pose) {
    return glm::transpose(
        Mat3(pose.rods[0] / pose.levers.x, pose.rods[1] / pose.levers.y, pose.rods[2] / pose.levers.z));
}

Vec3 delta_velocity(const DeltaPose& pose, const Vec3& angle_rates) {
    return meeting(pose.rods, angle_rates * pose.levers, pose.volume);
}

Vec3 delta_torques(const DeltaPose& pose, const Vec3& force) {
    const Vec3 pulls = Vec3(glm::dot(force, glm::cross(pose.rods[1], pose.rods[2])),
                            glm::dot(force, glm::cross(pose.rods[2], pose.rods[0])),
                            glm::dot(force, glm::cross(pose.rods[0], pose.rods[1]))) /
                       pose.volume;
    return pulls * pose.levers;
}

Vec3 delta_force(const DeltaPose& pose, const Vec3& torques) {
    const Vec3 pulls = torques / pose.levers;
    return pose.rods[0] * pulls.x + pose.rods[1] * pulls.y + pose.rods[2] * pulls.z;
}

}  // namespace tactus
