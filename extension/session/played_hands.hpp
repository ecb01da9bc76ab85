// The operator's hands as the far side has them: what comes is kept and played out on this side's ticks
// (jitter_buffer.hpp), as the owner's settings and the ticks of the two sides ask for. Those that hold tools
// are kept with these (tool_slot.hpp), so that a side without a tool has no room for them.
#pragma once

#include "core/teleop/jitter_buffer.hpp"
#include "session/channel.hpp"
#include "session/tool_slot.hpp"

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

    // `tool`: gives that of an operator's number, or null.
    template <typename ToolOf>
    void take(const OperatorSamples& samples, ToolOf&& tool) {
        for (std::size_t i = 0; i < samples.count; ++i) {
            const OperatorSample& sample = samples.samples[i];
            note_standing(sample);
            if (sample.pointer < pointers_ && !sample.has_turn) {
                buffers_[sample.pointer].insert(sample);
            } else if (sample.pointer >= first_tool && sample.has_turn) {
                if (ToolSlot* const slot = tool(sample.pointer - first_tool); slot && slot->heard) {
                    slot->heard->insert(sample);
                }
            }
        }
    }
    void take(const OperatorSamples& samples) {
        take(samples, [](std::size_t) { return static_cast<ToolSlot*>(nullptr); });
    }

    Playing play(std::size_t pointer, PointerSample& played) { return buffers_[pointer].play(played); }
    Playing play(ToolSlot& tool, OperatorSample& played) const {
        if (!tool.heard) {
            return Playing::waiting;
        }
        if (std::exchange(tool.heard_settings, settings_revision_) != settings_revision_) {
            tool.heard->set_settings(settings_);
        }
        return tool.heard->play(played);
    }

    // Whether the operator's hand was not there, see JitterBuffer::leads().
    bool leads(std::size_t pointer) const { return buffers_[pointer].leads(); }
    static bool leads(const ToolSlot& tool) { return tool.heard && tool.heard->leads(); }
    bool is_outage(std::size_t pointer) const { return buffers_[pointer].is_outage(); }
    static bool is_outage(const ToolSlot& tool) { return tool.heard && tool.heard->is_outage(); }

    // Once a tick: true where samples have come that stand, which are to be acknowledged.
    bool acknowledges(SampleAcknowledgements& message) {
        message.count = 0;
        for (std::size_t i = 0; i < standing_.size(); ++i) {
            if (standing_[i].is_new) {
                standing_[i].is_new = false;
                message.samples[message.count++] = {static_cast<std::uint16_t>(i), standing_[i].sequence};
            }
        }
        return message.count > 0;
    }

    // The hands are gone, or are those of another operator: what comes next is a new beginning.
    void restart() {
        standing_ = {};
        for (JitterBuffer<PointerSample>& buffer : buffers_) {
            if (buffer.counts().exact > 0) {
                buffer.restart();
            }
        }
    }
    static void restart(ToolSlot& tool) {
        if (tool.heard && tool.heard->counts().exact > 0) {
            tool.heard->restart();
        }
    }

    void tell(TeleopStatistics& statistics) const {
        statistics.buffer = buffers_[0].counts();
        statistics.buffer_depth = buffers_[0].depth();
    }

private:
    struct Standing {
        SampleSequence sequence = no_sample;
        bool is_new = false;
    };
    static_assert(first_tool + max_tools <= SampleAcknowledgements::max_count);

    void note_standing(const OperatorSample& sample) {
        const double spin = sample.has_turn ? glm::length(sample.spin) : 0.0;
        const bool is_repeated = settings_.sparse || !sample.connected;
        if (!is_repeated || sample.pointer >= standing_.size() ||
            !stands(glm::length(sample.velocity), spin)) {
            return;
        }
        Standing& newest = standing_[sample.pointer];
        // A hand that waits for its model is absent in every sample.
        constexpr SampleSequence seldom = 20;
        if (!settings_.sparse && newest.sequence != no_sample && sample.sequence > newest.sequence &&
            sample.sequence < newest.sequence + seldom) {
            return;
        }
        newest = sample.sequence > newest.sequence ? Standing{sample.sequence, true} : newest;
    }

    void set(const Channel& channel) {
        period_ = channel.link().statistics().peer_hello.period;
        settings_.depth = channel.settings().buffer_depth;
        settings_.sparse = channel.settings().deadband.enabled;
        settings_.newest = channel.settings().newest_wins;
        settings_.seconds = seconds_;
        settings_.sample_seconds = period_ > 0 ? to_seconds(period_) : seconds_;
        settings_.guess_seconds = 2.0 * to_seconds(channel.settings().deadband.longest_silence);
        ++settings_revision_;
        for (JitterBuffer<PointerSample>& buffer : buffers_) {
            buffer.set_settings(settings_);
        }
    }

    std::size_t pointers_;
    double seconds_;
    Nanoseconds period_ = 0;  // of a tick of the operator
    JitterBufferSettings settings_;
    std::uint64_t settings_revision_ = 0;
    std::array<JitterBuffer<PointerSample>, max_proxies> buffers_;
    std::array<Standing, first_tool + max_tools> standing_{};
};

}  // namespace tactus
