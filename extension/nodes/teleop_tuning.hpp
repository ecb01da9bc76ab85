#pragma once

#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>

#include "nodes/value_rows.hpp"
#include "session/teleop_port.hpp"

namespace tactus {

// Everything about a teleoperation that can be turned, as a resource that links, scenes and experiments
// share. What the link itself says (scenario, schemes, clock) is left as it is by default.
class TeleopTuning : public godot::Resource {
    GDCLASS(TeleopTuning, godot::Resource)

public:
    static std::span<const ValueRow<TeleopSettings>> rows();

    void set_value(int64_t index, const godot::Variant& value) {
        tactus::set_value(*this, rows(), index, values_, value);
    }
    godot::Variant get_value(int64_t index) const { return tactus::get_value(rows(), index, values_); }

    const TeleopSettings& settings() const { return values_; }

protected:
    static void _bind_methods();

private:
    TeleopSettings values_;
};

}  // namespace tactus
