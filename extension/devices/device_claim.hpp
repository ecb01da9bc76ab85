// A device that a driver of this program has: a second driver on it would push the same hand.
#pragma once

#include <string>

namespace tactus {

class DeviceClaim {
public:
    DeviceClaim() = default;
    ~DeviceClaim() { give_back(); }
    DeviceClaim(const DeviceClaim&) = delete;
    DeviceClaim& operator=(const DeviceClaim&) = delete;

    // By a name that no device of another kind has. False: another driver has it. What was claimed before is
    // given back.
    bool take(const std::string& name);
    void give_back();

private:
    std::string name_;
};

}  // namespace tactus
