#include "devices/drivers.hpp"

#include <utility>

#include "devices/falcon/falcon_driver.hpp"

namespace tactus {

std::unique_ptr<Driver> make_driver(DriverKind kind, DriverSettings settings) {
    switch (kind) {
        case DriverKind::falcon:
            return std::make_unique<FalconDriver>(
                FalconSettings{std::move(settings.firmware), std::move(settings.id), settings.weight, {}});
    }
    return nullptr;
}

}  // namespace tactus
