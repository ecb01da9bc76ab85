// The far hand when the operator's is guessed, lost, gone, or back: it touches nothing that the operator does
// not touch, and no force of it changes by a step.
#include <algorithm>
#include <functional>
#include <numbers>

#include "linked_tools.hpp"

namespace tactus::far_presence_test {
namespace {

using namespace session_test;

constexpr double smooth_step = 0.51;  // (unit: newtons)
constexpr double no_touch = 1e-3;     // a tool that rests where it has come to (unit: newtons)

TeleopSettings with_deadband() {
    TeleopSettings settings;
    settings.deadband.enabled = true;
    return settings;
}

TeleopSettings traditional() {
    TeleopSettings settings;
    settings.traditional = true;
    return settings;
}

// What the far hand does in some ticks.
struct Watched {
    double largest_force = 0.0;  // (unit: newtons)
    double largest_step = 0.0;   // of it, in a tick (unit: newtons)
    int touches = 0;             // times that it has begun to touch

    Watched and_then(const Watched& later) const {
        return {std::max(largest_force, later.largest_force), std::max(largest_step, later.largest_step),
                touches + later.touches};
    }
};

class Watch {
public:
    explicit Watch(LinkedPlaces& places, bool tool = false) : places_(places), tool_(tool) {
        before_ = force();
    }
    Watched ticks(int count) {
        Watched seen;
        for (int i = 0; i < count; ++i) {
            places_.tick();
            const double now = force();
            seen.largest_force = std::max(seen.largest_force, now);
            seen.largest_step = std::max(seen.largest_step, std::abs(now - before_));
            seen.touches += before_ <= no_touch && now > no_touch ? 1 : 0;
            before_ = now;
        }
        return seen;
    }
    double force() const {
        const SessionSnapshot& there = places_.far.session.snapshot();
        return glm::length(tool_ ? there.tools[0].force : there.proxies[0].force);
    }

private:
    LinkedPlaces& places_;
    bool tool_;
    double before_ = 0.0;
};

// --- a deadband and losses

// The hand goes down at 0.7 m/s and stops 40 mm above the floor, again and again.
void expect_no_touch(LinkedPlaces& places, HeldDevice& hand, bool tool, int stops,
                     const std::function<void(int)>& at_tick) {
    constexpr double low = 0.04, high = 0.18, speed = 0.7;
    constexpr int travel = static_cast<int>(1e3 * (high - low) / speed), rest = 300;
    Watch watch(places, tool);
    Watched all;
    int tick = 0;
    for (int stop = 0; stop < stops; ++stop) {
        for (int i = 0; i < 2 * (travel + rest); ++i) {
            const int phase = i % (travel + rest);
            const double down = i < travel + rest ? 1.0 : -1.0;
            const double gone = std::min(1.0, static_cast<double>(phase) / travel);
            hand.position = {0.0, down > 0.0 ? high - gone * (high - low) : low + gone * (high - low), 0.0};
            hand.velocity = {0.0, phase < travel ? -down * speed : 0.0, 0.0};
            at_tick(tick++);
            all = all.and_then(watch.ticks(1));
        }
    }
    EXPECT_EQ(all.touches, 0);
    EXPECT_LE(all.largest_force, tool ? no_touch : 0.0);
}

TEST(FarPresence, AGuessOfTheFingertipTouchesNothing) {
    for (const double loss : {0.1, 0.5}) {
        LinkedPlaces places(0.05, loss, 1, with_deadband(), with_deadband());
        places.add(ground());
        places.settle();
        places.near.devices[0].position = {0.0, 0.18, 0.0};
        places.ticks(500);
        SCOPED_TRACE(loss);
        expect_no_touch(places, places.near.devices[0], false, 10, [](int) {});
    }
}

TEST(FarPresence, AnOutageDuringAStopTouchesNothing) {
    for (const int outage : {50, 300, 2000}) {
        LinkedPlaces places(0.05, 0.0, 1, with_deadband(), with_deadband());
        places.add(ground());
        places.settle();
        places.near.devices[0].position = {0.0, 0.18, 0.0};
        places.ticks(500);
        SCOPED_TRACE(outage);
        expect_no_touch(places, places.near.devices[0], false, 6,
                        [&](int tick) { places.lose_everything(tick >= 1150 && tick < 1150 + outage); });
    }
}

TEST(FarPresence, AGuessOfAToolTouchesNothing) {
    LinkedTools places(0.05, 0.3, with_deadband(), with_deadband());
    places.add(floor_of(0.5));
    places.settle();
    put(places.hand(), {0.0, 0.18, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
    places.ticks(500);
    expect_no_touch(places, places.hand(), true, 6, [](int) {});
}

// A stop is repeated only until it is known there, and then hardly anything is said.
TEST(FarPresence, AHandThatStandsSaysLittle) {
    LinkedPlaces places(0.05, 0.0, 1, with_deadband(), with_deadband());
    places.settle();
    places.near.devices[0].position = {0.0, 0.2, 0.0};
    places.ticks(1000);
    const std::uint64_t before = places.statistics().link.packets_sent;
    places.ticks(2000);
    EXPECT_LT(places.statistics().link.packets_sent - before, 2u * 45u);
}

// --- absence

struct Pressing : LinkedPlaces {
    explicit Pressing(const TeleopSettings& settings, double delay = 0.05)
        : LinkedPlaces(delay, 0.0, 1, settings, settings) {
        add(ground());
        settle();
        near.devices[0].position = {0.0, 0.1, 0.0};
        ticks(300);
        draw({0.0, 0.0, 0.0}, 300);
        ticks(500);
        EXPECT_NEAR(glm::length(far.session.snapshot().proxies[0].force), 5.0, 0.1);
    }
    void draw(const Vec3& to, int count) {
        draw(to, count, [this] { tick(); });
    }
    Watched draw(const Vec3& to, int count, Watch& watch) {
        Watched all;
        draw(to, count, [&] { all = all.and_then(watch.ticks(1)); });
        return all;
    }
    void draw(const Vec3& to, int count, const std::function<void()>& tick_once) {
        HeldDevice& hand = near.devices[0];
        const Vec3 from = hand.position;
        for (int i = 1; i <= count; ++i) {
            hand.position = from + (to - from) * (static_cast<double>(i) / count);
            hand.velocity = (to - from) * (1e3 / count);
            tick_once();
        }
        hand.velocity = Vec3(0.0);
    }
    ProxyDescription pointer(bool enabled) const {
        ProxyDescription description;
        description.device = 0;
        description.enabled = enabled;
        return description;
    }
};

TEST(FarPresence, APointerThatIsSwitchedOffLeavesGentlyAndComesBackGently) {
    for (const TeleopSettings& settings : {TeleopSettings{}, traditional(), with_deadband()}) {
        SCOPED_TRACE(settings.traditional ? "traditional" : settings.deadband.enabled ? "deadband" : "model");
        Pressing places(settings);
        Watch watch(places);
        places.near.session.set_proxy(0, places.pointer(false));
        const Watched leaves = watch.ticks(500);
        EXPECT_EQ(watch.force(), 0.0);
        EXPECT_LE(leaves.largest_step, smooth_step);
        EXPECT_EQ(glm::length(places.near.devices[0].force), 0.0);
        EXPECT_GT(places.far.session.snapshot().proxies[0].position.y, 0.0) << "it stays where it was";
        places.near.devices[0].position = {0.0, 0.1, 0.0};
        places.near.session.set_proxy(0, places.pointer(true));
        places.ticks(500);
        const Watched back = places.draw({0.0, 0.0, 0.0}, 300, watch).and_then(watch.ticks(500));
        EXPECT_LE(back.largest_step, smooth_step);
        EXPECT_NEAR(watch.force(), 5.0, 0.1);
    }
}

// A hand that is switched on elsewhere begins there: the far one is not led there through what is between.
TEST(FarPresence, APointerThatIsSwitchedOnElsewhereIsNotLedThere) {
    for (const TeleopSettings& settings : {TeleopSettings{}, with_deadband()}) {
        LinkedPlaces places(0.05, 0.0, 1, settings, settings);
        places.add(body(BoxShape{{0.01, 0.5, 0.5}}, Vec3(0.0), Motion::Static));
        places.settle();
        HeldDevice& hand = places.near.devices[0];
        hand.position = {-0.2, 0.0, 0.0};
        places.ticks(500);
        ProxyDescription pointer;
        pointer.device = 0;
        pointer.enabled = false;
        places.near.session.set_proxy(0, pointer);
        places.ticks(500);
        hand.position = {0.2, 0.0, 0.0};
        pointer.enabled = true;
        places.near.session.set_proxy(0, pointer);
        Watch watch(places);
        EXPECT_EQ(watch.ticks(1000).largest_force, 0.0);
        EXPECT_LT(glm::distance(places.far.session.snapshot().proxies[0].position, hand.position), 1e-3);
    }
}

// The model's hand begins inside a body, where it was free before it was switched off, and feels nothing.
TEST(FarPresence, APointerThatIsSwitchedOnInsideABodyPressesNothingThere) {
    for (const TeleopSettings& settings : {TeleopSettings{}, with_deadband()}) {
        Pressing places(settings);
        places.draw({0.0, 0.1, 0.0}, 300);
        places.near.session.set_proxy(0, places.pointer(false));
        places.ticks(500);
        places.near.devices[0].position = {0.0, -0.01, 0.0};
        places.near.session.set_proxy(0, places.pointer(true));
        Watch watch(places);
        EXPECT_EQ(watch.ticks(1000).largest_force, 0.0);
        EXPECT_EQ(glm::length(places.near.devices[0].force), 0.0);
    }
}

TEST(FarPresence, AToolThatComesBackElsewhereIsNotLedThere) {
    LinkedTools places(0.05);
    places.add(body(BoxShape{{0.01, 0.5, 0.5}}, {0.0, 0.5, 0.0}, Motion::Static));
    places.settle();
    put(places.hand(), {-0.3, 0.5, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
    places.ticks(500);
    places.near.devices[0].connected = false;
    places.ticks(500);
    put(places.hand(), {0.3, 0.5, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
    places.near.devices[0].connected = true;
    Watch watch(places, true);
    EXPECT_EQ(watch.ticks(1000).largest_force, 0.0);
    EXPECT_LT(glm::distance(places.far.session.snapshot().tools[0].pose.position, places.hand().position),
              0.05);
}

TEST(FarPresence, APointerThatIsFreedLeavesGently) {
    for (const TeleopSettings& settings : {TeleopSettings{}, traditional(), with_deadband()}) {
        Pressing places(settings);
        Watch watch(places);
        places.near.session.remove_proxy(0);
        const Watched leaves = watch.ticks(500);
        EXPECT_EQ(watch.force(), 0.0);
        EXPECT_LE(leaves.largest_step, smooth_step);
    }
}

// A tool that presses onto the floor of the far side.
struct PressingTool : LinkedTools {
    PressingTool() : LinkedTools(0.05) {
        add(floor_of(0.5));
        settle();
        put(hand(), {0.0, 0.1, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
        ticks(300);
        for (int i = 0; i < 300; ++i) {
            put(hand(), {0.0, 0.1 - 1e-3 * 0.33 * i, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
            tick();
        }
        ticks(500);
    }
};

TEST(FarPresence, AToolThatIsFreedLeavesGently) {
    PressingTool places;
    Watch watch(places, true);
    ASSERT_GT(watch.force(), 1.0);
    places.near.session.remove_tool(0);
    const Watched leaves = watch.ticks(500);
    EXPECT_EQ(watch.force(), 0.0);
    EXPECT_LE(leaves.largest_step, smooth_step);
}

// Its process is stopped, and goes on with all that was sent meanwhile: the hand is let go, and is not led
// late along where the operator's was.
TEST(FarPresence, AFarSideThatStoodStillFollowsTheHandAtOnce) {
    for (const TeleopSettings& settings : {TeleopSettings{}, traditional(), with_deadband()}) {
        SCOPED_TRACE(settings.traditional ? "traditional" : settings.deadband.enabled ? "deadband" : "model");
        Pressing places(settings);
        places.draw({0.1, 0.1, 0.0}, 1500, [&] {
            places.now += period;
            places.near.session.tick(places.now);
            places.near.session.refresh();
            places.near.session.collect();
        });
        const auto lag = [&] {
            return glm::distance(places.far.session.snapshot().proxies[0].position,
                                 places.near.devices[0].position);
        };
        Watch watch(places);
        const Watched back = watch.ticks(200);
        EXPECT_LE(back.largest_force, 5.1);
        EXPECT_EQ(watch.force(), 0.0);
        places.draw({-0.1, 0.1, 0.0}, 500);
        EXPECT_LT(lag(), 0.4 * 0.1) << "the hand goes 0.4 m in a second";
        places.ticks(100);
        EXPECT_LT(lag(), 1e-3);
    }
}

// A hand on the left of a post, in both scenes.
struct BesidePost : LinkedPlaces {
    explicit BesidePost(const TeleopSettings& settings) : LinkedPlaces(0.05, 0.0, 1, settings, settings) {
        add(body(BoxShape{{0.01, 0.05, 0.5}}, Vec3(0.0), Motion::Static));
        settle();
        near.devices[0].position = {-0.1, 0.0, 0.0};
        ticks(500);
    }
};

// While nothing gets through, the hand goes around a body: the far one neither goes through it nor presses.
TEST(FarPresence, AnOutageWhileTheHandGoesAroundABodyTouchesNothing) {
    for (const int outage : {100, 300, 500, 900}) {
        for (const TeleopSettings& settings : {TeleopSettings{}, with_deadband()}) {
            SCOPED_TRACE(std::to_string(outage) + (settings.deadband.enabled ? " ms, deadband" : " ms"));
            BesidePost places(settings);
            HeldDevice& hand = places.near.devices[0];
            Watch watch(places);
            Watched all;
            for (int i = 0; i <= 400; ++i) {
                const double angle = std::numbers::pi * i / 400.0;
                const double speed = std::numbers::pi / 0.4 * 0.1;
                hand.position = {-0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.0};
                hand.velocity = i < 400 ? speed * Vec3(std::sin(angle), std::cos(angle), 0.0) : Vec3(0.0);
                places.lose_everything(i >= 50 && i < 50 + outage);
                all = all.and_then(watch.ticks(1));
            }
            for (int i = 401; i < 2400; ++i) {
                places.lose_everything(i < 50 + outage);
                all = all.and_then(watch.ticks(1));
            }
            EXPECT_EQ(all.largest_force, 0.0);
            EXPECT_LT(glm::distance(places.far.session.snapshot().proxies[0].position, hand.position), 1e-3);
        }
    }
}

// Where the operator presses on the other side: what is in the way feels no more than that.
TEST(FarPresence, AnOutageAfterWhichTheHandPressesElsewherePressesNoHarder) {
    for (const TeleopSettings& settings : {TeleopSettings{}, with_deadband()}) {
        SCOPED_TRACE(settings.deadband.enabled ? "deadband" : "model");
        BesidePost places(settings);
        HeldDevice& hand = places.near.devices[0];
        Watch watch(places);
        const auto go = [&](const Vec3& to) {
            const Vec3 from = hand.position;
            for (int i = 1; i <= 100; ++i) {
                hand.position = from + (to - from) * (i / 100.0);
                hand.velocity = (to - from) * 10.0;
                places.tick();
            }
            hand.velocity = Vec3(0.0);
        };
        places.lose_everything(true);
        go({-0.1, 0.1, 0.0});
        go({0.1, 0.1, 0.0});
        go({0.1, 0.0, 0.0});
        go({0.016, 0.0, 0.0});
        places.ticks(100);
        places.lose_everything(false);
        const Watched after = watch.ticks(2000);
        const double own = glm::length(places.near.devices[0].force);
        EXPECT_NEAR(own, 2.0, 0.1);
        EXPECT_LE(after.largest_force, own + 1.0);
        EXPECT_LE(after.largest_step, smooth_step);
    }
}

// While no hand is played no sample is answered: that asks for no longer history.
TEST(FarPresence, NoAnswerIsLateWhileNoHandIsPlayed) {
    for (const bool at_operator : {true, false}) {
        Pressing places({});
        LinkedPlaces::Place& place = at_operator ? places.near : places.far;
        place.session.set_proxy(0, places.pointer(false));
        places.ticks(2000);
        EXPECT_LT(places.statistics().round_trip, 0.1);
    }
}

// The far side's own pointer is taken away under the hand, and another one is added: it begins where the
// first was, not inside what that pressed.
TEST(FarPresence, AFarPointerThatIsAddedAgainComesBackFromWhereItWas) {
    for (const TeleopSettings& settings : {TeleopSettings{}, traditional(), with_deadband()}) {
        SCOPED_TRACE(settings.traditional ? "traditional" : settings.deadband.enabled ? "deadband" : "model");
        Pressing places(settings);
        places.far.session.remove_proxy(0);
        places.ticks(300);
        EXPECT_EQ(places.far.session.add_proxy(places.pointer(true)).error, "");
        places.tick();
        Watch watch(places);
        const Watched back = watch.ticks(2000);
        EXPECT_LE(back.largest_step, smooth_step);
        EXPECT_NEAR(watch.force(), 5.0, 0.1);
        EXPECT_GT(places.far.session.snapshot().proxies[0].position.y, 0.0);
    }
}

// It is added again elsewhere than a hand that has left meanwhile is.
TEST(FarPresence, AFarPointerThatIsAddedLaterIsWhereTheHandIs) {
    Pressing places({});
    places.far.session.remove_proxy(0);
    places.ticks(300);
    places.draw({0.2, 0.1, 0.0}, 300);
    EXPECT_EQ(places.far.session.add_proxy(places.pointer(true)).error, "");
    places.ticks(1000);
    EXPECT_LT(glm::distance(places.far.session.snapshot().proxies[0].position, Vec3(0.2, 0.1, 0.0)), 1e-3);
}

// The operator's tool is held back meanwhile, begins inside the floor then and feels nothing.
TEST(FarPresence, AFarToolThatIsAddedAgainPressesNoMoreThanTheOperator) {
    PressingTool places;
    Watch watch(places, true);
    const double before = watch.force();
    ASSERT_GT(before, 1.0);
    places.far.session.remove_tool(0);
    places.ticks(300);
    EXPECT_EQ(places.far.session.add_tool(bar(), held_by(0)).error, "");
    double most = 0.0;
    for (int i = 0; i < 2000; ++i) {
        places.tick();
        most = std::max(most, glm::length(places.theirs().force) - glm::length(places.ours().force));
    }
    EXPECT_LT(most, 0.5);
    // Once it is out, it is as ever.
    for (int i = 300; i > 0; --i) {
        put(places.hand(), {0.0, 0.1 - 1e-3 * 0.33 * i, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
        places.tick();
    }
    for (int i = 0; i < 300; ++i) {
        put(places.hand(), {0.0, 0.1 - 1e-3 * 0.33 * i, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
        places.tick();
    }
    places.ticks(500);
    EXPECT_NEAR(glm::length(places.theirs().force), before, 0.05 * before);
}

// The model's hand begins inside a body and feels nothing: nor does the far one press.
TEST(FarPresence, WhoBeginsInsideABodyPressesNothingThere) {
    Pressing places({});
    Watch watch(places);
    places.near.session.set_proxy(0, places.pointer(false));
    places.ticks(500);
    places.near.session.set_proxy(0, places.pointer(true));
    const Watched back = watch.ticks(1000);
    EXPECT_EQ(glm::length(places.near.devices[0].force), 0.0);
    EXPECT_EQ(back.largest_force, 0.0);
    // Once it is out, it is as ever.
    places.draw({0.0, 0.1, 0.0}, 300);
    places.draw({0.0, 0.0, 0.0}, 300);
    places.ticks(300);
    EXPECT_NEAR(watch.force(), 5.0, 0.1);
}

TEST(FarPresence, ALineThatComesBackIsPressedWithGradually) {
    for (const TeleopSettings& settings : {TeleopSettings{}, traditional(), with_deadband()}) {
        Pressing places(settings);
        Watch watch(places);
        places.lose_everything(true);
        const Watched lost = watch.ticks(2000);
        EXPECT_LE(lost.largest_step, smooth_step);
        places.lose_everything(false);
        const Watched back = watch.ticks(2000);
        EXPECT_LE(back.largest_step, smooth_step);
        EXPECT_NEAR(watch.force(), 5.0, 0.1);
    }
}

// --- a way back that touches nothing

void expect_same_side(const TeleopSettings& settings, const BodyAddition& wall, const Vec3& from,
                      const Vec3& to, const Vec3& tip) {
    LinkedPlaces places(0.05, 0.0, 1, settings, settings);
    places.add(wall);
    places.settle();
    HeldDevice& hand = places.near.devices[0];
    hand.position = from;
    places.ticks(1000);
    places.lose_everything(true);
    for (int i = 1; i <= 1500; ++i) {
        hand.position = from + (to - from) * std::min(1.0, i / 1000.0);
        places.tick();
        if (i == 1400) {
            const ProxyState& lost = places.far.session.snapshot().proxies[0];
            EXPECT_LT(glm::distance(lost.position, from), 0.01);
            EXPECT_NE(lost.status & far_hand_away, 0u);
        }
    }
    places.lose_everything(false);
    places.ticks(2000);
    const Vec3 there = places.far.session.snapshot().proxies[0].position;
    EXPECT_LT(glm::distance(there, tip), 1e-3) << there.x << " " << there.y;
    if (!settings.traditional) {
        EXPECT_LT(glm::distance(places.near.session.snapshot().proxies[0].position, tip), 1e-3);
    }
}

BodyAddition wall(const Vec3& half) {
    return body(BoxShape{half}, Vec3(0.0), Motion::Static);
}

TEST(FarPresence, AfterADeadLineTheTipIsOnTheSameSideOfAWall) {
    for (const TeleopSettings& settings : {TeleopSettings{}, traditional(), with_deadband()}) {
        expect_same_side(settings, wall({0.01, 0.5, 0.5}), {-0.2, 0.0, 0.0}, {0.04, 0.0, 0.0},
                         {-0.02, 0.0, 0.0});
        expect_same_side(settings, wall({0.5, 0.005, 0.5}), {0.0, 0.2, 0.0}, {0.0, -0.03, 0.0},
                         {0.0, 0.015, 0.0});
    }
}

// A hand that is free at the operator has gone around.
TEST(FarPresence, AfterADeadLineAHandThatHasGoneAroundIsThere) {
    LinkedPlaces places(0.05, 0.0, 1);
    places.add(wall({0.01, 0.5, 0.5}));
    places.settle();
    HeldDevice& hand = places.near.devices[0];
    hand.position = {-0.2, 0.0, 0.0};
    places.ticks(1000);
    places.lose_everything(true);
    const auto draw = [&](const Vec3& to) {
        const Vec3 from = hand.position;
        for (int i = 1; i <= 500; ++i) {
            hand.position = from + (to - from) * (i / 500.0);
            places.tick();
        }
    };
    draw({-0.2, 0.6, 0.0});
    draw({0.2, 0.6, 0.0});
    draw({0.2, 0.0, 0.0});
    Watch watch(places);
    places.lose_everything(false);
    const Watched back = watch.ticks(1000);
    EXPECT_EQ(back.largest_force, 0.0);
    EXPECT_LT(glm::distance(places.far.session.snapshot().proxies[0].position, hand.position), 1e-3);
}

// The far side is there first when the operator presses its model already, as after a restart.
TEST(FarPresence, AHandThatIsHeardFirstWhileItPressesPushesNothing) {
    for (const TeleopSettings& settings : {TeleopSettings{}, traditional(), with_deadband()}) {
        SCOPED_TRACE(settings.traditional ? "traditional" : settings.deadband.enabled ? "deadband" : "model");
        LinkedPlaces places(0.05, 0.0, 1, settings, settings);
        places.add(ground());
        const SessionHandle box =
            places.add(body(BoxShape{Vec3(0.075)}, {0.0, 0.075, 0.25}, Motion::Dynamic, 0.3));
        places.settle();
        places.lose_everything(true);
        HeldDevice& hand = places.near.devices[0];
        for (int i = 0; i <= 500; ++i) {
            hand.position = {0.0, 0.3 - 0.17 * i / 500.0, 0.25};
            places.tick();
        }
        const Vec3 before = places.far.pose(box).position;
        Watch watch(places);
        places.lose_everything(false);
        const Watched heard = watch.ticks(1000);
        EXPECT_EQ(heard.largest_force, 0.0);
        EXPECT_LT(glm::distance(places.far.pose(box).position, before), 1e-4);
    }
}

}  // namespace
}  // namespace tactus::far_presence_test
