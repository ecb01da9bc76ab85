// A robot that an operator's hand guides over a block on a table, as scenario 5 has it: the far side of a
// session with an emulated robot whose tip is a hand of a place of its own, and eyes that see that place
// roughly and late. What the far side tells of the block is read off the link.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>

#include "devices/robot_tip.hpp"
#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"
#include "session/robot_side.hpp"
#include "session/session.hpp"
#include "shared/endpoints.hpp"
#include "shared/random_values.hpp"
#include "shared/rough_eyes.hpp"

namespace tactus::shared {

struct BlockTruth {
    double stiffness = 500.0;  // of its surface (unit: newtons per meter)
    double friction = 0.4;     // under the tip
    double on_table = 0.3;     // under the block
    double mass = 0.5;         // (unit: kilograms)
    unsigned seed = 1;
};

// One that a robot of 8 N can slide.
inline BlockTruth any_block(std::uint64_t seed) {
    constexpr double most_to_slide = 4.0;  // (unit: newtons)
    RandomValues random(seed);
    BlockTruth block;
    block.stiffness = random.magnitude(200.0, 1200.0);
    block.friction = random.between(0.15, 1.0);
    block.mass = random.magnitude(0.2, 2.0);
    block.on_table = random.between(0.15, std::min(0.7, most_to_slide / (9.81 * block.mass)));
    block.seed = static_cast<unsigned>(seed);
    return block;
}

class RobotAtBlock {
public:
    static constexpr double half = 0.015;   // of the block (unit: meters)
    static constexpr double radius = 0.01;  // of the tip (unit: meters)

    explicit RobotAtBlock(const BlockTruth& truth)
        : truth_(truth),
          eyes_(3e-4, 3e-3, truth.seed),
          near_(at_operator_, endpoint_of(Side::operator_side, 1)) {
        build_place();
        build_far_side();
        go({0.0, 2.0 * half + radius + 0.01, 0.0}, 1.0);
    }

    // The hand goes there at a steady pace.
    void go(const Vec3& to, double seconds) {
        const Vec3 from = hand_;
        const int ticks = static_cast<int>(seconds * 1e3);
        for (int i = 1; i <= ticks; ++i) {
            put(from + (to - from) * (static_cast<double>(i) / ticks));
        }
    }

    // Presses straight down on the block's top for a third of the time, and rubs to and fro for the rest:
    // from lightly on, as what is light and rough is dragged along by more.
    void rub(double seconds) {
        const double top = block().y + half + radius;
        const Vec3 above(block().x, top + 0.002, 0.0);
        go(above, 0.3);
        const double straight = 0.3 * seconds;
        const int ticks = static_cast<int>(seconds * 1e3);
        for (int i = 0; i < ticks; ++i) {
            const double t = 1e-3 * i;
            const double rubbed = std::max(0.0, t - straight);
            const double pressed = 0.006 * (1.0 - std::cos(2.0 * pi * t / straight));
            const double rubbing =
                0.001 + 0.005 * rubbed / (seconds - straight) - 0.001 * std::sin(2.0 * pi * 4.0 * rubbed);
            put(above + Vec3(0.012 * std::sin(2.0 * pi * 1.5 * rubbed),
                             -0.002 - (t < straight ? pressed : rubbing), 0.0));
        }
        go(above + Vec3(0.0, 0.01, 0.0), 0.2);
    }

    // Pushes its side at a steady pace, as steady as a hand is: one that goes slower and faster lets go of
    // what is light, or stands still with it.
    void push(double seconds) {
        const Vec3 before(block().x - half - radius - 0.002, block().y, 0.0);
        go({before.x, hand_.y, 0.0}, 0.3);
        go(before, 0.3);
        const int ticks = static_cast<int>(seconds * 1e3);
        for (int i = 0; i < ticks; ++i) {
            const double t = 1e-3 * i;
            put(before + Vec3(0.07 * t + 0.0002 * (1.0 - std::cos(2.0 * pi * 5.0 * t)), 0.0, 0.0));
        }
        go(hand_ - Vec3(0.02, 0.0, 0.0), 0.2);
    }

    // What has been told of the block last.
    const ObjectEstimate& told() const { return told_; }
    Vec3 block() const { return place_.snapshot().bodies[0].pose.position; }

private:
    static constexpr double pi = std::numbers::pi;
    static constexpr Nanoseconds period = 1'000'000;
    static constexpr Nanoseconds image = 33'000'000, late = 45'000'000;

