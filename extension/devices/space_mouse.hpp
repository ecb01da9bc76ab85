// A SpaceMouse of 3Dconnexion, as spacenavd tells of it over its socket (version 1.0 and later, which every
// distribution has): messages of 32 bytes. Its client library would add one connection for a whole process
// and no word of it when the daemon goes.
//
// Threads: one at a time. Nothing here waits.
#pragma once

#include <array>
#include <span>
#include <string>

#include "devices/steering.hpp"
#include "platform/stream_socket.hpp"

namespace tactus {

class SpaceMouse {
public:
    // Where spacenavd listens, unless SPNAV_SOCKET of the environment says otherwise.
    static std::string usual_socket();

    explicit SpaceMouse(std::string socket = usual_socket()) : path_(std::move(socket)) {}

    // How it is held now; a daemon that is not there is looked for once a second. A cap at its stop deflects
    // by about 1.
    const SteeringInput& look(Nanoseconds now);

    // Why it does not steer, and what to do; empty where it does, or may do so in a moment.
    const std::string& problem() const { return problem_; }

private:
    using Message = std::array<std::int32_t, 8>;

    void connect(Nanoseconds now);
    void read_all();
    void take_all();
    void take(const Message& message);
    void ask_for_device();
    void leave(std::string problem);

    std::string path_;
    StreamSocket socket_;
    SteeringInput input_;
    std::string problem_;
    std::array<std::uint8_t, 4096> heard_{};
    std::size_t size_ = 0;           // of heard_: what is there
    Nanoseconds next_look_ = 0;      // for a daemon
    Nanoseconds answers_until_ = 0;  // the daemon, or it is too old; 0: it has
};

}  // namespace tactus
