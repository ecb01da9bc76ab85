#include "support/process.hpp"

#include <windows.h>

#include <process.h>
#include <psapi.h>

#include <cstdlib>

namespace tactus::testing {

namespace {

Nanoseconds sum(const FILETIME& kernel, const FILETIME& user) {
    const auto steps = [](const FILETIME& time) {
        return static_cast<Nanoseconds>(time.dwHighDateTime) << 32 | time.dwLowDateTime;
    };
    return 100 * (steps(kernel) + steps(user));
}

DWORD_PTR mask_of(const std::string& processors) {
    DWORD_PTR mask = 0;
    for (const char c : processors) {
        mask |= c == ',' ? 0 : DWORD_PTR{1} << (c - '0');
    }
    return mask;
}

}  // namespace

std::filesystem::path program_path() {
    wchar_t path[MAX_PATH];
    const DWORD length = GetModuleFileNameW(nullptr, path, MAX_PATH);
    return std::wstring(path, length);
}

Nanoseconds process_time() {
    FILETIME created, ended, kernel, user;
    GetProcessTimes(GetCurrentProcess(), &created, &ended, &kernel, &user);
    return sum(kernel, user);
}

double resident_bytes() {
    PROCESS_MEMORY_COUNTERS use{};
    GetProcessMemoryInfo(GetCurrentProcess(), &use, sizeof use);
    return static_cast<double>(use.WorkingSetSize);
}

bool stay_on_one_processor() {
    return SetThreadAffinityMask(GetCurrentThread(), DWORD_PTR{1} << GetCurrentProcessorNumber()) != 0;
}

void leave_one_processor() {
    DWORD_PTR own = 0, of_the_system = 0;
    GetProcessAffinityMask(GetCurrentProcess(), &own, &of_the_system);
    SetThreadAffinityMask(GetCurrentThread(), own);
}

void set_environment(const char* name, const char* value) {
    _putenv_s(name, value != nullptr ? value : "");
}

// A process has its parent's processors.
bool run_tests_again(const std::string& filter, const char* variable, const std::string& value,
                     const std::string& processors) {
    DWORD_PTR own = 0, of_the_system = 0;
    GetProcessAffinityMask(GetCurrentProcess(), &own, &of_the_system);
    if (SetProcessAffinityMask(GetCurrentProcess(), mask_of(processors)) == 0) {
        return false;
    }
    set_environment(variable, value.c_str());
    const std::string path = program_path().string(), option = "--gtest_filter=" + filter;
    const std::intptr_t code =
        _spawnl(_P_WAIT, path.c_str(), path.c_str(), option.c_str(), "--gtest_brief=1", nullptr);
    set_environment(variable, nullptr);
    SetProcessAffinityMask(GetCurrentProcess(), own);
    return code == 0;
}

}  // namespace tactus::testing
