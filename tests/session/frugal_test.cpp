// What the environment says of itself takes no more of the network than it must: what stands is told once,
// and a way that is narrow is not filled up.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "model_rig.hpp"

namespace tactus::frugal_test {
namespace {

using namespace session_test;

constexpr Nanoseconds second = 1'000'000'000;

BodyAddition stone(int number) {
    return body(BoxShape{Vec3(0.01)}, {0.1 * (number % 8), 0.0, 0.1 * (number / 8)}, Motion::Static);
}

BodyAddition tumbling(int number) {
    BodyAddition box =
        body(BoxShape{Vec3(0.01)}, {0.1 * (number % 8), 1.0, 0.1 * (number / 8)}, Motion::Dynamic, 0.1);
    box.description.gravity_scale = 0.0;
    box.description.angular_velocity = {0.0, 3.0, 0.0};
    box.description.can_sleep = false;
    return box;
}

double bits_from_far(const ModelRig& rig) {
    return rig.near->port->statistics.front().link.received_rate.bits_per_s;
}

// What the hand of the operator feels where it is put down from above.
double felt_at(ModelRig& rig, const Vec3& place) {
    rig.near->device.position = place + Vec3(0.0, 0.1, 0.0);
    rig.run(second / 10);
    for (int i = 0; i < 100; ++i) {
        rig.near->device.position.y -= 0.001;
        rig.run(period);
    }
    return glm::length(rig.near->device.force);
}

LinkConditions way(double rate, double loss = 0.0) {
    LinkConditions conditions;
    conditions.delay = 10 * ms;
    conditions.rate = rate;
    conditions.loss = loss;
    return conditions;
}

std::shared_ptr<TriangleMesh> land(std::uint32_t side) {
    auto mesh = std::make_shared<TriangleMesh>();
    for (std::uint32_t i = 0; i < side * side; ++i) {
        mesh->vertices.push_back({0.02 * (i % side), 0.001 * ((i * 7919) % 13), 0.02 * (i / side)});
    }
    for (std::uint32_t i = 0; i + side + 1 < side * side; ++i) {
        if (i % side + 1 < side) {
            mesh->triangles.push_back({i, i + side, i + 1});
            mesh->triangles.push_back({i + 1, i + side, i + side + 1});
        }
    }
    return mesh;
}

TEST(Frugal, WhatStandsIsToldOnce) {
    ModelRig rig;
    for (int i = 0; i < 50; ++i) {
        rig.far->add("Stone" + std::to_string(i), stone(i));
    }
    rig.run(3 * second);
    ASSERT_EQ(rig.near->builder.objects().size(), 50u);
    rig.run(2 * second);
    // Hellos and the comparison of clocks, both ten times a second.
    EXPECT_LT(bits_from_far(rig), 30e3);
}

// Whatever the model has made of a description: where the body stands is put right, however much is lost.
TEST(Frugal, WhatStandsIsPutRightAfterItWasDescribed) {
    for (const double loss : {0.0, 0.1, 0.5}) {
        ModelRig rig(way(0.0, loss));
        rig.near->builder.set_distortion(
            [](ObjectDescription& description) { description.body.pose.position.y -= 0.5; });
        for (int i = 0; i < 20; ++i) {
            rig.far->add("Stone" + std::to_string(i), stone(i));
        }
        // It is said once more every four seconds, and half of that is lost.
        rig.run((loss < 0.5 ? 12 : 40) * second);
        for (int i = 0; i < 20; ++i) {
            EXPECT_GT(felt_at(rig, stone(i).description.pose.position), 0.5) << i << ", " << loss;
        }
        // Described anew, while all else goes on.
        const SessionHandle again = rig.far->add("Again", stone(40));
        rig.run(3 * second);
        BodyAddition other = stone(40);
        other.description.mass = 2.0;
        EXPECT_EQ(rig.far->teller.tell(again, "Again", other), "");
        rig.run(6 * second);
        EXPECT_GT(felt_at(rig, stone(40).description.pose.position), 0.5) << loss;
    }
}

void expect_told_elsewhere(std::uint64_t network) {
    SCOPED_TRACE(network);
    ModelRig rig(way(0.0, 0.3), {}, network);
    const SessionHandle moved = rig.far->add("Stone", stone(0));
    rig.far->add("Other", stone(1));
    rig.run(2 * second);
    ASSERT_NE(rig.near->find("Stone"), nullptr);
    const Vec3 there(0.3, 0.2, 0.3);
    rig.far->session.teleport_body(moved, {there, Quat(1.0, 0.0, 0.0, 0.0)});
    rig.run(2 * second);
    EXPECT_GT(felt_at(rig, there), 0.5);
    // Who comes later finds it there, too.
    rig.near.reset();
    rig.run(2 * second);
    rig.start_operator(9);
    rig.near->device.position = there + Vec3(0.0, 0.1, 0.0);
    rig.run(3 * second);
    EXPECT_GT(felt_at(rig, there), 0.5);
}

TEST(Frugal, WhatStandsAndIsPutElsewhereIsTold) {
    for (std::uint64_t network = 1; network <= 20; ++network) {
        expect_told_elsewhere(network);
    }
}

// Whoever has the key may say anything; nothing false of it stays for ever.
TEST(Frugal, WhatIsFalseOfWhatStandsHeals) {
    ModelRig rig;
    for (int i = 0; i < 40; ++i) {
        rig.far->add("Stone" + std::to_string(i), stone(i));
    }
    rig.run(3 * second);
    const Vec3 place = stone(39).description.pose.position;
    ASSERT_GT(felt_at(rig, place), 0.5);
    rig.near->device.position = {0.0, 1.0, 0.0};
    rig.run(second / 10);
    ObjectStates lie;
    lie.newest_operator_sample = rig.far->port->statistics.front().sample;
    const ModelObject* const object = rig.near->find("Stone39");
    ASSERT_NE(object, nullptr);
    lie.count = 1;
    lie.states[0].object = object->object;
    lie.states[0].pose.position = place + Vec3(0.0, -0.5, 0.0);
    std::array<std::byte, max_datagram_bytes> bytes;
    const std::uint64_t sequence = rig.far->port->statistics.front().link.packets_sent + 40;
    const std::size_t size = encode({2, sequence, rig.now}, lie, bytes);
    ASSERT_TRUE(rig.wire.second().send(std::span(bytes).first(size), rig.now));
    rig.run(second / 10);
    EXPECT_LT(felt_at(rig, place), 0.1) << "it was believed";
    rig.run(6 * second);
    EXPECT_GT(felt_at(rig, place), 0.5);
}

// However many stand, a turn is a packet: what is false heals later, and nothing else waits for it.
TEST(Frugal, TheTurnOfWhatStandsTakesLittle) {
    ModelRig rig;
    for (int i = 0; i < 60; ++i) {
        rig.far->add("Stone" + std::to_string(i), stone(i));
    }
    rig.run(4 * second);
    double most = 0.0;
    for (int i = 0; i < 10; ++i) {
        rig.run(second);
        most = std::max(most, bits_from_far(rig));
    }
    EXPECT_LT(most, 50e3);
}

// Many that move are told in as many packets, each in a tick of its own.
TEST(Frugal, StatesAreSpreadOverTicks) {
    ModelRig rig;
    for (int i = 0; i < 40; ++i) {
        rig.far->add("Box" + std::to_string(i), tumbling(i));
    }
    rig.run(3 * second);
    std::uint64_t sent = rig.far->port->statistics.front().link.packets_sent, most = 0, all = 0;
    for (int i = 0; i < 1000; ++i) {
        rig.run(period);
        const std::uint64_t now = rig.far->port->statistics.front().link.packets_sent;
        most = std::max(most, now - sent);
        all += now - std::exchange(sent, now);
    }
    EXPECT_GE(all, 600u) << "three packets in five ticks";
    EXPECT_LE(most, 4u) << "one of states, a hello, a request and an answer";
}

struct Waits {
    double mean = 0.0, longest = 0.0;  // (unit: nanoseconds)
};

// How long what comes from the environment is on its way. Both sides have the same clock: what the link takes
// them to differ by, where one way is slower than the other, is none of it.
Waits waits(ModelRig& rig, Nanoseconds span) {
    Waits found;
    const auto looks = static_cast<int>(span / (10 * ms));
    for (int i = 0; i < looks; ++i) {
        rig.run(10 * ms);
        const LinkStatistics& link = rig.near->port->statistics.front().link;
        const double now = link.one_way_delay - static_cast<double>(link.clock.offset);
        found.mean += now / looks;
        found.longest = std::max(found.longest, now);
    }
    return found;
}

// A hundred kilobytes: the description takes its time, and what the hand needs is not held up by it.
TEST(Frugal, ADescriptionDoesNotFillUpANarrowWay) {
    for (const double rate : {300e3, 1e6, 10e6}) {
        ModelRig rig(way(rate));
        rig.run(second);
        rig.far->add("Land", body(MeshShape{land(48), 0.0}, {0.0, -1.0, 0.0}, Motion::Static));
        const Waits found = waits(rig, rate < 1e6 ? 12 * second : 6 * second);
        EXPECT_LT(found.longest, 90e6) << rate << ": ns, of which the way takes 10; a full queue takes 200";
        EXPECT_LT(found.mean, 50e6) << rate;
        EXPECT_NE(rig.near->find("Land"), nullptr) << rate;
    }
}

TEST(Frugal, AWideWayIsUsed) {
    LinkConditions wide = way(0.0);
    wide.delay = 25 * ms;
    ModelRig rig(wide);
    rig.run(second);
    rig.far->add("Land", body(MeshShape{land(150), 0.0}, {0.0, -1.0, 0.0}, Motion::Static));  // a megabyte
    rig.run(4 * second);
    EXPECT_NE(rig.near->find("Land"), nullptr);
}

// Forty boxes that go on tumbling need two megabits at full rate.
TEST(Frugal, StatesDoNotFillUpANarrowWay) {
    for (const double rate : {280e3, 300e3, 350e3, 420e3, 500e3, 700e3, 1e6}) {
        ModelRig rig(way(rate));
        rig.far->session.set_gravity(Vec3(0.0));
        for (int i = 0; i < 40; ++i) {
            rig.far->add("Box" + std::to_string(i), tumbling(i));
        }
        rig.run(8 * second);
        ASSERT_EQ(rig.near->builder.objects().size(), 40u);
        const Waits found = waits(rig, 20 * second);
        EXPECT_LT(found.mean, 60e6) << rate << ": ns; the way alone takes 10, a full queue 200";
        EXPECT_LT(found.longest, 90e6) << rate;
    }
}

// Where both ways are too narrow, requests are lost on the one and answers on the other.
TEST(Frugal, AWayThatIsFullEmptiesWithoutAnswers) {
    for (const double rate : {200e3, 350e3, 400e3}) {
        ModelRig rig(way(rate));
        rig.far->session.set_gravity(Vec3(0.0));
        for (int i = 0; i < 40; ++i) {
            rig.far->add("Box" + std::to_string(i), tumbling(i));
        }
        rig.run(8 * second);
        EXPECT_EQ(rig.near->builder.objects().size(), 40u) << rate;
        EXPECT_LT(waits(rig, 10 * second).mean, 60e6) << rate << ": ns";
    }
}

}  // namespace
}  // namespace tactus::frugal_test
