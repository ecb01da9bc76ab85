#include "devices/device_claim.hpp"

#include <mutex>
#include <set>

namespace tactus {

namespace {

// Of all drivers; it outlives threads that hang in a vendor's library.
struct ClaimedDevices {
    std::mutex mutex;
    std::set<std::string> names;
};
ClaimedDevices& claimed_devices() {
    static ClaimedDevices& all = *new ClaimedDevices;
    return all;
}

}  // namespace

bool DeviceClaim::take(const std::string& name) {
    give_back();
    ClaimedDevices& all = claimed_devices();
    const std::lock_guard lock(all.mutex);
    if (!all.names.insert(name).second) {
        return false;
    }
    name_ = name;
    return true;
}

void DeviceClaim::give_back() {
    if (name_.empty()) {
        return;
    }
    ClaimedDevices& all = claimed_devices();
    const std::lock_guard lock(all.mutex);
    all.names.erase(name_);
    name_.clear();
}

}  // namespace tactus
