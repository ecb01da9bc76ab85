// A side of a teleoperation before it is made: all that it is made from, as plain values, and what it stands
// on.
#pragma once

#include <memory>
#include <vector>

#include "session/side_settings.hpp"
#include "session/teleop_port.hpp"
#include "session/teleop_side.hpp"

namespace tactus {

struct SidePlan {
    enum class Kind : std::uint8_t { operator_side, environment, robot };

    Kind kind = Kind::operator_side;
    TeleopSettings settings;
    EndpointSettings endpoint;
    OperatorRoom room;   // of an operator
    PointerShare share;  // of an environment
};

// One end of a link, with a side that uses it.
struct LinkEnd {
    SidePlan plan;
    Link* link = nullptr;  // outlives the side
    std::shared_ptr<TeleopPort> port;
};

// An operator's one, a robot's one, or those of an environment to each of its operators. Null where there is
// none.
std::unique_ptr<TeleopSide> make_side(const SessionSettings& session, const std::vector<LinkEnd>& ends);

}  // namespace tactus
