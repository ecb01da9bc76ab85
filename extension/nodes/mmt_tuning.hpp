#pragma once

#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>

#include "nodes/properties.hpp"
#include "session/teleop_port.hpp"

namespace tactus {

// Everything about a teleoperation that can be turned, as a resource that links, scenes and experiments
// share. What the link itself says (scenario, schemes, clock) is left as it is by default.
class MMTTuning : public godot::Resource {
    GDCLASS(MMTTuning, godot::Resource)

public:
    TACTUS_PROPERTIES(MMTTuning)

    const TeleopSettings& settings() const { return values_; }

protected:
    static void _bind_methods();

private:
    TeleopSettings values_;
};

}  // namespace tactus
