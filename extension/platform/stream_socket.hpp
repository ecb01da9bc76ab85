// A stream of bytes to a service of this machine.
//
// Threads: one at a time.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/math/types.hpp"
#include "platform/wake_signal.hpp"

namespace tactus {

class StreamSocket {
public:
    StreamSocket() = default;
    ~StreamSocket() { close(); }
    StreamSocket(const StreamSocket&) = delete;
    StreamSocket& operator=(const StreamSocket&) = delete;

    // To a port of this machine, within a tenth of a second. Empty, or why not.
    std::string connect_here(std::uint16_t port);
    // To the socket at this place of the file system, where the system has such sockets.
    std::string connect_to(const std::string& path);
    void close();
    bool is_open() const { return handle_ != closed; }
    // To wait for something that comes.
    WaitFile file() const { return {handle_}; }

    enum class State : std::uint8_t { done, nothing, gone };
    struct Received {
        State state = State::nothing;
        std::size_t bytes = 0;
    };
    // Until something has come, no longer than `at_most`, and up to a millisecond less.
    void wait(Nanoseconds at_most) const;
    // What has come, at most so much; waits for it no longer than `at_most`, and up to a millisecond less.
    Received receive(std::span<std::uint8_t> into, Nanoseconds at_most);
    // All of it, within a tenth of a second.
    State send(std::span<const std::uint8_t> bytes);

private:
    static constexpr std::int64_t closed = -1;

    std::int64_t handle_ = closed;  // the system's
};

}  // namespace tactus
