#include "shared/lossy_hands.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <utility>

#include "core/tool/tool_shape.hpp"
#include "devices/robot_tip.hpp"
#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"
#include "session/session.hpp"
#include "session/side_plan.hpp"
#include "shared/endpoints.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/turning_hand.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds tick_length = 1'000'000;
constexpr double radius = 0.01;  // of the fingertip, and half of the tool's height (unit: meters)
constexpr int settled = 1000, longest_meeting = 20'000, runs_down = 6, rest = 300;  // (unit: ticks)

BodyAddition plate(double top = 0.0) {
    BodyAddition made;
    made.description.shapes = {PlacedShape{BoxShape{{0.5, 0.005, 0.5}}, Pose{}}};
    made.description.pose.position = {0.0, top - 0.005, 0.0};
    made.description.motion = Motion::Static;
    made.touch_material = {500.0, 0.0, 0.5, 0.4};
    return made;
}

// What a hand goes around: above it, from the one side to the other.
BodyAddition post() {
    BodyAddition made = plate();
    made.description.shapes = {PlacedShape{BoxShape{{0.004, 0.01, 0.02}}, Pose{}}};
    made.description.pose.position = {0.0, 0.045, 0.0};
    return made;
}

SessionSettings room() {
    SessionSettings settings;
    settings.max_bodies = 16;
    settings.max_parts = 64;
    return settings;
}

Workspace workspace() {
    Workspace workspace;
    workspace.force_limit = 100.0;
    return workspace;
}

TeleopSettings settings_of(const LossyCase& one) {
    TeleopSettings settings;
    settings.deadband.enabled = true;
    settings.robot = one.hand == LossyHand::robot;
    settings.traditional = one.is_direct;
    return settings;
}

// Where the hand goes: a robot reaches less far, and is slower.
struct Reach {
    double high = 0.18, stop = 0.05, press = -0.01, speed = 0.7;
};
Reach motion_of(LossyHand hand) {
    return hand == LossyHand::robot ? Reach{0.085, 0.05, 0.0, 0.35} : Reach{};
}

class LossyRun {
public:
    LossyRun(const LossyCase& one, std::uint64_t seed, BodyAddition obstacle = plate())
        : one_(one),
          obstacle_(std::move(obstacle)),
          random_(seed),
          at_far_(wire_.second(), one.conditions, luck_of(seed, Way::to_teleoperator)),
          at_near_(wire_.first(), one.conditions, luck_of(seed, Way::to_operator)) {
        device_.position.y = far_device_.position.y = Reach{}.high;
        begin(near_, Side::operator_side, 1, at_near_, near_port_);
        begin(far_, Side::teleoperator_side, 2, at_far_, far_port_);
        add_hand(near_, device_);
        one.hand == LossyHand::robot ? add_robot() : add_hand(far_, far_device_);
        near_.settle();
        far_.settle();
    }

    LossyFigures run() {
        const Reach motion = motion_of(one_.hand);
        const double low = one_.presses ? motion.press : motion.stop;
        device_.position.y = motion.high;
        // The two meet later where much is lost.
        for (int i = 0; i < settled || (i < longest_meeting && height() < radius); ++i) {
            tick();
        }
        figures_ = {};
        for (int i = 0; i < runs_down; ++i) {
            outage_from_ = static_cast<int>(random_.between(0.0, 400.0));
            outage_to_ = i % 2 == 0 ? outage_from_ + static_cast<int>(1e3 * one_.outage) : 0;
            since_ = 0;
            draw(low, motion.speed);
            draw(motion.high, motion.speed);
            while (since_ < outage_to_ + (outage_to_ > 0 ? 1500 : 0)) {
                tick();
            }
        }
        figures_.agreed = near_port_->statistics.front().link.peer == PeerState::connected;
        return figures_;
    }

    AbsentFigures run_absent(Absence absence) {
        const Reach motion = motion_of(one_.hand);
        for (int i = 0; i < settled; ++i) {
            tick();
        }
        device_.position.y = motion.high;
        draw(motion.press, 0.1);
        AbsentFigures figures;
        figures.pressed = far_force();
        const auto hold = [&](bool is_there) {
            if (absence == Absence::device) {
                device_.connected = is_there;
                return;
            }
            if (absence == Absence::clutch) {
                Workspace held = workspace();
                held.clutch = !is_there;
                near_.set_workspace(is_tool() ? tool_.device : pointer_.device, held);
                return;
            }
            if (absence == Absence::another_device && !is_there) {
                other_device_.position.y = motion.press - 0.005;
                pointer_.device = tool_.device = near_.add_device(other_device_, workspace()).handle;
            } else {
                tool_.enabled = pointer_.enabled = is_there;
            }
            is_tool() ? near_.set_tool(0, tool_) : near_.set_proxy(0, pointer_);
        };
        hold(false);
        for (int i = 0; i < 500; ++i) {
            tick();
        }
        figures.away = far_force();
        hold(true);
        figures_ = {};
        for (int i = 0; i < 2000; ++i) {
            tick();
            figures.lasting = i < 1000 ? 0.0 : std::max(figures.lasting, far_force());
        }
        figures.back = figures_;
        return figures;
    }

