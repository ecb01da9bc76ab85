#include "shared/unexplained_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "core/tool/tool_shape.hpp"
#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"
#include "session/session.hpp"
#include "session/side_plan.hpp"
#include "shared/endpoints.hpp"
#include "shared/meshes.hpp"
#include "shared/turning_hand.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds tick_length = 1'000'000;
constexpr double tick_seconds = 1e-3;
constexpr int measured = 4000;  // (unit: ticks)
constexpr int first_change = 500;
// By then both know who has gone or come (unit: ticks).
constexpr int longest_word = 1000;

BodyAddition floor_below() {
    BodyAddition made;
    made.description.shapes = {PlacedShape{PlaneShape{}, Pose{}}};
    made.description.motion = Motion::Static;
    made.description.material.friction = 0.5;
    made.touch_material = {500.0, 0.0, 0.5, 0.4};
    return made;
}

BodyAddition box_on_it(Motion motion) {
    BodyAddition made;
    made.description.shapes = {PlacedShape{BoxShape{Vec3(0.025)}, Pose{}}};
    made.description.pose.position = {0.0, 0.025, 0.0};
    made.description.motion = motion;
    made.description.mass = 0.3;
    made.description.material.friction = 0.5;
    made.touch_material = {500.0, 0.0, 0.5, 0.4};
    return made;
}

// A board that the hand presses down onto the lower limit of its hinge, which is along z at its left edge.
BodyAddition board() {
    BodyAddition made = box_on_it(Motion::Dynamic);
    made.description.shapes = {PlacedShape{BoxShape{{0.1, 0.005, 0.05}}, Pose{}}};
    made.description.pose.position = {0.08, 0.045, 0.0};
    made.description.can_sleep = false;
    return made;
}

JointDescription hinge(double lower) {
    JointDescription joint;
    joint.kind = JointKind::Hinge;
    joint.angular[2] = {lower, 0.5};
    joint.frame = {{-0.1, 0.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)};
    joint.second_frame = Pose{{-0.02, 0.045, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)};
    return joint;
}

class StillPlace {
public:
    StillPlace(const StillCase& one, Side side, std::uint64_t epoch, Link& link,
               const std::optional<Pose>& body_at = std::nullopt)
        : one_(one), session(room()) {
        OperatorRoom operator_room;
        TeleopSettings settings;
        settings.traditional = one.scenario == 2;
        const bool operates = side == Side::operator_side;
        session.attach({{{operates ? SidePlan::Kind::operator_side : SidePlan::Kind::environment,
                          settings,
                          endpoint(side, epoch),
                          operator_room,
                          {}},
                         &link,
                         port}});
        Workspace workspace;
        workspace.force_limit = 100.0;
        device_ = session.add_device(device, workspace).handle;
        add_hand();
        add_bodies(body_at);
        session.settle();
    }

    void tick(Nanoseconds now) {
        session.tick(now);
        session.refresh();
        session.collect();
        port->statistics.refresh();
    }
    const TeleopStatistics& statistics() const { return port->statistics.front(); }
    Pose pose() const {
        const SessionSnapshot& snapshot = session.snapshot();
        const BodyState* const state = state_of(snapshot.bodies, snapshot.body_count, body_);
        return state ? state->pose : Pose{};
    }
    double hand_force() const {
        const SessionSnapshot& snapshot = session.snapshot();
        return glm::length(one_.tool ? snapshot.tools[0].force : snapshot.proxies[0].force);
    }
    void put(const Vec3& way) {
        Pose moved = pose();
        moved.position += way;
        session.teleport_body(body_, moved);
    }
    void lead(double time) {
        Pose pose;
        pose.position = {0.0, 0.025 + 0.02 * std::sin(2.0 * 6.283185307179586 * time), 0.0};
        session.move_body(body_, pose, tick_seconds);
    }
    void push(const Vec3& force) { session.set_body_push(body_, force, Vec3(0.0)); }
    void harden(double stiffness) { session.set_touch_material(body_, {stiffness, 0.0, 0.5, 0.4}); }
    void limit(double lower) {
        session.remove_joint(joint_);
        joint_ = session.add_joint(hinge(lower), body_, no_handle).handle;
    }
    void mask(std::uint32_t layers) {
        if (one_.tool) {
            ToolUse use = held();
            use.settings.mask = layers;
            session.set_tool(0, use);
        } else {
            ProxyDescription made = pointer();
            made.settings.mask = layers;
            session.set_proxy(0, made);
        }
    }
    void enable(bool enabled) {
        if (one_.tool) {
            ToolUse use = held();
            use.enabled = enabled;
            session.set_tool(0, use);
        } else {
            ProxyDescription made = pointer();
            made.enabled = enabled;
            session.set_proxy(0, made);
        }
    }
    void free_hand() { one_.tool ? session.remove_tool(0) : session.remove_proxy(0); }

private:
    StillCase one_;

public:
    TurningHand device;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    Session session;

private:
    static SessionSettings room() {
        SessionSettings settings;
        settings.max_bodies = 16;
        settings.max_parts = 64;
        return settings;
    }
    ProxyDescription pointer() const {
        ProxyDescription made;
        made.device = device_;
        return made;
    }
    ToolUse held() const {
        ToolUse use;
        use.device = device_;
        return use;
    }
    void add_hand() {
        if (one_.tool) {
            session.add_tool(make_tool_shape(box({0.015, 0.01, 0.015}), {1e-3, 200}).shape, held());
        } else {
            session.add_proxy(pointer());
        }
    }
    void add_bodies(const std::optional<Pose>& body_at) {
        const auto add = [&](const BodyAddition& addition) {
            const SessionHandle handle = session.add_body(addition).handle;
            port->bindings.try_push({handle, handle});
            return handle;
        };
        add(floor_below());
        const bool hangs = one_.change == StillChange::limits_changed;
        const Motion motion = one_.change == StillChange::led ? Motion::Kinematic : Motion::Dynamic;
        BodyAddition made = hangs ? board() : box_on_it(motion);
        made.description.pose = body_at.value_or(made.description.pose);
        body_ = add(made);
        if (hangs) {
            joint_ = session.add_joint(hinge(0.0), body_, no_handle).handle;
        }
    }

