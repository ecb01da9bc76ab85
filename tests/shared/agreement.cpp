#include "shared/agreement.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <memory>
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

constexpr Nanoseconds period = 1'000'000;
constexpr int meeting = 1500, playing = 1500, settling = 300;  // (unit: ticks)

TeleopSettings settings_of(const AgreementSide& side) {
    TeleopSettings settings;
    settings.traditional = side.scenario == 2 || side.scenario == 3;
    settings.robot = side.scenario == 3 || side.scenario == 5;
    settings.passivity = side.passivity;
    settings.passive.impedance = side.impedance;
    return settings;
}

BodyAddition box_at(const Vec3& place, const Vec3& half) {
    BodyAddition made;
    made.description.shapes = {PlacedShape{BoxShape{half}, Pose{}}};
    made.description.pose.position = place;
    made.description.motion = Motion::Static;
    made.touch_material = {500.0, 0.0, 0.0, 0.0};
    return made;
}

class AgreementPlace {
public:
    AgreementPlace(const AgreementSide& side, Side which, Link& link)
        : session(with_room(side)), side_(side) {
        OperatorRoom room;
        room.replays = false;
        const bool operates = which == Side::operator_side;
        const SidePlan::Kind kind = operates                                   ? SidePlan::Kind::operator_side
                                    : side.scenario == 3 || side.scenario == 5 ? SidePlan::Kind::robot
                                                                               : SidePlan::Kind::environment;
        session.attach(
            {{{kind, settings_of(side), endpoint(which, operates ? 1 : 2), room, {}}, &link, port}});
        Workspace workspace;
        workspace.force_limit = 100.0;
        hand_ = session.add_device(device, workspace).handle;
        add_bodies();
        add_hand();
        session.settle();
    }

    // Where the two differ in the kind of side, nothing can be changed in play.
    void become(const AgreementSide& side) {
        const AgreementSide before = std::exchange(side_, side);
        TeleopSettings settings = settings_of(side);
        port->settings.publish(settings);
        add_bodies();
        if (before.has_hand && (!side.has_hand || side.bar != before.bar)) {
            before.bar > 0.0 ? session.remove_tool(0) : session.remove_proxy(0);
            add_hand();
        } else if (side.has_hand && side.radius != before.radius) {
            session.set_proxy(0, pointer());
        }
    }

    void tick(Nanoseconds now) {
        session.tick(now);
        session.refresh();
        session.collect();
        port->statistics.refresh();
    }
    const TeleopStatistics& statistics() const { return port->statistics.front(); }
    bool says(Side which) const {
        const TeleopStatistics& told = statistics();
        return !explain(told.disagreement, told.own_terms, told.peer_terms, which).empty();
    }

    TurningHand device;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    Session session;

private:
    static SessionSettings with_room(const AgreementSide& side) {
        SessionSettings settings;
        settings.max_bodies = side.max_bodies;
        settings.max_parts = 128;
        return settings;
    }
    ProxyDescription pointer() const {
        ProxyDescription made;
        made.device = hand_;
        made.settings.radius = side_.radius;
        return made;
    }
    void add_hand() {
        if (!side_.has_hand) {
            return;
        }
        if (side_.bar > 0.0) {
            ToolUse use;
            use.device = hand_;
            session.add_tool(make_tool_shape(box({side_.bar, 0.01, 0.01}), {1e-3, 200}).shape, use);
        } else {
            session.add_proxy(pointer());
        }
    }
    void add_bodies() {
        for (; bodies_ < side_.bodies; ++bodies_) {
            const Vec3 place = bodies_ == 0 ? Vec3(0.0, -0.5, 0.0) : Vec3(0.0, -5.0 * bodies_, 0.0);
            const SessionHandle body = session.add_body(box_at(place, Vec3(0.5))).handle;
            port->bindings.try_push({body, body});
        }
    }

    AgreementSide side_;
    SessionHandle hand_ = no_handle;
    std::size_t bodies_ = 0;
};

AgreementCase differing(const std::string& name, const AgreementSide& near, const AgreementSide& far) {
    return {name, near, far, false, {}, false};
}

void add_both_ways(std::vector<AgreementCase>& cases, const std::string& name, const AgreementSide& usual,
                   const AgreementSide& other, bool other_may_be_far, bool other_may_be_near) {
    const auto add = [&](const std::string& how, const AgreementSide& near, const AgreementSide& far) {
        AgreementCase one = differing(name + how, near, far);
        cases.push_back(one);
        one.name += ".in_play";
        one.in_play = true;
        one.before = usual;
        cases.push_back(one);
    };
    if (other_may_be_far) {
        add(".far", usual, other);
    }
    if (other_may_be_near) {
        add(".near", other, usual);
    }
}

}  // namespace

