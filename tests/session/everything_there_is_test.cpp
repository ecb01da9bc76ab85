// Whatever an environment holds is where it should be in the model: many bodies, some that are driven, some
// that two hands hold.
#include <cmath>

#include "linked_places.hpp"

namespace tactus::everything_there_is_test {
namespace {

using namespace session_test;

BodyAddition with_friction(BodyAddition addition, double friction) {
    addition.description.material.friction = friction;
    return addition;
}

TEST(EverythingThereIs, APlatformThatIsDrivenIsWhereItIsAtAnyDelay) {
    LinkedPlaces places(0.2, 0.0, 1);
    places.add(ground());
    const SessionHandle platform =
        places.add(body(BoxShape{{0.1, 0.02, 0.1}}, {0.0, 0.3, 0.0}, Motion::Kinematic));
    places.settle();
    places.ticks(500);
    places.far.session.move_body(platform, {{1.0, 0.3, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}, 5.0);
    places.ticks(600);
    double worst = 0.0;
    for (int i = 0; i < 3000; ++i) {
        places.tick();
        worst = std::max(worst, places.apart(1));
    }
    EXPECT_LT(worst, 1e-4);
    EXPECT_GT(places.far.pose(platform).position.x, 0.5);
    places.ticks(3000);
    EXPECT_LT(places.apart(1), 1e-5);
}

TEST(EverythingThereIs, AHundredBodiesOfWhichTwentyMoveAreAllWhereTheyShouldBe) {
    LinkedPlaces places(0.1, 0.2, 1);
    places.add(ground());
    std::vector<SessionHandle> boxes;
    for (int i = 0; i < 100; ++i) {
        BodyAddition there = with_friction(
            body(BoxShape{Vec3(0.03)}, {0.2 * (i % 10), 0.03, 0.2 * (i / 10)}, Motion::Dynamic, 0.3), 0.3);
        BodyAddition here = there;
        here.description.mass = 0.36;
        here.description.material.friction = 0.36;
        boxes.push_back(places.add(there, here));
    }
    places.settle();
    places.ticks(700);
    for (std::size_t i = 0; i < 100; i += 5) {
        const double angle = 0.7 * static_cast<double>(i);
        places.far.session.set_body_velocity(boxes[i], {0.5 * std::cos(angle), 0.0, 0.5 * std::sin(angle)},
                                             Vec3(0.0));
    }
    places.ticks(2000);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        EXPECT_LT(places.apart(i + 1), 1e-3) << i;
    }
    EXPECT_GT(places.statistics().corrections, 0u);
}

TEST(EverythingThereIs, WhereThereIsNoRoomForThePastBodiesAreStillPutRight) {
    LinkedPlaces places(0.1, 0.0, 1, {}, {}, 2);
    places.add(ground());
    std::vector<SessionHandle> boxes;
    for (int i = 0; i < 12; ++i) {
        boxes.push_back(places.add(
            with_friction(body(BoxShape{Vec3(0.03)}, {0.2 * i, 0.03, 0.0}, Motion::Dynamic, 0.3), 0.3)));
    }
    places.settle();
    places.ticks(300);
    for (const SessionHandle box : boxes) {
        places.far.session.set_body_velocity(box, {0.0, 0.0, 0.4}, Vec3(0.0));
    }
    places.ticks(2000);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        EXPECT_GT(places.far.pose(boxes[i]).position.z, 0.01);
        EXPECT_LT(places.apart(i + 1), 1e-4) << i;
    }
    EXPECT_GT(places.statistics().without_past, 0u);
}

TEST(EverythingThereIs, TwoFingersHoldABoxOverTheLink) {
    LinkedPlaces places(0.1, 0.0, 2);
    places.add(ground());
    BodyAddition box = body(BoxShape{Vec3(0.03)}, {0.0, 0.03, 0.0}, Motion::Dynamic, 0.1);
    box.touch_material = {500.0, 0.5, 0.8, 0.7};
    places.add(box);
    places.settle();
    auto& left = places.near.devices[0];
    auto& right = places.near.devices[1];
    const auto put = [&](double gap, double height) {
        left.velocity = (Vec3(-gap, height, 0.0) - left.position) * 1e3;
        right.velocity = (Vec3(gap, height, 0.0) - right.position) * 1e3;
        left.position = {-gap, height, 0.0};
        right.position = {gap, height, 0.0};
        places.tick();
    };
    left.position = {-0.08, 0.03, 0.0};
    right.position = {0.08, 0.03, 0.0};
    places.ticks(300);
    for (int i = 0; i <= 300; ++i) {
        put(0.08 - 0.046 * i / 300.0, 0.03);
    }
    for (int i = 0; i <= 1000; ++i) {
        put(0.034, 0.03 + 0.1 * i / 1000.0);
    }
    double lowest = 1.0, worst = 0.0;
    for (int i = 0; i < 10'000; ++i) {
        put(0.034, 0.13);
        lowest = std::min(lowest, places.near.pose(places.watched[1]).position.y);
        worst = std::max(worst, places.apart(1));
    }
    EXPECT_GT(lowest, 0.11);
    EXPECT_GT(places.far.pose(places.watched[1]).position.y, 0.11);
    EXPECT_LT(worst, 1e-3);
}

TEST(EverythingThereIs, AHandThatIsLostWhileItPressesPressesOnWhenItComesBack) {
    LinkedPlaces places(0.05, 0.0, 1);
    places.add(ground());
    places.add(with_friction(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, 0.3), 0.5));
    places.settle();
    HeldDevice& hand = places.near.devices[0];
    hand.position = {0.0, 0.2, 0.0};
    places.ticks(300);
    for (int i = 1; i <= 200; ++i) {
        hand.position.y = 0.2 - 0.095 * i / 200.0;
        places.tick();
    }
    places.ticks(300);
    const double pressed = places.far.devices[0].force.y;
    ASSERT_GT(pressed, 1.0);
    places.lose_everything(true);
    places.ticks(3000);
    EXPECT_EQ(places.far.devices[0].force, Vec3(0.0));
    places.lose_everything(false);
    places.ticks(1500);
    EXPECT_NEAR(places.far.devices[0].force.y, pressed, 0.05 * pressed);
    EXPECT_NEAR(hand.force.y, pressed, 0.05 * pressed);
}

