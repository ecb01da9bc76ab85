// A scene as the far sides of its links are told of it. Owner's thread only.
#pragma once

#include <vector>

#include "world/body_mirrors.hpp"
#include "world/world_link.hpp"

namespace tactus {

void tell(const BodyMirrors& scene, const std::vector<std::unique_ptr<WorldLink>>& links,
          const SessionSnapshot& snapshot, Nanoseconds now);

}  // namespace tactus
