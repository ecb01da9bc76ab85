#include "shared/bench_kit.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "support/process.hpp"

namespace tactus::shared {

Options::Options(int count, char** arguments) {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a bench of minutes says what it has, also into a file
    for (int i = 1; i < count; ++i) {
        const std::string_view argument = arguments[i];
        const std::size_t equals = argument.find('=');
        const bool named = argument.starts_with("--");
        arguments_.push_back({std::string(argument.substr(named ? 2 : 0, equals - (named ? 2 : 0))),
                              equals == argument.npos ? "" : std::string(argument.substr(equals + 1)), false,
                              named});
    }
}

Options::Argument* Options::find(std::string_view key) {
    const auto found = std::ranges::find(arguments_, key, &Argument::key);
    if (found == arguments_.end()) {
        return nullptr;
    }
    found->used = true;
    return &*found;
}

bool Options::has(std::string_view key) {
    return find(key) != nullptr;
}

std::string Options::text(std::string_view key, std::string fallback) {
    const Argument* const found = find(key);
    return found ? found->value : fallback;
}

double Options::number(std::string_view key, double fallback) {
    Argument* const found = find(key);
    if (!found) {
        return fallback;
    }
    double value = 0.0;
    const char* const end = found->value.data() + found->value.size();
    const auto [read_to, error] = std::from_chars(found->value.data(), end, value);
    found->sound = error == std::errc{} && read_to == end && std::isfinite(value);
    return value;
}

bool Options::understood() const {
    bool all = true;
    for (const Argument& argument : arguments_) {
        if (!argument.used || !argument.sound) {
            std::fprintf(stderr, "not understood: %s%s%s\n", argument.key.c_str(),
                         argument.value.empty() ? "" : "=", argument.value.c_str());
            all = false;
        }
    }
    return all;
}

bool is_chosen(std::string_view name, std::string_view pattern, bool whole) {
    if (pattern.empty()) {
        return true;
    }
    if (name.empty()) {
        return !whole || pattern.find_first_not_of('*') == pattern.npos;
    }
    if (pattern.front() == '*') {
        return is_chosen(name, pattern.substr(1), whole) || is_chosen(name.substr(1), pattern, whole);
    }
    return name.front() == pattern.front() && is_chosen(name.substr(1), pattern.substr(1), whole);
}

void Report::set(const std::string& key, double value) {
    const auto found = std::ranges::find(values_, key, &std::pair<std::string, double>::first);
    if (found != values_.end()) {
        found->second = value;
    } else {
        values_.emplace_back(key, value);
    }
}

KeptFile::KeptFile(std::filesystem::path path) : path_(std::move(path)), partial_(path_) {
    std::error_code failed;
    if (path_.has_parent_path()) {
        std::filesystem::create_directories(path_.parent_path(), failed);
    }
    partial_ += ".partial";
    file_ = std::fopen(partial_.string().c_str(), "w");
    if (!file_) {
        std::perror(partial_.string().c_str());
    }
}

KeptFile::~KeptFile() {
    if (file_) {
        std::fclose(file_);
    }
}

bool KeptFile::keep() {
    if (!file_) {
        return false;
    }
    // What the system still holds is written now, or never.
    const bool failed_before = std::ferror(file_) != 0;
    const bool failed_now = std::fclose(std::exchange(file_, nullptr)) != 0;
    std::error_code failed;
    if (failed_before || failed_now) {
        std::fprintf(stderr, "%s could not be written to its end: is the disk full?\n",
                     path_.string().c_str());
        std::filesystem::remove(partial_, failed);
        return false;
    }
    std::filesystem::rename(partial_, path_, failed);
    if (failed) {
        std::fprintf(stderr, "%s: %s\n", path_.string().c_str(), failed.message().c_str());
    }
    return !failed;
}

bool Report::write_json(const std::filesystem::path& path) const {
    if (values_.empty()) {
        std::fprintf(stderr, "nothing of that name is measured; %s stays as it was\n", path.string().c_str());
        return false;
    }
    KeptFile file(path);
    if (!file.get()) {
        return false;
    }
    const char* separator = "{\n";
    for (const auto& [key, value] : values_) {
        std::fprintf(file.get(), "%s  \"%s\": %.9g", separator, key.c_str(),
                     std::isfinite(value) ? value : -1.0);
        separator = ",\n";
    }
    std::fputs("\n}\n", file.get());
    return file.keep();
}

std::filesystem::path result_path(std::string_view name) {
    const char* const given = std::getenv("TACTUS_BENCH_JSON");
    return given ? std::filesystem::path(given)
                 : std::filesystem::path("build/bench") / (std::string(name) + ".json");
}

SpanClock::SpanClock() {
    using Steady = std::chrono::steady_clock;
    const auto start = Steady::now();
    const std::uint64_t first = now();
    while (Steady::now() - start < std::chrono::milliseconds(50)) {
    }
    const std::uint64_t last = now();
    per_count_ = std::chrono::duration<double, std::nano>(Steady::now() - start).count() /
                 static_cast<double>(last - first);
    std::vector<double> empty;
    for (int i = 0; i < 2'000; ++i) {
        const std::uint64_t from = now();
        empty.push_back(static_cast<double>(now() - from));
    }
    cost_ = quantile(empty, 0.5);
}

std::uint64_t SpanClock::now() const {
    return testing::time_stamp();
}

double SpanClock::nanoseconds(std::uint64_t from, std::uint64_t to) const {
    return std::max(0.0, static_cast<double>(to - from) - cost_) * per_count_;
}

double quantile(std::vector<double>& values, double q) {
    if (values.empty()) {
        return 0.0;
    }
    const auto place = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
}

void run_on_two_threads(std::size_t count, const std::function<void(std::size_t)>& task) {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            task(i);
        }
    };
    if (count < 2) {
        work();
        return;
    }
    std::thread other([&work] {
        // A thread begins with its maker's processors: that may be one only.
        testing::leave_one_processor();
        work();
    });
    work();
    other.join();
}

}  // namespace tactus::shared
