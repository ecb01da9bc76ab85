// A device of USB as the kernel shows it to the threads of this process, played: its calls go out at once,
// also while another thread stands still outside of them, and whoever polls it sleeps until a transfer is
// done. umockdev's own node is a plain file that is always ready, whose calls another thread answers, one
// after the other; it remains for other processes.
//
// As in the kernel a call is not interrupted by a signal, unless it sleeps.
#pragma once

#include <string>

#include "platform/clock.hpp"

namespace tactus::shared {

class PlayedNode {
public:
    explicit PlayedNode(std::string node);  // as in /dev/bus/usb/001/002
    virtual ~PlayedNode() = default;
    PlayedNode(const PlayedNode&) = delete;
    PlayedNode& operator=(const PlayedNode&) = delete;

    // An ioctl: 0, or the error below 0. From any thread, one at a time.
    virtual int call(unsigned long request, void* argument) = 0;
    // When somebody who polls the node wakes, as it stands (on the steady clock); changed() tells of another
    // time. From any thread.
    virtual Nanoseconds ready_at() = 0;
    void changed();

    const std::string node;

protected:
    // Nobody calls it any more.
    void vanish();

private:
    friend struct PlayedNodes;
    int wake_ = -1;
};

}  // namespace tactus::shared