    SessionHandle device_ = no_handle, body_ = no_handle, joint_ = no_handle;
};

class StillRun {
public:
    explicit StillRun(const StillCase& one)
        : one_(one),
          at_far_(wire_.second(), conditions(one.delay), 1),
          at_near_(wire_.first(), conditions(one.delay), 2),
          near_(std::make_unique<StillPlace>(one, Side::operator_side, 1, at_near_)),
          far_(std::make_unique<StillPlace>(one, Side::teleoperator_side, 2, at_far_)) {}

    StillFigures run() {
        press();
        figures_.pressed = glm::length(near_->device.force);
        for (int i = 0; i < measured; ++i) {
            change(i);
            const Vec3 near_before = near_->device.force;
            const double far_before = far_ ? far_->hand_force() : 0.0;
            tick();
            note(near_before, far_before);
        }
        figures_.told_step = near_->statistics().largest_unexplained_step;
        return figures_;
    }

private:
    static LinkConditions conditions(double delay) {
        LinkConditions made;
        made.delay = from_seconds(0.5 * delay);
        return made;
    }
    void lose_everything(bool lost) {
        LinkConditions other = conditions(one_.delay);
        other.loss = lost ? 1.0 : 0.0;
        at_far_.change(other);
        at_near_.change(other);
    }
    bool hand_goes() const {
        return one_.change == StillChange::pointer_disabled || one_.change == StillChange::pointer_freed ||
               one_.change == StillChange::device_gone || one_.change == StillChange::operator_restarts;
    }

    void press() {
        const Vec3 above{0.0, 0.1, 0.0}, pressing{0.0, 0.05, 0.0};
        const auto hold = [&](int count) {
            for (int i = 0; i < count; ++i) {
                tick();
            }
        };
        hold(500);
        for (int i = 1; i <= 300; ++i) {
            near_->device.position = above + (pressing - above) * (i / 300.0);
            near_->device.velocity = (pressing - above) / 0.3;
            tick();
        }
        near_->device.velocity = Vec3(0.0);
        hold(500);
    }
    void tick() {
        now_ += tick_length;
        near_->tick(now_);
        if (far_) {
            far_->tick(now_);
        } else {
            std::array<std::byte, max_datagram_bytes> ignored;
            while (at_far_.receive(ignored, now_)) {
            }
        }
    }

