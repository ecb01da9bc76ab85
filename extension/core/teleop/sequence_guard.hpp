// Where in the operator's sequence the next sample can be.
//
// The operator takes one sample a tick of its own: since the newest one came, not many more can have been
// taken than ticks have passed, and a transit does not shrink by more than `max_shrink` from one sample to
// the next. What is older than the ring is of no use. Where nothing plausible comes for a while and what is
// refused agrees with itself, the sequence has been begun anew.
#pragma once

#include <cmath>
#include <cstdint>

namespace tactus {

class SequenceGuard {
public:
    static constexpr std::uint64_t max_shrink = 128;  // (unit: samples)
    static constexpr double silence_seconds = 0.05;
    static constexpr double agreeing_seconds = 0.02;

    // `ratio`: samples in a tick; `seconds`: of a tick, > 0.
    void set(double ratio, double seconds) {
        ratio_ = ratio;
        seconds_ = seconds;
    }

    // `newest`: the newest one believed, 0: none; `ring`: how many places back can still be used.
    bool is_plausible(std::uint64_t sequence, std::uint64_t newest, std::uint64_t ring,
                      std::uint64_t tick) const {
        if (newest == 0) {
            return true;
        }
        if (sequence <= newest) {
            return newest - sequence < ring;
        }
        const double passed = static_cast<double>(tick - newest_at_) * ratio_;
        constexpr double drift = 1.01;
        return static_cast<double>(sequence - newest) <= static_cast<double>(max_shrink) + drift * passed;
    }

    // A newest one has been believed.
    void note_newest(std::uint64_t tick) { newest_at_ = tick; }

    // A sample has been refused. True where it is to be believed after all.
    bool is_new_beginning(std::uint64_t sequence, std::uint64_t tick) {
        const double passed = static_cast<double>(tick - suspect_at_) * ratio_;
        const double went = static_cast<double>(sequence) - static_cast<double>(suspect_);
        if (suspect_ == 0 || std::abs(went - passed) > static_cast<double>(max_shrink)) {
            suspect_ = sequence;
            suspect_at_ = tick;
            return false;
        }
        return seconds(tick - newest_at_) >= silence_seconds &&
               seconds(tick - suspect_at_) >= agreeing_seconds;
    }

    void forget() { suspect_ = 0; }

private:
    double seconds(std::uint64_t ticks) const { return static_cast<double>(ticks) * seconds_; }

    double ratio_ = 1.0;
    double seconds_ = 0.001;
    std::uint64_t newest_at_ = 0;  // tick in which the newest one came
    std::uint64_t suspect_ = 0;    // the first one that was refused and that later ones agree with; 0: none
    std::uint64_t suspect_at_ = 0;
};

}  // namespace tactus
