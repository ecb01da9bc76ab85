// What is in the environment becomes the operator's model, through the network, and stays it: late joiners,
// restarts, removals and changes.
#include "session/model_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"
#include "session/environment_teller.hpp"
#include "session/operator_side.hpp"
#include "session/teleoperator_side.hpp"
#include "session_rig.hpp"

namespace tactus {
namespace {

using session_test::body;
using session_test::period;

constexpr Nanoseconds ms = 1'000'000;

SessionSettings small_session() {
    SessionSettings settings;
    settings.most_bodies = 64;
    settings.most_parts = 128;
    return settings;
}

EndpointSettings endpoint(Side side, std::uint64_t epoch) {
    EndpointSettings settings;
    settings.side = side;
    settings.epoch = epoch;
    return settings;
}

// A hand and a pointer, on each side.
void add_pointer(Session& session, session_test::HeldDevice& device) {
    device.position = {0.0, 0.5, 0.0};
    ProxyDescription description;
    description.device = session.add_device(device, {}).handle;
    session.add_proxy(description);
}

struct Environment {
    Environment(Link& link, std::uint64_t epoch) {
        session.attach(std::make_unique<TeleoperatorSide>(small_session(), TeleopSettings{}, link, port,
                                                          endpoint(Side::teleoperator_side, epoch)));
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

    session_test::HeldDevice device;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    Session session{small_session()};
    EnvironmentTeller teller{port};
};

struct Operator {
    Operator(Link& link, std::uint64_t epoch) {
        OperatorRoom room;
        room.replays = false;
        session.attach(std::make_unique<OperatorSide>(small_session(), room, TeleopSettings{}, link, port,
                                                      endpoint(Side::operator_side, epoch)));
        add_pointer(session, device);
    }

    void tick(Nanoseconds now) {
        session.tick(now);
        session.collect();
        session.refresh();
        port->statistics.refresh();
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
        for (std::size_t i = 0; object != nullptr && i < snapshot.body_count; ++i) {
            if (snapshot.bodies[i].handle == object->body) {
                return snapshot.bodies[i].pose;
            }
        }
        return {Vec3(-99.0), {}};
    }

    session_test::HeldDevice device;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    Session session{small_session()};
    ModelBuilder builder{session, port};
};

struct Rig {
    explicit Rig(const LinkConditions& conditions = {})
        : at_operator(wire.first(), conditions, 1), at_environment(wire.second(), conditions, 2) {
        start_operator(1);
        start_environment(2);
    }

