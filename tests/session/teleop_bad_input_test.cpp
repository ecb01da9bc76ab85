// What goes wrong between the two sides: nothing moves by it, and no hand feels it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <thread>

#include "network/memory_link.hpp"
#include "session/operator_side.hpp"
#include "session/teleoperator_side.hpp"
#include "session_rig.hpp"
#include "shared/endpoints.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::teleop_bad_input_test {
namespace {

using session_test::body;
using session_test::HeldDevice;
using session_test::period;
using shared::endpoint;
using testing::AuditScope;
using testing::LockAudit;

constexpr SessionHandle ground = 0;
constexpr SessionHandle box = 1;
constexpr double true_mass = 0.3;
constexpr double wrong_mass = 0.36;  // of the model's box (unit: kilograms)

// Lets a test see and change what arrives.
class Tampered final : public Link {
public:
    explicit Tampered(Link& inner) : inner_(inner) {}

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
        return inner_.send(datagram, now);
    }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
        ReceivedDatagram received = inner_.receive(into, now);
        Packet packet;
        if (change && received && decode(into.first(received.bytes), packet) == Refusal::none) {
            change(packet.message);
            received.bytes = encode(packet.header, packet.message, into);
            spoil(into.first(received.bytes));
        }
        return received;
    }

    std::function<void(Message&)> change;  // what is set to `spoilt` arrives as a NaN
    static constexpr double spoilt = 12.3456789;

private:
    // A writer refuses to encode what is no number: it is put in afterwards.
    static void spoil(std::span<std::byte> datagram) {
        spoil_as(datagram, spoilt);
        spoil_as(datagram, static_cast<float>(spoilt));
    }
    template <typename Real>
    static void spoil_as(std::span<std::byte> datagram, Real wanted) {
        constexpr Real none = std::numeric_limits<Real>::quiet_NaN();
        for (std::size_t i = 0; i + sizeof none <= datagram.size(); ++i) {
            if (std::memcmp(&datagram[i], &wanted, sizeof none) == 0) {
                std::memcpy(&datagram[i], &none, sizeof none);
            }
        }
    }

    Link& inner_;
};

SessionSettings small_session() {
    SessionSettings settings;
    settings.max_bodies = 16;
    settings.max_parts = 64;
    return settings;
}

// A world with a box on a ground and a hand.
struct Place {
    // After the side is attached, which has its twin follow what comes.
    void fill(double mass) {
        Workspace workspace;
        workspace.force_limit = 100.0;
        device.position = {0.0, 0.2, 0.0};
        ProxyDescription pointer;
        pointer.device = session.add_device(device, workspace).handle;
        session.add_proxy(pointer);
        add(body(BoxShape{{1.0, 0.05, 1.0}}, {0.0, -0.05, 0.0}, Motion::Static));
        add(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, mass));
        session.settle();
    }

    void add(const BodyAddition& addition) { EXPECT_EQ(session.add_body(addition).error, ""); }

    void tick(Nanoseconds now) {
        session.tick(now);
        session.refresh();
        port->statistics.refresh();
    }

    Vec3 box_position() const { return session.snapshot().bodies[0].pose.position; }
    const TeleopStatistics& statistics() const { return port->statistics.front(); }

    HeldDevice device;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    Session session{small_session()};
};

class TeleopBadInput : public ::testing::Test {
protected:
    TeleopBadInput() {
        start_operator(1);
        start_far(100);
    }

    void start_operator(std::uint64_t epoch) {
        near = std::make_unique<Place>();
        near->session.attach(std::make_unique<OperatorSide>(small_session(), OperatorRoom{}, TeleopSettings{},
                                                            to_operator, near->port,
                                                            endpoint(Side::operator_side, epoch)));
        near->fill(wrong_mass);
        for (const SessionHandle handle : {ground, box}) {
            near->port->bindings.try_push({handle, handle});
        }
    }

    void start_far(std::uint64_t epoch) {
        far = std::make_unique<Place>();
        far->session.attach(std::make_unique<TeleoperatorSide>(
            small_session(), TeleopSettings{}, to_far, far->port, endpoint(Side::teleoperator_side, epoch)));
        far->fill(true_mass);
    }

    void tick() {
        const Vec3 before = near->device.force;
        now += period;
        near->tick(now);
        if (far) {
            far->tick(now);
        }
        const double step = glm::distance(near->device.force, before);
        EXPECT_TRUE(std::isfinite(step));
        largest_step = std::max(largest_step, step);
    }

    void ticks(int count) {
        for (int i = 0; i < count; ++i) {
            tick();
        }
    }

