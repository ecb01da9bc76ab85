// An environment and an operator whose model is what that describes, joined by two emulated ways and ticked
// in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"
#include "session/environment_teller.hpp"
#include "session/model_builder.hpp"
#include "session/operator_side.hpp"
#include "session/robot_side.hpp"
#include "session/teleoperator_side.hpp"
#include "session_rig.hpp"
#include "shared/endpoints.hpp"

namespace tactus::session_test {

using shared::endpoint;

constexpr Nanoseconds ms = 1'000'000;

// Room of the sides that are made from now on.
constexpr std::uint32_t usual_rig_bodies = 64;
inline std::uint32_t rig_bodies = usual_rig_bodies;

inline SessionSettings small_session() {
    SessionSettings settings;
    settings.max_bodies = rig_bodies;
    settings.max_parts = 2 * rig_bodies;
    return settings;
}

// A hand and a pointer, on each side.
inline void add_pointer(Session& session, HeldDevice& device) {
    device.position = {0.0, 0.5, 0.0};
    ProxyDescription description;
    description.device = session.add_device(device, {}).handle;
    session.add_proxy(description);
}

struct Environment {
    Environment(Link& link, std::uint64_t epoch, const TeleopSettings& settings = {}) {
        EndpointSettings end = endpoint(Side::teleoperator_side, epoch);
        end.scenario = scenario_of(settings);
        if (settings.robot) {
            session.attach(std::make_unique<RobotSide>(small_session(), settings, link, port, end));
        } else {
            session.attach(std::make_unique<TeleoperatorSide>(small_session(), settings, link, port, end));
        }
        add_pointer(session, device);
    }

    SessionHandle add(const std::string& name, const BodyAddition& addition) {
        const AddResult added = session.add_body(addition);
        EXPECT_EQ(added.error, "");
        EXPECT_EQ(teller.tell(added.handle, name, addition), "");
        return added.handle;
    }

    void remove(SessionHandle handle) {
        teller.forget(handle);
        session.remove_body(handle);
    }

    void tick(Nanoseconds now) {
        session.tick(now);
        session.collect();
        session.refresh();
        port->statistics.refresh();
        teller.update(session.snapshot(), port->statistics.front().link.peer_epoch);
    }

    HeldDevice device;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    Session session{small_session()};
    EnvironmentTeller teller{port};
};

struct Operator {
    Operator(Link& link, std::uint64_t epoch, const TeleopSettings& settings = {}) {
        OperatorRoom room;
        room.replays = false;
        EndpointSettings end = endpoint(Side::operator_side, epoch);
        end.scenario = scenario_of(settings);
        session.attach(std::make_unique<OperatorSide>(small_session(), room, settings, link, port, end));
        add_pointer(session, device);
    }

    void tick(Nanoseconds now) {
        if (reads_early) {
            port->statistics.refresh();
        }
        session.tick(now);
        session.collect();
        session.refresh();
        if (!reads_early) {
            port->statistics.refresh();
        }
        builder.update(now, port->statistics.front().link);
    }

    const ModelObject* find(const std::string& name) const {
        const auto found = std::ranges::find(builder.objects(), name, &ModelObject::name);
        return found == builder.objects().end() ? nullptr : &*found;
    }

    // Where the model has what is called `name`, of what can move.
    Pose pose(const std::string& name) const {
        const ModelObject* const object = find(name);
        const SessionSnapshot& snapshot = session.snapshot();
        const BodyState* const state =
            object ? state_of(snapshot.bodies, snapshot.body_count, object->body) : nullptr;
        return state ? state->pose : Pose{Vec3(-99.0), {}};
    }

    HeldDevice device;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    Session session{small_session()};
    ModelBuilder builder{session, port};
    bool reads_early = false;  // statistics, before the tick
};

struct ModelRig {
    // `network`: which packets chance hits, from 1 on.
    explicit ModelRig(const LinkConditions& conditions = {}, const TeleopSettings& settings_of_both = {},
                      std::uint64_t network = 1)
        : settings(settings_of_both),
          at_operator(wire.first(), conditions, 2 * network - 1),
          at_environment(wire.second(), conditions, 2 * network) {
        start_operator(1);
        start_environment(2);
    }

    void start_operator(std::uint64_t epoch) {
        near = std::make_unique<Operator>(at_operator, epoch, settings);
    }
    void start_environment(std::uint64_t epoch) {
        far = std::make_unique<Environment>(at_environment, epoch, settings);
    }

    void run(Nanoseconds span) {
        for (const Nanoseconds end = now + span; now < end;) {
            now += period;
            if (near) {
                near->tick(now);
            }
            if (far) {
                far->tick(now);
            }
        }
    }

    TeleopSettings settings;
    MemoryLinkPair wire{8192};
    LinkEmulator at_operator, at_environment;
    std::unique_ptr<Operator> near;
    std::unique_ptr<Environment> far;
    Nanoseconds now = 0;
};

}  // namespace tactus::session_test
