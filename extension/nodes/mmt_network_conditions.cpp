#include "nodes/mmt_network_conditions.hpp"

#include <godot_cpp/classes/file_access.hpp>

#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

void MMTNetworkConditions::set_trace_file(const String& path) {
    trace_file_ = path;
    trace_.reset();
    trace_error_ = String();
    if (!path.is_empty()) {
        if (!FileAccess::file_exists(path)) {
            trace_error_ = "there is no file '" + path + "'";
        } else if (DelayTraceResult read =
                       parse_delay_trace(from_godot(FileAccess::get_file_as_string(path)));
                   read.error.empty()) {
            trace_ = std::make_shared<const DelayTrace>(std::move(read.trace));
        } else {
            trace_error_ = "'" + path + "': " + to_godot(read.error);
        }
    }
    emit_changed();
}

LinkConditions MMTNetworkConditions::conditions() const {
    LinkConditions conditions = values_.link;
    conditions.trace = trace_.get();
    if (values_.burst_loss > 0.0) {
        conditions.burst = bursts(values_.burst_loss, values_.burst_length);
    }
    return conditions;
}

std::vector<std::string> MMTNetworkConditions::notes() const {
    return notes_on(conditions(), values_.burst_loss, values_.burst_length);
}

String MMTNetworkConditions::trace_problem() const {
    if (values_.link.shape != JitterShape::trace || trace_ != nullptr) {
        return String();
    }
    return trace_error_.is_empty() ? String(
                                         "the jitter is that of a trace and there is none: set 'trace_file' "
                                         "to a file of one delay in milliseconds a line")
                                   : trace_error_;
}

}  // namespace tactus
