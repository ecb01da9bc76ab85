#include "devices/robot_tip.hpp"

#include <gtest/gtest.h>

namespace tactus::robot_tip_test {
namespace {

TEST(RobotTip, IsTheHandOfAnotherWorldAndIsPushedByIt) {
    const auto exchange = std::make_shared<TipExchange>();
    RobotTable::Settings table;
    table.height = -0.01;
    auto surroundings = std::make_unique<TipSurroundings>(table, exchange);
    auto hand = std::make_unique<TipDevice>(exchange);
    EXPECT_FALSE(hand->read(0).connected) << "the robot has not moved yet";

    EXPECT_EQ(surroundings->push(1, {0.0, 0.02, 0.0}, {0.0, 0.1, 0.0}), Vec3(0.0));
    const DeviceSample sample = hand->read(1);
    EXPECT_TRUE(sample.connected);
    EXPECT_EQ(sample.position, Vec3(0.0, 0.02, 0.0));
    EXPECT_EQ(sample.velocity, Vec3(0.0, 0.1, 0.0));

    hand->write(1, {0.0, 2.0, 0.0});
    EXPECT_EQ(surroundings->push(2, {0.0, 0.02, 0.0}, {}), Vec3(0.0, 2.0, 0.0));
    // In the table as well.
    EXPECT_GT(surroundings->push(3, {0.0, -0.011, 0.0}, {}).y, 2.0 + 1.0);

    hand.reset();
    EXPECT_EQ(surroundings->push(4, {0.0, 0.02, 0.0}, {}), Vec3(0.0)) << "that world is gone";
    hand = std::make_unique<TipDevice>(exchange);
    surroundings.reset();
    EXPECT_FALSE(hand->read(5).connected) << "the robot is gone";
}

}  // namespace
}  // namespace tactus::robot_tip_test
