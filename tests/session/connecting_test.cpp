// While the far side describes its bodies nothing of the model falls through what is not described yet.
#include <algorithm>
#include <string>

#include "model_rig.hpp"

namespace tactus::connecting_test {
namespace {

using namespace session_test;

BodyAddition brick(const Vec3& position, double half = 0.02) {
    return body(BoxShape{Vec3(half)}, position, Motion::Dynamic, 0.3);
}

// The most that any box of the model is below the one that it shows (unit: meters).
double fall_while_connecting(ModelRig& rig, const std::vector<SessionHandle>& bricks, double seconds) {
    double most = 0.0;
    for (int i = 0; i < static_cast<int>(seconds * 1e3); ++i) {
        rig.run(ms);
        const SessionSnapshot& there = rig.far->session.snapshot();
        for (std::size_t k = 0; k < bricks.size(); ++k) {
            const ModelObject* const object = rig.near->find("Box" + std::to_string(k));
            const BodyState* const truth = state_of(there.bodies, there.body_count, bricks[k]);
            if (object && object->body != no_handle && truth) {
                const double y = rig.near->pose(object->name).position.y;
                most = y > -90.0 ? std::max(most, truth->pose.position.y - y) : most;
            }
        }
    }
    return most;
}

std::vector<SessionHandle> pile(ModelRig& rig, int count) {
    std::vector<SessionHandle> bricks;
    for (int k = 0; k < count; ++k) {
        bricks.push_back(rig.far->add("Box" + std::to_string(k), brick({0.06 * k - 0.6, 0.02, 0.0})));
    }
    return bricks;
}

TEST(Connecting, NothingFallsThroughWhatIsDescribedLast) {
    for (const double loss : {0.0, 0.05}) {
        LinkConditions conditions;
        conditions.delay = 25 * ms;
        conditions.loss = loss;
        conditions.rate = 256e3;
        ModelRig rig(conditions);
        const std::vector<SessionHandle> bricks = pile(rig, 20);
        rig.far->add("Table", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -0.1, 0.0}, Motion::Static));
        EXPECT_LE(fall_while_connecting(rig, bricks, 6.0), 1e-3) << loss;
        EXPECT_EQ(rig.near->builder.objects().size(), 21u);
    }
}

// Once all is known it falls as at the far side.
TEST(Connecting, WhatIsKnownFallsAgain) {
    ModelRig rig;
    const std::vector<SessionHandle> bricks = pile(rig, 3);
    rig.far->add("Table", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -0.1, 0.0}, Motion::Static));
    rig.run(1000 * ms);
    rig.far->session.teleport_body(bricks[1], {{0.0, 0.5, 0.5}, {1.0, 0.0, 0.0, 0.0}});
    rig.run(1000 * ms);
    EXPECT_NEAR(rig.near->pose("Box1").position.y, 0.02, 1e-3);
}

// A body and what it rests on come while the two are connected, and the support is described last.
TEST(Connecting, WhatComesLaterRestsOnWhatComesWithIt) {
    LinkConditions conditions;
    conditions.delay = 25 * ms;
    conditions.rate = 64e3;
    ModelRig rig(conditions);
    rig.far->add("Ground", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -5.0, 0.0}, Motion::Static));
    rig.run(1000 * ms);
    const std::vector<SessionHandle> bricks = pile(rig, 12);
    rig.far->add("Table", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -0.1, 0.0}, Motion::Static));
    EXPECT_LE(fall_while_connecting(rig, bricks, 4.0), 1e-3);
}

// A brick and its table come together while the two are connected, the brick first. That there is more to
// come is said in a packet of its own, which may be lost or overtaken.
TEST(Connecting, NothingFallsWhereWordOfMoreToComeIsLost) {
    for (std::uint64_t network = 1; network <= 40; ++network) {
        LinkConditions conditions;
        conditions.delay = 25 * ms;
        conditions.jitter = 10 * ms;
        conditions.loss = 0.2;
        ModelRig rig(conditions, {}, network);
        rig.far->add("Ground", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -5.0, 0.0}, Motion::Static));
        rig.run(1000 * ms);
        const std::vector<SessionHandle> bricks = pile(rig, 1);
        rig.far->add("Table", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -0.1, 0.0}, Motion::Static));
        EXPECT_LE(fall_while_connecting(rig, bricks, 2.0), 1e-3) << network;
    }
}

// The owner reads statistics, and the loop goes on before it takes what has been described by then.
TEST(Connecting, NothingFallsWhereTheOwnerReadsStatisticsEarly) {
    ModelRig rig;
    rig.near->reads_early = true;
    rig.far->add("Ground", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -5.0, 0.0}, Motion::Static));
    rig.run(1000 * ms);
    const std::vector<SessionHandle> bricks = pile(rig, 12);
    rig.far->add("Table", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -0.1, 0.0}, Motion::Static));
    EXPECT_LE(fall_while_connecting(rig, bricks, 2.0), 1e-4);
}