    // The hand pushes the box from its side, so that its wrong mass shows and the past is done again, comes
    // down onto it and stays, pressing.
    void press() {
        ticks(50);
        const auto draw = [&](const Vec3& to, int count) {
            const Vec3 from = near->device.position;
            for (int i = 1; i <= count; ++i) {
                near->device.position = from + (to - from) * (static_cast<double>(i) / count);
                near->device.velocity = (to - from) * (1e3 / count);
                tick();
            }
            near->device.velocity = Vec3(0.0);
        };
        draw({-0.08, 0.05, 0.0}, 100);
        draw({0.0, 0.05, 0.0}, 200);
        ticks(300);
        ASSERT_GT(near->statistics().replays, 0u);
        ASSERT_GT(near->statistics().corrections, 0u);
        const Vec3 box_at = near->box_position();
        draw({-0.05, 0.2, 0.0}, 100);
        draw({box_at.x, 0.2, 0.0}, 100);
        draw({box_at.x, 0.105, 0.0}, 200);
        ticks(2000);
        ASSERT_GT(near->device.force.y, 1.0);
        largest_step = 0.0;
        place = near->box_position();
        force = near->device.force;
    }

    // Within a hundredth of a newton and of a millimetre of where they were.
    void expect_nothing_has_happened() {
        EXPECT_LT(largest_step, 0.01);
        EXPECT_LT(glm::distance(near->device.force, force), 0.01);
        EXPECT_LT(glm::distance(near->box_position(), place), 1e-5);
    }

    MemoryLinkPair wire{4096};
    Tampered to_operator{wire.first()}, to_far{wire.second()};
    std::unique_ptr<Place> near, far;
    Nanoseconds now = 0;
    double largest_step = 0.0;
    Vec3 place{0.0}, force{0.0};
};

TEST_F(TeleopBadInput, StatesOfUnknownObjectsAreCounted) {
    press();
    to_operator.change = [](Message& message) {
        if (auto* const states = std::get_if<ObjectStates>(&message)) {
            for (std::size_t i = 0; i < states->count; ++i) {
                states->states[i].object += i % 2 == 0 ? 7 : 4'000'000'000u;
                states->states[i].pose.position = {9.0, 9.0, 9.0};
            }
        }
    };
    ticks(500);
    EXPECT_GT(near->statistics().unknown_objects, 0u);
    expect_nothing_has_happened();
}

TEST_F(TeleopBadInput, AStateThatFliesWhileItsObjectIsRemovedIsIgnored) {
    press();
    near->device.position.y = 0.2;
    ticks(50);
    near->port->bindings.try_push({box, no_handle});
    near->session.remove_body(box);
    ticks(300);
    EXPECT_GT(near->statistics().unknown_objects, 0u);
    EXPECT_EQ(near->session.snapshot().body_count, 0u);
    EXPECT_EQ(near->device.force, Vec3(0.0));
}

TEST_F(TeleopBadInput, AnObjectThatIsRemovedUnderTheHandLeavesNoBodyBehind) {
    press();
    near->session.remove_body(box);  // and the binding stays
    ticks(300);
    EXPECT_GT(near->statistics().unknown_objects, 0u);
    EXPECT_EQ(near->device.force, Vec3(0.0));
}

TEST_F(TeleopBadInput, NumbersThatAreNoneAreRefused) {
    press();
    int count = 0;
    const auto now_and_then = [&count] { return ++count % 3 != 0; };
    to_operator.change = [=](Message& message) {
        auto* const states = std::get_if<ObjectStates>(&message);
        if (states != nullptr && now_and_then()) {
            states->states[0].linear_velocity.x = Tampered::spoilt;
        }
    };
    to_far.change = [=](Message& message) {
        if (auto* const hello = std::get_if<Hello>(&message)) {
            hello->gravity.y = Tampered::spoilt;
        }
    };
    ticks(500);
    const auto refused = [](const Place& one) {
        return one.statistics().link.refused.by_reason[static_cast<std::size_t>(Refusal::not_finite)];
    };
    EXPECT_GT(refused(*near), 50u);
    EXPECT_GE(refused(*far), 4u);
    EXPECT_LT(glm::distance(far->box_position(), near->box_position()), 1e-4);
    expect_nothing_has_happened();
}

TEST_F(TeleopBadInput, AClockThatJumpsByAnHourIsNotFelt) {
    press();
    constexpr Nanoseconds hour = 3600 * nanoseconds_per_second;
    for (const Nanoseconds offset : {hour, -hour, Nanoseconds{0}}) {
        for (Place* const side : {far.get(), near.get()}) {
            TeleopSettings settings;
            settings.skew.offset = offset;
            side->port->settings.publish(settings);
            ticks(300);
        }
    }
    EXPECT_EQ(near->statistics().link.peer, PeerState::connected);
    EXPECT_EQ(far->statistics().link.peer, PeerState::connected);
    EXPECT_GT(near->statistics().link.clock.jumps, 0u);
    expect_nothing_has_happened();
}

