// A SpaceMouse against a daemon that answers as spacenavd does, with version 1 of its protocol.
#include "devices/space_mouse.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <glm/geometric.hpp>
#include <span>
#include <string>

namespace tactus::space_mouse_linux_test {
namespace {

constexpr Nanoseconds second = 1'000'000'000;

using Message = std::array<std::int32_t, 8>;

class Daemon {
public:
    Daemon() : path_(testing::TempDir() + "tactus_spacenavd_" + std::to_string(getpid())) { start(); }
    ~Daemon() { stop(); }
    Daemon(const Daemon&) = delete;
    Daemon& operator=(const Daemon&) = delete;

    const std::string& path() const { return path_; }
    bool plugged = true;
    bool old = false;  // it takes the greeting for a sensitivity, and says nothing

    void start() {
        listener_ = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, path_.data(), path_.size());
        unlink(path_.c_str());
        EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
        EXPECT_EQ(listen(listener_, 8), 0);
    }
    void stop() {
        hang_up();
        close(listener_);
        unlink(path_.c_str());
    }
    void hang_up() {
        if (client_ >= 0) {
            close(client_);
        }
        client_ = -1;
        greeted_ = false;
    }

    // Answers what it has been asked.
    void serve() {
        if (client_ < 0) {
            client_ = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK);
        }
        if (client_ < 0 || old) {
            return;
        }
        std::int32_t greeting = 0;
        if (!greeted_ && read(client_, &greeting, sizeof greeting) == sizeof greeting) {
            EXPECT_EQ(greeting, 0x7faa5501);
            greeted_ = true;
            send_bytes(&greeting, sizeof greeting);
        }
        for (Message asked{}; greeted_ && read(client_, asked.data(), sizeof asked) == sizeof asked;) {
            EXPECT_EQ(asked[0], 0x7faa2005);
            asked[7] = plugged ? 0 : -1;
            send(asked);
        }
    }

    void send(const Message& message) { send_bytes(message.data(), sizeof message); }
    void send_bytes(const void* bytes, std::size_t size) {
        EXPECT_EQ(write(client_, bytes, size), static_cast<ssize_t>(size));
    }

private:
    std::string path_;
    int listener_ = -1, client_ = -1;
    bool greeted_ = false;
};

void introduce(SpaceMouse& mouse, Daemon& daemon, Nanoseconds now = 0) {
    for (int i = 0; i < 3; ++i) {
        mouse.look(now);
        daemon.serve();
    }
    mouse.look(now);
}

TEST(SpaceMouse, ItsCapPointsAsTheHandGoes) {
    Daemon daemon;
    SpaceMouse mouse(daemon.path());
    introduce(mouse, daemon);
    EXPECT_EQ(mouse.problem(), "");
    EXPECT_EQ(mouse.look(1).deflection, Vec3(0.0));
    daemon.send({0, 350, 175, 35, 10, 20, 30, 16});  // right, up, away; turned as well
    EXPECT_LT(glm::distance(mouse.look(2).deflection, Vec3(1.0, 0.5, -0.1)), 1e-12);
    daemon.send({0, -70, 0, 0, 0, 0, 0, 16});
    EXPECT_LT(glm::distance(mouse.look(3).deflection, Vec3(-0.2, 0.0, 0.0)), 1e-12);
    EXPECT_LT(glm::distance(mouse.look(4).deflection, Vec3(-0.2, 0.0, 0.0)), 1e-12);  // held so
}

TEST(SpaceMouse, HasButtons) {
    Daemon daemon;
    SpaceMouse mouse(daemon.path());
    introduce(mouse, daemon);
    daemon.send({1, 0});
    daemon.send({1, 31});
    daemon.send({1, 32});
    daemon.send({1, -1});
    EXPECT_EQ(mouse.look(1).buttons, 0x80000001u);
    daemon.send({2, 0});
    EXPECT_EQ(mouse.look(2).buttons, 0x80000000u);
}