    AroundFigures run_around() {
        constexpr double wide = 0.03, pi = std::numbers::pi;
        constexpr int way = 600, start = 50;  // (unit: ticks)
        AroundFigures figures;
        outage_from_ = settled + start;
        outage_to_ = outage_from_ + static_cast<int>(1e3 * one_.outage);
        for (int i = -settled; i < way + 3000; ++i) {
            const double angle = pi * std::clamp(i, 0, way) / way;
            const Vec3 before = device_.position;
            device_.position = {-wide * std::cos(angle), 0.045 + wide * std::sin(angle), 0.0};
            device_.velocity = i > 0 ? (device_.position - before) * 1e3 : Vec3(0.0);
            tick();
            figures.far_force = std::max(figures.far_force, i > 0 ? far_force() : 0.0);
            figures.lasting = i < way + 2000 ? 0.0 : std::max(figures.lasting, far_force());
            figures.own_force = std::max(figures.own_force, glm::length(device_.force));
        }
        return figures;
    }

private:
    void begin(Session& session, Side side, std::uint64_t epoch, Link& link,
               const std::shared_ptr<TeleopPort>& port) const {
        const TeleopSettings settings = settings_of(one_);
        EndpointSettings end = endpoint(side, epoch);
        end.scenario = scenario_of(settings);
        const auto kind = side == Side::operator_side ? SidePlan::Kind::operator_side
                          : settings.robot            ? SidePlan::Kind::robot
                                                      : SidePlan::Kind::environment;
        session.attach({{{kind, settings, end, OperatorRoom{}, {}}, &link, port}});
        const SessionHandle handle = session.add_body(obstacle_).handle;
        port->bindings.try_push({handle, handle});
    }
    void add_hand(Session& session, Device& device) {
        const SessionHandle made = session.add_device(device, workspace()).handle;
        if (one_.hand == LossyHand::tool) {
            tool_.device = made;
            session.add_tool(make_tool_shape(box({0.015, radius, 0.015}), {1e-3, 200}).shape, tool_);
        } else {
            pointer_.device = made;
            pointer_.settings.radius = radius;
            session.add_proxy(pointer_);
        }
    }
    // Its tip is a hand of a place of its own, where the plate is real.
    void add_robot() {
        Workspace reach;
        reach.pose.position = {0.0, 0.045, 0.0};
        tip_ = std::make_unique<TipDevice>(exchange_);
        place_ = std::make_unique<Session>(room());
        place_->add_body(obstacle_);
        ProxyDescription pointer;
        pointer.settings.radius = radius;
        pointer.device = place_->add_device(*tip_, reach).handle;
        place_->add_proxy(pointer);
        RobotTable::Settings nothing;
        nothing.height = -10.0;
        robot_ = std::make_unique<EmulatedRobot>(EmulatedRobotSettings{},
                                                 std::make_shared<TipSurroundings>(nothing, exchange_));
        pointer.device = far_.add_device(*robot_, reach).handle;
        far_.add_proxy(pointer);
        place_->settle();
    }

    void draw(double to, double speed) {
        const double from = device_.position.y;
        const int ticks = static_cast<int>(1e3 * std::abs(to - from) / speed);
        for (int i = 1; i <= ticks; ++i) {
            device_.position.y = from + (to - from) * i / ticks;
            device_.velocity.y = (to - from) * 1e3 / ticks;
            tick();
        }
        device_.velocity.y = 0.0;
        for (int i = 0; i < rest; ++i) {
            tick();
        }
    }

    void tick() {
        now_ += tick_length;
        const bool is_out = since_ >= outage_from_ && since_ < outage_to_;
        if (is_out != std::exchange(was_out_, is_out)) {
            LinkConditions conditions = one_.conditions;
            conditions.loss = is_out ? 1.0 : conditions.loss;
            at_far_.change(conditions);
            at_near_.change(conditions);
        }
        ++since_;
        for (Session* const session : {&near_, &far_, place_.get()}) {
            if (session) {
                session->tick(now_);
                session->refresh();
                session->collect();
            }
        }
        near_port_->statistics.refresh();
        far_port_->statistics.refresh();
        note();
    }

