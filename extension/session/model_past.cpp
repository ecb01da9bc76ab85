#include "session/model_past.hpp"

#include <algorithm>

namespace tactus {

void ModelPast::note_hands(SessionLoop& loop, SampleSequence sample, Nanoseconds now) {
    Moment& moment = moments_[sample % moments_.size()];
    moment.time = now;
    for (std::size_t i = 0; i < max_proxies; ++i) {
        const SessionLoop::ProxySlot& slot = loop.proxy(i);
        moment.hands[i] = {slot.hand, slot.hand_velocity, !loop.is_held(slot)};
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (const ToolSlot* const slot = loop.tool(i)) {
            moment.tools[i] = slot->hand;
        }
    }
}

void ModelPast::note_pushes(SessionLoop& loop, const TruthStore& truths, SampleSequence sample) {
    for (std::size_t place = 0; place < truths.places(); ++place) {
        if (const SessionHandle body = truths.body_at(place); loop.body(body)) {
            const Vec3 push = loop.pushed(body);
            pushes_[place * samples() + sample % samples()] = push;
            residuals_[place * samples() + sample % samples()] = {loop.body(body)->helped,
                                                                  loop.body(body)->helped_turn};
            if (push != Vec3(0.0)) {
                last_push_ = std::max(last_push_, sample);
            }
        }
    }
}

void ModelPast::note_motions(SessionLoop& loop, const TruthStore& truths, SampleSequence sample) {
    for (std::size_t place = 0; place < truths.places(); ++place) {
        if (const SessionHandle body = truths.body_at(place); loop.body(body)) {
            history_.set(place, sample, loop.motion(body));
        }
    }
}

Vec3 ModelPast::pushed(std::uint32_t place, SampleSequence first, SampleSequence last) const {
    Vec3 sum(0.0);
    for (SampleSequence sample = first + 1; sample <= last; ++sample) {
        sum += pushes_[place * samples() + sample % samples()];
    }
    return sum;
}

ModelPast::Given ModelPast::helped(std::uint32_t place, SampleSequence first, SampleSequence last) const {
    Given sum;
    for (SampleSequence sample = first + 1; sample <= last; ++sample) {
        const Given& given = residuals_[place * samples() + sample % samples()];
        sum.linear += given.linear;
        sum.angular += given.angular;
    }
    return sum;
}

}  // namespace tactus
