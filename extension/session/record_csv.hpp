// A recording as text: one row a tick, the thesis's columns first (section 5.1), the same bytes in every
// locale.
#pragma once

#include <string>

#include "session/session_types.hpp"

namespace tactus {

// With the end of its line. Units: microseconds, newtons, meters; rotations are unit quaternions.
std::string record_csv_header();

// `epoch` is the zero of the session's clock: times count from where that is zero.
void append_record_csv(std::string& text, const SessionRecord& record, Nanoseconds epoch);

}  // namespace tactus
