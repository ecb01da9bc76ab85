#include <winsock2.h>

#include <algorithm>
#include <array>

#include "platform/clock.hpp"
#include "platform/system_message.hpp"
#include "platform/waitable_timer_windows.hpp"
#include "platform/wake_signal.hpp"

namespace tactus {

struct WakeSignal::System {
    HANDLE woken = CreateEventW(nullptr, FALSE, FALSE, nullptr);
    HANDLE came = CreateEventW(nullptr, TRUE, FALSE, nullptr);
    HANDLE timer = windows::open_timer();
};

WakeSignal::WakeSignal() : system_(std::make_unique<System>()) {
    if (system_->woken == nullptr || system_->came == nullptr || system_->timer == nullptr) {
        error_ = system_message(static_cast<int>(GetLastError()));
    }
}

WakeSignal::~WakeSignal() {
    for (const HANDLE handle : {system_->woken, system_->came, system_->timer}) {
        if (handle != nullptr) {
            CloseHandle(handle);
        }
    }
}

// Asking for the event anew sets it where something waits already.
void WakeSignal::wait(Nanoseconds deadline, std::span<const WaitFile> files) {
    const Nanoseconds left = deadline - monotonic_now();
    if (left <= 0) {
        return;
    }
    ResetEvent(system_->came);
    for (const WaitFile& file : files.first(std::min(files.size(), max_files))) {
        WSAEventSelect(static_cast<SOCKET>(file.handle), system_->came, FD_READ | FD_CLOSE);
    }
    windows::arm(system_->timer, left);
    const std::array<HANDLE, 3> handles{system_->woken, system_->came, system_->timer};
    WaitForMultipleObjects(static_cast<DWORD>(handles.size()), handles.data(), FALSE, INFINITE);
}

void WakeSignal::signal() {
    SetEvent(system_->woken);
}

}  // namespace tactus
