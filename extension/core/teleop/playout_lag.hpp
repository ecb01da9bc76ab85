// How far behind the arrivals a playout has to stay so that hardly anything comes too late.
//
// Transits of samples are gathered in stretches of 50 ms; of the last forty stretches in which anything came,
// the one in twenty that needed most is left out: one outage, however long, is one stretch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

namespace tactus {

class PlayoutLag {
public:
    static constexpr double stretch_seconds = 0.05;

    struct Settings {
        double ratio = 1.0;          // samples in a tick
        std::uint32_t depth = 0;     // samples kept in hand at least
        bool sparse = false;         // the fastest one sets the pace
        std::uint64_t stretch = 50;  // (unit: ticks)
    };

    void set(const Settings& settings) { settings_ = settings; }

    // `wanted`: to begin with (unit: samples).
    void begin(double wanted) {
        wanted_ = wanted;
        count_ = at_ = 0;
        ticks_ = 0;
        less_for_ = 0;
        open_ = {};
    }

    // A sample came that a playout with a lag of `transit` could just have played (unit: samples).
    void note(double transit) {
        open_.max = std::max(open_.max, transit);
        open_.min = std::min(open_.min, transit);
        open_.last = transit;
    }

    void tick() {
        if (++ticks_ < settings_.stretch) {
            return;
        }
        ticks_ = 0;
        if (open_.min <= open_.max) {
            skip_backlog();
            stretches_[at_] = open_;
            at_ = (at_ + 1) % stretches_.size();
            count_ = std::min(count_ + 1, stretches_.size());
            open_ = {};
            weigh();
        }
    }

    double wanted() const { return wanted_; }

private:
    struct Stretch {
        double max = -std::numeric_limits<double>::infinity();
        double min = std::numeric_limits<double>::infinity();
        double last = 0.0;
    };
    static constexpr std::size_t max_kept = 40;
    static constexpr std::size_t left_out = 20;  // one in so many
    static constexpr std::size_t least_to_choose = 4;
    static constexpr int calm = 10;  // stretches that need less before less is kept

    // A playout that begins while this side works off what was sent during a standstill of it would stay as
    // late as the oldest of that.
    void skip_backlog() {
        const double long_ago = 2.0 * static_cast<double>(settings_.stretch) * settings_.ratio;
        if (count_ == 0 && open_.max - open_.last > long_ago) {
            wanted_ = open_.max = open_.last;
        }
    }

    void weigh() {
        const double needed = this->needed();
        if (needed > wanted_) {
            wanted_ = needed;
            less_for_ = 0;
        } else if (needed > wanted_ - 1.0) {
            less_for_ = 0;
        } else {
            enough_ = less_for_ == 0 ? needed : std::max(enough_, needed);
            if (++less_for_ >= calm || settings_.sparse) {
                wanted_ = enough_;
                less_for_ = 0;
            }
        }
    }

    double needed() const {
        std::array<double, max_kept> max{};
        double min = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < count_; ++i) {
            max[i] = stretches_[i].max;
            min = std::min(min, stretches_[i].min);
        }
        const double least = min + settings_.depth;
        if (settings_.sparse) {
            return least;
        }
        const std::size_t skip = count_ < least_to_choose ? 0 : (count_ + left_out - 1) / left_out;
        const auto nth = max.begin() + static_cast<std::ptrdiff_t>(skip);
        std::nth_element(max.begin(), nth, max.begin() + static_cast<std::ptrdiff_t>(count_),
                         std::greater<>{});
        // Between two samples both have to be there: one more where heads fall between them.
        const double between = settings_.ratio == std::floor(settings_.ratio) ? 0.0 : 1.0;
        return std::max(*nth + between, least);
    }

    Settings settings_;
    std::array<Stretch, max_kept> stretches_{};
    std::size_t count_ = 0, at_ = 0;
    Stretch open_;
    std::uint64_t ticks_ = 0;
    double wanted_ = 0.0;
    double enough_ = 0.0;
    int less_for_ = 0;
};

}  // namespace tactus
