// What is in the environment becomes the operator's model, through the network, and stays it: late joiners,
// restarts, removals and changes.
#include "session/model_builder.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "model_rig.hpp"

namespace tactus {
namespace {

using namespace session_test;
using Rig = ModelRig;

BodyAddition box(const Vec3& position) {
    return body(BoxShape{Vec3(0.05)}, position, Motion::Dynamic, 0.3);
}

BodyAddition slab() {
    return body(BoxShape{{1.0, 0.05, 1.0}}, {0.0, -0.05, 0.0}, Motion::Static);
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
    const SessionHandle next = rig.far->add("Ball", body(SphereShape{0.05}, {0.2, 0.5, 0.0}, Motion::Static));
    EXPECT_EQ(next, handle);
    rig.run(500 * ms);
    ASSERT_EQ(rig.near->builder.objects().size(), 1u);
    EXPECT_NE(rig.near->find("Ball"), nullptr);
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
