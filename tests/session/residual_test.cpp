// What acts on a far body besides the operator, and is not described, is felt: another operator's hand, a
// spring to the world, a hidden wall, a draft.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>

#include "linked_places.hpp"
#include "session/shared_environment.hpp"
#include "session/teleoperator_side.hpp"

namespace tactus::residual_test {
namespace {

using namespace session_test;

constexpr double half_box = 0.025;  // (unit: meters)
constexpr double deep = 0.005;      // a hand goes so much beyond a surface (unit: meters)

BodyAddition slippery_floor() {
    BodyAddition floor = ground();
    floor.description.material.friction = 0.2;
    return floor;
}
BodyAddition small_box() {
    BodyAddition box = body(BoxShape{Vec3(half_box)}, {0.0, half_box, 0.0}, Motion::Dynamic, 0.3);
    box.description.material.friction = 0.2;
    return box;
}

struct Held {
    double felt = 0.0, far = 0.0;  // at the end (unit: newtons)
    double apart = 0.0;            // the boxes (unit: meters)
    double step = 0.0;             // largest unexplained one of the force (unit: newtons)
    double gone = 0.0;             // the model's box beyond where the far one has been (unit: meters)
};

// The force that acts on the far box alone, of its position and velocity.
using Acts = std::function<Vec3(const Vec3&, const Vec3&)>;

struct Pressing {
    Pressing(double delay, const Acts& what_acts, const TeleopSettings& settings = {})
        : places(delay, 0.0, 1, settings, settings), acts(what_acts) {
        places.add(slippery_floor());
        held = places.add(small_box());
        places.settle();
        hand().position = {0.08, half_box, 0.0};
        before = places.far.pose(held).position;
    }
    HeldDevice& hand() { return places.near.devices[0]; }
    void ticks(int count) {
        for (int i = 0; i < count; ++i) {
            const Vec3 at = places.far.pose(held).position;
            const Vec3 force = acts ? acts(at, (at - before) / 1e-3) : Vec3(0.0);
            before = at;
            places.far.session.set_body_push(held, force, Vec3(0.0));
            places.tick();
            least = std::min({least, places.near.pose(held).position.x, at.x});
            most = std::max(most, places.near.pose(held).position.x);
            far_most = std::max(far_most, at.x);
        }
    }
    void go(double x, int count) {
        const double from = hand().position.x;
        for (int i = 1; i <= count; ++i) {
            hand().position.x = from + (x - from) * i / count;
            hand().velocity.x = (x - from) / (1e-3 * count);
            ticks(1);
        }
        hand().velocity.x = 0.0;
    }
    Held figures() {
        return {glm::length(hand().force), glm::length(places.far.session.snapshot().proxies[0].force),
                places.apart(1), places.statistics().largest_unexplained_step, most - far_most};
    }

