#include "devices/space_mouse.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace tactus {

namespace {

// Of the protocol, version 1.
enum : std::int32_t { motion = 0, press = 1, release = 2, device_change = 3, last_event = 6 };
constexpr std::int32_t change_protocol = 0x7faa5500;  // with the version in the last byte
constexpr std::int32_t query_device = 0x7faa2005;
constexpr std::int32_t version = 1;
constexpr std::size_t status = 7;  // of an answer: below 0, there is no device

constexpr double full_deflection = 350.0;  // of a cap at its stop
constexpr int max_buttons = 32;
constexpr int max_reads = 16;  // at once; a daemon that says more is heard on the next look
constexpr Nanoseconds look_again = 1'000'000'000;
constexpr Nanoseconds time_to_answer = 500'000'000;

template <typename Value>
std::span<const std::uint8_t> bytes_of(const Value& value) {
    return {reinterpret_cast<const std::uint8_t*>(&value), sizeof value};
}

}  // namespace

std::string SpaceMouse::usual_socket() {
    const char* const named = std::getenv("SPNAV_SOCKET");
    return named != nullptr ? named : "/var/run/spnav.sock";
}

const SteeringInput& SpaceMouse::look(Nanoseconds now) {
    if (!socket_.is_open() && now >= next_look_) {
        next_look_ = now + look_again;
        connect(now);
    }
    if (socket_.is_open()) {
        read_all();
    }
    if (socket_.is_open() && answers_until_ != 0 && now > answers_until_) {
        leave("spacenavd does not answer: install version 1.0 or later, and start it anew");
    }
    return input_;
}

void SpaceMouse::connect(Nanoseconds now) {
    if (const std::string why = socket_.connect_to(path_); !why.empty()) {
        problem_ = "a SpaceMouse needs spacenavd, which cannot be reached at " + path_ + " (" + why +
                   "): install it (Debian: apt-get install spacenavd) and start it";
        return;
    }
    problem_.clear();
    answers_until_ = now + time_to_answer;
    const std::int32_t greeting = change_protocol | version;
    socket_.send(bytes_of(greeting));
}

void SpaceMouse::read_all() {
    for (int reads = 0; reads < max_reads && socket_.is_open(); ++reads) {
        const StreamSocket::Received got = socket_.receive(std::span(heard_).subspan(size_), 0);
        if (got.state == StreamSocket::State::nothing) {
            return;
        }
        if (got.state == StreamSocket::State::gone) {
            leave("spacenavd has gone: start it anew, it goes on by itself");
            return;
        }
        size_ += got.bytes;
        take_all();
    }
}

// Whole messages; what is left is less than one.
void SpaceMouse::take_all() {
    std::size_t at = 0;
    while (socket_.is_open() && size_ - at >= sizeof(std::int32_t)) {
        std::int32_t type = 0;
        std::memcpy(&type, &heard_[at], sizeof type);
        if (answers_until_ != 0 && (type & ~0xff) == change_protocol) {
            at += sizeof type;
            answers_until_ = 0;
            ask_for_device();
            continue;
        }
        Message message{};
        if (size_ - at < sizeof message) {
            break;
        }
        std::memcpy(message.data(), &heard_[at], sizeof message);
        at += sizeof message;
        take(message);
    }
    size_ -= std::min(size_, at);
    std::memmove(heard_.data(), heard_.data() + at, size_);
}

// Its axes are right, up and away.
void SpaceMouse::take(const Message& message) {
    const std::int32_t type = message[0];
    if (type == motion) {
        input_.deflection = Vec3(message[1], message[2], -static_cast<double>(message[3])) / full_deflection;
    } else if (type == press || type == release) {
        const std::uint32_t bit = message[1] >= 0 && message[1] < max_buttons ? 1u << message[1] : 0u;
        input_.buttons = type == press ? input_.buttons | bit : input_.buttons & ~bit;
    } else if (type == device_change) {
        input_ = {};
        ask_for_device();
    } else if (type == query_device) {
        problem_ =
            message[status] < 0 ? "no SpaceMouse is plugged in: plug it in, or choose another driver" : "";
    } else if (type < 0 || type > last_event) {
        leave("spacenavd sends an unknown message: install version 1.0 or later");
    }
}

void SpaceMouse::ask_for_device() {
    const Message question{query_device};
    if (socket_.send(bytes_of(question)) == StreamSocket::State::gone) {
        leave("spacenavd has gone: start it anew, it goes on by itself");
    }
}

void SpaceMouse::leave(std::string problem) {
    socket_.close();
    problem_ = std::move(problem);
    input_ = {};
    size_ = 0;
    answers_until_ = 0;
}

}  // namespace tactus