    void start_operator(std::uint64_t epoch) { near = std::make_unique<Operator>(at_operator, epoch); }
    void start_environment(std::uint64_t epoch) {
        far = std::make_unique<Environment>(at_environment, epoch);
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

    MemoryLinkPair wire{8192};
    LinkEmulator at_operator, at_environment;
    std::unique_ptr<Operator> near;
    std::unique_ptr<Environment> far;
    Nanoseconds now = 0;
};

BodyAddition box(const Vec3& position) {
    return body(BoxShape{Vec3(0.05)}, position, Motion::Dynamic, 0.3);
}

BodyAddition ground() {
    return body(BoxShape{{1.0, 0.05, 1.0}}, {0.0, -0.05, 0.0}, Motion::Static);
}

TEST(ModelBuilder, BuildsWhatTheFarSideHas) {
    LinkConditions conditions;
    conditions.delay = 20 * ms;
    conditions.loss = 0.3;
    Rig rig(conditions);
    rig.far->add("Ground", ground());
    rig.far->add("Box", box({0.0, 0.05, 0.0}));
    rig.run(3000 * ms);
    EXPECT_EQ(rig.near->builder.objects().size(), 2u);
    ASSERT_NE(rig.near->find("Box"), nullptr);
    EXPECT_EQ(rig.near->find("Box")->problem, "");
    EXPECT_NEAR(glm::distance(rig.near->pose("Box").position, Vec3(0.0, 0.05, 0.0)), 0.0, 1e-3);
    EXPECT_EQ(rig.far->port->statistics.front().discovery.known, 2u);
}

TEST(ModelBuilder, WhatMovesThereMovesHere) {
    Rig rig;
    rig.far->add("Ground", ground());
    const SessionHandle handle = rig.far->add("Box", box({0.0, 0.05, 0.0}));
    rig.run(500 * ms);
    rig.far->session.teleport_body(handle, {{0.3, 0.05, 0.2}, {1.0, 0.0, 0.0, 0.0}});
    rig.run(2000 * ms);
    EXPECT_NEAR(glm::distance(rig.near->pose("Box").position, Vec3(0.3, 0.05, 0.2)), 0.0, 2e-3);
}

TEST(ModelBuilder, ALateOperatorIsToldWhereThingsAreByNow) {
    Rig rig;
    rig.near.reset();
    rig.far->add("Ground", ground());
    const SessionHandle handle = rig.far->add("Box", box({0.0, 0.05, 0.0}));
    rig.run(200 * ms);
    rig.far->session.teleport_body(handle, {{0.4, 0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    rig.run(500 * ms);
    rig.start_operator(11);
    rig.near->port->settings.publish([] {
        TeleopSettings settings;
        settings.correction = Correction::none;  // nothing but the description says where it is
        return settings;
    }());
    rig.run(500 * ms);
    EXPECT_NEAR(glm::distance(rig.near->pose("Box").position, Vec3(0.4, 0.05, 0.0)), 0.0, 1e-3);
}

TEST(ModelBuilder, AnEnvironmentThatRestartsReplacesTheModel) {
    Rig rig;
    rig.far->add("Ground", ground());
    rig.far->add("Box", box({0.0, 0.05, 0.0}));
    rig.run(500 * ms);
    rig.start_environment(22);
    rig.far->add("Ground", ground());
    rig.far->add("Ball", body(SphereShape{0.05}, {0.2, 0.05, 0.0}, Motion::Dynamic));
    rig.run(500 * ms);
    EXPECT_EQ(rig.near->builder.objects().size(), 2u);
    EXPECT_EQ(rig.near->find("Box"), nullptr);
    EXPECT_NEAR(rig.near->pose("Ball").position.x, 0.2, 1e-2);
}

TEST(ModelBuilder, WhatIsRemovedThereGoesHere) {
    Rig rig;
    rig.far->add("Ground", ground());
    const SessionHandle handle = rig.far->add("Box", box({0.0, 0.05, 0.0}));
    rig.run(500 * ms);
    rig.far->remove(handle);
    rig.run(500 * ms);
    EXPECT_EQ(rig.near->find("Box"), nullptr);
    EXPECT_EQ(rig.near->session.snapshot().body_count, 0u);
    EXPECT_EQ(rig.far->port->statistics.front().discovery.waiting, 0u);
}

TEST(ModelBuilder, ANumberThatIsGivenAgainIsAnotherObject) {
    Rig rig;
    const SessionHandle handle = rig.far->add("Box", box({0.0, 0.5, 0.0}));
    rig.run(300 * ms);
    rig.far->remove(handle);
    rig.run(3 * ms);
    const SessionHandle next = rig.far->add("Ball", body(SphereShape{0.05}, {0.2, 0.5, 0.0}, Motion::Static));
    EXPECT_EQ(next, handle);
    rig.run(500 * ms);
    ASSERT_EQ(rig.near->builder.objects().size(), 1u);
    EXPECT_NE(rig.near->find("Ball"), nullptr);
}

TEST(ModelBuilder, ANewDescriptionTakesThePlaceOfTheOld) {
    Rig rig;
    rig.far->add("Ground", ground());
    BodyAddition addition = box({0.0, 0.05, 0.0});
    const SessionHandle handle = rig.far->add("Box", addition);
    rig.run(500 * ms);
    const SessionHandle before = rig.near->find("Box")->body;
    addition.touch_material.stiffness = 900.0;
    EXPECT_EQ(rig.far->teller.tell(handle, "Box", addition), "");
    rig.run(500 * ms);
    EXPECT_EQ(rig.near->builder.objects().size(), 2u);
    EXPECT_NE(rig.near->find("Box")->body, before);
    EXPECT_EQ(rig.near->session.snapshot().body_count, 1u);
}

TEST(ModelBuilder, TheModelMayBeMadeWrong) {
    Rig rig;
    rig.near->builder.set_distortion([](ObjectDescription& description) {
        if (description.name == "Ball") {
            description.body.pose.position.x += 0.1;
        }
    });
    rig.far->add("Ball", body(SphereShape{0.05}, {0.2, 0.05, 0.0}, Motion::Kinematic));
    rig.near->port->settings.publish([] {
        TeleopSettings settings;
        settings.correction = Correction::none;
        return settings;
    }());
    rig.run(300 * ms);
    EXPECT_NEAR(rig.near->pose("Ball").position.x, 0.3, 1e-9);
}

TEST(ModelBuilder, WhatCannotBeBuiltIsSaidAndNotRepeated) {
    Rig rig;
    rig.near->builder.set_distortion([](ObjectDescription& description) {
        description.body.shapes = {PlacedShape{SphereShape{-1.0}, Pose{}}};
    });
    rig.far->add("Ball", body(SphereShape{0.05}, {0.2, 0.05, 0.0}, Motion::Static));
    rig.run(500 * ms);
    ASSERT_NE(rig.near->find("Ball"), nullptr);
    EXPECT_EQ(rig.near->find("Ball")->body, no_handle);
    EXPECT_NE(rig.near->find("Ball")->problem, "");
    EXPECT_EQ(rig.far->port->statistics.front().discovery.refused, 1u);
}

TEST(ModelBuilder, ClearingTakesEverythingOut) {
    Rig rig;
    rig.far->add("Box", box({0.0, 0.5, 0.0}));
    rig.run(300 * ms);
    rig.near->builder.clear();
    rig.run(10 * ms);
    EXPECT_TRUE(rig.near->builder.objects().empty());
    EXPECT_EQ(rig.near->session.snapshot().body_count, 0u);
}

TEST(EnvironmentTeller, SaysWhatCannotBeDescribed) {
    const auto port = std::make_shared<TeleopPort>();
    EnvironmentTeller teller(port);
    BodyAddition addition = box(Vec3(0.0));
    addition.description.mass = -1.0;
    EXPECT_NE(teller.tell(1, "Box", addition).find("\"Box\" cannot be described"), std::string::npos);
    EXPECT_EQ(port->announced.size(), 0u);
}

TEST(EnvironmentTeller, HoldsBackWhatFindsNoRoomAndKeepsTheOrder) {
    const auto port = std::make_shared<TeleopPort>();
    EnvironmentTeller teller(port);
    const std::size_t many = port->announced.capacity() + 10;
    for (std::size_t i = 0; i < many; ++i) {
        EXPECT_EQ(teller.tell(static_cast<SessionHandle>(i), "Box", box(Vec3(0.0))), "");
    }
    std::size_t taken = 0;
    PreparedDiscovery prepared;
    for (int round = 0; round < 3; ++round) {
        while (port->announced.try_pop(prepared)) {
            EXPECT_EQ(prepared.object, taken++);
        }
        teller.update({}, 0);
    }
    EXPECT_EQ(taken, many);

    teller.forget(3);
    EXPECT_EQ(teller.tell(3, "Ball", box(Vec3(1.0))), "");
    EXPECT_EQ(port->announced.size(), 0u) << "not before the loop has taken the withdrawal";
    ObjectId withdrawn = no_object;
    EXPECT_TRUE(port->withdrawn.try_pop(withdrawn));
    EXPECT_EQ(withdrawn, 3u);
    teller.update({}, 0);
    EXPECT_EQ(port->announced.size(), 1u);
}

}  // namespace
}  // namespace tactus
