// Where the operator's device is not given the force that its hand presses with, the far hand presses hardly
// harder than the operator feels, however that came.
#include <deque>
#include <functional>

#include "linked_tools.hpp"
#include "session/denied_press.hpp"

namespace tactus::denied_press_test {
namespace {

using namespace session_test;

constexpr double smooth_step = 0.51;  // (unit: newtons)
constexpr double no_more = DeniedPress::allowed + 0.15;
constexpr int leaving = 200;  // until a far hand has let go of its force (unit: ticks)
constexpr double radius = 0.01, deep = 0.015, rise = 0.008;  // (unit: meters)

struct Kind {
    const char* name;
    bool tool;
    TeleopSettings settings;
};

std::vector<Kind> kinds() {
    TeleopSettings traditional, deadband;
    traditional.traditional = true;
    deadband.deadband.enabled = true;
    return {{"fingertip", false, {}},
            {"fingertip, deadband", false, deadband},
            {"fingertip, direct", false, traditional},
            {"tool", true, {}},
            {"tool, direct", true, traditional}};
}

// A hand that presses a floor.
class Pressing {
public:
    explicit Pressing(const Kind& kind, double limit = 100.0)
        : is_tool_(kind.tool),
          limit_(limit),
          places_(kind.tool ? std::make_unique<LinkedTools>(0.05, 0.0, kind.settings, kind.settings)
                            : std::make_unique<LinkedPlaces>(0.05, 0.0, 1, kind.settings, kind.settings)) {
        floor_ = places_->add(body(BoxShape{{0.5, 0.05, 0.5}}, {0.0, -0.05, 0.0}, Motion::Static));
        set(false, 0);
        places_->settle();
        hand().can.ramp = 0.5;
        hand().buttons = 1;
        hand().position = {0.0, 0.05, 0.0};
        places_->ticks(800);
        draw({0.0, radius - deep, 0.0}, 300);
        places_->ticks(500);
        pressed_ = far_force();
        past_.assign(kind.settings.traditional ? 52 : 0, pressed_);
        EXPECT_GT(pressed_, 5.0);
    }

    HeldDevice& hand() { return places_->near.devices[0]; }
    LinkedPlaces& places() { return *places_; }
    double far_force() const {
        const SessionSnapshot& there = places_->far.session.snapshot();
        return glm::length(is_tool_ ? there.tools[0].force : there.proxies[0].force);
    }
    double own_force() const { return glm::length(places_->near.devices[0].force); }
    double pressed() const { return pressed_; }  // before anything was denied (unit: newtons)
    void set(bool clutch, std::uint32_t dead_man) {
        Workspace workspace;
        workspace.force_limit = limit_;
        workspace.clutch = clutch;
        workspace.dead_man = dead_man;
        places_->near.session.set_workspace(0, workspace);
    }
    void raise_far_floor(double by) {
        Pose raised;
        raised.position.y = -0.05 + by;
        places_->far.session.move_body(floor_, raised, 0.02);
    }
    void draw(const Vec3& to, int count) {
        const Vec3 from = hand().position;
        for (int i = 1; i <= count; ++i) {
            hand().position = from + (to - from) * (static_cast<double>(i) / count);
            hand().velocity = (to - from) * (1e3 / count);
            places_->tick();
        }
        hand().velocity = Vec3(0.0);
    }

