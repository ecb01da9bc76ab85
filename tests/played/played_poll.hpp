// The kernel lets who polls a device of USB sleep until a transfer is done. umockdev's node is a plain file,
// which is always ready: poll() is played as well, for the threads of this process.
#pragma once

#include <string>

#include "platform/clock.hpp"

namespace tactus::shared {

class PlayedPoll {
public:
    explicit PlayedPoll(std::string node);  // as in /dev/bus/usb/001/002
    virtual ~PlayedPoll();
    PlayedPoll(const PlayedPoll&) = delete;
    PlayedPoll& operator=(const PlayedPoll&) = delete;

    // When somebody who polls the node wakes, as it stands (on the steady clock); changed() tells of another
    // time. From any thread.
    virtual Nanoseconds ready_at() = 0;
    void changed();

    // Whether anybody in this process has polled a played node: nobody asks in vain then.
    static bool is_used();

    const std::string node;

private:
    friend struct PlayedPolls;
    int wake_ = -1;
};

}  // namespace tactus::shared
