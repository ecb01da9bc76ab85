// What tests and benches ask the system about themselves.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/math/types.hpp"

namespace tactus::testing {

// The file of the running program.
std::filesystem::path program_path();

// Processor time of the whole process; that of a thread is in platform/clock.hpp.
Nanoseconds process_time();

// Memory of this process that is in the machine's (unit: bytes).
double resident_bytes();

// Keeps this thread on the processor it runs on. False where the system does not permit it.
bool stay_on_one_processor();

// Gives the calling thread all processors that the program began with: a new thread begins with its maker's.
void leave_one_processor();

// Null takes it away.
void set_environment(const char* name, const char* value);

// Runs the tests of this program that `filter` names once more, in a process of its own on the processors
// named ("0", "0,1"), with one more variable in its environment. Whether it ended well.
bool run_tests_again(const std::string& filter, const char* variable, const std::string& value,
                     const std::string& processors);

// Counts up fast and evenly, on all processors alike; taken when all before has been done.
std::uint64_t time_stamp();

}  // namespace tactus::testing
