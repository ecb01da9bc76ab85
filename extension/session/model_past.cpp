#include "session/model_past.hpp"

namespace tactus {

void ModelPast::note_hands(SessionLoop& loop, SampleSequence sample, Nanoseconds now) {
    Moment& moment = moments_[sample % moments_.size()];
    moment.time = now;
    for (std::size_t i = 0; i < max_proxies; ++i) {
        const SessionLoop::ProxySlot& slot = loop.proxy(i);
        moment.hands[i] = {slot.hand, slot.hand_velocity, slot.idle};
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
            pushes_[place * samples() + sample % samples()] = loop.pushed(body);
            helps_[place * samples() + sample % samples()] = loop.helped(body);
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

Vec3 ModelPast::sum(const std::vector<Vec3>& of, std::uint32_t place, SampleSequence first,
                    SampleSequence last) const {
    Vec3 all(0.0);
    for (SampleSequence sample = first + 1; sample <= last; ++sample) {
        all += of[place * samples() + sample % samples()];
    }
    return all;
}

Vec3 ModelPast::pushed(std::uint32_t place, SampleSequence first, SampleSequence last) const {
    return sum(pushes_, place, first, last);
}

Vec3 ModelPast::helped(std::uint32_t place, SampleSequence first, SampleSequence last) const {
    return sum(helps_, place, first, last);
}

}  // namespace tactus