// What is let fall while the two are connected falls in the model as it does at the far side, one way later.
TEST(Connecting, WhatComesFallingFallsAsThere) {
    constexpr int one_way = 25;
    LinkConditions conditions;
    conditions.delay = one_way * ms;
    ModelRig rig(conditions);
    rig.far->add("Ground", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -2.0, 0.0}, Motion::Static));
    rig.run(1000 * ms);
    const SessionHandle falls = rig.far->add("Box", brick({0.5, 1.0, 0.0}));
    std::vector<double> model;
    double most = 0.0;
    for (int i = 0; i < 600; ++i) {
        rig.run(ms);
        model.push_back(rig.near->pose("Box").position.y);
        const SessionSnapshot& there = rig.far->session.snapshot();
        const BodyState* const truth = state_of(there.bodies, there.body_count, falls);
        if (const int then = i - one_way; then >= 250 && truth) {
            most = std::max(most, std::abs(truth->pose.position.y - model[static_cast<std::size_t>(then)]));
        }
    }
    EXPECT_LE(most, 0.01);
    EXPECT_LT(model.back(), 0.0);
}

// What is described anew while a hand holds it keeps its weight.
TEST(Connecting, WhatIsDescribedAnewKeepsItsWeight) {
    ModelRig rig;
    const SessionHandle box = rig.far->add("Box", brick({0.0, 1.0, 0.0}));
    rig.far->add("Table", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -0.1, 0.0}, Motion::Static));
    rig.run(1000 * ms);
    rig.near->session.set_body_velocity(rig.near->find("Box")->body, {}, {});
    EXPECT_EQ(rig.far->teller.tell(box, "Box", brick({0.0, 0.02, 0.0})), "");
    rig.run(5 * ms);
    EXPECT_FALSE(rig.near->find("Box")->floats);
}

double force_of(const Session& session) {
    return glm::length(session.snapshot().proxies[0].force);
}

// The hand comes down on a table that is described last.
void press_while_connecting(const LinkConditions& conditions, std::uint64_t network,
                            const TeleopSettings& settings = {}) {
    ModelRig rig(conditions, settings, network);
    pile(rig, 20);
    rig.far->add("Table", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -0.1, 0.5}, Motion::Static));
    double most = 0.0;
    for (int i = 0; i < 4000; ++i) {
        const double way = std::clamp((i - 150) / 200.0, 0.0, 1.0);
        rig.near->device.position = {0.0, 0.1 - 0.11 * way, 0.4};
        rig.run(ms);
        most = std::max(most, force_of(rig.far->session) - force_of(rig.near->session));
    }
    EXPECT_LT(most, 1.0) << "loss " << conditions.loss << ", network " << network;
}

TEST(Connecting, NoFarHandPressesWhatIsNotDescribedYet) {
    for (std::uint64_t network = 1; network <= 10; ++network) {
        LinkConditions conditions;
        conditions.delay = 25 * ms;
        conditions.loss = 0.9;
        press_while_connecting(conditions, network);
    }
}

TEST(Connecting, NoFarHandPressesWhatANarrowLinkBringsLate) {
    for (const double rate : {32e3, 64e3, 128e3}) {
        LinkConditions conditions;
        conditions.delay = 25 * ms;
        conditions.rate = rate;
        press_while_connecting(conditions, 1);
    }
}

TEST(Connecting, NoFarHandPressesWhatIsNotDescribedYetWithADeadband) {
    TeleopSettings settings;
    settings.deadband.enabled = true;
    for (const double loss : {0.3, 0.9}) {
        LinkConditions conditions;
        conditions.delay = 5 * ms;
        conditions.loss = loss;
        press_while_connecting(conditions, 3, settings);
    }
}

TEST(Connecting, BothHandsPressOnceAllIsDescribed) {
    LinkConditions conditions;
    conditions.delay = 25 * ms;
    conditions.loss = 0.5;
    ModelRig rig(conditions);
    pile(rig, 3);
    rig.far->add("Table", body(BoxShape{{1.0, 0.1, 1.0}}, {0.0, -0.1, 0.5}, Motion::Static));
    rig.near->device.position = {0.0, 0.1, 0.4};
    rig.run(4000 * ms);
    rig.near->device.position = {0.0, -0.01, 0.4};
    rig.run(2000 * ms);
    EXPECT_GT(force_of(rig.near->session), 3.0);
    EXPECT_NEAR(force_of(rig.far->session), force_of(rig.near->session), 0.1);
}

}  // namespace
}  // namespace tactus::connecting_test
