#include "core/proxy/step_trust.hpp"

#include <utility>

namespace tactus {

namespace {

// On shorter ways (of the radius), and in fewer steps, it is the single facet that bends the step.
constexpr double least_whole = 1e-3;
constexpr int least_planned = 4;

}  // namespace

void StepTrust::heed(ConstrainedStep& step, const Vec3& pull, const Vec3& position,
                     const Tolerances& tolerances) {
    doubt(step, pull, tolerances.same);
    follow_whole(step, pull, position, tolerances.step);
}

// Flat steps never lead away from the hand, bent ones may, and several may lead around in a circle. What
// counts is how far from the hand the proxy is once it has dropped onto what holds it back: the gradient of
// half that distance's square is the flat slide, and a step that ends at the nearest place of a parabola wins
// half of what the gradient promises. Where a bent step has won as much, the next is trusted twice as far as
// it went; half as far where it has won less, and a quarter where nothing. A step that was stopped was
// planned without what has stopped it, the next one mostly over what is in mind alone: both promise too much,
// and show nothing.
void StepTrust::doubt(const ConstrainedStep& step, const Vec3& pull, double same) {
    if (was_stopped_) {
        return;
    }
    const double distance = glm::distance(pull, step.drop);
    const bool has_won = distance < nearest_ - same;
    if (has_won) {
        nearest_ = distance;
    }
    const BentStep& last = last_bent_;
    if (last.length > 0.0) {
        const double won = 0.5 * (last.distance * last.distance - distance * distance);
        const bool kept_promise = won >= 0.5 * last.slide * last.length;
        trust_ = (!has_won ? 0.25 : kept_promise ? 2.0 : 0.5) * last.length;
    }
}

// A surface of many small facets bends as a whole otherwise than any of them. What pushes the sphere out
// turns on its way there: by how much on the last way is the bend of the whole along the slide (unit:
// 1/meters, above 0 on a hill), and a Newton step on the Lagrangian is the slide over 1 - pressure * bend.
void StepTrust::follow_whole(ConstrainedStep& step, const Vec3& pull, const Vec3& position,
                             double least_slide) {
    const Vec3 push = step.drop + step.slide - pull;
    const Vec3 pushed = std::exchange(pushed_, push);
    const Vec3 moved = position - std::exchange(began_, position);
    const double way = glm::length(moved);
    const double slide = glm::length(step.slide);
    ++planned_;
    foreseen_ = std::numeric_limits<double>::infinity();
    if (way <= 0.0 || slide <= least_slide) {
        return;
    }
    const double pressure = glm::length(push);
    const Vec3 normal = push / std::max(pressure, 1e-300);
    const Vec3 turned = normal - pushed / std::max(glm::length(pushed), 1e-300);
    const Vec3 along = step.slide / slide;
    const double bend = glm::dot(turned, along) / way;
    const double curvature = 1.0 - pressure * bend;
    if (bend < 0.0 && stops_ >= 2) {
        follow_hollow(step, slide / curvature, bend, normal, way);
    } else if (bend > 0.0 && planned_ >= least_planned && slide > least_whole * radius_ &&
               glm::dot(moved, along) > 0.7 * way) {
        follow_hill(step, curvature > 0.0 ? slide / curvature : 0.5 / bend, way);
    }
}

// Each facet would stop the sphere. It ends as far above them as the hollow rises on the way; they are found
// below it then. Of use where it goes farther than a few facets.
void StepTrust::follow_hollow(ConstrainedStep& step, double newton, double bend, const Vec3& normal,
                              double way) const {
    const double length = std::min(newton, trust_);
    if (length > 2.0 * way) {
        const Vec3 along = glm::normalize(step.slide);
        step.motion = step.drop + along * length - normal * (0.5 * bend * length * length);
        step.bent = true;
    }
}

// With the hand at depth d below a hill of radius R a flat step leaves d / R of the way. What the hill was
// seen to do on the last way it is believed to do on twice as much, and no edge or corner of it bends a step
// farther than the whole does.
void StepTrust::follow_hill(ConstrainedStep& step, double newton, double way) {
    const double slide = glm::length(step.slide);
    foreseen_ = std::max(1.2 * slide, newton);
    const double length = std::min({newton, 2.0 * way, trust_});
    if (length > 1.5 * slide) {
        step.motion = step.drop + step.slide * (length / slide);
        step.bent = true;
    }
}

}  // namespace tactus
