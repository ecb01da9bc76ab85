#include <winsock2.h>

#include <algorithm>

#include "platform/system_message.hpp"
#include "platform/udp_socket.hpp"
#include "platform/waitable_timer_windows.hpp"

namespace tactus {

struct SocketWait::System {
    HANDLE woken = CreateEventW(nullptr, TRUE, FALSE, nullptr);
    HANDLE came = CreateEventW(nullptr, TRUE, FALSE, nullptr);
    HANDLE timer = windows::open_timer();
};

SocketWait::SocketWait() : system_(std::make_unique<System>()) {
    if (system_->woken == nullptr || system_->came == nullptr || system_->timer == nullptr) {
        error_ = system_message(static_cast<int>(GetLastError()));
    }
}

SocketWait::~SocketWait() {
    for (const HANDLE handle : {system_->woken, system_->came, system_->timer}) {
        if (handle != nullptr) {
            CloseHandle(handle);
        }
    }
}

// Asking for the event anew sets it where something waits already.
void SocketWait::wait(std::span<const SocketHandle> sockets, Nanoseconds at_most) {
    ResetEvent(system_->came);
    for (const SocketHandle socket : sockets.first(std::min(sockets.size(), max_sockets))) {
        WSAEventSelect(static_cast<SOCKET>(socket), system_->came, FD_READ);
    }
    windows::arm(system_->timer, at_most);
    const std::array<HANDLE, 3> handles{system_->woken, system_->came, system_->timer};
    WaitForMultipleObjects(static_cast<DWORD>(handles.size()), handles.data(), FALSE, INFINITE);
}

void SocketWait::wake() {
    SetEvent(system_->woken);
}

}  // namespace tactus
