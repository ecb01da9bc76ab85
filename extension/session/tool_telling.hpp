// What a far side says of the tools that an operator's hands hold there. Pure functions.
#pragma once

#include <glm/common.hpp>

#include "core/math/wrench.hpp"
#include "core/teleop/deadband.hpp"
#include "network/messages.hpp"
#include "network/plausibility.hpp"

namespace tactus {

// When this was said last.
struct SaidWrench {
    Wrench wrench;
    Nanoseconds at = 0;
};

// `length`: by which a torque is felt like a force, see FeltTool (unit: meters).
inline bool wrench_is_due(const DeadbandSettings& settings, const SaidWrench& said, const Wrench& now_felt,
                          double length, Nanoseconds now) {
    return force_needs_sending(settings, said.wrench.force, now_felt.force) ||
           force_needs_sending(settings, said.wrench.torque / length, now_felt.torque / length) ||
           now - said.at >= settings.longest_silence;
}

// `wrench`: on the hand, about where it would have the tool; that and `tool` are in the scene.
inline WrenchSample wrench_sample(const Pose& frame, std::size_t index, SampleSequence answers,
                                  Nanoseconds true_at, const Wrench& wrench, const Pose& tool) {
    WrenchSample sample;
    sample.pointer = static_cast<std::uint16_t>(first_tool + index);
    sample.true_at = true_at;
    sample.newest_operator_sample = answers;
    sample.force =
        glm::clamp(direction_to_local(frame, wrench.force), -plausible::max_force, plausible::max_force);
    sample.torque =
        glm::clamp(direction_to_local(frame, wrench.torque), -plausible::max_torque, plausible::max_torque);
    sample.tool = compose(inverse(frame), tool);
    return sample;
}

}  // namespace tactus
