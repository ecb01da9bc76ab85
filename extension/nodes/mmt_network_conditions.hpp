#pragma once

#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <memory>

#include "network/link_conditions.hpp"
#include "nodes/properties.hpp"

namespace tactus {

// An emulated network, as a resource that links, scenes and experiments share.
class MMTNetworkConditions : public godot::Resource {
    GDCLASS(MMTNetworkConditions, godot::Resource)

public:
    struct Values {
        LinkConditions link;        // without burst and trace
        double burst_loss = 0.0;    // share lost in bursts, 0 … 0.95
        double burst_length = 5.0;  // datagrams, >= 1
        ClockSkew skew;             // of this side's clock
        std::uint64_t seed = 1;
    };
    TACTUS_PROPERTIES(MMTNetworkConditions)
    void set_trace_file(const godot::String& path);
    godot::String get_trace_file() const { return trace_file_; }

    // Points into trace().
    LinkConditions conditions() const;
    ClockSkew skew() const { return values_.skew; }
    std::uint64_t seed() const { return values_.seed; }
    std::shared_ptr<const DelayTrace> trace() const { return trace_; }
    std::vector<std::string> notes() const;  // see notes_on()
    godot::String trace_problem() const;     // empty where there is none

protected:
    static void _bind_methods();

private:
    Values values_;
    godot::String trace_file_;
    std::shared_ptr<const DelayTrace> trace_;
    godot::String trace_error_;
};

}  // namespace tactus
