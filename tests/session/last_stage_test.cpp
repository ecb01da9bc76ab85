// Whatever changes a hand's force besides its own motion, it changes it by half a newton a tick at most: the
// hand is held still here, so that every step is one of those.
#include <algorithm>
#include <cmath>
#include <functional>

#include "linked_tools.hpp"

namespace tactus::last_stage_test {
namespace {

using namespace session_test;

constexpr double most_unexplained = 0.5 + 1e-9;  // (unit: newtons)

class StillHand : public LinkedPlaces {
public:
    StillHand(double delay, const BodyAddition& under, const Vec3& above, const Vec3& pressing)
        : LinkedPlaces(delay, 0.0, 1) {
        for (Place* const place : {&near, &far}) {
            ProxyDescription pointer;
            pointer.device = 0;
            place->session.set_proxy(0, pointer);
        }
        add(ground());
        body = add(under);
        settle();
        HeldDevice& hand = near.devices[0];
        hand.position = above;
        ticks(500);
        for (int i = 1; i <= 200; ++i) {
            hand.position = above + (pressing - above) * (i / 200.0);
            tick();
        }
        ticks(300);
        EXPECT_GT(glm::length(hand.force), 2.0);
    }
    // The largest step in some ticks.
    double run(int count, const std::function<void(int)>& at_tick) {
        double largest = 0.0;
        for (int i = 0; i < count; ++i) {
            at_tick(i);
            const Vec3 before = near.devices[0].force;
            tick();
            largest = std::max(largest, glm::distance(before, near.devices[0].force));
        }
        return largest;
    }

