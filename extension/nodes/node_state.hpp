// The states that the nodes of a hand have in common. MMTLink and HapticDepthSensor have more of them.
#pragma once

#include <cstdint>
#include <utility>

#include "nodes/signals.hpp"

namespace tactus {

// State is the node's own enum: STATE_OFF, STATE_FAILED, STATE_WAITING, STATE_WORKING.
template <class State>
State state_of(bool is_wrong, bool works, bool has_world) {
    if (is_wrong) {
        return State::STATE_FAILED;
    }
    if (works) {
        return State::STATE_WORKING;
    }
    return has_world ? State::STATE_WAITING : State::STATE_OFF;
}

// Posts "state_changed" where the state is another one than the last time.
template <class State>
class ToldState {
public:
    template <class NodeType>
    void tell(const NodeType& node) {
        const State now = node.get_state();
        if (std::exchange(told_, now) != now) {
            post_signal(node, "state_changed", {static_cast<int64_t>(now), node.get_state_text()});
        }
    }

private:
    State told_ = State::STATE_OFF;
};

}  // namespace tactus
