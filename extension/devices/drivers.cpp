#include "devices/drivers.hpp"

#include <utility>

#include "devices/falcon/falcon_driver.hpp"
#include "devices/haply/inverse3_driver.hpp"
#include "devices/vendors/force_dimension_driver.hpp"
#include "devices/vendors/openhaptics_driver.hpp"

namespace tactus {

std::unique_ptr<Driver> make_driver(DriverKind kind, DriverSettings settings) {
    switch (kind) {
        case DriverKind::falcon:
            return std::make_unique<FalconDriver>(
                FalconSettings{std::move(settings.firmware), std::move(settings.id), settings.weight, {}});
        case DriverKind::force_dimension:
            return std::make_unique<ForceDimensionDriver>(std::move(settings.id));
        case DriverKind::openhaptics:
            return std::make_unique<OpenHapticsDriver>(std::move(settings.id));
        case DriverKind::inverse3:
            return std::make_unique<Inverse3Driver>(std::move(settings.id));
    }
    return nullptr;
}

}  // namespace tactus
