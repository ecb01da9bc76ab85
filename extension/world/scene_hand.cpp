#include "world/scene_hand.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "devices/falcon/falcon_arm.hpp"
#include "devices/path_device.hpp"

namespace tactus {

namespace {

constexpr const char* unheld = "its device is not there, or it is switched off";

Vec3 in_device(const Workspace& mapping, const Vec3& place) {
    return to_local(mapping.pose, place) / mapping.scale;
}

DriverKind driver_of(HandKind kind) {
    return static_cast<DriverKind>(static_cast<int>(kind) - static_cast<int>(HandKind::falcon));
}

}  // namespace

SceneHand::SceneHand(HandPlan plan, const Workspace& mapping) : pointed_at_(plan.start) {
    if (has_driver(plan.kind)) {
        driver_ = std::make_shared<DriverDevice>(make_driver(driver_of(plan.kind), std::move(plan.driver)));
        port_ = driver_;
    } else if (plan.kind == HandKind::path) {
        const auto follower = std::make_shared<PathDevice>(std::move(plan.path));
        clock_ = &follower->clock();
        port_ = follower;
    } else if (plan.kind == HandKind::arm) {
        arm_ = std::make_shared<SimulatedArm>(std::move(plan.path), plan.arm);
        clock_ = &arm_->clock();
        port_ = arm_;
    } else if (plan.kind == HandKind::emulated_robot) {
        RobotTable::Settings table;
        table.height = plan.table_height;
        EmulatedRobotSettings robot;
        robot.believed_mass += plan.robot_mass_error;
        robot.believed_friction += plan.robot_friction_error;
        port_ = std::make_shared<EmulatedRobot>(
            robot, std::make_shared<TipSurroundings>(table, std::move(plan.tip)));
    } else if (plan.kind == HandKind::robot_tip) {
        port_ = std::make_shared<TipDevice>(std::move(plan.tip));
    } else {
        aimed_at_ = in_device(mapping, plan.start);
        turn_to(plan.kind == HandKind::node ? plan.turned : mapping.pose.rotation, mapping);
        follower_ = std::make_shared<FollowingDevice>(
            FollowingDevice::Settings{.rest = aimed_at_,
                                      .turned = turned_to_,
                                      .is_there = !may_be_missing(plan.kind),
                                      .rotates = plan.kind == HandKind::node});
        port_ = follower_;
    }
}

void SceneHand::change(const ArmSettings& arm) {
    if (arm_ != nullptr) {
        arm_->change(arm);
    }
}

void SceneHand::restart_path() {
    if (clock_ != nullptr) {
        clock_->restart();
    }
}

void SceneHand::turn_to(const Quat& turned, const Workspace& mapping) {
    if (std::isfinite(glm::dot(turned, turned))) {  // a node may be scaled to nothing
        turned_to_ = glm::conjugate(mapping.pose.rotation) * turned;
    }
}

void SceneHand::lead(const Pose& place, const Workspace& mapping, std::uint32_t buttons) {
    turn_to(place.rotation, mapping);
    const bool is_somewhere = glm::length(place.position) < farthest_hand;
    aim(is_somewhere ? in_device(mapping, place.position) : aimed_at_, is_somewhere ? buttons : 0);
}

void SceneHand::aim(const Vec3& place, std::uint32_t buttons, bool is_there) {
    if (is_led()) {
        aimed_at_ = place;
        follower_->aim({place, buttons, is_there, turned_to_});
    }
}

void SceneHand::point(const ScreenRay& ray, double deeper, const Workspace& mapping, std::uint32_t buttons) {
    if (const auto place = is_led() ? under_pointer(ray, pointed_at_, deeper) : std::nullopt) {
        pointed_at_ = *place;
        aim(in_device(mapping, pointed_at_), buttons);
    }
}

void SceneHand::steer(const Vec3& deflection, const SteeringSettings& steering, double seconds,
                      const Workspace& mapping, std::uint32_t buttons, bool is_there) {
    if (is_led()) {
        steered_to_ = steered(steered_to_, direction_to_local(mapping.pose, deflection), steering, seconds);
        aim(steered_to_, buttons, is_there);
    }
}

double usual_radius(HandKind kind, const SteeringSettings& steering) {
    if (has_driver(kind)) {
        return make_driver(driver_of(kind), {})->capabilities().radius;
    }
    if (kind == HandKind::emulated_robot) {
        return falcon_capabilities().radius;
    }
    return is_steered(kind) ? steering.reach : 0.0;
}

std::string problem_of_gamepad(int wanted, const std::vector<Gamepad>& there) {
    if (there.empty()) {
        return "no gamepad is connected: plug one in, or choose another driver";
    }
    std::string all;
    for (const Gamepad& gamepad : there) {
        if (gamepad.number == wanted) {
            return {};
        }
        all += (all.empty() ? "" : ", ") + std::to_string(gamepad.number) + " (" + gamepad.name + ")";
    }
    return "there is no gamepad " + std::to_string(wanted) + ": set 'gamepad' to one of " + all;
}

std::string state_of_hand(const DeviceState& state, bool has_driver, const std::string& said) {
    if (!said.empty()) {
        return said;
    }
    if (!state.connected && state.safety == HandState::no_number) {
        return text_of(state.safety);
    }
    if (!state.connected) {
        return has_driver ? "waiting for the device" : "waiting for the first tick";
    }
    std::string text = "connected";
    if (state.safety != HandState::working) {
        text += std::string("; ") + text_of(state.safety);
    }
    const std::string too_stiff = explain_stiffness(state.stiffness_wanted, state.stiffness_used, state.lag);
    return too_stiff.empty() ? text : text + "; " + too_stiff;
}

std::string text_of_cuts(const ForceSlot::Cuts& cuts) {
    const std::uint64_t all = std::accumulate(cuts.begin(), cuts.end(), std::uint64_t{0});
    if (all == 0) {
        return {};
    }
    const auto most = std::ranges::max_element(cuts) - cuts.begin();
    return "; its force was cut " + std::to_string(all) + (all == 1 ? " time: " : " times, mostly: ") +
           text_of(static_cast<ForceCut>(most));
}

std::string state_of_fingertip(const ProxyState& state) {
    if (state.handle == no_handle) {
        return "waiting for the first tick";
    }
    if ((state.status & touch_unheld) != 0) {
        return unheld;
    }
    if ((state.status & far_hand_away) != 0) {
        return "no hand of the operator is here";
    }
    if ((state.status & proxy_absent) != 0) {
        return "the hand began inside a body: move it out once";
    }
    if ((state.status & proxy_letting_out) != 0) {
        return "a body has come to stand where the hand is, and is not felt until the hand is out of it";
    }
    return (state.status & proxy_touching) != 0 ? "touching" : "free";
}

std::string state_of_tool(const ToolState& state) {
    if (state.handle == no_handle) {
        return "waiting for the first tick";
    }
    if ((state.status & touch_unheld) != 0) {
        return unheld;
    }
    if ((state.status & far_hand_away) != 0) {
        return "no hand of the operator is here";
    }
    if ((state.status & tool_absent) != 0) {
        return "the tool does not fit in where the hand holds it: move it to where it touches nothing";
    }
    if ((state.status & tool_wrist_loose) != 0) {
        return "its robot turns and has no motors that hold the tool: use one that gives a torque";
    }
    const std::string does = (state.status & tool_touching) != 0 ? "touching" : "free";
    return (state.status & tool_turn_fixed) != 0 ? does + "; its robot cannot turn it" : does;
}

}  // namespace tactus