    const SessionSnapshot& there() const { return (place_ ? *place_ : far_).snapshot(); }
    bool is_tool() const { return one_.hand == LossyHand::tool; }
    double far_force() const {  // (unit: newtons)
        return glm::length(is_tool() ? there().tools[0].force : there().proxies[0].force);
    }
    double height() const {  // of the far hand (unit: meters)
        return is_tool() ? there().tools[0].pose.position.y : there().proxies[0].position.y;
    }

    void note() {
        const double force = far_force();
        constexpr double no_force = 1e-3;
        figures_.touches += !one_.presses && force > no_force && before_ <= no_force ? 1 : 0;
        figures_.beyond += height() < 0.5 * radius ? 1 : 0;
        figures_.far_force = std::max(figures_.far_force, force);
        figures_.own_force = std::max(figures_.own_force, glm::length(device_.force));
        before_ = force;
    }

    LossyCase one_;
    BodyAddition obstacle_;
    RandomValues random_;
    MemoryLinkPair wire_{8192};
    LinkEmulator at_far_, at_near_;
    std::shared_ptr<TeleopPort> near_port_ = std::make_shared<TeleopPort>();
    std::shared_ptr<TeleopPort> far_port_ = std::make_shared<TeleopPort>();
    std::shared_ptr<TipExchange> exchange_ = std::make_shared<TipExchange>();
    TurningHand device_, other_device_, far_device_;
    ProxyDescription pointer_;
    ToolUse tool_;
    std::unique_ptr<TipDevice> tip_;
    std::unique_ptr<EmulatedRobot> robot_;
    Session near_{room()}, far_{room()};
    std::unique_ptr<Session> place_;  // of the robot
    LossyFigures figures_;
    double before_ = 0.0;
    Nanoseconds now_ = 0;
    int since_ = 0, outage_from_ = 0, outage_to_ = 0;  // since the hand began to go down (unit: ticks)
    bool was_out_ = false;
};

}  // namespace

std::vector<LossyCase> lossy_cases() {
    LinkConditions usual;
    usual.delay = from_seconds(0.025);
    std::vector<LossyCase> cases;
    const std::pair<LossyHand, const char*> hands[] = {
        {LossyHand::fingertip, "fingertip"}, {LossyHand::tool, "tool"}, {LossyHand::robot, "robot"}};
    for (const auto& [hand, name] : hands) {
        for (const bool presses : {false, true}) {
            const std::string begin = std::string(name) + (presses ? ".press." : ".stop.");
            const auto add = [&](const std::string& what, const LinkConditions& conditions, double outage) {
                cases.push_back({begin + what, hand, conditions, outage, presses});
            };
            for (const int percent : {0, 10, 20, 30, 50}) {
                LinkConditions lossy = usual;
                lossy.loss = 0.01 * percent;
                add("loss_" + std::to_string(percent), lossy, 0.0);
            }
            for (const int length : {5, 20, 100}) {
                LinkConditions lossy = usual;
                lossy.burst = bursts(0.2, length);
                add("bursts_" + std::to_string(length), lossy, 0.0);
            }
            for (const int milliseconds : {50, 100, 300, 1000, 2000, 5000}) {
                add("outage_" + std::to_string(milliseconds) + "ms", usual, 1e-3 * milliseconds);
            }
        }
    }
    return cases;
}

LossyFigures run_lossy(const LossyCase& one, std::uint64_t seed) {
    return LossyRun(one, seed).run();
}

AbsentFigures run_absent(LossyHand hand, Absence absence, bool is_direct) {
    LossyCase one;
    one.hand = hand;
    one.is_direct = is_direct;
    one.conditions.delay = from_seconds(0.025);
    one.presses = true;
    // A robot that is to press reaches less deep.
    const bool is_higher = hand == LossyHand::robot && absence == Absence::clutch;
    return LossyRun(one, 1, plate(is_higher ? 0.02 : 0.0)).run_absent(absence);
}

AroundFigures run_around(LossyHand hand, double outage) {
    LossyCase one{"around", hand, {}, outage, false};
    one.conditions.delay = 25'000'000;
    return LossyRun(one, 1, post()).run_around();
}

}  // namespace tactus::shared