TEST_F(TeleopBadInput, ADeviceThatSaysNoNumbersIsPutUpWith) {
    press();
    const double y = near->device.position.y;
    near->device.position.y = std::numeric_limits<double>::quiet_NaN();
    near->device.velocity.y = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 5; ++i) {
        now += period;
        near->tick(now);
        far->tick(now);
        EXPECT_TRUE(std::isfinite(near->device.force.y));
    }
    near->device.position.y = y;
    near->device.velocity = Vec3(0.0);
    ticks(300);
    EXPECT_LT(glm::distance(near->box_position(), place), 1e-4);
    EXPECT_LT(glm::distance(far->box_position(), place), 1e-4);
}

TEST_F(TeleopBadInput, SamplesThatNobodyHasSentYetAreNoneOfOurs) {
    press();
    to_operator.change = [](Message& message) {
        if (auto* const states = std::get_if<ObjectStates>(&message)) {
            states->newest_operator_sample += 1'000'000;
            states->states[0].pose.position.y += 1.0;
        }
    };
    ticks(300);
    expect_nothing_has_happened();
}

TEST_F(TeleopBadInput, AClockThatJumpsMovesNothing) {
    press();
    TeleopSettings jumped;
    jumped.skew.offset = 3'600'000'000'000;
    far->port->settings.publish(jumped);
    ticks(300);
    expect_nothing_has_happened();
    jumped.skew.offset = -3'600'000'000'000;
    far->port->settings.publish(jumped);
    ticks(1500);
    expect_nothing_has_happened();
}

TEST_F(TeleopBadInput, AFarSideThatVanishesLeavesTheModelAsItIs) {
    press();
    far.reset();
    ticks(2500);
    EXPECT_EQ(near->statistics().link.peer, PeerState::vanished);
    expect_nothing_has_happened();
}

TEST_F(TeleopBadInput, AFarSideThatRestartsMovesNothing) {
    press();
    const Vec3 position = near->device.position;
    start_far(200);
    ticks(1);
    EXPECT_EQ(near->device.position, position);
    ticks(1000);
    EXPECT_EQ(near->statistics().link.peer_epoch, 200u);
    EXPECT_EQ(near->statistics().link.peer_restarts, 1u);
    expect_nothing_has_happened();
}

// It is not led there from where the other one was lost.
TEST_F(TeleopBadInput, AnotherOperatorThatPressesAtOnceMovesNothing) {
    near->device.position = {-0.2, 0.05, 0.0};
    ticks(500);
    near.reset();
    for (int i = 0; i < 2500; ++i) {
        far->tick(now += period);
    }
    start_operator(2);
    for (int i = 0; i < 500; ++i) {
        near->device.position = {0.0, 0.2 - 0.115 * i / 500.0, 0.0};
        near->tick(now += period);
        std::array<std::byte, 2048> unheard;
        while (to_far.receive(unheard, now)) {
        }
    }
    const Vec3 box_before = far->box_position();
    ticks(1000);
    EXPECT_EQ(far->statistics().link.peer_restarts, 1u);
    EXPECT_LT(glm::distance(far->box_position(), box_before), 1e-4);
}

TEST_F(TeleopBadInput, ARestartIsNoticedWithoutAnyData) {
    ticks(100);
    start_far(200);
    to_operator.change = [](Message& message) {
        if (std::holds_alternative<ObjectStates>(message)) {
            message = Hello{.side = Side::teleoperator_side};
        }
    };
    ticks(300);
    bool restarted = false;
    while (const std::optional<DiscoveryEvent> event = near->port->discovery.next()) {
        restarted = restarted || event->kind == DiscoveryEvent::Kind::restarted;
    }
    EXPECT_TRUE(restarted);
}

TEST_F(TeleopBadInput, TheScenarioChangesWhileAHandPresses) {
    press();
    TeleopSettings traditional;
    traditional.traditional = true;
    near->port->settings.publish(traditional);
    far->port->settings.publish(traditional);
    ticks(300);
    EXPECT_LT(glm::distance(near->device.force, force), 0.05);
    near->port->settings.publish({});
    far->port->settings.publish({});
    ticks(300);
    EXPECT_LT(glm::distance(near->device.force, force), 0.05);
    EXPECT_LT(glm::distance(near->box_position(), place), 1e-4);
}

TEST_F(TeleopBadInput, WhatWasPressedInTheOtherScenarioIsPressedNoMore) {
    press();
    TeleopSettings traditional;
    traditional.traditional = true;
    near->port->settings.publish(traditional);
    far->port->settings.publish(traditional);
    ticks(100);
    near->port->bindings.try_push({box, no_handle});
    near->session.remove_body(box);
    ticks(100);
    EXPECT_EQ(near->session.snapshot().body_count, 0u);
}

