// Which devices there are drivers for. Nothing of a driver, and no library that it needs, is in the process
// until one is made and opened.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/driver.hpp"

namespace tactus {

enum class DriverKind : std::uint8_t { falcon };

struct DriverSettings {
    std::string id;                      // of one of several; empty: the first that is free
    std::vector<std::uint8_t> firmware;  // for those that need it at every start
    double weight = 0.0;  // of arm and grip in the hand, which the motors carry (unit: newtons), >= 0
};

std::unique_ptr<Driver> make_driver(DriverKind kind, DriverSettings settings);

}  // namespace tactus
