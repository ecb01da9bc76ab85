// The client's end of a WebSocket to a service of this machine. Frames are made and read by wslay, which
// speaks the protocol and nothing else: no thread, no socket, no wait of its own, and it is in every
// distribution (aria2 uses it). Loaded when a device needs it; what is used of its interface (1.1) is
// declared here.
//
// Threads: one at a time.
#pragma once

#include <atomic>
#include <string>

#include "devices/runtime_library.hpp"
#include "platform/stream_socket.hpp"

namespace tactus {

class WebSocket {
public:
    WebSocket() = default;
    ~WebSocket() { close(); }

    // Gives up soon after `stop` is set. Empty, or what to do.
    std::string open(std::uint16_t port, const std::atomic<bool>& stop);
    void close();

    // The newest text that has come, waiting until then, and how many have come; the older ones are lost. Of
    // what comes faster than that, the rest waits for the next call.
    int receive(std::string& text, Nanoseconds at_most);
    void send(const std::string& text);
    // An unsolicited pong (RFC 6455, 5.5.3), in place of an answer: it takes TCP's acknowledgment along. A
    // peer that collects small writes until they are acknowledged (RFC 896) would be late by 40 ms.
    void acknowledge();
    bool is_gone() const { return is_gone_; }
    WaitFile file() const { return socket_.file(); }

private:
    struct Context;
    struct Message {
        std::uint8_t opcode;
        const std::uint8_t* bytes;
        std::size_t size;
    };
    struct Arrival {
        std::uint8_t rsv;
        std::uint8_t opcode;
        const std::uint8_t* bytes;
        std::size_t size;
        std::uint16_t status;
    };
    using Size = std::ptrdiff_t;
    struct Callbacks {
        Size (*receive)(Context*, std::uint8_t*, std::size_t, int, void*);
        Size (*send)(Context*, const std::uint8_t*, std::size_t, int, void*);
        int (*mask)(Context*, std::uint8_t*, std::size_t, void*);
        void* frame_begins;
        void* frame_part;
        void* frame_ends;
        void (*arrived)(Context*, const Arrival*, void*);
    };
    struct Functions {
        int (*init)(Context**, const Callbacks*, void*) = nullptr;
        void (*free)(Context*) = nullptr;
        void (*set_most)(Context*, std::uint64_t) = nullptr;
        void (*set_error)(Context*, int) = nullptr;
        int (*receive)(Context*) = nullptr;
        int (*send)(Context*) = nullptr;
        int (*queue)(Context*, const Message*) = nullptr;
    };

    void send(std::uint8_t opcode, const std::string& text);
    std::string load();
    std::string shake_hands(std::uint16_t port, const std::atomic<bool>& stop);

    RuntimeLibrary library_;
    Functions wslay_;
    StreamSocket socket_;
    Context* context_ = nullptr;
    std::string begun_;  // that came behind the handshake
    std::string arrived_;
    std::uint32_t mask_ = 0x9e3779b9u;
    int arrivals_ = 0;          // since receive() began
    std::size_t may_read_ = 0;  // until it ends (unit: bytes)
    bool is_gone_ = false;
};

}  // namespace tactus
