#include "devices/haply/web_socket.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "platform/clock.hpp"

namespace tactus {

namespace {

constexpr std::uint8_t opcode_text = 1;
constexpr std::uint8_t opcode_pong = 10;
constexpr int would_block = -401;
constexpr int callback_failed = -400;

// A state of all its devices takes some kilobytes (unit: bytes).
constexpr std::uint64_t longest_message = 1 << 20;
constexpr std::size_t longest_answer = 4096;
// Of what has come, in one receive(): a service that sends faster than it is read must not hold up the
// thread that takes forces away (unit: bytes).
constexpr std::size_t most_at_once = 1 << 16;
constexpr Nanoseconds handshake_time = 1'000'000'000;
constexpr Nanoseconds part_of_handshake = 10'000'000;

}  // namespace

std::string WebSocket::load() {
    if (wslay_.queue != nullptr) {
        return {};
    }
    if (!library_.load({"libwslay.so.1", "libwslay.dylib", "libwslay.dll"},
                       "wslay_event_context_client_init")) {
        return "wslay is not installed: install it (Debian: apt-get install libwslay1)";
    }
    const bool all = library_.find({
        {"wslay_event_context_client_init", wslay_.init},
        {"wslay_event_context_free", wslay_.free},
        {"wslay_event_config_set_max_recv_msg_length", wslay_.set_most},
        {"wslay_event_set_error", wslay_.set_error},
        {"wslay_event_recv", wslay_.receive},
        {"wslay_event_send", wslay_.send},
        {"wslay_event_queue_msg", wslay_.queue},
    });
    return all ? "" : "the installed wslay is too old: version 1.1 or later is needed";
}

std::string WebSocket::open(std::uint16_t port, const std::atomic<bool>& stop) {
    close();
    if (std::string problem = load(); !problem.empty()) {
        return problem;
    }
    if (std::string problem = shake_hands(port, stop); !problem.empty()) {
        socket_.close();
        return problem;
    }
    Callbacks callbacks{};
    callbacks.receive = [](Context* context, std::uint8_t* into, std::size_t room, int, void* self) -> Size {
        WebSocket& socket = *static_cast<WebSocket*>(self);
        if (!socket.begun_.empty()) {
            const std::size_t size = std::min(room, socket.begun_.size());
            std::memcpy(into, socket.begun_.data(), size);
            socket.begun_.erase(0, size);
            return static_cast<Size>(size);
        }
        const StreamSocket::Received got =
            socket.may_read_ > 0 ? socket.socket_.receive({into, std::min(room, socket.may_read_)}, 0)
                                 : StreamSocket::Received{StreamSocket::State::nothing, 0};
        if (got.state == StreamSocket::State::done) {
            socket.may_read_ -= got.bytes;
            return static_cast<Size>(got.bytes);
        }
        socket.wslay_.set_error(context,
                                got.state == StreamSocket::State::nothing ? would_block : callback_failed);
        return -1;
    };
    callbacks.send = [](Context* context, const std::uint8_t* bytes, std::size_t size, int,
                        void* self) -> Size {
        WebSocket& socket = *static_cast<WebSocket*>(self);
        if (socket.socket_.send({bytes, size}) == StreamSocket::State::done) {
            return static_cast<Size>(size);
        }
        socket.wslay_.set_error(context, callback_failed);
        return -1;
    };
    // Masks keep proxies on the way from mistaking one protocol for another; on one machine there are none.
    callbacks.mask = [](Context*, std::uint8_t* into, std::size_t size, void* self) -> int {
        std::uint32_t& mask = static_cast<WebSocket*>(self)->mask_;
        for (std::size_t i = 0; i < size; ++i) {
            mask = mask * 1664525u + 1013904223u;
            into[i] = static_cast<std::uint8_t>(mask >> 24);
        }
        return 0;
    };
    callbacks.arrived = [](Context*, const Arrival* arrival, void* self) {
        WebSocket& socket = *static_cast<WebSocket*>(self);
        if (arrival->opcode == opcode_text) {
            socket.arrived_.assign(reinterpret_cast<const char*>(arrival->bytes), arrival->size);
            ++socket.arrivals_;
        }
    };
    if (wslay_.init(&context_, &callbacks, this) != 0) {
        context_ = nullptr;
        socket_.close();
        return "wslay does not start: is memory short?";
    }
    wslay_.set_most(context_, longest_message);
    is_gone_ = false;
    arrivals_ = 0;
    return {};
}

// RFC 6455, 4.1. The key only shows that the service read the request; to a service of this machine any will
// do.
std::string WebSocket::shake_hands(std::uint16_t port, const std::atomic<bool>& stop) {
    if (const std::string why = socket_.connect_here(port); !why.empty()) {
        return "no program answers at port " + std::to_string(port) + " of this machine: " + why;
    }
    const std::string request =
        "GET / HTTP/1.1\r\nHost: localhost:" + std::to_string(port) +
        "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGFjdHVzLWhhcHRpY3MhIQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
    const std::string no_web_socket = "port " + std::to_string(port) + " of this machine is no WebSocket's";
    if (socket_.send({reinterpret_cast<const std::uint8_t*>(request.data()), request.size()}) !=
        StreamSocket::State::done) {
        return no_web_socket;
    }
    std::string answer;
    const Nanoseconds until = monotonic_now() + handshake_time;
    std::size_t end = std::string::npos;
    while (end == std::string::npos) {
        std::array<std::uint8_t, 1024> part{};
        const StreamSocket::Received got = socket_.receive(part, part_of_handshake);
        const bool is_in_time = monotonic_now() < until && !stop.load();
        if (got.state == StreamSocket::State::gone || !is_in_time || answer.size() > longest_answer) {
            return no_web_socket;
        }
        answer.append(reinterpret_cast<const char*>(part.data()), got.bytes);
        end = answer.find("\r\n\r\n");
    }
    begun_ = answer.substr(end + 4);
    return answer.rfind("HTTP/1.1 101", 0) == 0 ? "" : no_web_socket;
}

void WebSocket::close() {
    if (context_ != nullptr) {
        wslay_.free(context_);
        context_ = nullptr;
    }
    socket_.close();
    begun_.clear();
}

int WebSocket::receive(std::string& text, Nanoseconds at_most) {
    arrivals_ = 0;
    may_read_ = most_at_once;
    is_gone_ = is_gone_ || wslay_.receive(context_) != 0;
    if (arrivals_ == 0 && !is_gone_ && at_most > 0) {
        socket_.wait(at_most);
        is_gone_ = wslay_.receive(context_) != 0;
    }
    is_gone_ = is_gone_ || wslay_.send(context_) != 0;  // what the protocol itself answers
    if (arrivals_ > 0) {
        text.swap(arrived_);
    }
    return arrivals_;
}

void WebSocket::send(const std::string& text) {
    send(opcode_text, text);
}

void WebSocket::acknowledge() {
    send(opcode_pong, {});
}

void WebSocket::send(std::uint8_t opcode, const std::string& text) {
    const Message message{opcode, reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
    is_gone_ = is_gone_ || wslay_.queue(context_, &message) != 0 || wslay_.send(context_) != 0;
}

}  // namespace tactus