TEST(SpaceMouse, HearsWhatComesInPiecesAndBeforeTheAnswer) {
    Daemon daemon;
    SpaceMouse mouse(daemon.path());
    mouse.look(0);
    daemon.old = true;
    daemon.serve();
    daemon.send({0, 35, 0, 0, 0, 0, 0, 16});
    EXPECT_LT(glm::distance(mouse.look(1).deflection, Vec3(0.1, 0.0, 0.0)), 1e-12);
    daemon.old = false;
    introduce(mouse, daemon);
    EXPECT_EQ(mouse.problem(), "");
    const Message message{0, 0, 350, 0, 0, 0, 0, 16};
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(message.data());
    daemon.send_bytes(bytes, 9);
    EXPECT_LT(glm::distance(mouse.look(2).deflection, Vec3(0.1, 0.0, 0.0)), 1e-12);
    daemon.send_bytes(bytes + 9, 23);
    EXPECT_LT(glm::distance(mouse.look(3).deflection, Vec3(0.0, 1.0, 0.0)), 1e-12);
}

TEST(SpaceMouse, AnUnpluggedOneIsLetGoOfAndComesBack) {
    Daemon daemon;
    SpaceMouse mouse(daemon.path());
    introduce(mouse, daemon);
    daemon.send({0, 350, 0, 0, 0, 0, 0, 16});
    daemon.send({1, 2});
    EXPECT_EQ(mouse.look(1).buttons, 4u);
    daemon.plugged = false;
    daemon.send({3, 1});
    EXPECT_EQ(mouse.look(2).deflection, Vec3(0.0));
    EXPECT_EQ(mouse.look(2).buttons, 0u);
    daemon.serve();
    mouse.look(3);
    EXPECT_NE(mouse.problem().find("plug it in"), std::string::npos) << mouse.problem();
    daemon.plugged = true;
    daemon.send({3, 0});
    introduce(mouse, daemon, 4);
    EXPECT_EQ(mouse.problem(), "");
}

TEST(SpaceMouse, ADaemonThatGoesIsLookedForUntilItIsBack) {
    Daemon daemon;
    SpaceMouse mouse(daemon.path());
    introduce(mouse, daemon);
    daemon.send({0, 350, 0, 0, 0, 0, 0, 16});
    EXPECT_NE(mouse.look(1).deflection, Vec3(0.0));
    daemon.stop();
    EXPECT_EQ(mouse.look(2).deflection, Vec3(0.0));
    EXPECT_NE(mouse.problem().find("has gone"), std::string::npos) << mouse.problem();
    mouse.look(second);
    EXPECT_NE(mouse.problem().find("apt-get install spacenavd"), std::string::npos) << mouse.problem();
    daemon.start();
    mouse.look(second + 1);
    EXPECT_NE(mouse.problem(), "") << "it is looked for once a second";
    introduce(mouse, daemon, 2 * second);
    EXPECT_EQ(mouse.problem(), "");
}

TEST(SpaceMouse, SaysWhatIsInTheWay) {
    SpaceMouse nobody(testing::TempDir() + "tactus_no_spacenavd");
    nobody.look(0);
    EXPECT_NE(nobody.problem().find("apt-get install spacenavd"), std::string::npos) << nobody.problem();
    SpaceMouse nowhere(std::string(1'000, 'x'));
    nowhere.look(0);
    EXPECT_NE(nowhere.problem().find("cannot be reached"), std::string::npos) << nowhere.problem();
    Daemon daemon;
    daemon.old = true;
    SpaceMouse mouse(daemon.path());
    mouse.look(0);
    daemon.serve();
    mouse.look(second);
    EXPECT_NE(mouse.problem().find("version 1.0"), std::string::npos) << mouse.problem();
}

TEST(SpaceMouse, NonsenseIsNotFollowed) {
    Daemon daemon;
    SpaceMouse mouse(daemon.path());
    introduce(mouse, daemon);
    daemon.send({0, 350, 0, 0, 0, 0, 0, 16});
    daemon.send({0x20202020, 1, 2, 3});
    EXPECT_EQ(mouse.look(1).deflection, Vec3(0.0));
    EXPECT_NE(mouse.problem().find("unknown message"), std::string::npos) << mouse.problem();
    std::array<std::int32_t, 16'000> flood{};
    daemon.hang_up();
    mouse.look(second);
    daemon.serve();
    daemon.send_bytes(flood.data(), sizeof flood);  // 2,000 messages of a cap at rest
    introduce(mouse, daemon, second + 1);
    EXPECT_EQ(mouse.look(second + 2).deflection, Vec3(0.0));
    EXPECT_EQ(mouse.problem(), "");
}

}  // namespace
}  // namespace tactus::space_mouse_linux_test
