// The far side: plays the operator's hand out in the environment, through a stand-in for the operator (C'),
// and tells what became of the bodies, or what the hand would feel.
#pragma once

#include "session/body_telling.hpp"
#include "session/ghosts.hpp"
#include "session/played_hands.hpp"

namespace tactus {

// Which pointers of the environment an operator has: of several operators, each has every so manieth.
struct PointerShare {
    std::size_t first = 0;
    std::size_t every = 1;  // >= 1

    // That stands in for a pointer of the operator.
    std::size_t proxy_of(std::size_t pointer) const { return first + pointer * every; }
    bool has(std::size_t proxy) const { return proxy >= first && (proxy - first) % every == 0; }
    // Pointers of the operator that can have one.
    std::size_t most() const { return first < max_proxies ? (max_proxies - first + every - 1) / every : 0; }
};

class TeleoperatorSide final : public TeleopSide {
public:
    TeleoperatorSide(const SessionSettings& session, const TeleopSettings& settings, Link& link,
                     std::shared_ptr<TeleopPort> port, const EndpointSettings& endpoint,
                     const PointerShare& share = {});

    void set_hands(SessionLoop& loop, Nanoseconds now) override;
    void set_forces(SessionLoop& loop, Nanoseconds) override { loop.fade_jumps(); }
    void report(SessionLoop& loop, Nanoseconds now) override;
    const ForceLimits& limits() const override { return channel_.settings().limits; }

private:
    struct Pointer {
        OperatorSample played;
        OperatorSample here;                   // the same in this side's scene
        bool holds = false;                    // a hand is there
        Vec3 hand{0.0};                        // where the stand-in has put it (unit: meters)
        FarPassivity passivity;                // traditional
        SessionHandle kept_on = no_handle;     // a body that was pressed when the hand was lost
        Vec3 kept_proxy{0.0}, kept_hand{0.0};  // in its frame (unit: meters)
        Vec3 had_force{0.0}, had_hand{0.0};    // one tick ago (unit: newtons, meters)
        Vec3 force_sent{0.0};
        Nanoseconds force_sent_at = 0;
    };

    const TeleopSettings& settings() const { return channel_.settings(); }
    SessionLoop::ProxySlot& slot_of(SessionLoop& loop, std::size_t pointer) const {
        return loop.proxy(share_.proxy_of(pointer));
    }
    void receive();
    void start_over_if_peer_has();
    void release_hands();
    void play(SessionLoop& loop, std::size_t index, SessionLoop::ProxySlot& slot);
    Vec3 passive_hand(Pointer& pointer, const SessionLoop::ProxySlot& slot) const;
    void keep(SessionLoop& loop, Pointer& pointer, const SessionLoop::ProxySlot& slot) const;
    void come_back(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot) const;
    StandInInput stand_in_input(SessionLoop& loop, const Pointer& pointer,
                                const SessionLoop::ProxySlot& slot) const;
    void send_forces(SessionLoop& loop, Nanoseconds now);
    bool force_is_due(SessionLoop& loop, std::size_t index, Nanoseconds now) const;
    ForceSample force_of(SessionLoop& loop, std::size_t index, Nanoseconds now) const;

    Channel channel_;
    GhostTeller ghosts_;
    BodyTelling telling_;
    PointerShare share_;
    PlayedHands hands_;
    double seconds_;  // of a tick
    Pace force_pace_{PaceSettings{}};
    std::uint64_t force_tick_ = 0;
    std::array<Pointer, max_proxies> pointers_;
    SampleSequence newest_applied_ = no_sample;
    TeleopStatistics statistics_;
};

}  // namespace tactus
