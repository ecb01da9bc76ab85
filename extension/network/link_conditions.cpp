#include "network/link_conditions.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace tactus {
namespace {

constexpr double longest_delay_ms = 3'600'000.0;

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blank = " \t\r";
    const std::size_t first = text.find_first_not_of(blank);
    return first == text.npos ? "" : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

// False where `word` is no delay.
bool parse_delay(std::string_view word, Nanoseconds& delay) {
    if (word == "lost") {
        delay = DelayTrace::lost;
        return true;
    }
    double milliseconds = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), milliseconds);
    if (error != std::errc{} || end != word.data() + word.size() ||
        !(milliseconds >= 0.0 && milliseconds <= longest_delay_ms)) {
        return false;
    }
    delay = from_seconds(milliseconds * 1e-3);
    return true;
}

}  // namespace

DelayTraceResult parse_delay_trace(std::string_view text) {
    DelayTraceResult result;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view word = trimmed(text.substr(0, std::min(text.find('#'), end)));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (word.empty()) {
            continue;
        }
        Nanoseconds delay = 0;
        if (!parse_delay(word, delay)) {
            result.error = "line " + std::to_string(line) + ": \"" + std::string(word.substr(0, 40)) +
                           "\" is neither milliseconds nor \"lost\"";
            return result;
        }
        result.trace.delays.push_back(delay);
    }
    if (result.trace.delays.empty()) {
        result.error = "no delay in it";
    }
    return result;
}

// In the long run the model is bad for enter / (enter + leave) of the time, and every datagram is lost then.
BurstLoss bursts(double share, double length) {
    if (!(share > 0.0)) {
        return {};
    }
    if (share >= 1.0) {
        return {1.0, 0.0, 1.0};
    }
    const double leave = 1.0 / std::max(length, 1.0);
    const double enter = leave * share / (1.0 - share);
    // Bursts too short to lose so much cannot be entered more often than always: they get longer.
    return enter <= 1.0 ? BurstLoss{enter, leave, 1.0} : BurstLoss{1.0, (1.0 - share) / share, 1.0};
}

namespace {

// The mean of max(delay + jitter x, 0), x even in [-1, 1] or a standard normal deviate (unit: milliseconds).
double mean_delay_ms(JitterShape shape, double delay, double jitter) {
    if (shape == JitterShape::uniform) {
        return jitter <= delay ? delay : (delay + jitter) * (delay + jitter) / (4.0 * jitter);
    }
    const double ratio = delay / jitter;
    constexpr double root_two_pi = 2.506628274631000502;
    return delay * 0.5 * std::erfc(-ratio / std::sqrt(2.0)) +
           jitter * std::exp(-0.5 * ratio * ratio) / root_two_pi;
}

std::string in_ms(double milliseconds) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g ms", milliseconds);
    return text;
}

}  // namespace

std::vector<std::string> notes_on(const LinkConditions& conditions, double burst_share, double burst_length) {
    std::vector<std::string> notes;
    const double delay = 1e3 * to_seconds(conditions.delay), jitter = 1e3 * to_seconds(conditions.jitter);
    const bool goes_below =
        jitter > 0.0 && ((conditions.shape == JitterShape::uniform && jitter > delay) ||
                         (conditions.shape == JitterShape::normal && 3.0 * jitter > delay));
    if (goes_below) {
        notes.push_back("no delay is below 0: with 'delay' " + in_ms(delay) + " and 'jitter' " +
                        in_ms(jitter) + " the mean is " +
                        in_ms(mean_delay_ms(conditions.shape, delay, jitter)));
    }
    if (conditions.keep_order && (jitter > 0.0 || conditions.shape == JitterShape::trace)) {
        notes.push_back(
            "with 'keep_order' a datagram waits for those before it: the mean delay is more than 'delay'");
    }
    const double least = burst_share < 1.0 ? burst_share / (1.0 - burst_share) : 1.0;
    if (burst_share > 0.0 && burst_length < least) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "bursts of %.3g datagrams cannot lose a share of %.3g: they are %.3g long",
                      burst_length, burst_share, least);
        notes.push_back(text);
    }
    return notes;
}

}  // namespace tactus