    static EndpointSettings endpoint_of(Side side, std::uint64_t epoch) {
        EndpointSettings settings = endpoint(side, epoch);
        settings.scenario = scenario_of(scenario());
        return settings;
    }
    static TeleopSettings scenario() {
        TeleopSettings settings;
        settings.robot = true;
        return settings;
    }
    static SessionSettings small() {
        SessionSettings settings;
        settings.max_bodies = 16;
        settings.max_parts = 32;
        return settings;
    }
    BodyAddition block_of(double mass) const {
        BodyAddition block;
        block.description.shapes = {PlacedShape{BoxShape{Vec3(half)}, Pose{}}};
        block.description.pose.position = {0.0, half, 0.0};
        block.description.mass = mass;
        block.description.material.friction = truth_.on_table;
        block.touch_material = {truth_.stiffness, 1.5, truth_.friction, truth_.friction};
        return block;
    }
    BodyAddition table() const {
        BodyAddition table;
        table.description.shapes = {PlacedShape{PlaneShape{}, Pose{}}};
        table.description.motion = Motion::Static;
        table.description.material.friction = truth_.on_table;
        return table;
    }

    // The middle of the robot's workspace is where the block is.
    static Workspace workspace() {
        Workspace workspace;
        workspace.pose.position = {0.0, half + 0.005, 0.0};
        return workspace;
    }

    void build_place() {
        tip_ = std::make_unique<TipDevice>(exchange_);
        place_.add_body(block_of(truth_.mass));
        place_.add_body(table());
        ProxyDescription pointer;
        pointer.settings.radius = radius;
        pointer.device = place_.add_device(*tip_, workspace()).handle;
        place_.add_proxy(pointer);
    }

    void build_far_side() {
        RobotTable::Settings nothing;
        nothing.height = -10.0;
        robot_ = std::make_unique<EmulatedRobot>(EmulatedRobotSettings{},
                                                 std::make_shared<TipSurroundings>(nothing, exchange_));
        far_.attach(std::make_unique<RobotSide>(small(), scenario(), at_robot_, port_,
                                                endpoint_of(Side::teleoperator_side, 2)));
        ProxyDescription pointer;
        pointer.settings.radius = radius;
        pointer.device = far_.add_device(*robot_, workspace()).handle;
        far_.add_proxy(pointer);
        known_ = far_.add_body(block_of(0.3)).handle;
    }

    void put(const Vec3& hand) {
        OperatorSamples said;
        said.count = 1;
        OperatorSample& sample = said.samples[0];
        sample.sequence = ++sequence_;
        sample.time = now_ + period;
        sample.connected = true;
        sample.position = position_as_sent(hand);
        sample.velocity = velocity_as_sent((hand - hand_) * 1e3);
        hand_ = hand;
        tick(said);
    }

    void tick(const OperatorSamples& said) {
        now_ += period;
        near_.begin_tick(now_);
        while (const Endpoint::Received* const received = near_.receive()) {
            if (const auto* const told = std::get_if<ObjectEstimates>(&received->packet.message)) {
                told_ = told->estimates[0];
            }
        }
        near_.send(said);
        near_.end_tick();
        Terms terms;
        terms.scenario = static_cast<std::uint8_t>(scenario_of(scenario()));
        terms.bodies = 1000;
        near_.send(terms);
        for (Session* const session : {&far_, &place_}) {
            session->tick(now_);
            session->collect();
            session->refresh();
        }
        look();
    }

    // An image every 33 ms, told when it has been looked at.
    void look() {
        const BodyState& there = place_.snapshot().bodies[0];
        if (now_ % image == 0) {
            const double speed = glm::length(there.linear_velocity);
            const bool rests = speed < 3e-3;
            // At rest the mean of many images is told, and no motion.
            const Pose told = rests ? there.pose : eyes_.see(there.pose);
            seen_ = {
                {told, rests ? Vec3(0.0) : there.linear_velocity, rests ? Vec3(0.0) : there.angular_velocity},
                to_seconds(late),
                {Mat3(1e-8), Mat3(1e-6)}};
            due_ = now_ + late % image;
        }
        if (now_ == due_) {
            // One image lies between.
            if (waiting_) {
                far_.see_body(known_, *waiting_);
            }
            waiting_ = seen_;
        }
    }

    BlockTruth truth_;
    RoughEyes eyes_;
    MemoryLinkPair wire_{8192};
    LinkEmulator at_operator_{wire_.first(), LinkConditions{}, 1},
        at_robot_{wire_.second(), LinkConditions{}, 2};
    Endpoint near_;
    std::shared_ptr<TipExchange> exchange_ = std::make_shared<TipExchange>();
    std::unique_ptr<TipDevice> tip_;
    std::unique_ptr<EmulatedRobot> robot_;
    std::shared_ptr<TeleopPort> port_ = std::make_shared<TeleopPort>();
    Session place_{small()}, far_{small()};
    SessionHandle known_ = no_handle;
    ObjectEstimate told_;
    BodySighting seen_;
    std::optional<BodySighting> waiting_;
    Nanoseconds now_ = 0, due_ = 0;
    SampleSequence sequence_ = 0;
    Vec3 hand_{0.0, 0.06, 0.0};
};

}  // namespace tactus::shared
