#include "shared/delta_figures.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>

#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

constexpr double tick_of_hand = 2e-4;  // 0.2 m/s for a millisecond (unit: meters)
constexpr double difference = 1e-4;    // (unit: meters)

double size_of(const Mat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

double degrees_between(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) / delta_degrees;
}

}  // namespace

void DeltaFigures::add(const DeltaFigures& other) {
    places += other.places;
    lost += other.lost;
    round_trip_rad = std::max(round_trip_rad, other.round_trip_rad);
    round_trip_m = std::max(round_trip_m, other.round_trip_m);
    steps_cold = std::max(steps_cold, other.steps_cold);
    steps_warm = std::max(steps_warm, other.steps_warm);
    jacobian_error = std::max(jacobian_error, other.jacobian_error);
    force_direction_deg = std::max(force_direction_deg, other.force_direction_deg);
    force_size_error = std::max(force_size_error, other.force_size_error);
}

Vec3 sound_place(const DeltaGeometry& geometry, RandomValues& random) {
    for (;;) {
        const Vec3 place(random.between(-0.1, 0.1), random.between(-0.1, 0.1), random.between(0.05, 0.19));
        if (delta_pose(geometry, place).state == DeltaState::sound) {
            return place;
        }
    }
}

Mat3 numeric_jacobian(const DeltaGeometry& geometry, const Vec3& place) {
    Mat3 jacobian(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto angles = [&](double way) {
            Vec3 there = place;
            there[axis] += way;
            return delta_pose(geometry, there).angles;
        };
        const Vec3 near = angles(difference) - angles(-difference);
        const Vec3 far = angles(2.0 * difference) - angles(-2.0 * difference);
        jacobian[axis] = (8.0 * near - far) / (12.0 * difference);
    }
    return jacobian;
}

DeltaFigures check_delta(const DeltaGeometry& geometry, std::uint64_t seed, int places) {
    RandomValues random(seed);
    const Vec3 centre = delta_centre(geometry);
    DeltaFigures figures;
    for (; figures.places < places; ++figures.places) {
        const Vec3 place = sound_place(geometry, random);
        const DeltaPose pose = delta_pose(geometry, place);
        const DeltaPlace cold = delta_place(geometry, pose.angles, centre);
        const DeltaPlace warm = delta_place(geometry, pose.angles, place + random.direction() * tick_of_hand);
        if (!cold.found || !warm.found) {
            ++figures.lost;
            continue;
        }
        const DeltaPose again = delta_pose(geometry, cold.place);
        const Vec3 turned = glm::abs(again.angles - pose.angles);
        const Mat3 numeric = numeric_jacobian(geometry, place);
        const Vec3 wanted = random.direction() * random.magnitude(1e-3, 10.0);
        const Vec3 done = glm::transpose(numeric) * delta_torques(pose, wanted);

        DeltaFigures one;
        one.round_trip_rad = std::max({turned.x, turned.y, turned.z});
        one.round_trip_m = std::max(glm::length(cold.place - place), glm::length(warm.place - place));
        one.steps_cold = cold.steps;
        one.steps_warm = warm.steps;
        one.jacobian_error = size_of(delta_jacobian(pose) - numeric) / size_of(numeric);
        one.force_direction_deg = degrees_between(wanted, done);
        one.force_size_error = std::abs(glm::length(done) / glm::length(wanted) - 1.0);
        figures.add(one);
    }
    return figures;
}

// The square root of the ratio of the eigenvalues of J^T J, by the trigonometric solution of their cubic.
double condition_of(const DeltaPose& pose) {
    const Mat3 jacobian = delta_jacobian(pose);
    const Mat3 a = glm::transpose(jacobian) * jacobian;
    const double mean = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
    const Mat3 b = a - Mat3(mean);
    double squares = 0.0;
    for (int column = 0; column < 3; ++column) {
        squares += glm::dot(b[column], b[column]);
    }
    const double p = std::sqrt(squares / 6.0);
    if (!(p > 0.0)) {
        return 1.0;
    }
    const double angle = std::acos(std::clamp(0.5 * glm::determinant(b / p), -1.0, 1.0)) / 3.0;
    const double largest = mean + 2.0 * p * std::cos(angle);
    const double smallest = mean + 2.0 * p * std::cos(angle + 2.0 * std::numbers::pi / 3.0);
    return smallest > 0.0 ? std::sqrt(largest / smallest) : std::numeric_limits<double>::infinity();
}

}  // namespace tactus::shared