    SessionHandle body = no_handle;
};

BodyAddition box(double mass) {
    BodyAddition made = session_test::body(BoxShape{Vec3(0.025)}, {0.0, 0.025, 0.0}, Motion::Dynamic, mass);
    made.description.material.friction = 0.5;
    made.touch_material = {500.0, 0.0, 0.5, 0.4};
    return made;
}

TEST(LastStage, AScriptThatMovesTheFarBodyIsFeltGradually) {
    for (const double delay : {0.0, 0.002, 0.01, 0.05, 0.2}) {
        for (const Vec3& step :
             {Vec3(-0.002, 0.0, 0.0), Vec3(-0.01, 0.0, 0.0), Vec3(0.0, 0.004, 0.0), Vec3(0.0, 0.01, 0.0)}) {
            StillHand hand(delay, box(0.3), {0.0, 0.1, 0.0}, {0.0, 0.05, 0.0});
            const double largest = hand.run(2500, [&](int i) {
                if (i % 150 == 0) {
                    Pose moved = hand.far.pose(hand.body);
                    moved.position += step;
                    hand.far.session.teleport_body(hand.body, moved);
                }
            });
            EXPECT_LE(largest, most_unexplained) << delay << " " << step.x << " " << step.y;
        }
    }
}

TEST(LastStage, AFarHandThatTouchesNothingMakesNoKick) {
    for (const double delay : {0.0, 0.05}) {
        StillHand hand(delay, box(0.3), {0.0, 0.1, 0.0}, {0.0, 0.05, 0.0});
        const double largest = hand.run(3000, [&](int i) {
            if (i % 500 == 0) {
                ProxyDescription pointer;
                pointer.device = 0;
                pointer.settings.mask = i % 1000 == 0 ? 0 : ~0u;
                hand.far.session.set_proxy(0, pointer);
            }
        });
        EXPECT_LE(largest, most_unexplained) << delay;
    }
}

TEST(LastStage, ABodyThatIsLedAtTheFarSideMakesNoKick) {
    for (const double delay : {0.0, 0.05, 0.2}) {
        BodyAddition led = box(0.3);
        led.description.motion = Motion::Kinematic;
        StillHand hand(delay, led, {0.0, 0.1, 0.0}, {0.0, 0.05, 0.0});
        const double largest = hand.run(3000, [&](int i) {
            Pose pose;
            pose.position = {0.0, 0.025 + 0.02 * std::sin(6.283185 * 2.0 * 1e-3 * i), 0.0};
            hand.far.session.move_body(hand.body, pose, 1e-3);
        });
        EXPECT_LE(largest, most_unexplained) << delay;
    }
}

TEST(LastStage, ALineThatDiesAndComesBackMakesNoKick) {
    for (const bool is_traditional : {false, true}) {
        for (const int dead : {150, 1500}) {
            StillHand hand(0.01, box(0.3), {0.0, 0.1, 0.0}, {0.0, 0.05, 0.0});
            if (is_traditional) {
                TeleopSettings settings;
                settings.traditional = true;
                hand.near.port->settings.publish(settings);
                hand.far.port->settings.publish(settings);
            }
            const double largest =
                hand.run(4000, [&](int i) { hand.lose_everything(i >= 500 && i < 500 + dead); });
            EXPECT_LE(largest, most_unexplained) << dead;
        }
    }
}

// What the hand does itself is not held back: it goes into a wall at 1 m/s.
TEST(LastStage, TheHandsOwnMotionIsFeltAtOnce) {
    StillHand hand(0.05, box(0.3), {0.3, 0.1, 0.0}, {0.3, 0.005, 0.0});
    HeldDevice& device = hand.near.devices[0];
    device.position = {0.3, 0.05, 0.0};
    hand.ticks(300);
    for (int i = 0; i < 60; ++i) {
        device.position.y -= 1e-3;
        device.velocity.y = -1.0;
        hand.tick();
        const double depth = 0.01 - device.position.y;
        EXPECT_NEAR(device.force.y, 500.0 * std::max(0.0, depth), 0.51) << i;
    }
}

// What keeps direct touch passive acts at once, and counts as explained. Where damping begins and ends in the
// time domain and with two layers, a hand that goes up and down smoothly feels larger steps.
TEST(LastStage, ThePassivityOfADirectLinkMakesBoundedSteps) {
    const std::pair<Passivity, double> most_of_schemes[] = {
        {Passivity::wave_variables, 0.05}, {Passivity::time_domain, 1.1}, {Passivity::two_layers, 1.7}};
    for (const auto& [scheme, most] : most_of_schemes) {
        for (const double delay : {0.0, 0.05, 0.2}) {
            TeleopSettings settings;
            settings.traditional = true;
            settings.passivity = scheme;
            LinkedPlaces places(delay, 0.0, 1, settings, settings);
            places.add(ground());
            places.settle();
            HeldDevice& hand = places.near.devices[0];
            hand.position = {0.0, 0.03, 0.0};
            places.ticks(800);
            double largest = 0.0, pressed = 0.0;
            for (int i = 0; i < 6000; ++i) {
                const double angle = 6.283185 * 0.5e-3 * i;
                hand.position.y = 0.01 + 0.02 * std::cos(angle);
                hand.velocity.y = -0.02 * 6.283185 * 0.5 * std::sin(angle);
                const Vec3 before = hand.force;
                places.tick();
                largest = std::max(largest, glm::distance(before, hand.force));
                pressed = std::max(pressed, glm::length(hand.force));
            }
            EXPECT_LE(largest, most) << static_cast<int>(scheme) << " " << delay;
            EXPECT_GT(pressed, 2.0) << static_cast<int>(scheme) << " " << delay;
        }
    }
}

TEST(LastStage, TheStatisticIsThatOfWhatLeft) {
    StillHand hand(0.05, box(0.3), {0.0, 0.1, 0.0}, {0.0, 0.05, 0.0});
    EXPECT_LE(hand.statistics().largest_unexplained_step, most_unexplained);
    const double largest = hand.run(1000, [&](int i) {
        if (i == 100) {
            Pose moved = hand.far.pose(hand.body);
            moved.position.y += 0.01;
            hand.far.session.teleport_body(hand.body, moved);
        }
    });
    EXPECT_GE(hand.statistics().largest_unexplained_step, largest - 1e-6);
}

}  // namespace
}  // namespace tactus::last_stage_test
