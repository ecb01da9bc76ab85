// The driver against a service that answers as Haply's does (tests/stand_ins/haply_service.py).
#include "devices/haply/inverse3_driver.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <thread>
#include <vector>

#include "shared/driven_device.hpp"
#include "shared/haply_service.hpp"

namespace tactus::inverse3_driver_linux_test {
namespace {

using shared::HaplyService;

// Whether both libraries are here; they come with no other part of the project.
bool is_supported() {
    JsonReader json;
    RuntimeLibrary wslay;
    return json.load().empty() && wslay.load({"libwslay.so.1"}, "wslay_event_recv");
}
#define NEEDS_LIBRARIES()                                       \
    if (!is_supported()) {                                      \
        GTEST_SKIP() << "libwslay1 and libjansson4 are needed"; \
    }

bool says(const DriverDevice& device, const std::string& words) {
    return wait_until([&] { return device.health().text.find(words) != std::string::npos; });
}

std::unique_ptr<DriverDevice> inverse3(const HaplyService& service, std::string id = {}) {
    return std::make_unique<DriverDevice>(std::make_unique<Inverse3Driver>(std::move(id), service.port()));
}

TEST(Inverse3, PlacesTurnsButtonsAndForcesAreInOurAxes) {
    NEEDS_LIBRARIES();
    HaplyService service;
    const auto device = inverse3(service);
    ASSERT_TRUE(
        tick_until(*device, {1.0, 2.0, 3.0}, [&](const auto&) { return service.force() == "1.0 -3.0 2.0"; }));
    const DeviceSample sample = device->read(0);
    EXPECT_LT(glm::distance(sample.position, Vec3(0.01, 0.03, -0.02)), 1e-9);
    EXPECT_LT(glm::distance(sample.velocity, Vec3(0.1, 0.3, -0.2)), 1e-9);
    // A quarter turn about their z, which is our y.
    EXPECT_LT(glm::distance(sample.rotation * Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, -1.0)), 1e-6);
    EXPECT_EQ(sample.buttons, 5u);
    EXPECT_EQ(device->health().id, "048D");
}

TEST(Inverse3, AStalledLoopLetsTheHandGo) {
    NEEDS_LIBRARIES();
    HaplyService service;
    const auto device = inverse3(service);
    ASSERT_TRUE(
        tick_until(*device, {1.0, 0.0, 0.0}, [&](const auto&) { return service.force() == "1.0 0.0 0.0"; }));
    EXPECT_TRUE(wait_until([&] { return service.force() == "0.0 0.0 0.0"; }));
}

// Exchanges with the service by hand: the loop's next look is at a time of the test's, and no force ends.
class InverseExchanges {
public:
    explicit InverseExchanges(const HaplyService& service) : driver_("", service.port()) {
        const std::atomic<bool> stop{false};
        EXPECT_EQ(driver_.open(stop), "");
        forces_.begin(driver_.capabilities(), driver_.is_paced());
    }
    // Of the loop, which looks again within `to_look`.
    void write(const Vec3& force, Nanoseconds to_look) {
        const Nanoseconds now = monotonic_now();
        forces_.write({force, Vec3(0.0), now + longest_wait, 0, now + to_look - one_tick});
    }
    bool reads_at_once() {
        const Driver::Exchange done = driver_.exchange(forces_, monotonic_now() + 50 * one_tick, reading_);
        forces_.heard(monotonic_now(), monotonic_now() + longest_wait);
        return done == Driver::Exchange::reading;
    }
    bool next_reading() {
        int tries = 100;
        while (!reads_at_once() && tries > 0) {
            --tries;
        }
        return tries > 0;
    }

private:
    ForceSlot forces_;
    Inverse3Driver driver_;
    DriverReading reading_;
};

// It was answered with the force of the state before, and its own went out a period of the service later.
TEST(Inverse3, AStateWaitsForTheForceThatItLeadsTo) {
    NEEDS_LIBRARIES();
    HaplyService service;
    InverseExchanges driver(service);
    int states = 1;  // with the one that open() has read
    for (double newtons = 0.25; newtons <= 2.5; newtons += 0.25) {
        ASSERT_TRUE(driver.next_reading());
        ++states;
        driver.write({newtons, 0.0, 0.0}, 0);
        ASSERT_TRUE(driver.next_reading());
        ASSERT_TRUE(wait_until([&] { return service.newest_force().x == newtons; })) << newtons;
        EXPECT_EQ(service.answered(), states) << newtons;
        ++states;
    }
}

TEST(Inverse3, AStateIsAnsweredAtOnceWhereTheLoopLooksLater) {
    NEEDS_LIBRARIES();
    HaplyService service;
    InverseExchanges driver(service);
    ASSERT_TRUE(driver.next_reading());
    for (int i = 0; i < 3; ++i) {
        driver.write({1.0 + i, 0.0, 0.0}, 1'000 * one_tick);
        ASSERT_TRUE(driver.next_reading());
        ASSERT_TRUE(driver.next_reading()) << "it has had its answer without a write";
        EXPECT_LT(service.waited(), 3);
    }
}

// It waited for the next state, by which the hand was pushed for up to a period of the service.
TEST(Inverse3, AForceThatTheLoopTakesAwayWaitsForNoState) {
    NEEDS_LIBRARIES();
    HaplyService service;
    InverseExchanges driver(service);
    ASSERT_TRUE(driver.next_reading());
    driver.write({1.0, 0.0, 0.0}, 0);
    ASSERT_TRUE(driver.next_reading());
    ASSERT_TRUE(wait_until([&] { return service.force() == "1.0 0.0 0.0"; }));
    service.lie(stand_ins::Field::position, stand_ins::Lie::is_silent);
    ASSERT_TRUE(wait_until([&] { return !driver.reads_at_once(); }));
    EXPECT_EQ(service.force(), "1.0 0.0 0.0");
    driver.write(Vec3(0.0), 0);
    driver.reads_at_once();
    EXPECT_TRUE(wait_until([&] { return service.force() == "0.0 0.0 0.0"; }));
}

// The stand-in told its state once more for each line that it was told, and was answered twice: from then on
// every answer waited in it for a state.
TEST(Inverse3, AStandInThatIsToldToLieIsNoAnswerBehind) {
    NEEDS_LIBRARIES();
    HaplyService service;
    InverseExchanges driver(service);
    ASSERT_TRUE(driver.next_reading());
    const int before = service.waited();
    for (const stand_ins::Lie lie : {stand_ins::Lie::leaps, stand_ins::Lie::none, stand_ins::Lie::leaps}) {
        service.lie(stand_ins::Field::buttons, lie);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));  // it has read that, and has no answer
        ASSERT_TRUE(driver.next_reading());
        ASSERT_TRUE(driver.next_reading());
    }
    EXPECT_LT(service.waited() - before, 3) << "on a machine that is late it may wait in earnest";
}

