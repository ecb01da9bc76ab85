#include "session/side_plan.hpp"

#include "session/operator_side.hpp"
#include "session/robot_side.hpp"
#include "session/shared_environment.hpp"
#include "session/teleoperator_side.hpp"

namespace tactus {

namespace {

std::unique_ptr<TeleopSide> make_one(const SessionSettings& session, const LinkEnd& end) {
    const SidePlan& plan = end.plan;
    switch (plan.kind) {
        case SidePlan::Kind::operator_side:
            return std::make_unique<OperatorSide>(session, plan.room, plan.settings, *end.link, end.port,
                                                  plan.endpoint);
        case SidePlan::Kind::robot:
            return std::make_unique<RobotSide>(session, plan.settings, *end.link, end.port, plan.endpoint);
        case SidePlan::Kind::environment:
            break;
    }
    return std::make_unique<TeleoperatorSide>(session, plan.settings, *end.link, end.port, plan.endpoint,
                                              plan.share);
}

}  // namespace

std::unique_ptr<TeleopSide> make_side(const SessionSettings& session, const std::vector<LinkEnd>& ends) {
    std::vector<std::unique_ptr<TeleopSide>> sides;
    for (const LinkEnd& end : ends) {
        sides.push_back(make_one(session, end));
    }
    if (sides.size() > 1) {
        return std::make_unique<SharedEnvironment>(std::move(sides));
    }
    return sides.empty() ? nullptr : std::move(sides.front());
}

}  // namespace tactus
