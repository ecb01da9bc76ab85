// The two sides of a teleoperation.
#pragma once

#include <cstdint>

namespace tactus {

enum class Side : std::uint8_t { operator_side = 0, teleoperator_side = 1 };

}  // namespace tactus
