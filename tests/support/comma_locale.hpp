// A locale that writes 0.5 as "0,5", for tests of what must not follow it.
#pragma once

#include <string>

namespace tactus::testing {

// In force for numbers of the whole program while this lives. Systems have such locales installed or not:
// where there is none, one is made, if the system has the tool for it.
class CommaLocale {
public:
    CommaLocale();
    ~CommaLocale();
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

    // Whether numbers are written with a comma now. A test without that tests nothing, and is to be skipped.
    static bool is_in_force();

private:
    std::string before_;
};

}  // namespace tactus::testing
