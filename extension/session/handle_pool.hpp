// The numbers by which the owner of a session and its loop speak of bodies, devices, proxies, tools, joints.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "session/session_types.hpp"

namespace tactus {

// Hands out the numbers 0 … count - 1, the lowest free one first.
class HandlePool {
public:
    explicit HandlePool(std::size_t count) : in_use_(count) {
        for (std::size_t i = count; i-- > 0;) {
            free_.push_back(static_cast<SessionHandle>(i));
        }
    }
    // `wanted`: this one, where it is free; no_handle: any.
    SessionHandle take(SessionHandle wanted) {
        const auto found =
            wanted == no_handle && !free_.empty() ? free_.end() - 1 : std::ranges::find(free_, wanted);
        if (found == free_.end()) {
            return no_handle;
        }
        const SessionHandle handle = *found;
        free_.erase(found);
        in_use_[handle] = true;
        return handle;
    }
    bool in_use(SessionHandle handle) const { return handle < in_use_.size() && in_use_[handle]; }
    // Also those that the loop may still have.
    bool any() const { return free_.size() < in_use_.size(); }
    // Its owner lets go of it; the loop may still have it. False where nobody held it.
    bool let_go(SessionHandle handle) {
        const bool held = in_use(handle);
        if (held) {
            in_use_[handle] = false;
        }
        return held;
    }
    void give_back(SessionHandle handle) {
        if (handle != no_handle) {
            in_use_[handle] = false;
            free_.push_back(handle);
        }
    }

private:
    std::vector<SessionHandle> free_;
    std::vector<bool> in_use_;
};

}  // namespace tactus
