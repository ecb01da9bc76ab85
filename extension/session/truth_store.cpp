#include "session/truth_store.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace tactus {

TruthStore::TruthStore(std::size_t max_bodies, std::size_t places)
    : truths_(max_bodies), place_of_(max_bodies, no_place), body_at_(places, no_handle) {
    fresh_.reserve(max_bodies);
}

bool TruthStore::take(SessionHandle body, SampleSequence sample, std::uint64_t packet,
                      const BodyMotion& motion) {
    Truth& truth = truths_[body];
    if (!is_newer(body, packet)) {
        return false;
    }
    truth.sample_before = truth.packet != 0 ? truth.sample : no_sample;
    truth.before = truth.motion;
    truth.sample = sample;
    truth.packet = packet;
    truth.motion = motion;
    if (!truth.fresh) {
        truth.fresh = true;
        fresh_.push_back(body);
    }
    return true;
}

void TruthStore::settle() {
    for (const SessionHandle body : fresh_) {
        truths_[body].fresh = false;
    }
    fresh_.clear();
}

std::uint32_t TruthStore::give_place(SessionHandle body, std::span<const Vec3> hands,
                                     SessionHandle& evicted) {
    evicted = no_handle;
    if (place_of_[body] != no_place) {
        return place_of_[body];
    }
    auto place = std::ranges::find(body_at_, no_handle);
    if (place == body_at_.end() && !hands.empty()) {
        const auto far = std::ranges::max_element(
            body_at_, {}, [&](SessionHandle other) { return distance(other, hands); });
        if (far != body_at_.end() && distance(*far, hands) > distance(body, hands)) {
            evicted = *far;
            place_of_[evicted] = no_place;
            place = far;
        }
    }
    if (place == body_at_.end()) {
        return no_place;
    }
    *place = body;
    return place_of_[body] = static_cast<std::uint32_t>(place - body_at_.begin());
}

double TruthStore::distance(SessionHandle body, std::span<const Vec3> hands) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& hand : hands) {
        nearest = std::min(nearest, glm::distance(hand, truths_[body].motion.pose.position));
    }
    return nearest;
}

void TruthStore::forget(SessionHandle body) {
    if (truths_[body].fresh) {
        std::erase(fresh_, body);
    }
    truths_[body] = {};
    if (const std::uint32_t place = std::exchange(place_of_[body], no_place); place != no_place) {
        body_at_[place] = no_handle;
    }
}

void TruthStore::forget_all() {
    std::ranges::fill(truths_, Truth{});
    std::ranges::fill(place_of_, no_place);
    std::ranges::fill(body_at_, no_handle);
    fresh_.clear();
}

}  // namespace tactus