    struct Seen {
        // Of the far force over the operator's, which feels it one delay later without a model, once it had
        // the time to fall (unit: newtons).
        double excess = 0.0;
        double step = 0.0;  // of the far force, in a tick (unit: newtons)
    };
    Seen watch(int count, int grace = leaving) {
        Seen seen;
        double before = far_force();
        for (int i = 0; i < count; ++i) {
            places_->tick();
            seen.step = std::max(seen.step, std::abs(far_force() - before));
            before = far_force();
            past_.push_back(before);
            seen.excess = std::max(seen.excess, i < grace ? 0.0 : past_.front() - own_force());
            past_.pop_front();
        }
        return seen;
    }

private:
    bool is_tool_;
    double limit_;
    std::deque<double> past_;  // far forces, as old as what the operator feels (unit: newtons)
    std::unique_ptr<LinkedPlaces> places_;
    SessionHandle floor_ = no_handle;
    double pressed_ = 0.0;
};

void for_each_kind(const std::function<void(const Kind&)>& run) {
    for (const Kind& kind : kinds()) {
        SCOPED_TRACE(kind.name);
        run(kind);
    }
}

// The device gives no force for a while, and then a force that grows: so does the far hand.
void expect_as_the_device(const std::function<void(Pressing&, bool)>& deny) {
    for_each_kind([&](const Kind& kind) {
        Pressing places(kind);
        deny(places, true);
        const Pressing::Seen away = places.watch(800);
        EXPECT_EQ(places.own_force(), 0.0);
        EXPECT_LE(away.excess, no_more);
        EXPECT_LE(away.step, smooth_step);
        deny(places, false);
        const Pressing::Seen back = places.watch(1500, 0);
        EXPECT_LE(back.excess, no_more);
        EXPECT_LE(back.step, smooth_step);
        EXPECT_NEAR(places.far_force(), places.pressed(), 0.02 * places.pressed());
        EXPECT_NEAR(places.own_force(), places.pressed(), 0.02 * places.pressed());
    });
}

TEST(DeniedPress, ADeadManButtonThatIsLetGo) {
    expect_as_the_device([](Pressing& places, bool denied) {
        places.set(false, 1);
        places.hand().buttons = denied ? 0 : 1;
    });
}

TEST(DeniedPress, AClutchThatIsHeld) {
    expect_as_the_device([](Pressing& places, bool denied) { places.set(denied, 0); });
}

// The device repeats its position though its velocity says that the hand moves.
TEST(DeniedPress, ADeviceThatIsFrozen) {
    expect_as_the_device([](Pressing& places, bool denied) {
        places.hand().can.feels = true;
        places.hand().velocity = denied ? Vec3(0.1, 0.0, 0.0) : Vec3(0.0);
    });
}

// The far floor rises under the hand, and the correction hides most of what the hand would feel.
TEST(DeniedPress, AForceThatIsHidden) {
    for (const bool tool : {false, true}) {
        SCOPED_TRACE(tool ? "tool" : "fingertip");
        Pressing places({"", tool, {}});
        places.raise_far_floor(rise);
        places.watch(300);
        EXPECT_GT(places.far_force(), 0.95 * places.pressed() * (deep + rise) / deep) << "not for long yet";
        places.watch(400);
        EXPECT_LE(places.watch(100, 0).excess, no_more);
        EXPECT_LT(places.own_force(), 0.95 * places.pressed() * (deep + rise) / deep) << "it is hidden";
        EXPECT_LE(places.watch(3000, 0).excess, no_more);
        EXPECT_NEAR(places.own_force(), places.pressed() * (deep + rise) / deep, 0.1);
        EXPECT_NEAR(places.far_force(), places.own_force(), 0.1);
    }
}

// A hand may press harder than its device can display, here as there.
TEST(DeniedPress, TheLargestForceOfADeviceDeniesNothing) {
    for_each_kind([&](const Kind& kind) {
        Pressing places(kind, 2.0);
        EXPECT_NEAR(places.own_force(), 2.0, 1e-6);
        EXPECT_GT(places.far_force(), 7.0);
    });
}

TEST(DeniedPress, ADeviceWithoutForceDeniesNothing) {
    for_each_kind([&](const Kind& kind) {
        Pressing places(kind);
        places.hand().can.max_force = 0.0;
        places.watch(800);
        EXPECT_EQ(places.own_force(), 0.0);
        EXPECT_NEAR(places.far_force(), places.pressed(), 1e-3);
    });
}

// The hand goes into a wall at 1 m/s: its device is given the force in the same tick.
TEST(DeniedPress, AnImpactDeniesNothing) {
    for_each_kind([&](const Kind& kind) {
        Pressing places(kind);
        places.draw({0.0, 0.05, 0.0}, 50);
        places.places().ticks(500);
        double most = 0.0;
        places.draw({0.0, radius - deep, 0.0}, 55);
        for (int i = 0; i < 200; ++i) {
            places.places().tick();
            most = std::max(most, places.far_force());
        }
        EXPECT_NEAR(most, places.pressed(), 0.05 * places.pressed());
    });
}

}  // namespace
}  // namespace tactus::denied_press_test
