#include <fcntl.h>
#include <sys/select.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "platform/clock.hpp"
#include "platform/system_message.hpp"
#include "platform/wake_signal.hpp"

namespace tactus {

struct WakeSignal::System {
    int ends[2] = {-1, -1};  // a pipe
};

WakeSignal::WakeSignal() : system_(std::make_unique<System>()) {
    if (pipe(system_->ends) != 0) {
        error_ = last_system_message();
        return;
    }
    for (const int end : system_->ends) {
        fcntl(end, F_SETFD, FD_CLOEXEC);
        fcntl(end, F_SETFL, O_NONBLOCK);
    }
}

WakeSignal::~WakeSignal() {
    for (const int end : system_->ends) {
        if (end >= 0) {
            close(end);
        }
    }
}

// pselect: poll() of this system knows no time below a millisecond.
void WakeSignal::wait(Nanoseconds deadline, std::span<const WaitFile> files) {
    const Nanoseconds left = std::max<Nanoseconds>(0, deadline - monotonic_now());
    const timespec timeout{static_cast<time_t>(left / nanoseconds_per_second),
                           static_cast<long>(left % nanoseconds_per_second)};
    fd_set read_files, written_files;
    FD_ZERO(&read_files);
    FD_ZERO(&written_files);
    int last = system_->ends[0];
    if (last >= 0) {
        FD_SET(last, &read_files);
    }
    for (const WaitFile& file : files.first(std::min(files.size(), max_files))) {
        const int handle = static_cast<int>(file.handle);
        if (handle < 0 || handle >= FD_SETSIZE) {
            continue;
        }
        if (file.reads) {
            FD_SET(handle, &read_files);
        }
        if (file.writes) {
            FD_SET(handle, &written_files);
        }
        last = std::max(last, handle);
    }
    pselect(last + 1, &read_files, &written_files, nullptr, &timeout, nullptr);
    char taken[64];
    while (read(system_->ends[0], taken, sizeof taken) == static_cast<ssize_t>(sizeof taken)) {
    }
}

void WakeSignal::signal() {
    const char one = 1;
    [[maybe_unused]] const ssize_t written = write(system_->ends[1], &one, sizeof one);
}

}  // namespace tactus
