// Pointers that are carried along with what a correction moves (thesis 3.1.4), under a fingertip that presses
// and holds still.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>

#include "shared/teleop_run.hpp"

namespace tactus::carried_pointer_test {
namespace {

using namespace shared;

constexpr double told_at = 1.0;  // (unit: seconds)

struct Felt {
    Vec3 before{0.0}, after{0.0},
        last{0.0};  // in the ticks around the correction, and in the end (unit: newtons)
    double offset = 0.0, last_offset = 0.0;  // after the correction, and in the end (unit: meters)
};

// A frictionless ground; the fingertip presses above its center, 5 mm deep.
TeleopScene pressed_ground() {
    TeleopScene made;
    TeleopBody& ground = made.bodies.emplace_back();
    ground.name = "Ground";
    ground.addition.description.shapes = {PlacedShape{BoxShape{{0.5, 0.05, 0.5}}, Pose{}}};
    ground.addition.description.pose.position = {0.0, -0.05, 0.0};
    ground.addition.description.motion = Motion::Static;
    ground.addition.touch_material = {500.0, 0.0, 0.0, 0.0};
    KeyframePath path;
    path.keyframes = {{0, {0.0, 0.05, 0.0}}, {500'000'000, {0.0, 0.005, 0.0}}};
    path.interpolation = PathInterpolation::linear;
    made.path = path;
    made.force_limit = 10.0;
    return made;
}

// The model is corrected by `scheme` at told_at.
Felt corrected(Correction scheme, const WrongBody& wrong) {
    TeleopCase one;
    one.settings.correction = scheme;
    one.seconds = 12.0;
    one.wrong["Ground"] = wrong;
    one.events.push_back({told_at, TeleopEvent::Kind::correct, "", 0.0});
    one.rows = testing::TempDir() + "carried_pointer_rows.csv";
    run_teleop(pressed_ground(), one);
    std::ifstream file(one.rows);
    Felt felt;
    std::string line, cell;
    std::getline(file, line);
    Vec3 before(0.0);
    for (bool found = false; std::getline(file, line);) {
        std::istringstream cells(line);
        std::vector<double> values;
        while (std::getline(cells, cell, ',')) {
            values.push_back(std::stod(cell));
        }
        felt.last = Vec3(values[4], values[5], values[6]);
        felt.last_offset = values[20];
        if (!found && values[0] > 1e6 * (told_at - 0.1) &&
            glm::distance(felt.last, before) + values[20] > 1e-6) {
            found = true;
            felt.before = before;
            felt.after = felt.last;
            felt.offset = felt.last_offset;
        }
        before = felt.last;
    }
    return felt;
}

double angle_deg(const Vec3& a, const Vec3& b) {
    return 57.29577951308232 * std::acos(glm::dot(a, b) / (glm::length(a) * glm::length(b)));
}

WrongBody turned(double degrees) {
    WrongBody wrong;
    wrong.turn = glm::angleAxis(degrees / 57.29577951308232, Vec3(0.0, 0.0, 1.0));
    return wrong;
}

TEST(CarriedPointer, TurnedWithTheObjectTheForceKeepsItsSizeAndTurns) {
    const Felt felt = corrected(Correction::stealthy_turn, turned(10.0));
    EXPECT_GT(felt.offset, 1e-3);
    EXPECT_NEAR(glm::length(felt.after), glm::length(felt.before), 0.02);
    EXPECT_NEAR(angle_deg(felt.after, felt.before), 10.0, 0.2);
}

TEST(CarriedPointer, TranslatedWithTheObjectTheForceStays) {
    WrongBody lower;
    lower.move = {0.0, -0.003, 0.0};
    for (const Correction scheme : {Correction::stealthy_translate, Correction::stealthy_turn}) {
        const Felt felt = corrected(scheme, lower);
        EXPECT_NEAR(felt.offset, 0.003, 1e-4);
        EXPECT_LT(glm::distance(felt.after, felt.before), 0.02);
        EXPECT_NEAR(felt.before.y, 1.0, 0.05);
    }
    EXPECT_GT(
        glm::distance(corrected(Correction::pose, lower).after, corrected(Correction::pose, lower).before),
        0.4)
        << "what is carried is hidden: without it the force steps";
}

TEST(CarriedPointer, WhatItWasCarriedByFadesUntilTheForceIsRight) {
    WrongBody lower;
    lower.move = {0.0, -0.003, 0.0};
    for (const WrongBody& wrong : {lower, turned(10.0)}) {
        for (const Correction scheme : {Correction::stealthy_translate, Correction::stealthy_turn}) {
            const Felt felt = corrected(scheme, wrong);
            EXPECT_EQ(felt.last_offset, 0.0);
            EXPECT_NEAR(felt.last.y, 2.5, 1e-3);
        }
    }
}

}  // namespace
}  // namespace tactus::carried_pointer_test
