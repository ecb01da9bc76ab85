#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "platform/clock.hpp"
#include "platform/system_message.hpp"
#include "platform/wake_signal.hpp"

namespace tactus {

struct WakeSignal::System {
    int event = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
};

WakeSignal::WakeSignal() : system_(std::make_unique<System>()) {
    if (system_->event < 0) {
        error_ = last_system_message();
    }
}

WakeSignal::~WakeSignal() {
    if (system_->event >= 0) {
        close(system_->event);
    }
}

void WakeSignal::wait(Nanoseconds deadline, std::span<const WaitFile> files) {
    const Nanoseconds left = std::max<Nanoseconds>(0, deadline - monotonic_now());
    const timespec timeout{static_cast<time_t>(left / nanoseconds_per_second),
                           static_cast<long>(left % nanoseconds_per_second)};
    std::array<pollfd, 1 + max_files> polled{{{system_->event, POLLIN, 0}}};
    const std::size_t watched = std::min(files.size(), max_files);
    for (std::size_t i = 0; i < watched; ++i) {
        const int events = (files[i].reads ? POLLIN : 0) | (files[i].writes ? POLLOUT : 0);
        polled[i + 1] = {static_cast<int>(files[i].handle), static_cast<short>(events), 0};
    }
    ppoll(polled.data(), watched + 1, &timeout, nullptr);
    if (polled[0].revents != 0) {
        std::uint64_t count = 0;
        [[maybe_unused]] const ssize_t taken = read(system_->event, &count, sizeof count);
    }
}

void WakeSignal::signal() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(system_->event, &one, sizeof one);
}

}  // namespace tactus
