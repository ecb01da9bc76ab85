// How far to believe in the steps of one tick along bent surfaces, and how a surface of many small facets
// bends as a whole.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "core/proxy/constrained_step.hpp"
#include "core/proxy/tolerances.hpp"

namespace tactus {

class StepTrust {
public:
    // At first a bent step is believed in as far as a proxy follows its hand. `given_way`: of the hand and of
    // what carries the proxy since the last tick (unit: meters).
    StepTrust(double radius, double given_way)
        : radius_(radius), trust_(std::max(max_sensitivity * given_way, least_trust * radius)) {}

    // Nothing beyond a flat step goes farther (unit: meters).
    double limit() const { return std::min(trust_, foreseen_); }
    int stops() const { return stops_; }  // steps that something has stopped

    // Of a flat step from `position` towards the hand at `pull` from there: what the last bent one has won
    // says how far the next one is believed in, and what the last ways have shown of the whole surface bends
    // this one.
    void heed(ConstrainedStep& step, const Vec3& pull, const Vec3& position, const Tolerances& tolerances);
    // It has led that far (unit: meters).
    void taken(const ConstrainedStep& step, const Vec3& pull, double length, bool was_stopped) {
        was_stopped_ = was_stopped;
        stops_ += was_stopped;
        last_bent_ = step.bent ? BentStep{length, glm::length(step.slide), glm::distance(pull, step.drop)}
                               : BentStep{};
    }

private:
    static constexpr double least_trust = 1e-6;  // of the radius: where the hand rests they are still of use

    // What the last step was, if it was a bent one.
    struct BentStep {
        double length = 0.0;    // 0: it was not (unit: meters)
        double slide = 0.0;     // of the flat step in its place (unit: meters)
        double distance = 0.0;  // where it began, as `nearest_` (unit: meters)
    };

    void doubt(const ConstrainedStep& step, const Vec3& pull, double same);
    void follow_whole(ConstrainedStep& step, const Vec3& pull, const Vec3& position, double least_slide);
    void follow_hollow(ConstrainedStep& step, double newton, double bend, const Vec3& normal,
                       double way) const;
    void follow_hill(ConstrainedStep& step, double newton, double way);

    double radius_;
    double trust_;
    double foreseen_ = std::numeric_limits<double>::infinity();  // see follow_hill (unit: meters)
    double nearest_ = std::numeric_limits<double>::infinity();   // to the hand while touching (unit: meters)
    BentStep last_bent_;
    int planned_ = 0;  // steps along a surface
    int stops_ = 0;
    bool was_stopped_ = false;  // the last one has been
    Vec3 began_{0.0};           // where the last step began,
    Vec3 pushed_{0.0};          // and which way the surfaces pushed there
};

}  // namespace tactus
