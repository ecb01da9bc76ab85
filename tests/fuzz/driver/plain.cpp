// Plays a target without libFuzzer, for compilers that have none: what the target begins with and what stands
// in FOLDERs first, then these again and again with bytes that have changed. Blind where libFuzzer sees which
// code an input reaches; the same options, and the same files for what it finds.
//
//     TARGET [-runs=1000] [-seed=1] [-max_len=4096] [-timeout=60] [-artifact_prefix=PREFIX] [FOLDER…]
//     TARGET FILE…             plays these alone
//     TARGET -seeds=FOLDER     writes what the target begins with, for libFuzzer to go on from
//
// An input that ends the program is kept as PREFIXcrash-NUMBER, one that takes longer than `timeout` seconds
// of the processor as PREFIXtimeout-NUMBER, NUMBER being the run's; the program ends with 77 and 70.
#include <fcntl.h>
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "fuzz_target.hpp"
#include "shared/dice.hpp"

namespace tactus::fuzz {
namespace {

struct Options {
    std::uint64_t runs = 1000, seed = 1, max_len = 4096, timeout = 60;
    std::string artifact_prefix, seeds;
    std::vector<std::filesystem::path> folders, files;
};

bool parse(int count, char** arguments, Options& options) {
    const auto number = [](std::string_view text, std::uint64_t& into) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), into);
        return error == std::errc{} && end == text.data() + text.size();
    };
    for (int i = 1; i < count; ++i) {
        const std::string_view argument = arguments[i];
        const std::string_view key = argument.substr(0, argument.find('='));
        const std::string_view value = key.size() < argument.size() ? argument.substr(key.size() + 1) : "";
        bool known = true;
        if (key == "-runs") {
            known = number(value, options.runs);
        } else if (key == "-seed") {
            known = number(value, options.seed);
        } else if (key == "-max_len") {
            known = number(value, options.max_len) && options.max_len > 0;
        } else if (key == "-timeout") {
            known = number(value, options.timeout) && options.timeout > 0;
        } else if (key == "-artifact_prefix") {
            options.artifact_prefix = value;
        } else if (key == "-seeds") {
            options.seeds = value;
        } else if (!argument.starts_with('-')) {
            (std::filesystem::is_directory(argument) ? options.folders : options.files)
                .emplace_back(argument);
        } else {
            known = false;
        }
        if (!known) {
            std::fprintf(stderr, "not understood: %s\n", arguments[i]);
            return false;
        }
    }
    return true;
}

// --- what is kept of a run that does not return

// Written by handlers of signals: plain memory, made before.
struct Present {
    const std::byte* data = nullptr;
    std::size_t size = 0;
    std::uint64_t run = 0;
    std::array<char, 4096> path{};
    std::size_t prefix = 0;
} present;

// By what a handler may call.
void keep(std::string_view kind) {
    char* at = present.path.data() + present.prefix;
    at = std::copy(kind.begin(), kind.end(), at);
    at = std::to_chars(at, present.path.data() + present.path.size() - 1, present.run).ptr;
    *at = '\0';
    const int file = open(present.path.data(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    bool kept = file >= 0;
    for (std::size_t done = 0; kept && done < present.size;) {
        const ssize_t written = write(file, present.data + done, present.size - done);
        kept = written > 0;
        done += kept ? static_cast<std::size_t>(written) : 0;
    }
    const std::string_view said = kept ? "Test unit written to " : "The input could not be kept: ";
    [[maybe_unused]] ssize_t told = write(STDERR_FILENO, said.data(), said.size());
    *at++ = '\n';
    told = write(STDERR_FILENO, present.path.data(), static_cast<std::size_t>(at - present.path.data()));
}

constexpr int exit_crash = 77, exit_timeout = 70;

void on_crash(int) {
    keep("crash-");
    _exit(exit_crash);
}
void on_timeout(int) {
    keep("timeout-");
    _exit(exit_timeout);
}

void watch(const Options& options) {
    const std::string& prefix = options.artifact_prefix;
    present.prefix = std::min(prefix.size(), present.path.size() - 64);
    std::copy_n(prefix.begin(), present.prefix, present.path.begin());
    // A stack that has overflown is no place to handle that on.
    static std::array<std::byte, 1 << 16> stack;
    const stack_t other{stack.data(), 0, stack.size()};
    sigaltstack(&other, nullptr);
    struct sigaction action{};
    action.sa_flags = SA_ONSTACK;
    action.sa_handler = on_crash;
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGTRAP}) {
        sigaction(signal, &action, nullptr);
    }
    action.sa_handler = on_timeout;
    sigaction(SIGPROF, &action, nullptr);
}

