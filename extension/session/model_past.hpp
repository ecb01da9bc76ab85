// What the model has been through, by sample of the operator: the hands, and for each body with a place how
// it moved and what the hands and its residual gave it.
#pragma once

#include <array>
#include <vector>

#include "core/teleop/state_history.hpp"
#include "session/session_loop.hpp"
#include "session/tool_slot.hpp"
#include "session/truth_store.hpp"

namespace tactus {

class ModelPast {
public:
    // Velocities.
    struct Given {
        Vec3 linear{0.0}, angular{0.0};
    };
    struct Hand {
        Vec3 position{0.0};
        Vec3 velocity{0.0};
        bool idle = false;
    };
    struct Moment {
        Nanoseconds time = 0;
        std::array<Hand, max_proxies> hands;
        std::array<ToolHand, max_tools> tools;
    };

    ModelPast(std::size_t places, std::size_t samples)
        : history_(places, samples),
          moments_(samples),
          pushes_(places * samples, Vec3(0.0)),
          residuals_(places * samples) {}

    std::size_t samples() const { return moments_.size(); }

    void note_hands(SessionLoop& loop, SampleSequence sample, Nanoseconds now);
    const Moment& moment(SampleSequence sample) const { return moments_[sample % moments_.size()]; }

    // What hands and residuals gave bodies in this sample's step, and how they move after it.
    void note_pushes(SessionLoop& loop, const TruthStore& truths, SampleSequence sample);
    void note_motions(SessionLoop& loop, const TruthStore& truths, SampleSequence sample);

    // Null where it is not known.
    const BodyMotion* motion(std::uint32_t place, SampleSequence sample) const {
        return place != TruthStore::no_place && sample != no_sample ? history_.at(place, sample) : nullptr;
    }
    // The newest sample in whose tick a hand pressed any body that has a place; no_sample: none has.
    SampleSequence last_push() const { return last_push_; }
    // The velocity that hands gave the body after sample `first` up to `last`.
    Vec3 pushed(std::uint32_t place, SampleSequence first, SampleSequence last) const;
    // And its residual.
    Given helped(std::uint32_t place, SampleSequence first, SampleSequence last) const;

    // The body has been elsewhere since `first`.
    void carry(std::uint32_t place, SampleSequence first, SampleSequence last, const BodyMotion& before,
               const BodyMotion& after) {
        history_.carry(place, first, last, before, after);
    }
    void forget(std::uint32_t place) { history_.forget(place); }

private:
    StateHistory history_;
    std::vector<Moment> moments_;
    std::vector<Vec3> pushes_;      // by place and sample
    std::vector<Given> residuals_;  // by place and sample
    SampleSequence last_push_ = no_sample;
};

}  // namespace tactus