    LinkedPlaces places;
    Acts acts;
    SessionHandle held = no_handle;
    Vec3 before{0.0};
    double least = 0.0, most = 0.0, far_most = 0.0;
};

// The hand comes from +x, and stops `deep` beyond where the box stands.
Held press(double delay, const Acts& acts, double depth = deep, const TeleopSettings& settings = {}) {
    Pressing pressing(delay, acts, settings);
    pressing.ticks(500);
    pressing.go(half_box + 0.01 - depth, 300);
    pressing.ticks(static_cast<int>(1e3 * delay) + 500);
    return pressing.figures();
}

Acts spring(double stiffness) {
    return [=](const Vec3& at, const Vec3& velocity) {
        return Vec3(-stiffness * at.x - 5.0 * velocity.x, 0.0, 0.0);
    };
}
// It does not pull.
Acts hidden_wall(double stiffness) {
    return [=](const Vec3& at, const Vec3& velocity) {
        return Vec3(std::max(0.0, at.x < 0.0 ? -stiffness * at.x - 5.0 * velocity.x : 0.0), 0.0, 0.0);
    };
}

void expect_felt(const Held& held, double least) {
    EXPECT_GT(held.far, least);
    EXPECT_NEAR(held.felt, held.far, 0.1 * held.far);
    EXPECT_LT(held.apart, 2e-3);
    EXPECT_LE(held.step, 0.5 + 1e-9);
}

constexpr double delays[] = {0.0, 0.01, 0.05, 0.1, 0.2};

TEST(Residual, ASpringThatHoldsTheFarBodyIsFelt) {
    for (const double delay : delays) {
        SCOPED_TRACE(delay);
        expect_felt(press(delay, spring(1000.0), 0.015), 3.0);
    }
}

TEST(Residual, AHiddenWallIsFelt) {
    for (const double delay : delays) {
        SCOPED_TRACE(delay);
        expect_felt(press(delay, hidden_wall(1e4)), 2.0);
    }
}

// It holds the box against friction and the hand.
TEST(Residual, ADraftIsFelt) {
    for (const double delay : {0.0, 0.01, 0.05}) {
        SCOPED_TRACE(delay);
        Pressing pressing(delay, nullptr);
        pressing.ticks(300);
        pressing.go(half_box + 0.012, 200);
        pressing.acts = [](const Vec3&, const Vec3&) { return Vec3(3.0, 0.0, 0.0); };
        pressing.ticks(static_cast<int>(1e3 * delay) + 700);
        expect_felt(pressing.figures(), 1.5);
    }
}

// A support that is let go does not push the model's box after the hand.
TEST(Residual, GivesNothingToABodyThatIsLetGo) {
    for (const double delay : delays) {
        SCOPED_TRACE(delay);
        Pressing pressing(delay, hidden_wall(1e4));
        pressing.ticks(300);
        pressing.go(half_box + 0.01 - deep, 300);
        pressing.ticks(500);
        pressing.go(0.08, 100);
        pressing.ticks(1000);
        const Held held = pressing.figures();
        EXPECT_LT(held.gone, 2e-3);
        EXPECT_LT(held.apart, 1e-4);
        EXPECT_EQ(held.felt, 0.0);
    }
}

TEST(Residual, WhereNothingElseActsThereIsNone) {
    for (const double delay : delays) {
        TeleopSettings without;
        without.residual.gain = 0.0;
        const Held held = press(delay, nullptr, 0.02), as_before = press(delay, nullptr, 0.02, without);
        EXPECT_EQ(held.felt, as_before.felt) << delay;
        EXPECT_EQ(held.gone, as_before.gone) << delay;
    }
}

// --- two operators

struct Squeezing {
    explicit Squeezing(double delay) : wires{EmulatedWire(delay), EmulatedWire(delay)} {
        std::vector<std::unique_ptr<TeleopSide>> sides;
        for (std::size_t i = 0; i < 2; ++i) {
            Place& place = near[i];
            sides.push_back(std::make_unique<TeleoperatorSide>(
                LinkedPlaces::session_settings(), TeleopSettings{}, wires[i].far(), far_ports[i],
                endpoint(Side::teleoperator_side, 100 + i), PointerShare{i, 2}));
            place.session.attach(
                {{{SidePlan::Kind::operator_side, {}, endpoint(Side::operator_side, 1 + i), {}, {}},
                  &wires[i].near(),
                  place.port}});
        }
        far.attach(std::make_unique<SharedEnvironment>(std::move(sides)));
        for (std::size_t i = 0; i < 2; ++i) {
            add_hand(far, far_hands[i]);
            add_hand(near[i].session, near[i].hand);
        }
        for (const BodyAddition& addition : {slippery_floor(), small_box()}) {
            box = far.add_body(addition).handle;
            for (Place& place : near) {
                EXPECT_EQ(place.session.add_body(addition).handle, box);
                place.port->bindings.try_push({box, box});
            }
        }
    }
    static void add_hand(Session& session, HeldDevice& hand) {
        Workspace workspace;
        workspace.force_limit = 100.0;
        ProxyDescription pointer;
        pointer.device = session.add_device(hand, workspace).handle;
        session.add_proxy(pointer);
    }
    void hold(double x) {
        near[0].hand.position = {x, half_box, 0.0};
        near[1].hand.position = {-x, half_box, 0.0};
    }
    void ticks(int count) {
        for (int i = 0; i < count; ++i) {
            now += period;
            for (Place& place : near) {
                place.session.tick(now);
                place.session.refresh();
                place.session.collect();
                place.port->statistics.refresh();
            }
            far.tick(now);
            far.collect();
            far.refresh();
        }
    }

    class EmulatedWire : public EmulatedLink {
    public:
        using EmulatedLink::EmulatedLink;
        Link& far() { return at_far_; }
        Link& near() { return at_near_; }
    };
    struct Place {
        Session session{LinkedPlaces::session_settings()};
        HeldDevice hand;
        std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    };
    std::array<EmulatedWire, 2> wires;
    std::array<std::shared_ptr<TeleopPort>, 2> far_ports{std::make_shared<TeleopPort>(),
                                                         std::make_shared<TeleopPort>()};
    Session far{LinkedPlaces::session_settings()};
    std::array<Place, 2> near;
    std::array<HeldDevice, 2> far_hands;
    SessionHandle box = no_handle;
    Nanoseconds now = 0;
};

TEST(Residual, TwoOperatorsWhoSqueezeABoxFeelEachOther) {
    for (const double delay : delays) {
        SCOPED_TRACE(delay);
        Squeezing squeezing(delay);
        squeezing.hold(0.08);
        squeezing.ticks(500);
        for (int i = 1; i <= 300; ++i) {
            squeezing.hold(0.08 + (half_box + 0.01 - deep - 0.08) * i / 300.0);
            squeezing.ticks(1);
        }
        squeezing.ticks(static_cast<int>(1e3 * delay) + 500);
        for (std::size_t i = 0; i < 2; ++i) {
            const double far = glm::length(squeezing.far.snapshot().proxies[i].force);
            EXPECT_GT(far, 2.0);
            EXPECT_NEAR(glm::length(squeezing.near[i].hand.force), far, 0.1 * far);
            EXPECT_LE(squeezing.near[i].port->statistics.front().largest_unexplained_step, 0.5 + 1e-9);
        }
    }
}

}  // namespace
}  // namespace tactus::residual_test
