// What the benches share: options, a clock for single ticks, figures over many of them, flat reports.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/tree/triangle_tree.hpp"

namespace tactus::shared {

// --key=value and --key. Every key that is asked for is known; what is left over is not.
class Options {
public:
    Options(int count, char** arguments);

    bool has(std::string_view key);
    std::string text(std::string_view key, std::string fallback = {});
    double number(std::string_view key, double fallback);

    // False, with a message on stderr, where something was not understood.
    bool understood() const;

private:
    struct Argument {
        std::string key, value;
        bool used = false;
        bool sound = true;
    };
    Argument* find(std::string_view key);
    std::vector<Argument> arguments_;
};

// Whether `name` is among what --only=PATTERN chooses: names that begin with the pattern, in which * stands
// for anything. With `whole` false the name may go on: whether something that begins with it can be chosen.
bool is_chosen(std::string_view name, std::string_view pattern, bool whole = true);

// A file of results that takes the place of the one before when all of it is there, and not sooner.
class KeptFile {
public:
    // Where it cannot be made, the reason is on stderr and `get` is null.
    explicit KeptFile(std::filesystem::path path);
    ~KeptFile();
    KeptFile(const KeptFile&) = delete;
    KeptFile& operator=(const KeptFile&) = delete;

    std::FILE* get() const { return file_; }
    // Closes it. False where not all of it could be written: then the file of before is as it was, and the
    // reason is on stderr.
    bool keep();

private:
    std::filesystem::path path_, partial_;
    std::FILE* file_ = nullptr;
};

// One flat JSON object; CASE.metric keys in the order they were set.
class Report {
public:
    void set(const std::string& key, double value);
    bool write_json(const std::filesystem::path& path) const;

private:
    std::vector<std::pair<std::string, double>> values_;
};

// Where a bench writes: the file named by TACTUS_BENCH_JSON, or build/bench/NAME.json.
std::filesystem::path result_path(std::string_view name);

// The processor's time stamp counter as a clock for spans from ten nanoseconds on.
class SpanClock {
public:
    SpanClock();
    std::uint64_t now() const;
    // Length of the span, without the cost of taking the time (unit: nanoseconds).
    double nanoseconds(std::uint64_t from, std::uint64_t to) const;

private:
    double per_count_ = 1.0;  // (unit: nanoseconds)
    double cost_ = 0.0;       // (unit: counts)
};

// The value below which the share q of all lies; 0 for none. Reorders.
double quantile(std::vector<double>& values, double q);

// Two tasks at a time, on two processors also where the calling thread stays on one.
void run_on_two_threads(std::size_t count, const std::function<void(std::size_t)>& task);

}  // namespace tactus::shared
