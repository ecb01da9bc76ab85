#include "support/process.hpp"

#include <sched.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace tactus::testing {

namespace {

// Those that the program began with.
const cpu_set_t& processors() {
    static const cpu_set_t all = [] {
        cpu_set_t set;
        CPU_ZERO(&set);
        sched_getaffinity(0, sizeof set, &set);
        return set;
    }();
    return all;
}

}  // namespace

std::filesystem::path program_path() {
    return std::filesystem::read_symlink("/proc/self/exe");
}

Nanoseconds process_time() {
    timespec taken;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &taken);
    return static_cast<Nanoseconds>(taken.tv_sec) * nanoseconds_per_second + taken.tv_nsec;
}

double resident_bytes() {
    long pages = 0, resident = 0;
    if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
        const int read = std::fscanf(file, "%ld %ld", &pages, &resident);
        std::fclose(file);
        resident = read == 2 ? resident : 0;
    }
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

bool stay_on_one_processor() {
    processors();
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(sched_getcpu()), &one);
    return sched_setaffinity(0, sizeof one, &one) == 0;
}

void leave_one_processor() {
    sched_setaffinity(0, sizeof(cpu_set_t), &processors());
}

void set_environment(const char* name, const char* value) {
    if (value != nullptr) {
        setenv(name, value, 1);
    } else {
        unsetenv(name);
    }
}

// A program for another processor is started through the emulator that runs this one.
bool run_tests_again(const std::string& filter, const char* variable, const std::string& value,
                     const std::string& processors) {
    const char* const emulator = std::getenv("TACTUS_EMULATOR");
    const std::string command = std::string(variable) + "='" + value + "' taskset -c " + processors + " " +
                                (emulator != nullptr ? emulator : "") + " '" + program_path().string() +
                                "' --gtest_filter=" + filter + " > /dev/null";
    return std::system(command.c_str()) == 0;
}

}  // namespace tactus::testing
