// The operator's side: the hand is answered by the model of the far side's bodies (scenario 4), or by the far
// side itself, one delay later (scenario 2).
//
// States of the far side are compared with the model's past at the same sample of the operator, so that a
// right model is never dragged back by the delay. What differs leads to the present state (derivation.hpp),
// and that is brought in without being felt (stealth.hpp): bodies and the pointer that presses them are put
// right at once; a second pointer, carried along, is the one that is felt.
//
// operator_side.cpp hears, compares and sends, operator_replay.cpp goes back and does the past again,
// operator_touch.cpp brings corrections in and gives the hand its force.
#pragma once

#include <memory>
#include <optional>

#include "core/teleop/state_history.hpp"
#include "network/sample_stream.hpp"
#include "session/session_loop.hpp"
#include "session/teleop_port.hpp"

namespace tactus {

struct OperatorRoom {
    std::size_t most_tracked = 32;      // bodies with handles below this are corrected
    std::size_t samples = 1024;         // of the past; more delay than this is not corrected
    std::size_t samples_a_memento = 8;  // a replay does up to so many ticks more
    std::size_t memento_bytes = 65536;  // of physics in each (see PhysicsWorld::save)
    std::size_t pointers = 4;           // that can be carried along; others feel corrections
    bool replays = true;                // false: no twin, re-simulation is not available
};

class OperatorSide final : public TeleopSide {
public:
    OperatorSide(const SessionSettings& session, const OperatorRoom& room, const TeleopSettings& settings,
                 Link& link, std::shared_ptr<TeleopPort> port, const EndpointSettings& endpoint);

    void set_hands(SessionLoop& loop, Nanoseconds now) override;
    void set_forces(SessionLoop& loop, Nanoseconds now) override;
    void report(SessionLoop& loop, Nanoseconds now) override;
    bool simulates() const override { return !settings_.traditional; }
    SessionLoop* twin() override { return twin_.get(); }

private:
    // What the far side said about a body last.
    struct Truth {
        bool fresh = false;
        SampleSequence sample = no_sample;
        std::uint64_t packet = 0;  // sequence of the one that said so
        BodyMotion motion;
        SampleSequence sample_before = no_sample;  // of the state before that one, for accelerations
        BodyMotion before;
    };
    struct Hand {
        Vec3 position{0.0};
        Vec3 velocity{0.0};
        bool idle = false;
    };
    struct Past {
        Nanoseconds time = 0;
        std::array<Hand, most_proxies> hands;
    };
    struct Pointer {
        SessionLoop::ProxySlot felt;  // its proxy is carried along; `hand` is the hand with the offset
        bool active = false;          // else what is modelled is felt
        bool apart = false;           // `felt` is the one that is felt, else the one that presses
        Vec3 offset{0.0};             // (unit: meters)
        ForceBridge bridge;
        DriftRate drift;
        Vec3 force_before{0.0};  // felt in this tick if nothing were corrected (unit: newtons)
        // Traditional: what came last.
        Vec3 far_force{0.0};
        Vec3 far_proxy{0.0};
        ObjectId far_object = no_object;  // that is touched there
        SampleSequence far_sample = no_sample;
        // Sending.
        OperatorSample sent;
        bool has_sent = false;
        Nanoseconds sent_at = 0;
    };
    struct Target {
        SessionHandle body = no_handle;
        BodyMotion motion;
        std::optional<Pose> previous;  // one tick ago, where that is known
    };

    void take_settings(SessionLoop& loop);
    void take(const ObjectStates& states, std::uint64_t packet, SessionLoop& loop);
    void take(const ForceSample& force);
    void receive(SessionLoop& loop);
    void bind(const ObjectBinding& binding);
    void notice_restart();
    void acknowledge();
    void forget_far_side();
    void forget_past();
    void begin_model(SessionLoop& loop);
    bool nothing_is_touched(SessionLoop& loop) const;
    void remember_hands(SessionLoop& loop, Nanoseconds now);
    void follow_far_side(SessionLoop& loop);
    bool tracks(SessionLoop& loop, std::size_t body) const;
    bool is_news(SessionLoop& loop, std::size_t body) const;
    bool any_news(SessionLoop& loop) const;
    void find_targets(SessionLoop& loop, Derivation derivation);
    DerivationInput derivation_input(const Truth& truth, const BodyMotion& then, const BodyMotion& now) const;
    bool begin_replay(SessionLoop& loop);
    void learn_drags(SessionLoop& loop);
    void apply_drags(SessionLoop& loop) const;
    void replay(SessionLoop& loop);
    void replay_tick(SessionLoop& loop);
    void put_in_truth();
    void find_replayed_targets(SessionLoop& loop);
    bool lands(SessionLoop& loop, Nanoseconds now);
    void correct(SessionLoop& loop);
    Vec3 force_uncorrected(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot,
                           Nanoseconds now) const;
    bool carry(SessionLoop& loop, const Target& target, const Pose& motion);
    void part(Pointer& pointer, const SessionLoop::ProxySlot& slot) const;
    void lean_on_pressing(Pointer& pointer, const SessionLoop::ProxySlot& slot) const;
    bool presses_as_felt(const Pointer& pointer, const SessionLoop::ProxySlot& slot) const;
    Vec3 felt_apart(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot, Nanoseconds now);
    void feel_far_side(const Pointer& pointer, SessionLoop::ProxySlot& slot) const;
    void feel(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot, Nanoseconds now);
    void hide_correction(SessionLoop& loop, Pointer& pointer, const SessionLoop::ProxySlot& slot,
                         Nanoseconds now);
    void fade(const SessionLoop& loop, Pointer& pointer, const SessionLoop::ProxySlot& slot);
    void note_drift(const SessionLoop& loop, Pointer& pointer, double way) const;
    double stiffness_under(const SessionLoop& loop, const ProxyState& state) const;
    void remember(SessionLoop& loop);
    void send_sample(SessionLoop& loop, std::size_t index, Nanoseconds now);
    void find_nearest(SessionLoop& loop, const SessionLoop::ProxySlot& slot, OperatorSample& sample) const;

    TeleopSettings settings_;
    OperatorRoom room_;
    Endpoint link_;
    SampleStream samples_;
    std::shared_ptr<TeleopPort> port_;
    double seconds_;  // of a tick
    SampleSequence sample_ = no_sample;
    StateHistory history_;
    std::vector<Past> past_;  // by sample
    std::vector<Truth> truths_;
    std::vector<DragEstimate> drags_;
    std::vector<SessionHandle> body_of_object_;
    std::vector<ObjectId> object_of_body_;
    std::array<Pointer, most_proxies> pointers_;
    std::vector<Target> targets_;  // of this tick
    TeleopStatistics statistics_;

    TripleBuffer<SessionSnapshot> nobody_looks_;  // the twin publishes nothing
    std::unique_ptr<SessionLoop> twin_;
    std::vector<LoopMemento> mementos_;
    std::vector<SampleSequence> memento_of_;  // the sample after which it was taken; 0: none
    bool replaying_ = false;
    SampleSequence replayed_ = no_sample;  // the newest sample that the twin has applied
    SampleSequence truth_at_ = no_sample;
    std::vector<Target> replay_truth_;
    std::uint64_t peer_epoch_ = 0;  // whose states are known
    bool restart_waits_ = false;    // the owner has not been told yet
};

}  // namespace tactus
