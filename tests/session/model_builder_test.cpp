// What is in the environment becomes the operator's model, through the network, and stays it: late joiners,
// restarts, removals and changes.
#include "session/model_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "model_rig.hpp"

namespace tactus::model_builder_test {
namespace {

using namespace session_test;
using Rig = ModelRig;

BodyAddition box(const Vec3& position) {
    return body(BoxShape{Vec3(0.05)}, position, Motion::Dynamic, 0.3);
}

BodyAddition slab() {
    return body(BoxShape{{1.0, 0.05, 1.0}}, {0.0, -0.05, 0.0}, Motion::Static);
}

TeleopSettings never_corrected() {
    TeleopSettings settings;
    settings.correction = Correction::none;
    return settings;
}

TEST(ModelBuilder, BuildsWhatTheFarSideHas) {
    LinkConditions conditions;
    conditions.delay = 20 * ms;
    conditions.loss = 0.3;
    Rig rig(conditions);
    rig.far->add("Ground", slab());
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
    rig.far->add("Ground", slab());
    const SessionHandle handle = rig.far->add("Box", box({0.0, 0.05, 0.0}));
    rig.run(500 * ms);
    rig.far->session.teleport_body(handle, {{0.3, 0.05, 0.2}, {1.0, 0.0, 0.0, 0.0}});
    rig.run(2000 * ms);
    EXPECT_NEAR(glm::distance(rig.near->pose("Box").position, Vec3(0.3, 0.05, 0.2)), 0.0, 2e-3);
}

TEST(ModelBuilder, ALateOperatorIsToldWhereThingsAreByNow) {
    Rig rig;
    rig.near.reset();
    rig.far->add("Ground", slab());
    const SessionHandle handle = rig.far->add("Box", box({0.0, 0.05, 0.0}));
    rig.run(200 * ms);
    rig.far->session.teleport_body(handle, {{0.4, 0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    rig.run(500 * ms);
    rig.start_operator(11);
    rig.near->port->settings.publish(never_corrected());  // nothing but the description says where it is
    rig.run(500 * ms);
    EXPECT_NEAR(glm::distance(rig.near->pose("Box").position, Vec3(0.4, 0.05, 0.0)), 0.0, 1e-3);
}

TEST(ModelBuilder, AnEnvironmentThatRestartsReplacesTheModel) {
    Rig rig;
    rig.far->add("Ground", slab());
    rig.far->add("Box", box({0.0, 0.05, 0.0}));
    rig.run(500 * ms);
    rig.start_environment(22);
    rig.far->add("Ground", slab());
    rig.far->add("Ball", body(SphereShape{0.05}, {0.2, 0.05, 0.0}, Motion::Dynamic));
    rig.run(500 * ms);
    EXPECT_EQ(rig.near->builder.objects().size(), 2u);
    EXPECT_EQ(rig.near->find("Box"), nullptr);
    EXPECT_NEAR(rig.near->pose("Ball").position.x, 0.2, 1e-2);
}

TEST(ModelBuilder, WhatIsRemovedThereGoesHere) {
    Rig rig;
    rig.far->add("Ground", slab());
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
    const SessionHandle next =
        rig.far->add("Ball", body(SphereShape{0.05}, {0.2, 0.5, 0.0}, Motion::Kinematic));
    EXPECT_EQ(next, handle);
    rig.run(500 * ms);
    ASSERT_EQ(rig.near->builder.objects().size(), 1u);
    ASSERT_NE(rig.near->find("Ball"), nullptr);
    EXPECT_NEAR(glm::distance(rig.near->pose("Ball").position, Vec3(0.2, 0.5, 0.0)), 0.0, 1e-9);
}

TEST(ModelBuilder, ANewDescriptionTakesThePlaceOfTheOld) {
    Rig rig;
    rig.far->add("Ground", slab());
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

// By the time that it is told, it is elsewhere.
TEST(ModelBuilder, WhatMovesAndIsToldAnewGoesOnFromWhereTheModelHasIt) {
    LinkConditions conditions;
    conditions.delay = 50 * ms;
    Rig rig(conditions);
    BodyAddition sled = box({0.0, 0.05, 0.0});
    sled.description.gravity_scale = 0.0;
    sled.description.linear_damping = 0.0;
    sled.description.linear_velocity = {0.2, 0.0, 0.0};
    const SessionHandle handle = rig.far->add("Sled", sled);
    rig.near->port->settings.publish(never_corrected());
    rig.run(500 * ms);
    const SessionHandle before = rig.near->find("Sled")->body;
    sled.description.mass = 0.6;
    sled.description.pose = rig.far->session.snapshot().bodies[0].pose;
    EXPECT_EQ(rig.far->teller.tell(handle, "Sled", sled), "");
    const Nanoseconds told = rig.now;
    const double from = rig.near->pose("Sled").position.x;
    for (int i = 0; i < 300; ++i) {
        rig.run(1 * ms);
        if (const double at = rig.near->pose("Sled").position.x; at > -1.0) {  // the snapshot has it
            EXPECT_NEAR(at - from, 0.2 * to_seconds(rig.now - told), 1e-6) << i;
        }
    }
    EXPECT_NE(rig.near->find("Sled")->body, before);
}

// A weight on a hand changes by less than is noticed.
TEST(ModelBuilder, GravityIsFollowedUnnoticed) {
    Rig rig;
    rig.far->add("Ball", body(SphereShape{0.05}, {0.0, 1000.0, 0.0}, Motion::Dynamic));
    rig.near->port->settings.publish(never_corrected());
    rig.run(500 * ms);
    TeleopSettings moon;
    moon.gravity = {0.0, -1.62, 0.0};
    rig.far->port->settings.publish(moon);
    constexpr double span = 0.1;
    std::vector<double> fallen{rig.near->pose("Ball").position.y};
    for (int i = 0; i < 90; ++i) {
        rig.run(100 * ms);
        fallen.push_back(rig.near->pose("Ball").position.y);
    }
    double before = -9.81;
    for (std::size_t i = 2; i < fallen.size(); ++i) {
        const double now = (fallen[i] - 2.0 * fallen[i - 1] + fallen[i - 2]) / (span * span);
        EXPECT_LT(std::abs(now - before), 0.07 * std::abs(before)) << i;
        before = now;
    }
    EXPECT_NEAR(before, -1.62, 1e-2);
}

TEST(ModelBuilder, TheModelMayBeMadeWrong) {
    Rig rig;
    rig.near->builder.set_distortion([](ObjectDescription& description) {
        if (description.name == "Ball") {
            description.body.pose.position.x += 0.1;
        }
    });
    rig.far->add("Ball", body(SphereShape{0.05}, {0.2, 0.05, 0.0}, Motion::Kinematic));
    rig.near->port->settings.publish(never_corrected());
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
}  // namespace tactus::model_builder_test
