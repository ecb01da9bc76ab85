// A hand that is dragged onto a stiffer place, or over one that becomes stiffer, feels it grow.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "session_rig.hpp"

namespace tactus::dragged_test {
namespace {

using namespace session_test;

constexpr double soft = 500.0, stiff = 5000.0;  // (unit: newtons per meter)
constexpr double deep = 0.011;                  // (unit: meters)
constexpr double most_step = 0.5;               // (unit: newtons)

BodyAddition floor_at(double side, double stiffness) {
    BodyAddition floor = body(BoxShape{Vec3(1.0)}, {side, -1.0, 0.0}, Motion::Static);
    floor.touch_material.stiffness = stiffness;
    return floor;
}

// A hand that lies as deep in the floor, away from the border at x = 0.
struct Dragged : SessionRig {
    explicit Dragged(double here, double there) : first(add(floor_at(-1.0, here))) {
        add(floor_at(1.0, there));
        device.position = {-0.15, 0.02, 0.0};
        tick();
        draw({-0.15, 0.01 - deep, 0.0}, 1'000);
        before = device.force;
    }
    // The largest change of the force in a tick on the way there.
    double drag_to(double x, double speed, int changed_at = -1) {
        double largest = 0.0;
        const double step = speed * 1e-3;
        for (int i = 0; device.position.x != x; ++i) {
            const double left = x - device.position.x;
            device.velocity = {left > 0.0 ? speed : -speed, 0.0, 0.0};
            device.position.x = std::abs(left) <= step ? x : device.position.x + (left > 0.0 ? step : -step);
            if (i == changed_at) {
                session.set_touch_material(first, {stiff, 0.0, 0.0, 0.0});
            }
            largest = std::max(largest, step_of_tick());
        }
        device.velocity = Vec3(0.0);
        return largest;
    }
    double step_of_tick() {
        tick();
        const double step = glm::distance(device.force, before);
        before = device.force;
        return step;
    }
    double rest(int count) {
        double largest = 0.0;
        for (int i = 0; i < count; ++i) {
            largest = std::max(largest, step_of_tick());
        }
        return largest;
    }

    SessionHandle first;
    Vec3 before{0.0};
};

// It jumped by 0.5 N a tick at 0.1 m/s, by 2.5 and 5 N at 0.5 and 1 m/s.
TEST(Dragged, OntoAStifferPlaceAndBackTheForceGrowsAtAnySpeed) {
    for (const double speed : {0.1, 0.5, 1.0, 3.0}) {
        Dragged hand(soft, stiff);
        EXPECT_NEAR(hand.device.force.y, soft * deep, 1e-3);
        EXPECT_LE(hand.drag_to(0.15, speed), most_step) << speed << " m/s";
        EXPECT_LE(hand.rest(500), most_step);
        EXPECT_NEAR(hand.device.force.y, stiff * deep, 1e-3) << speed << " m/s";
        EXPECT_LE(hand.drag_to(-0.15, speed), most_step) << speed << " m/s, back";
        EXPECT_LE(hand.rest(500), most_step);
        EXPECT_NEAR(hand.device.force.y, soft * deep, 1e-3) << speed << " m/s";
    }
}

TEST(Dragged, AStiffnessThatIsSetWhileTheHandSlidesGrows) {
    for (const double speed : {0.02, 0.1, 0.5, 1.0}) {
        Dragged hand(soft, soft);
        EXPECT_LE(hand.drag_to(-0.02, speed, 20), most_step) << speed << " m/s";
        EXPECT_LE(hand.rest(500), most_step);
        EXPECT_NEAR(hand.device.force.y, stiff * deep, 1e-3) << speed << " m/s";
    }
}

// To and fro over the border, faster than the force has grown.
TEST(Dragged, ToAndFroOverTheBorderNothingAddsUp) {
    Dragged hand(soft, stiff);
    hand.drag_to(-0.01, 0.5);
    for (int i = 0; i < 40; ++i) {
        EXPECT_LE(hand.drag_to(i % 2 == 0 ? 0.01 : -0.01, 1.0), most_step) << i;
        EXPECT_LE(hand.device.force.y, stiff * deep + 1e-6) << i;
    }
    EXPECT_LE(hand.rest(500), most_step);
    EXPECT_NEAR(hand.device.force.y, soft * deep, 1e-3);
}

}  // namespace
}  // namespace tactus::dragged_test