std::vector<AgreementCase> agreement_cases() {
    std::vector<AgreementCase> cases;
    const auto of = [](int scenario) {
        AgreementSide side;
        side.scenario = scenario;
        return side;
    };
    for (int near = 2; near <= 5; ++near) {
        for (int far = 2; far <= 5; ++far) {
            if (near != far) {
                const std::string name = "scenario." + std::to_string(near) + "_" + std::to_string(far);
                cases.push_back(differing(name, of(near), of(far)));
                if (near % 2 == far % 2) {  // the same kind of far side
                    AgreementCase in_play = cases.back();
                    in_play.name += ".in_play";
                    in_play.in_play = true;
                    in_play.before = of(far);
                    cases.push_back(in_play);
                }
            }
        }
    }
    for (const Passivity scheme :
         {Passivity::wave_variables, Passivity::time_domain, Passivity::two_layers}) {
        AgreementSide other = of(2);
        other.passivity = scheme;
        add_both_ways(cases, "passivity." + std::to_string(static_cast<int>(scheme)), of(2), other, true,
                      true);
    }
    AgreementSide waves = of(2), other_waves = waves;
    waves.passivity = other_waves.passivity = Passivity::wave_variables;
    other_waves.impedance = 5.0;
    add_both_ways(cases, "impedance", waves, other_waves, true, true);
    for (const int scenario : {2, 4}) {
        const AgreementSide usual = of(scenario);
        const std::string of_scenario = "." + std::to_string(scenario);
        AgreementSide other = usual;
        other.radius = 0.02;
        add_both_ways(cases, "radius" + of_scenario, usual, other, true, true);
        other = usual;
        other.has_hand = false;
        add_both_ways(cases, "hand" + of_scenario, usual, other, true, false);
        AgreementSide tool = usual;
        tool.bar = 0.1;
        other = tool;
        other.bar = 0.05;
        add_both_ways(cases, "tool" + of_scenario, tool, other, true, true);
        add_both_ways(cases, "tool_or_fingertip" + of_scenario, usual, tool, true, true);
        AgreementSide little = usual;
        little.max_bodies = 8;
        other = usual;
        other.bodies = 12;
        cases.push_back(differing("bodies" + of_scenario, little, other));
        AgreementCase in_play = differing("bodies" + of_scenario + ".in_play", little, other);
        in_play.in_play = true;
        in_play.before = little;
        in_play.before.max_bodies = 64;
        cases.push_back(in_play);
    }
    for (const int scenario : {2, 4}) {
        for (const double bar : {0.0, 0.1}) {
            AgreementCase alike;
            alike.name =
                std::string("alike.") + std::to_string(scenario) + (bar > 0.0 ? ".tool" : ".fingertip");
            alike.near = alike.far = of(scenario);
            alike.near.bar = alike.far.bar = bar;
            alike.alike = true;
            cases.push_back(alike);
        }
    }
    return cases;
}

AgreementFigures run_agreement(const AgreementCase& one) {
    LinkConditions conditions;
    conditions.delay = 25 * period;
    MemoryLinkPair wire{4096};
    LinkEmulator at_far(wire.second(), conditions, 1), at_near(wire.first(), conditions, 2);
    // The room for bodies is a session's for good.
    AgreementSide first_near = one.in_play ? one.before : one.near;
    AgreementSide first_far = one.in_play ? one.before : one.far;
    first_near.max_bodies = one.near.max_bodies;
    first_far.max_bodies = one.far.max_bodies;
    AgreementPlace near(first_near, Side::operator_side, at_near);
    AgreementPlace far(first_far, Side::teleoperator_side, at_far);
    AgreementFigures figures;
    Vec3 near_before(0.0), far_before(0.0);
    Nanoseconds now = 0;
    const auto ticks = [&](int count, int measured_from) {
        for (int i = 0; i < count; ++i) {
            now += period;
            // Free until both have met, then 10 mm into the floor.
            const double t = static_cast<double>(now / period);
            near.device.position.y = 0.1 - 0.1 * std::clamp((t - 500.0) / 300.0, 0.0, 1.0);
            near.tick(now);
            far.tick(now);
            figures.largest_step =
                std::max({figures.largest_step, glm::distance(near.device.force, near_before),
                          glm::distance(far.device.force, far_before)});
            near_before = near.device.force;
            far_before = far.device.force;
            if (i >= measured_from) {
                figures.near_force = std::max(figures.near_force, glm::length(near.device.force));
                figures.far_force = std::max(figures.far_force, glm::length(far.device.force));
            }
        }
    };
    ticks(meeting, one.in_play ? meeting : settling);
    if (one.in_play) {
        near.become(one.near);
        far.become(one.far);
        ticks(playing, settling);
    }
    figures.near_says = near.says(Side::operator_side);
    figures.far_says = far.says(Side::teleoperator_side);
    return figures;
}

}  // namespace tactus::shared
