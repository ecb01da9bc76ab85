#include "core/teleop/seen_pose.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "core/math/body_motion.hpp"

namespace tactus {

namespace {

// Beyond these nothing is seen (unit: square meters, square radians).
constexpr double largest_place = 1e4;
constexpr double largest_turn = 100.0;

// Surer than these nothing is: no covariance is singular (unit: meters, radians).
constexpr double surest_place = 1e-6;
constexpr double surest_turn = 1e-5;

constexpr double of_rounding = 1e-4;

bool is_covariance(const Mat3& c, double largest) {
    double volume = 1.0;
    for (int i = 0; i < 3; ++i) {
        if (!(c[i][i] >= 0.0 && c[i][i] <= largest)) {
            return false;
        }
        volume *= c[i][i];
        for (int j = 0; j < i; ++j) {
            if (c[i][j] != c[j][i] || !(c[i][j] * c[i][j] <= (1.0 + of_rounding) * c[i][i] * c[j][j])) {
                return false;
            }
        }
    }
    return glm::determinant(c) >= -of_rounding * volume;
}

// Symmetric to the bit.
Mat3 turned_covariance(const Mat3& c, const Quat& turn) {
    const Mat3 axes = glm::mat3_cast(turn);
    const Mat3 whole = axes * c * glm::transpose(axes);
    return 0.5 * (whole + glm::transpose(whole));
}

double largest_deviation(const Mat3& c) {
    return std::sqrt(std::max({0.0, c[0][0], c[1][1], c[2][2]}));
}

// Of what is not quite a covariance, for rounding or for malice, nothing is explained.
bool explains(const Mat3& chance, const Vec3& off, double deviations) {
    if (!(glm::determinant(chance) > 0.0)) {
        return false;
    }
    const double squares = glm::dot(off, glm::inverse(chance) * off);
    return squares >= 0.0 && squares <= deviations * deviations;
}

}  // namespace

bool is_sound(const PoseDoubt& doubt) {
    return is_covariance(doubt.place, largest_place) && is_covariance(doubt.turn, largest_turn);
}

PoseDoubt turned(const PoseDoubt& doubt, const Quat& turn) {
    return {turned_covariance(doubt.place, turn), turned_covariance(doubt.turn, turn)};
}

double place_deviation(const PoseDoubt& doubt) {
    return largest_deviation(doubt.place);
}

double turn_deviation(const PoseDoubt& doubt) {
    return largest_deviation(doubt.turn);
}

Vec3 ModelOff::see(const SeenPoseSettings& settings, const Vec3& off, const Mat3& chance, double open) {
    covariance_ += Mat3(open * open);
    const bool begins = !known_ || !explains(covariance_ + chance, off - mean_, settings.contradicted);
    if (begins) {
        known_ = true;
        mean_ = off;
        covariance_ = chance;
    } else {
        const Mat3 gain = covariance_ * glm::inverse(covariance_ + chance);
        mean_ += gain * (off - mean_);
        covariance_ -= gain * covariance_;
        covariance_ = 0.5 * (covariance_ + glm::transpose(covariance_));
    }
    if (explains(covariance_ + settings.alike * chance, mean_, settings.contradicted)) {
        return Vec3(0.0);
    }
    return std::exchange(mean_, Vec3(0.0));
}

Pose SeenPose::believe(const SeenPoseSettings& settings, const Pose& seen, const PoseDoubt& doubt,
                       const Pose& model, double open_way, double open_turn) {
    const Vec3 off = seen.position - model.position;
    const Vec3 turned_off = turn_vector(seen.rotation * glm::conjugate(model.rotation));
    const Vec3 way = place_.see(settings, off, doubt.place + Mat3(surest_place * surest_place), open_way);
    const Vec3 turn =
        turn_.see(settings, turned_off, doubt.turn + Mat3(surest_turn * surest_turn), open_turn);
    Pose believed = model;
    if (way != Vec3(0.0)) {
        believed.position = way == off ? seen.position : model.position + way;
    }
    if (turn != Vec3(0.0)) {
        believed.rotation =
            turn == turned_off ? seen.rotation : glm::normalize(turn_by(turn, 1.0) * model.rotation);
    }
    return believed;
}

}  // namespace tactus
