// What the environment says of itself takes no more of the network than it must: what stands is told once,
// and a way that is narrow is not filled up.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "model_rig.hpp"

namespace tactus {
namespace {

using namespace session_test;

constexpr Nanoseconds second = 1'000'000'000;

BodyAddition stone(int number) {
    return body(BoxShape{Vec3(0.01)}, {0.1 * (number % 8), 0.0, 0.1 * (number / 8)}, Motion::Static);
}

double bits_from_far(const ModelRig& rig) {
    return rig.near->port->statistics.front().link.received_rate.bits_per_s;
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

TEST(Frugal, WhatStandsAndIsPutElsewhereIsTold) {
    ModelRig rig;
    const SessionHandle moved = rig.far->add("Stone", stone(0));
    rig.far->add("Other", stone(1));
    rig.run(second);
    ASSERT_NE(rig.near->find("Stone"), nullptr);
    // A hand that is put down there meets it in the model.
    const Vec3 there(0.3, 0.2, 0.3);
    rig.far->session.teleport_body(moved, {there, {}});
    rig.run(second);
    const auto touches = [&] {
        rig.near->device.position = there + Vec3(0.0, 0.1, 0.0);
        rig.run(second / 10);
        for (int i = 0; i < 100; ++i) {
            rig.near->device.position.y -= 0.001;
            rig.run(period);
        }
        return glm::length(rig.near->device.force) > 0.5;
    };
    EXPECT_TRUE(touches());
    // Who comes later finds it there, too.
    rig.near.reset();
    rig.run(2 * second);
    rig.start_operator(9);
    rig.near->device.position = there + Vec3(0.0, 0.1, 0.0);
    rig.run(2 * second);
    EXPECT_TRUE(touches());
}

// A hundred kilobytes of triangles on a way of a megabit: the description takes its time, and what the hand
// needs is not held up by it.
TEST(Frugal, ANarrowWayIsNotFilledUp) {
    LinkConditions narrow;
    narrow.delay = 10'000'000;
    narrow.rate = 1e6;
    ModelRig rig(narrow);
    auto mesh = std::make_shared<TriangleMesh>();
    constexpr std::uint32_t side = 48;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        mesh->vertices.push_back({0.02 * (i % side), 0.001 * ((i * 7919) % 13), 0.02 * (i / side)});
    }
    for (std::uint32_t i = 0; i + side + 1 < side * side; ++i) {
        if (i % side + 1 < side) {
            mesh->triangles.push_back({i, i + side, i + 1});
            mesh->triangles.push_back({i + 1, i + side, i + side + 1});
        }
    }
    rig.far->add("Land", body(MeshShape{mesh, 0.0}, {0.0, -1.0, 0.0}, Motion::Static));
    rig.run(3 * second);
    double delay = 0.0;
    constexpr int looks = 150;
    for (int i = 0; i < looks; ++i) {
        rig.run(second / 5);
        delay += rig.near->port->statistics.front().link.one_way_delay / looks;
    }
    EXPECT_LT(delay, 80e6) << "ns; the way alone takes 10 ms, a full queue 200";
    EXPECT_NE(rig.near->find("Land"), nullptr);
}

}  // namespace
}  // namespace tactus
