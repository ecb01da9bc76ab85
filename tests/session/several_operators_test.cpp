// Several operators on one environment: each with a link, pointers and truths of its own, each a ghost to the
// others.
#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>

#include "model_rig.hpp"
#include "session/shared_environment.hpp"

namespace tactus::several_operators_test {
namespace {

using namespace session_test;

constexpr std::size_t operators = 2;
constexpr double stiffness = 500.0;

BodyAddition touchable(BodyAddition addition) {
    addition.touch_material = {stiffness, 0.0, 0.0, 0.0};
    return addition;
}

struct SharedRig {
    SharedRig() {
        std::vector<std::unique_ptr<TeleopSide>> sides;
        for (std::size_t i = 0; i < operators; ++i) {
            ports[i] = std::make_shared<TeleopPort>();
            tellers[i] = std::make_unique<EnvironmentTeller>(ports[i]);
            sides.push_back(std::make_unique<TeleoperatorSide>(
                small_session(), TeleopSettings{}, wires[i].second(), ports[i],
                endpoint(Side::teleoperator_side, 100 + i), PointerShare{i, operators}));
            start(i, 1 + i);
        }
        far.attach(std::make_unique<SharedEnvironment>(std::move(sides)));
        for (HeldDevice& device : devices) {
            add_pointer(far, device);
        }
    }

    void start(std::size_t which, std::uint64_t epoch) {
        near[which] = std::make_unique<Operator>(wires[which].first(), epoch);
        near[which]->device.position = {0.0, 0.3, 0.0};
    }

    SessionHandle add(const std::string& name, const BodyAddition& addition) {
        const SessionHandle body = far.add_body(addition).handle;
        for (const auto& teller : tellers) {
            EXPECT_EQ(teller->tell(body, name, addition), "");
        }
        return body;
    }

    void tick() {
        now += period;
        for (const auto& one : near) {
            if (one) {
                one->tick(now);
            }
        }
        far.tick(now);
        far.collect();
        far.refresh();
        for (std::size_t i = 0; i < operators; ++i) {
            ports[i]->statistics.refresh();
            tellers[i]->update(far.snapshot(), ports[i]->statistics.front().link.peer_epoch);
        }
    }
    void run(Nanoseconds span) {
        for (const Nanoseconds end = now + span; now < end;) {
            tick();
        }
    }
    // Where the operator's hand goes within a tenth of a second.
    void move(std::size_t which, const Vec3& to) {
        const Vec3 from = near[which]->device.position;
        for (int i = 1; i <= 100; ++i) {
            near[which]->device.position = from + (to - from) * (i / 100.0);
            tick();
        }
    }
    double force(std::size_t which) const { return near[which]->device.force.y; }
    Vec3 place_of(SessionHandle body) const {
        const SessionSnapshot& snapshot = far.snapshot();
        const BodyState* const state = state_of(snapshot.bodies, snapshot.body_count, body);
        return state ? state->pose.position : Vec3(-99.0);
    }
    const LinkStatistics& link(std::size_t which) const { return ports[which]->statistics.front().link; }

