#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/math/body_motion.hpp"
#include "sensing/sensing_figures.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds image = 33'333'333;
constexpr int images = 1800;  // a minute
constexpr int images_to_settle = 600;

// Poses with chance of 1 mm and 5 mrad along every axis.
class RoughEyes {
public:
    explicit RoughEyes(std::uint64_t seed) : random_(seed) {
        for (std::size_t i = 0; i < 3; ++i) {
            covariance[i][i] = place * place;
            covariance[i + 3][i + 3] = turn * turn;
        }
    }
    Pose see(const Pose& pose) {
        return {pose.position + place * chance(),
                glm::normalize(turn_by(turn * chance(), 1.0) * pose.rotation)};
    }
    Matrix6 covariance{};

private:
    static constexpr double place = 1e-3, turn = 5e-3;

    // The sum of twelve even chances.
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) {
            sum += random_.unit();
        }
        return sum;
    }
    Vec3 chance() { return {normal(), normal(), normal()}; }

    RandomValues random_;
};

// A hand held still presses with 2 N on a wall of 1000 N/m that is where the pose says: what changes of its
// force within `window` seconds, a tenth of the force being just noticeable.
constexpr double stiffness = 1000.0;
constexpr double pressing = 2.0;
constexpr double just_noticeable = 0.1 * pressing;
constexpr int window = 15;  // images: half a second

double jitter_of(const std::vector<double>& heights) {
    double most = 0.0;
    for (std::size_t i = window; i < heights.size(); ++i) {
        const auto [low, high] =
            std::minmax_element(heights.begin() + static_cast<std::ptrdiff_t>(i) - window,
                                heights.begin() + static_cast<std::ptrdiff_t>(i));
        most = std::max(most, stiffness * (*high - *low));
    }
    return most / just_noticeable;
}

}  // namespace

void report_rest(Report& report, const SensingCase& bench) {
    double squares = 0.0, jitter = 0.0, fastest = 0.0;
    int counted = 0, awake = 0;
    for (int s = 0; s < bench.scenes; ++s) {
        RoughEyes eyes(bench.first + static_cast<std::uint64_t>(s));
        const Pose truth{{0.1, 0.05, -0.2}, {1.0, 0.0, 0.0, 0.0}};
        MotionFilter filter;
        std::vector<double> heights;
        for (int i = 1; i <= images; ++i) {
            filter.see({}, eyes.see(truth), eyes.covariance, i * image);
            if (i <= images_to_settle) {
                continue;
            }
            const Vec3 off = filter.pose().position - truth.position;
            squares += glm::dot(off, off);
            fastest = std::max(fastest, glm::length(filter.linear_velocity()));
            awake += !filter.rests();
            ++counted;
            heights.push_back(filter.pose().position.y);
        }
        jitter = std::max(jitter, jitter_of(heights));
    }
    const double off = 1e3 * std::sqrt(squares / std::max(1, counted));
    report.set("rest_position_rms_mm", off);
    report.set("rest_force_jitter_jnd", jitter);
    report.set("rest.fastest_m_s", fastest);
    report.set("rest.not_at_rest_percent", 100.0 * awake / std::max(1, counted));
    std::printf(
        "rest           under 1 mm of chance: %.3f mm RMS off after 20 s, at most %.4f m/s, force changes by "
        "%.4f of a "
        "just noticeable difference in half a second; awake %.3f %%\n",
        off, fastest, jitter, 100.0 * awake / std::max(1, counted));
}

}  // namespace tactus::shared
