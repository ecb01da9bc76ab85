// The eyes' shared library: loaded when a scene asks for it and never before; once loaded, it stays.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/ports/depth_sensing.hpp"

namespace tactus {

// Null: `error` says why and what to do. Main thread only.
const DepthSensing* depth_sensing(std::string& error);

// The cameras that are plugged in. Where they cannot be looked for, `error` says why and what to do.
std::vector<FoundCamera> found_cameras(std::string& error);

struct Destroy {
    template <class Made>
    void operator()(Made* made) const {
        made->destroy();
    }
};
using OwnedSensor = std::unique_ptr<SensorPort, Destroy>;
using OwnedScene = std::unique_ptr<SyntheticScene, Destroy>;

}  // namespace tactus