// The operator's world stands elsewhere, and turned: its hand and bodies are the environment's all the same.
TEST(EverythingThereIs, WorldsMayStandAnywhere) {
    TeleopSettings here, there;
    here.frame = {{3.0, -1.0, 2.0}, glm::angleAxis(0.8, Vec3(0.0, 1.0, 0.0))};
    there.frame = {{-5.0, 0.5, 0.0}, glm::angleAxis(-0.3, Vec3(0.0, 1.0, 0.0))};
    LinkedPlaces places(0.02, 0.0, 1, here, there);
    const auto placed = [](BodyAddition addition, const Pose& frame) {
        addition.description.pose = compose(frame, addition.description.pose);
        return addition;
    };
    const BodyAddition floor = body(BoxShape{{1.0, 0.05, 1.0}}, {0.0, -0.05, 0.0}, Motion::Static);
    const BodyAddition box =
        with_friction(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, 0.3), 0.5);
    places.add(placed(floor, there.frame), placed(floor, here.frame));
    const SessionHandle pushed = places.add(placed(box, there.frame), placed(box, here.frame));
    places.settle();
    HeldDevice& hand = places.near.devices[0];
    const auto put = [&](const Vec3& at) {
        const Vec3 to = to_parent(here.frame, at);
        hand.velocity = (to - hand.position) * 1e3;
        hand.position = to;
        places.tick();
    };
    put({-0.2, 0.05, 0.0});
    for (int i = 0; i <= 600; ++i) {
        put({-0.2 + 0.25 * i / 600.0, 0.05, 0.0});
    }
    for (int i = 0; i < 500; ++i) {
        put({0.05, 0.05, 0.0});
    }
    const Vec3 near = to_local(here.frame, places.near.pose(pushed).position);
    const Vec3 far = to_local(there.frame, places.far.pose(pushed).position);
    EXPECT_GT(far.x, 0.08);
    EXPECT_LT(glm::distance(near, far), 1e-4);
}

}  // namespace
}  // namespace tactus::everything_there_is_test
