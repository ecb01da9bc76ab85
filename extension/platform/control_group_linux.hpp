#pragma once

#include <string>

namespace tactus {

// Whether a control group (version 2) limits this process's processor time, from the text of its cpu.max.
bool limits_processor_time(const std::string& cpu_max);

}  // namespace tactus