// The service takes one message for each state: each one more was an answer late, with all forces behind it.
TEST(Inverse3, AForceIsNoLaterAfterManyCuts) {
    NEEDS_LIBRARIES();
    HaplyService service;
    const auto device = inverse3(service);
    constexpr int cuts = 40;
    for (int i = 0; i < cuts; ++i) {
        ASSERT_TRUE(tick_until(*device, {1.0, 0.0, 0.0},
                               [&](const auto&) { return service.force() == "1.0 0.0 0.0"; }));
        ASSERT_TRUE(wait_until([&] { return service.force() == "0.0 0.0 0.0"; }));
    }
    const std::uint64_t before = device->health().readings;
    ASSERT_TRUE(
        tick_until(*device, {1.0, 0.0, 0.0}, [&](const auto&) { return service.force() == "1.0 0.0 0.0"; }));
    EXPECT_LT(device->health().readings - before, cuts / 2);
    // A state that has had its answer in advance is acknowledged all the same, or the next is 40 ms late.
    EXPECT_GT(service.acknowledged(), cuts / 2);
}

// One that had its answer in advance, and the next: where only the newest counted, the service waited for the
// other one's answer, and the force for the service.
TEST(Inverse3, AnswersStatesThatComeTogether) {
    NEEDS_LIBRARIES();
    HaplyService service("hasty");
    const auto device = inverse3(service);
    constexpr int cuts = 40;
    int waited = 0;
    for (int i = 0; i < cuts; ++i) {
        ASSERT_TRUE(tick_until(*device, {1.0, 0.0, 0.0},
                               [&](const auto&) { return service.force() == "1.0 0.0 0.0"; }));
        waited = i == 0 ? service.waited() : waited;  // for the driver to open
        ASSERT_TRUE(wait_until([&] { return service.force() == "0.0 0.0 0.0"; }));
    }
    EXPECT_LT(service.waited() - waited, cuts / 4);
}

// Its last buttons stayed held, and with them a dead man's button.
TEST(Inverse3, AGripThatSleepsOrIsOutOfReachHoldsNoButton) {
    NEEDS_LIBRARIES();
    HaplyService service;
    const auto device = inverse3(service);
    const auto held = [](std::uint32_t buttons) {
        return
            [buttons](const DeviceSample& sample) { return sample.connected && sample.buttons == buttons; };
    };
    ASSERT_TRUE(tick_until(*device, {1.0, 0.0, 0.0}, held(5)));
    const Quat turned = device->read(0).rotation;
    for (const char* const status : {"awake", "connected"}) {
        service.lose_grip(status);
        EXPECT_TRUE(tick_until(*device, {1.0, 0.0, 0.0}, held(0))) << status;
        EXPECT_EQ(device->read(0).rotation, turned) << "it is turned as it was: " << status;
        service.lose_grip("");
        EXPECT_TRUE(tick_until(*device, {1.0, 0.0, 0.0}, held(5))) << status;
    }
}

