#include "support/comma_locale.hpp"

#include <array>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "support/process.hpp"

namespace tactus::testing {

namespace {

constexpr std::array names = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de-DE"};

bool take_one() {
    for (const char* name : names) {
        if (std::setlocale(LC_NUMERIC, name) != nullptr && CommaLocale::is_in_force()) {
            return true;
        }
    }
    return false;
}

// By glibc's own compiler of locales, into a folder where it looks for them.
void make_one() {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "tactus_locales";
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    const std::string made = (folder / "de_DE.UTF-8").string();
    const std::string command =
        "localedef --no-archive -i de_DE -f UTF-8 '" + made + "' >/dev/null 2>/dev/null";
    if (!std::filesystem::exists(made) && std::system(command.c_str()) != 0) {
        return;
    }
    set_environment("LOCPATH", folder.string().c_str());
}

}  // namespace

CommaLocale::CommaLocale() : before_(std::setlocale(LC_NUMERIC, nullptr)) {
    if (!take_one()) {
        make_one();
        take_one();
    }
}

CommaLocale::~CommaLocale() {
    std::setlocale(LC_NUMERIC, before_.c_str());
}

bool CommaLocale::is_in_force() {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%.1f", 0.5);
    return text[1] == ',';
}

}  // namespace tactus::testing