void run(const Bytes& input, const Options& options) {
    ++present.run;
    present.data = input.data();
    present.size = input.size();
    // Of this process's own processor time: a busy machine makes nothing hang.
    const itimerval limit{{}, {static_cast<time_t>(options.timeout), 0}};
    setitimer(ITIMER_PROF, &limit, nullptr);
    play(input);
}

// --- inputs

Bytes bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
    return {begin, begin + text.size()};
}

std::vector<Bytes> beginning(const Options& options) {
    std::vector<Bytes> all = seeds();
    for (const std::filesystem::path& folder : options.folders) {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            files.push_back(entry.path());
        }
        std::ranges::sort(files);
        for (const std::filesystem::path& file : files) {
            all.push_back(bytes_of(file));
        }
    }
    return all;
}

class Changes {
public:
    Changes(const std::vector<Bytes>& all, const Options& options)
        : all_(all), most_(options.max_len), dice_(options.seed) {}

    Bytes next() {
        Bytes bytes = all_.empty() ? Bytes{} : all_[dice_.below(all_.size())];
        for (std::uint64_t hits = 1 + dice_.below(8); hits > 0; --hits) {
            change(bytes);
        }
        bytes.resize(std::min<std::size_t>(bytes.size(), most_));
        return bytes;
    }

private:
    void change(Bytes& bytes) {
        if (bytes.empty()) {
            bytes.resize(1 + dice_.below(64));
        }
        const std::size_t at = dice_.below(bytes.size());
        const std::size_t length = 1 + dice_.below(std::min<std::size_t>(32, bytes.size() - at));
        const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
        const auto end = place + static_cast<std::ptrdiff_t>(length);
        switch (dice_.below(7)) {
            case 0:
                bytes[at] ^= static_cast<std::byte>(1u << dice_.below(8));
                break;
            case 1:
                bytes[at] = static_cast<std::byte>(dice_.bits());
                break;
            case 2: {  // a number at which something ends
                const std::uint64_t number = dice_.number();
                std::memcpy(&bytes[at], &number, std::min<std::size_t>(sizeof number, bytes.size() - at));
                break;
            }
            case 3: {
                const double real = dice_.one_in(4) ? 0.0 / (dice_.unit() - 2.0) : dice_.real(1e9);
                std::memcpy(&bytes[at], &real, std::min(sizeof real, bytes.size() - at));
                break;
            }
            case 4:
                bytes.erase(place, end);
                break;
            case 5: {  // once more
                const Bytes piece(place, end);
                bytes.insert(place, piece.begin(), piece.end());
                break;
            }
            default: {  // of another input
                const Bytes& other = all_.empty() ? bytes : all_[dice_.below(all_.size())];
                for (std::size_t i = 0; i < length && i < other.size(); ++i) {
                    bytes[at + i] = other[dice_.one_in(2) ? i : (at + i) % other.size()];
                }
            }
        }
    }

    const std::vector<Bytes>& all_;
    std::size_t most_;
    shared::Dice dice_;
};

bool write_seeds(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    int number = 0;
    for (const Bytes& one : seeds()) {
        std::ofstream file(folder / ("seed_" + std::to_string(number++)), std::ios::binary);
        file.write(reinterpret_cast<const char*>(one.data()), static_cast<std::streamsize>(one.size()));
        if (!file) {
            return false;
        }
    }
    return true;
}

}  // namespace
}  // namespace tactus::fuzz

int main(int count, char** arguments) {
    using namespace tactus::fuzz;
    Options options;
    if (!parse(count, arguments, options)) {
        return 2;
    }
    if (!options.seeds.empty()) {
        return write_seeds(options.seeds) ? 0 : 1;
    }
    watch(options);
    for (const std::filesystem::path& file : options.files) {
        run(bytes_of(file), options);
    }
    if (!options.files.empty()) {
        return 0;
    }
    const std::vector<Bytes> all = beginning(options);
    for (const Bytes& one : all) {
        run(one, options);
    }
    Changes changes(all, options);
    while (present.run < options.runs) {
        run(changes.next(), options);
    }
    std::printf("stat::number_of_executed_units: %llu\n", static_cast<unsigned long long>(present.run));
    return 0;
}
