// The operator's hands as the far side has them: what comes is kept and played out on this side's ticks
// (jitter_buffer.hpp), as the owner's settings and the ticks of the two sides ask for.
#pragma once

#include "core/teleop/jitter_buffer.hpp"
#include "session/channel.hpp"

namespace tactus {

class PlayedHands {
public:
    // `pointers`: of the operator that are heard; `seconds`: of a tick of this side.
    PlayedHands(const Channel& channel, std::size_t pointers, double seconds)
        : pointers_(pointers), seconds_(seconds) {
        set(channel);
    }

    // Once a tick. `changed`: the owner has given other settings.
    void follow(const Channel& channel, bool changed) {
        if (changed || channel.link().statistics().peer_hello.period != period_) {
            set(channel);
        }
    }

    void take(const OperatorSamples& samples) {
        for (std::size_t i = 0; i < samples.count; ++i) {
            if (samples.samples[i].pointer < pointers_) {
                buffers_[samples.samples[i].pointer].insert(samples.samples[i]);
            }
        }
    }

    Playing play(std::size_t pointer, OperatorSample& played) { return buffers_[pointer].play(played); }

    // Nobody is there, or another one: what comes next is a new beginning.
    void restart() {
        for (JitterBuffer<OperatorSample>& buffer : buffers_) {
            if (buffer.counts().exact > 0) {
                buffer.restart();
            }
        }
    }

    void tell(TeleopStatistics& statistics) const {
        statistics.buffer = buffers_[0].counts();
        statistics.buffer_depth = buffers_[0].depth();
    }

private:
    void set(const Channel& channel) {
        period_ = channel.link().statistics().peer_hello.period;
        JitterBufferSettings settings;
        settings.depth = channel.settings().buffer_depth;
        settings.sparse = channel.settings().deadband.enabled;
        settings.seconds = seconds_;
        settings.sample_seconds = period_ > 0 ? to_seconds(period_) : seconds_;
        settings.guess_seconds = 2.0 * to_seconds(channel.settings().deadband.longest_silence);
        for (JitterBuffer<OperatorSample>& buffer : buffers_) {
            buffer.set_settings(settings);
        }
    }

    std::size_t pointers_;
    double seconds_;
    Nanoseconds period_ = 0;  // of a tick of the operator
    std::array<JitterBuffer<OperatorSample>, max_proxies> buffers_;
};

}  // namespace tactus
