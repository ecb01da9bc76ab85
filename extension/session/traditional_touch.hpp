// Traditional touch (scenarios 2 and 3): the hand is given what the far side's hand feels, one delay later,
// and bodies are shown where the far side last saw them.
#pragma once

#include <array>
#include <span>

#include "network/messages.hpp"
#include "session/session_loop.hpp"
#include "session/tool_slot.hpp"

namespace tactus {

class TraditionalTouch {
public:
    // What the far side's hand was given last.
    struct Far {
        SampleSequence sample =
            no_sample;  // the newest one that had been applied; no_sample: nothing has come
        SampleSequence went_on = no_sample;  // the operator's own when that one came
        Vec3 force{0.0};                     // (unit: newtons)
        Vec3 proxy{0.0};                     // in the world (unit: meters)
        SessionHandle touched = no_handle;
        std::uint32_t told_taken = 0;  // ForceSample::taken
        double taken = 0.0;            // the same, added up (unit: joules)
    };

    struct FarTool {
        SampleSequence sample = no_sample, went_on = no_sample;
        Wrench wrench;  // about where the hand would have it
        Pose tool;      // in the world
        SessionHandle touched = no_handle;
        bool fixed = false;  // it cannot turn there
    };

    // False, and nothing has changed, where it is older than what is known.
    // `now`: the operator's own newest sample.
    bool take(const ForceSample& force, SessionHandle touched, SampleSequence now);

    // Whether what came last for pointer `index` still holds in the tick of `sample`: the far side is heard,
    // and has heard more of this hand within `ticks`.
    bool answers(std::size_t index, SampleSequence sample, bool hears_peer, SampleSequence ticks) const;

    // Of what is touched there, no more is known than which object, and where the force points.
    void describe(std::size_t index, SessionLoop::ProxySlot& slot, const Vec3& force) const;

    const Far& far(std::size_t index) const { return far_[index]; }

    // The same for tools. `index`: of the tool, whose number as a pointer is first_tool + index.
    bool take(const WrenchSample& wrench, SessionHandle touched, SampleSequence now);
    bool tool_answers(std::size_t index, SampleSequence sample, bool hears_peer, SampleSequence ticks) const;
    // `by_force`: what presses tells that it touches; what a robot feels is never nothing.
    void describe(std::size_t index, ToolSlot& slot, const Wrench& wrench, bool by_force) const;
    const FarTool& far_tool(std::size_t index) const { return far_tools_[index]; }

    void forget() {
        far_ = {};
        far_tools_ = {};
    }

private:
    std::array<Far, max_proxies> far_;
    std::array<FarTool, max_tools> far_tools_;
};

}  // namespace tactus