TEST(Inverse3, NonsenseIsGivenNoForceAndNoHand) {
    NEEDS_LIBRARIES();
    HaplyService service;
    const auto device = inverse3(service);
    ASSERT_TRUE(
        tick_until(*device, {1.0, 0.0, 0.0}, [&](const auto&) { return service.force() == "1.0 0.0 0.0"; }));
    service.go_mad();
    EXPECT_TRUE(tick_until(*device, {1.0, 0.0, 0.0}, [&](const DeviceSample& sample) {
        return !sample.connected && service.force() == "0.0 0.0 0.0";
    }));
    service.drop();
    EXPECT_TRUE(
        tick_until(*device, {1.0, 0.0, 0.0}, [&](const auto&) { return service.force() == "1.0 0.0 0.0"; }));
}

TEST(Inverse3, ConnectsAnewWhenTheServiceHasClosed) {
    NEEDS_LIBRARIES();
    HaplyService service;
    const auto device = inverse3(service);
    ASSERT_TRUE(tick_until(*device, Vec3(0.0), [](const DeviceSample& sample) { return sample.connected; }));
    service.drop();
    ASSERT_TRUE(tick_until(*device, Vec3(0.0), [](const DeviceSample& sample) { return !sample.connected; }));
    EXPECT_TRUE(tick_until(*device, Vec3(0.0), [](const DeviceSample& sample) { return sample.connected; }));
    EXPECT_EQ(device->health().times_lost, 1u);
}

// A service that the kernel takes connections for, and that does nothing with them.
class HungService {
public:
    explicit HungService(int queue) : listener_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
        EXPECT_EQ(listen(listener_, queue), 0);
        EXPECT_EQ(getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size), 0);
        address_ = address;
    }
    ~HungService() {
        for (const int client : clients_) {
            close(client);
        }
        close(listener_);
    }
    HungService(const HungService&) = delete;
    HungService& operator=(const HungService&) = delete;

    std::uint16_t port() const { return ntohs(address_.sin_port); }
    bool is_called() const {
        pollfd file{listener_, POLLIN, 0};
        return poll(&file, 1, 0) > 0;
    }
    // So that the next one waits.
    void fill_queue() {
        for (int i = 0; i < 8; ++i) {
            clients_.push_back(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
            connect(clients_.back(), reinterpret_cast<const sockaddr*>(&address_), sizeof address_);
        }
    }
    // Answers with a byte.
    void drip() {
        if (clients_.empty()) {
            clients_.push_back(accept(listener_, nullptr, nullptr));
        }
        send(clients_.back(), "H", 1, MSG_NOSIGNAL);
    }

private:
    int listener_;
    sockaddr_in address_{};
    std::vector<int> clients_;
};

// The destructor waited a second for the answer, or minutes for a connection: "restart the program".
TEST(Inverse3, AServiceThatDoesNotAnswerHoldsUpNoDestructor) {
    NEEDS_LIBRARIES();
    static std::string told;
    told.clear();
    DriverDevice::when_left_behind([](const std::string& text) { told = text; });
    {
        const HungService service(8);
        DriverDevice device(std::make_unique<Inverse3Driver>("", service.port()));
        ASSERT_TRUE(wait_until([&] { return service.is_called(); }));
    }
    EXPECT_EQ(told, "");
    {
        HungService service(0);
        service.fill_queue();
        DriverDevice device(std::make_unique<Inverse3Driver>("", service.port()));
        EXPECT_TRUE(says(device, "no program answers"));
    }
    EXPECT_EQ(told, "");
    DriverDevice::when_left_behind(nullptr);
}

// Each byte began the second anew in which an answer has to come.
TEST(Inverse3, AServiceThatAnswersWithAByteNowAndThenIsNone) {
    NEEDS_LIBRARIES();
    HungService service(8);
    DriverDevice device(std::make_unique<Inverse3Driver>("", service.port()));
    ASSERT_TRUE(wait_until([&] { return service.is_called(); }));
    int rounds = 0;
    EXPECT_TRUE(wait_until([&] {
        if (rounds++ % 20 == 0) {
            service.drip();
        }
        return device.health().text.find("no WebSocket") != std::string::npos;
    }));
}

TEST(Inverse3, SaysWhatIsMissing) {
    NEEDS_LIBRARIES();
    DriverDevice nobody(std::make_unique<Inverse3Driver>("", std::uint16_t{9}));
    EXPECT_TRUE(says(nobody, "Haply Hub"));
    HaplyService service, silent("silent"), mad("nonsense"), fresh("uncalibrated"), quoted("quoted");
    EXPECT_TRUE(says(*inverse3(service, "FFFF"), "no Inverse3 FFFF"));
    EXPECT_TRUE(says(*inverse3(silent), "says nothing"));
    EXPECT_TRUE(says(*inverse3(mad), "no Inverse3"));
    EXPECT_TRUE(says(*inverse3(quoted), "a name that no command can carry"));
    const auto uncalibrated = inverse3(fresh);
    EXPECT_TRUE(says(*uncalibrated, "calibration dock"));
    EXPECT_FALSE(uncalibrated->read(0).connected);
}

}  // namespace
}  // namespace tactus::inverse3_driver_linux_test