    // `i`: ticks since the hand has begun to hold still.
    void change(int i) {
        const bool every_150 = i % 150 == 0;
        const bool is_on = i / 500 % 2 == 1;
        const auto within = [&](int ticks) { return i >= first_change && i < first_change + ticks; };
        switch (one_.change) {
            case StillChange::put_2mm_aside:
                every_150 ? far_->put({-0.002, 0.0, 0.0}) : void();
                return;
            case StillChange::put_10mm_aside:
                every_150 ? far_->put({-0.01, 0.0, 0.0}) : void();
                return;
            case StillChange::put_10mm_up:
                every_150 ? far_->put({0.0, 0.01, 0.0}) : void();
                return;
            case StillChange::mask_off:
                i % 500 == 0 ? far_->mask(is_on ? ~0u : 0u) : void();
                return;
            case StillChange::led:
                far_->lead(tick_seconds * i);
                return;
            case StillChange::pushed:
                i % 500 == 0 ? far_->push(is_on ? Vec3(2.0, 0.0, 0.0) : Vec3(0.0)) : void();
                return;
            case StillChange::limits_changed:
                limit_hinge(i);
                return;
            case StillChange::stiffness_changed:
                change_stiffness(i);
                return;
            case StillChange::far_side_restarts:
                restart_far_side(i);
                return;
            case StillChange::line_dead_short:
                lose_everything(within(150));
                return;
            case StillChange::line_dead_long:
                lose_everything(within(1500));
                return;
            case StillChange::pointer_disabled:
                i == first_change || i == first_change + 1000 ? near_->enable(i != first_change) : void();
                return;
            case StillChange::pointer_freed:
                i == first_change ? near_->free_hand() : void();
                return;
            case StillChange::device_gone:
                near_->device.connected = !within(1500);
                return;
            case StillChange::operator_restarts:
                restart_operator(i);
                return;
        }
    }
    // The far side first; the word of it is under way for half the delay.
    void limit_hinge(int i) {
        const int later = static_cast<int>(std::lround(500.0 * one_.delay)) + 1;
        const auto lower = [](int at) { return at / 700 % 2 == 1 ? -0.2 : 0.0; };
        if (i % 700 == 0 && i > 0) {
            far_->limit(lower(i));
        }
        if (i > later && (i - later) % 700 == 0) {
            near_->limit(lower(i - later));
        }
    }
    void change_stiffness(int i) {
        if (i % 700 == 0 && i > 0) {
            far_->harden(i / 700 % 2 == 1 ? 2000.0 : 500.0);
            near_->harden(i / 700 % 2 == 1 ? 2000.0 : 500.0);
        }
    }
    void restart_far_side(int i) {
        if (i == first_change) {
            kept_ = far_->pose();
            far_.reset();
        } else if (i == first_change + 150) {
            far_ = std::make_unique<StillPlace>(one_, Side::teleoperator_side, 3, at_far_, kept_);
        }
    }
    void restart_operator(int i) {
        if (i == first_change) {
            const Vec3 hand = near_->device.position;
            const Pose body = near_->pose();
            near_.reset();
            near_ = std::make_unique<StillPlace>(one_, Side::operator_side, 4, at_near_, body);
            near_->device.position = hand;
        }
    }

    void note(const Vec3& near_before, double far_before) {
        const bool device_is_there = near_->device.connected && one_.change != StillChange::operator_restarts;
        const double near_step = glm::distance(near_->device.force, near_before);
        figures_.near_step = device_is_there ? std::max(figures_.near_step, near_step) : figures_.near_step;
        if (!hand_goes()) {
            return;
        }
        const double far = far_->hand_force();
        figures_.far_step = std::max(figures_.far_step, std::abs(far - far_before));
        const bool feels = near_->device.connected && near_->device.force != Vec3(0.0);
        alone_ = far > 0.0 && !feels ? alone_ + 1 : 0;
        if (alone_ > longest_word + static_cast<int>(std::lround(1e3 * one_.delay))) {
            figures_.far_alone = std::max(figures_.far_alone, far);
        }
    }

    StillCase one_;
    MemoryLinkPair wire_{4096};
    LinkEmulator at_far_, at_near_;
    std::unique_ptr<StillPlace> near_, far_;
    Pose kept_;
    Nanoseconds now_ = 0;
    int alone_ = 0;  // the far hand presses and the operator feels nothing, for so many ticks
    StillFigures figures_;
};

}  // namespace

std::vector<StillCase> still_cases() {
    struct Named {
        const char* name;
        StillChange change;
        bool traditional;  // also in scenario 2
    };
    constexpr Named changes[] = {
        {"put_2mm_aside", StillChange::put_2mm_aside, false},
        {"put_10mm_aside", StillChange::put_10mm_aside, false},
        {"put_10mm_up", StillChange::put_10mm_up, false},
        {"mask_off", StillChange::mask_off, true},
        {"led", StillChange::led, false},
        {"pushed", StillChange::pushed, false},
        {"limits_changed", StillChange::limits_changed, false},
        {"stiffness_changed", StillChange::stiffness_changed, false},
        {"far_side_restarts", StillChange::far_side_restarts, true},
        {"line_dead_short", StillChange::line_dead_short, true},
        {"line_dead_long", StillChange::line_dead_long, true},
        {"pointer_disabled", StillChange::pointer_disabled, true},
        {"pointer_freed", StillChange::pointer_freed, true},
        {"device_gone", StillChange::device_gone, true},
        {"operator_restarts", StillChange::operator_restarts, true},
    };
    std::vector<StillCase> cases;
    for (const Named& named : changes) {
        for (const double delay : {0.0, 0.002, 0.01, 0.05, 0.2}) {
            for (const int scenario : {4, 2}) {
                for (const bool tool : {false, true}) {
                    if (scenario == 2 && !named.traditional) {
                        continue;
                    }
                    const std::string milliseconds = std::to_string(std::lround(1e3 * delay));
                    const std::string hand = tool ? ".tool." : ".fingertip.";
                    cases.push_back({named.name + std::string(".") + std::to_string(scenario) + hand +
                                         milliseconds + "ms",
                                     named.change, delay, scenario, tool});
                }
            }
        }
    }
    return cases;
}

StillFigures run_still(const StillCase& one) {
    return StillRun(one).run();
}

}  // namespace tactus::shared
