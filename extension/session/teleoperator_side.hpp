// The far side: plays the operator's hand out in the environment, through a stand-in for the operator (C'),
// and tells what became of the bodies, or what the hand would feel.
#pragma once

#include <optional>

#include "session/body_telling.hpp"
#include "session/denied_press.hpp"
#include "session/ghosts.hpp"
#include "session/played_hands.hpp"
#include "session/press_limit.hpp"
#include "session/side_settings.hpp"
#include "session/tool_telling.hpp"

namespace tactus {

class TeleoperatorSide final : public TeleopSide {
public:
    TeleoperatorSide(const SessionSettings& session, const TeleopSettings& settings, Link& link,
                     std::shared_ptr<TeleopPort> port, const EndpointSettings& endpoint,
                     const PointerShare& share = {});

    void set_hands(SessionLoop& loop, Nanoseconds now) override;
    void set_forces(SessionLoop& loop, Nanoseconds) override { loop.fade_jumps(); }
    bool hears_tools() const override { return true; }
    void report(SessionLoop& loop, Nanoseconds now) override;
    const ForceLimits& limits() const override { return channel_.settings().limits; }

private:
    // Where a hand has been lost.
    struct KeptPlace {
        bool known = false;
        SessionHandle on = no_handle;  // what was pressed; no_handle: nothing
        Pose proxy;                    // in its frame, or in the world
    };

    struct Pointer {
        PointerSample played;
        PointerSample here;  // the same in this side's scene
        Playing playing = Playing::waiting;
        bool is_new = true;      // this operator's hand has not been there: no place of it is kept
        bool holds = false;      // a hand is there
        bool goes = false;       // it was there, and presses on with less and less
        bool is_away = false;    // its proxy was taken away since then
        Vec3 hand{0.0};          // where the stand-in has put it (unit: meters)
        FarPassivity passivity;  // traditional
        PressLimit limit;
        KeptPlace kept;
        Vec3 had_force{0.0}, had_hand{0.0};  // one tick ago (unit: newtons, meters)
        Vec3 force_sent{0.0};
        Nanoseconds force_sent_at = 0;

        // Its proxy is taken away; one that is added later begins where it was.
        void leave() {
            is_away = is_away || holds || goes;
            holds = goes = false;
        }
    };

    // One that holds a tool: the stand-in is always a spring to it.
    struct Tool {
        OperatorSample played;
        bool is_new = true;  // as for a pointer
        bool holds = false;  // a hand is there
        bool goes = false;   // it was there, and presses on with less and less
        bool idle = true;    // it touches nothing
        Pose goal;           // of the hand, in this side's scene
        PressLimit limit;
        KeptPlace kept;
        SaidWrench said;

        void leave() {  // as of a pointer
            idle = true;
            holds = goes = false;
        }
    };

    const TeleopSettings& settings() const { return channel_.settings(); }
    SessionLoop::ProxySlot& slot_of(SessionLoop& loop, std::size_t pointer) const {
        return loop.proxy(share_.proxy_of(pointer));
    }
    ToolSlot* tool_of(SessionLoop& loop, std::size_t tool) const {  // null: it has none
        return tool < share_.most(max_tools) ? loop.tool(share_.proxy_of(tool)) : nullptr;
    }
    void receive(SessionLoop& loop);
    void start_over_if_peer_has(SessionLoop& loop);
    void release_hands(SessionLoop& loop);
    void forget_operator();
    void play(SessionLoop& loop, std::size_t index, SessionLoop::ProxySlot& slot);
    void play_hand(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot);
    void draw_back(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot, PressLimit::Hand hand,
                   bool is_outage);
    void draw_back_tools(SessionLoop& loop);
    void note_pressed(SessionLoop& loop);
    PressLimit::In limited(const SessionLoop& loop, const auto& state, PressLimit::Hand hand) const;
    Vec3 passive_hand(Pointer& pointer, const SessionLoop::ProxySlot& slot) const;
    void let_go(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot);
    KeptPlace kept(const SessionLoop& loop, const auto& state, const Pose& proxy) const;
    std::optional<Pose> way_back(const SessionLoop& loop, const KeptPlace& kept, bool is_free) const;
    std::optional<double> known_press(const PointerSample& sample) const {
        return tactus::known_press(settings().traditional, settings().passivity, sample.force);
    }
    bool is_free(const Pointer& pointer) const;
    bool is_free(const Tool& tool) const;
    void come_back(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot) const;
    StandInInput stand_in_input(SessionLoop& loop, const Pointer& pointer,
                                const SessionLoop::ProxySlot& slot) const;
    void play(SessionLoop& loop, std::size_t index, ToolSlot& slot);
    void let_go(Tool& tool, ToolSlot& slot) const;
    void draw_back(Tool& tool, ToolSlot& slot, const ToolState& before, PressLimit::Hand hand) const;
    void come_back(SessionLoop& loop, Tool& tool, ToolSlot& slot) const;
    Terms own_terms(SessionLoop& loop) const;
    void send_back(SessionLoop& loop, Nanoseconds now);
    void send_wrenches(SessionLoop& loop, Nanoseconds now);
    void tell_tools(SessionLoop& loop, Nanoseconds now);
    WrenchSample wrench_of(std::size_t index, const ToolSlot& slot, Nanoseconds now) const;
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
    std::array<Tool, max_tools> tools_;
    SampleSequence newest_applied_ = no_sample;
    TeleopStatistics statistics_;
};

}  // namespace tactus