    std::array<MemoryLinkPair, operators> wires{MemoryLinkPair(8192), MemoryLinkPair(8192)};
    std::array<std::shared_ptr<TeleopPort>, operators> ports;
    std::array<std::unique_ptr<EnvironmentTeller>, operators> tellers;
    std::array<std::unique_ptr<Operator>, operators> near;
    std::array<HeldDevice, 4> devices;  // two pointers for each
    Session far{small_session()};
    Nanoseconds now = 0;
};

BodyAddition slab() {
    return touchable(body(BoxShape{{1.0, 0.05, 1.0}}, {0.0, -0.05, 0.0}, Motion::Static));
}
BodyAddition box() {
    return touchable(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, 0.3));
}

TEST(SeveralOperators, EachHasPointersOfItsOwn) {
    const PointerShare first{0, 3}, last{2, 3}, alone{};
    EXPECT_EQ(first.most(), 6u);
    EXPECT_EQ(last.most(), 5u);
    EXPECT_EQ(last.proxy_of(last.most() - 1), 14u);
    EXPECT_EQ(alone.most(), max_proxies);
}

TEST(SeveralOperators, AreGhostsToEachOther) {
    SharedRig rig;
    rig.add("Slab", slab());
    rig.run(500 * 1'000'000);
    rig.move(0, {0.0, 0.0, 0.0});
    rig.run(200 * 1'000'000);
    const double alone = rig.force(0);
    EXPECT_GT(alone, 1.0);
    rig.move(1, {0.0, 0.0, 0.0});  // in the very same place
    rig.run(200 * 1'000'000);
    EXPECT_NEAR(rig.force(0), alone, 1e-6);
    EXPECT_NEAR(rig.force(1), alone, 1e-6);
    // Both hands are there, and press.
    EXPECT_EQ(rig.far.snapshot().proxies[0].contact_count, 1);
    EXPECT_EQ(rig.far.snapshot().proxies[1].contact_count, 1);
    EXPECT_EQ(rig.far.snapshot().proxies[2].contact_count, 0);
}

// Each is told where the others' fingertips are, and of none of its own.
TEST(SeveralOperators, SeeWhereTheOthersAre) {
    SharedRig rig;
    rig.add("Slab", slab());
    rig.run(500 * 1'000'000);
    rig.move(0, {0.3, 0.2, 0.0});
    rig.move(1, {-0.2, 0.0, 0.1});
    rig.run(300 * 1'000'000);
    const auto seen_by = [&](std::size_t which) { return rig.near[which]->port->statistics.front().ghosts; };
    // Pointers 0 and 2 of the environment are the first one's, 1 and 3 the second one's, who has one hand.
    ASSERT_EQ(seen_by(0).count, 1u);
    EXPECT_EQ(seen_by(0).ghosts[0].pointer, 1);
    EXPECT_TRUE(seen_by(0).ghosts[0].touches);
    EXPECT_LT(glm::distance(seen_by(0).ghosts[0].position, rig.far.snapshot().proxies[1].position), 2e-4);
    EXPECT_DOUBLE_EQ(seen_by(0).ghosts[0].radius, 0.01);
    ASSERT_EQ(seen_by(1).count, 1u);
    EXPECT_EQ(seen_by(1).ghosts[0].pointer, 0);
    EXPECT_FALSE(seen_by(1).ghosts[0].touches);
    EXPECT_LT(glm::distance(seen_by(1).ghosts[0].position, Vec3(0.3, 0.2, 0.0)), 2e-4);
    // One that has gone is not seen any more, and one that is lost neither.
    rig.near[1].reset();
    rig.run(2'000'000'000);
    EXPECT_EQ(seen_by(0).count, 0u);
}

TEST(SeveralOperators, WhatOneMovesTheOtherSees) {
    SharedRig rig;
    rig.add("Slab", slab());
    const SessionHandle moved = rig.add("Box", box());
    rig.run(500 * 1'000'000);
    for (double x = -0.2; x < 0.1; x += 0.02) {
        rig.move(0, {x, 0.05, 0.0});
    }
    rig.run(1000 * 1'000'000);
    EXPECT_GT(rig.place_of(moved).x, 0.05);
    for (std::size_t i = 0; i < operators; ++i) {
        EXPECT_LT(glm::distance(rig.near[i]->pose("Box").position, rig.place_of(moved)), 1e-3) << i;
    }
}

TEST(SeveralOperators, WhoGoesAndComesDisturbsNobody) {
    SharedRig rig;
    rig.add("Slab", slab());
    rig.run(500 * 1'000'000);
    rig.move(0, {0.3, 0.0, 0.0});
    rig.move(1, {-0.3, 0.0, 0.0});
    rig.run(200 * 1'000'000);
    const double pressed = rig.force(1);
    rig.near[0].reset();  // killed
    double largest = 0.0;
    const auto watch = [&](Nanoseconds span) {
        for (const Nanoseconds end = rig.now + span; rig.now < end;) {
            rig.tick();
            largest = std::max(largest, std::abs(rig.force(1) - pressed));
        }
    };
    watch(2'000'000'000);
    EXPECT_EQ(rig.link(0).peer, PeerState::vanished);
    EXPECT_EQ(rig.far.snapshot().proxies[0].contact_count, 0) << "nobody holds it";
    rig.start(0, 77);
    watch(2'000'000'000);
    EXPECT_EQ(rig.link(0).peer, PeerState::connected);
    EXPECT_EQ(rig.link(1).peer_restarts, 0u);
    EXPECT_EQ(rig.link(1).peer, PeerState::connected);
    EXPECT_LT(largest, 1e-6) << "N, at the one that stays";
    EXPECT_EQ(rig.far.snapshot().proxies[1].contact_count, 1);
}

// One says whatever it likes about pointers: none of the other's moves.
TEST(SeveralOperators, OneHasNoPointerOfAnother) {
    SharedRig rig;
    rig.add("Slab", slab());
    rig.run(500 * 1'000'000);
    rig.move(1, {-0.3, 0.0, 0.0});
    rig.run(200 * 1'000'000);
    const Vec3 others = rig.far.snapshot().proxies[1].hand;
    rig.near[0].reset();
    Endpoint liar(rig.wires[0].first(), endpoint(Side::operator_side, 55));
    Terms terms;
    terms.bodies = 1000;
    for (SampleSequence sequence = 1; sequence < 1500; ++sequence) {
        liar.begin_tick(rig.now);
        while (const Endpoint::Received* const heard = liar.receive()) {
            if (const auto* const body = std::get_if<DiscoveryFragment>(&heard->packet.message)) {
                liar.send(DiscoveryAcknowledgement{body->object, body->hash, DiscoveryVerdict::known});
            }
        }
        OperatorSamples message;
        message.count = 16;
        for (std::uint16_t i = 0; i < 16; ++i) {
            message.samples[i].sequence = sequence;
            message.samples[i].time = rig.now;
            message.samples[i].pointer = i;
            message.samples[i].connected = true;
            message.samples[i].position = {0.5, 0.5, 0.5};
        }
        liar.send(message);
        liar.end_tick();
        liar.send(terms);
        rig.tick();
    }
    EXPECT_LT(glm::distance(rig.far.snapshot().proxies[0].hand, Vec3(0.5)), 1e-3) << "its own follows";
    EXPECT_EQ(rig.far.snapshot().proxies[1].hand, others);
}

}  // namespace
}  // namespace tactus::several_operators_test