// Clocks of strangers order nothing: what comes later is newer, whatever it says about when it was true.
TEST_F(TeleopBadInput, AStateFromTheFarFutureDoesNotFreezeItsObject) {
    press();
    bool once = true;
    to_operator.change = [&once](Message& message) {
        if (auto* const states = std::get_if<ObjectStates>(&message); states && std::exchange(once, false)) {
            states->true_at = Nanoseconds{1} << 60;
        }
    };
    ticks(300);
    EXPECT_FALSE(once);
    far->session.teleport_body(box, {{0.3, 0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    ticks(500);
    EXPECT_LT(glm::length(near->box_position() - far->box_position()), 1e-4);
}

TEST_F(TeleopBadInput, GravityThatChangesStaysChangedInWhatIsReplayed) {
    press();
    near->device.position = {0.5, 0.5, 0.0};
    ticks(200);
    for (Place* const one : {near.get(), far.get()}) {
        one->session.set_gravity({0.0, 1.0, 0.0});
    }
    const std::uint64_t replays = near->statistics().replays;
    far->session.set_body_velocity(box, {0.1, 0.0, 0.0}, Vec3(0.0));
    ticks(400);
    EXPECT_GT(near->statistics().replays, replays);
    EXPECT_GT(far->box_position().y, 0.1);
    EXPECT_LT(glm::length(near->box_position() - far->box_position()), 1e-3);
}

TEST_F(TeleopBadInput, AModelIsCorrectedBeforeAnyHandIsThere) {
    near->session.teleport_body(box, {{0.2, 0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    to_far.change = [](Message& message) {
        if (auto* const samples = std::get_if<OperatorSamples>(&message)) {
            for (std::size_t i = 0; i < samples->count; ++i) {
                samples->samples[i].connected = false;
            }
        }
    };
    ticks(500);
    EXPECT_LT(glm::length(near->box_position() - far->box_position()), 1e-4);
}

// The hand slides over the box and pushes it; the model is wrong, so that everything is at work.
void expect_fit_for_the_loop(const TeleopSettings& settings, double mass) {
    MemoryLinkPair wire(4096);
    Place near, far;
    near.session.attach(std::make_unique<OperatorSide>(small_session(), OperatorRoom{}, settings,
                                                       wire.first(), near.port,
                                                       endpoint(Side::operator_side, 1)));
    far.session.attach(std::make_unique<TeleoperatorSide>(small_session(), settings, wire.second(), far.port,
                                                          endpoint(Side::teleoperator_side, 2)));
    near.fill(mass);
    far.fill(true_mass);
    for (const SessionHandle handle : {ground, box}) {
        near.port->bindings.try_push({handle, handle});
    }
    // An owner on another thread, as Godot's is.
    const LockAudit locks;
    std::atomic<bool> done{false};
    std::thread owner([&] {
        while (!done.load()) {
            for (Place* const place : {&near, &far}) {
                place->session.refresh();
                place->port->statistics.refresh();
                place->port->settings.publish(settings);
            }
            std::this_thread::yield();
        }
    });
    std::size_t offences = 0;
    std::string first;
    for (int i = 1; i <= 2000; ++i) {
        near.device.position = {0.12 * std::sin(0.004 * i), 0.1 + 0.03 * std::cos(0.01 * i),
                                0.02 * std::sin(0.003 * i)};
        AuditScope audit;
        near.session.tick(i * period);
        far.session.tick(i * period);
        audit.finish();
        offences += audit.allocations() + audit.frees() + audit.waits() + audit.system_calls();
        if (first.empty() && offences > 0) {
            first = audit.describe();
        }
    }
    done = true;
    owner.join();
    near.port->statistics.refresh();
    EXPECT_EQ(offences, 0u) << first;
    EXPECT_TRUE(locks.shared_locks().empty());
    EXPECT_EQ(near.statistics().link.peer, PeerState::connected);
    if (!settings.traditional) {
        EXPECT_GT(near.statistics().corrections, 10u);
    }
    if (!settings.traditional && settings.derivation == Derivation::resimulate) {
        EXPECT_GT(near.statistics().replays, 10u);
    }
}

TEST(TeleopRealtime, NoTickOfEitherSideAllocatesWaitsOrCallsTheSystem) {
    expect_fit_for_the_loop({}, wrong_mass);
}

TEST(TeleopRealtime, NorWithADeadbandAndEveryScheme) {
    TeleopSettings settings;
    settings.deadband.enabled = true;
    settings.control = ControlScheme::position_force_relative;
    settings.derivation = Derivation::velocity;
    settings.correction = Correction::stealthy_magnitude;
    expect_fit_for_the_loop(settings, wrong_mass);
}

TEST(TeleopRealtime, NorInTraditionalTouch) {
    TeleopSettings settings;
    settings.traditional = true;
    expect_fit_for_the_loop(settings, true_mass);
}

}  // namespace
}  // namespace tactus::teleop_bad_input_test
