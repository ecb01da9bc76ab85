#include "session/estimate_teller.hpp"

#include <algorithm>
#include <cmath>

namespace tactus {

namespace {

// Eyes do not see more often, and nobody learns faster.
constexpr Nanoseconds look_every = 20'000'000;
constexpr Nanoseconds estimate_again_after = 500'000'000;

// What has changed by less is said again later (share of itself, of a deviation).
constexpr double changed_by = 0.1;
constexpr double surer_by = 0.3;

bool differ(double a, double b, double share) {
    return std::abs(a - b) > share * std::max(a, b);
}

bool differ(const TouchValue& a, const TouchValue& b) {
    return a.known != b.known || (a.known && (differ(a.value, b.value, changed_by * 0.5) ||
                                              differ(a.deviation, b.deviation, surer_by)));
}

bool differ(const ObjectEstimate& a, const ObjectEstimate& b) {
    return a.has_doubt != b.has_doubt || differ(a.stiffness, b.stiffness) || differ(a.friction, b.friction) ||
           differ(a.mass, b.mass) || differ(place_deviation(a.doubt), place_deviation(b.doubt), changed_by) ||
           differ(turn_deviation(a.doubt), turn_deviation(b.doubt), changed_by);
}

bool says_something(const ObjectEstimate& estimate) {
    return estimate.has_doubt || estimate.stiffness.known || estimate.friction.known || estimate.mass.known;
}

ObjectEstimate estimate_of(const SessionLoop::Body& body, SessionHandle handle, const TouchLearner* touch,
                           const Pose& frame) {
    ObjectEstimate estimate;
    estimate.object = static_cast<ObjectId>(handle);
    if (body.doubt) {
        estimate.has_doubt = true;
        estimate.doubt = turned(*body.doubt, glm::conjugate(frame.rotation));
    }
    if (const TouchEstimate* const felt = touch != nullptr ? touch->of(handle) : nullptr) {
        estimate.stiffness = felt->stiffness();
        estimate.friction = felt->friction();
        estimate.mass = body.motion == Motion::Dynamic ? felt->mass() : TouchValue{};
    }
    return estimate;
}

}  // namespace

void EstimateTeller::restart() {
    std::ranges::fill(told_, Told{});
}

void EstimateTeller::described(SessionHandle body) {
    if (body < told_.size()) {
        told_[body] = {};
    }
}

// At most one packet at a time, the bodies in turn.
void EstimateTeller::tell(SessionLoop& loop, Channel& channel, const TouchLearner* touch, Nanoseconds now) {
    if (now - looked_at_ < look_every || !channel.link().hears_peer()) {
        return;
    }
    looked_at_ = now;
    ObjectEstimates message;
    const std::size_t from = next_;
    for (std::size_t i = 0; i < told_.size() && message.count < ObjectEstimates::max_count; ++i) {
        const auto handle = static_cast<SessionHandle>((from + i) % told_.size());
        const SessionLoop::Body* const body = loop.body(handle);
        Told& told = told_[handle];
        if (body == nullptr) {
            told = {};
            continue;
        }
        const ObjectEstimate estimate = estimate_of(*body, handle, touch, channel.settings().frame);
        const bool said_before = told.at != 0 && says_something(told.estimate);
        const bool is_due =
            told.at == 0 || differ(estimate, told.estimate) || now - told.at >= estimate_again_after;
        if ((says_something(estimate) || said_before) && is_due) {
            message.estimates[message.count++] = estimate;
            told = {estimate, now};
            next_ = (handle + 1) % told_.size();
        }
    }
    if (message.count > 0) {
        channel.send(message);
    }
}

}  // namespace tactus
