// The far side: plays the operator's hand out in the environment, through a stand-in for the operator (C'),
// and tells what became of the bodies, or what the hand would feel.
#pragma once

#include "session/session_loop.hpp"
#include "session/teleop_port.hpp"

namespace tactus {

class TeleoperatorSide final : public TeleopSide {
public:
    TeleoperatorSide(const SessionSettings& session, const TeleopSettings& settings, Link& link,
                     std::shared_ptr<TeleopPort> port, const EndpointSettings& endpoint);

    void set_hands(SessionLoop& loop, Nanoseconds now) override;
    void set_forces(SessionLoop&, Nanoseconds) override {}
    void report(SessionLoop& loop, Nanoseconds now) override;

private:
    struct Pointer {
        JitterBuffer<OperatorSample> buffer;
        OperatorSample played;
        bool holds = false;  // a hand is there
        Vec3 hand{0.0};      // where the stand-in has put it (unit: meters)
        Vec3 force_sent{0.0};
        Nanoseconds force_sent_at = 0;
    };

    // What was said about a body last.
    struct Told {
        BodyMotion motion;
        std::uint64_t tick = 0;  // 0: never
        Nanoseconds time = 0;
        bool asleep = false;
    };

    void take_orders();
    void receive();
    void notice_restart();
    void release_hands();
    void describe(Nanoseconds now);
    void play(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot);
    StandInInput stand_in_input(SessionLoop& loop, const Pointer& pointer,
                                const SessionLoop::ProxySlot& slot) const;
    void set_buffers();
    bool state_needs_sending(SessionLoop& loop, std::size_t body, Nanoseconds now) const;
    void send_states(SessionLoop& loop, Nanoseconds now);
    void send_force(SessionLoop& loop, std::size_t index, Nanoseconds now);

    TeleopSettings settings_;
    Endpoint link_;
    std::shared_ptr<TeleopPort> port_;
    DiscoverySender discovery_;
    std::uint64_t peer_epoch_ = 0;
    double seconds_;                       // of a tick
    Nanoseconds peer_period_ = 0;          // of a tick of the operator, as the buffers have it
    std::vector<std::uint64_t> moved_at_;  // by body: the tick in which it was awake last
    std::vector<Told> told_;               // by body
    std::array<Pointer, most_proxies> pointers_;
    SampleSequence newest_applied_ = no_sample;
    std::uint64_t tick_ = 0;
    TeleopStatistics statistics_;
};

}  // namespace tactus
