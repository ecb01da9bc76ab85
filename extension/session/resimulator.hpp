// The one time machine: a twin of the loop goes back to the far side's words, each at its own sample, and
// does the hand's part since then again.
//
// A replay starts from the newest memento that is no newer than the oldest fresh truth, and puts every known
// truth in at its own sample on its way, so that what comes late for one body takes nothing back of another.
// It runs beside the present, some ticks in each tick, until it has caught up: no tick is late, however much
// there is to replay.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "session/loop_memento.hpp"
#include "session/model_past.hpp"

namespace tactus {

class Resimulator {
public:
    // A body that is to be elsewhere in the present.
    struct Target {
        SessionHandle body = no_handle;
        BodyMotion motion;
        bool previous_known = false;
        Pose previous;  // one tick ago
    };

    // Without `exists` there is no twin, and no memory for one.
    Resimulator(const SessionSettings& session, std::size_t samples, std::size_t samples_a_memento,
                std::size_t memento_bytes, bool exists);

    bool exists() const { return twin_ != nullptr; }
    SessionLoop* twin() { return twin_.get(); }
    bool running() const { return running_; }

    // After the step of `sample`, in the present or in the twin: a place that a replay can start from.
    void remember(SessionLoop& loop, SampleSequence sample);

    // False where there is no past to start from. What stands still does so where the present has it: the far
    // side's word about it holds for the past as well.
    bool begin(SessionLoop& loop, const TruthStore& truths, const ModelPast& past, SampleSequence now);
    // The same for those that the present puts elsewhere in this tick.
    void place_still(std::span<const Target> targets);

    // At most `ticks` more. True where only the present tick is missing.
    bool advance(const TruthStore& truths, ModelPast& past, SampleSequence now, std::uint32_t ticks);

    // The replay has caught up: bodies of the twin that differ from the present by more than the threshold.
    void finish(SessionLoop& loop, const TruthStore& truths, const MotionThreshold& threshold,
                std::vector<Target>& targets);

    // Where the far side's tool was after the sample.
    void note_tool(std::size_t tool, SampleSequence sample, const Pose& pose) {
        tools_[tool] = {sample, pose};
    }

    // The sample of the truth that the model's past of a body goes on from.
    SampleSequence goes_on_from(SessionHandle body) const {
        return body < put_in_.size() ? put_in_[body] : no_sample;
    }

    void stop() { running_ = false; }
    // Of what was before, nothing is left to start from.
    void forget();

private:
    struct Planned {
        SampleSequence sample = no_sample;
        SessionHandle body = no_handle;
        BodyMotion motion;
    };

    struct FarTool {
        SampleSequence sample = no_sample;
        Pose pose;
    };

    void plan(const TruthStore& truths);
    void put_in();
    void put_in_tools();
    void tick(const TruthStore& truths, ModelPast& past);

    TripleBuffer<SessionSnapshot> nobody_looks_;  // the twin publishes nothing
    std::unique_ptr<SessionLoop> twin_;
    std::size_t samples_a_memento_;
    std::vector<LoopMemento> mementos_;
    std::vector<SampleSequence> memento_of_;  // the sample after which it was taken; no_sample: none
    bool running_ = false;
    SampleSequence replayed_ = no_sample;  // the newest sample that the twin has applied
    SampleSequence first_truth_ = no_sample;
    std::array<FarTool, max_tools> tools_;
    std::vector<Planned> plan_;           // by sample
    std::size_t next_ = 0;                // of the plan
    std::vector<SampleSequence> put_in_;  // by body: the newest truth that a replay has put in
};

}  // namespace tactus
