// The operator's side: the hand is answered by the model of the far side's bodies (scenario 4), or by the far
// side itself, one delay later (scenario 2, traditional_touch.hpp).
//
// States of the far side (truth_store.hpp) are compared with the model's past (model_past.hpp) at the same
// sample of the operator, so that a right model is never dragged back by the delay. What differs leads to the
// present state, by a formula (derivation.hpp) or by doing the past again (resimulator.hpp). The model is put
// right at once; what the hand feels of it goes through one place (felt_pointer.hpp).
//
// operator_side.cpp hears and compares, operator_belief.cpp filters what is seen roughly,
// operator_learning.cpp learns what bodies weigh and how they slide, and takes over what the far side has
// learnt, operator_touch.cpp puts right and gives the hand its force, operator_sending.cpp tells the far
// side. operator_tools.cpp does for hands that hold a tool what the last two do for pointers.
#pragma once

#include "core/haptics/surface_spring.hpp"
#include "core/teleop/felt_pointer.hpp"
#include "core/teleop/felt_tool.hpp"
#include "core/teleop/passive_update.hpp"
#include "core/teleop/pose_filter.hpp"
#include "core/teleop/wrench_passivity.hpp"
#include "network/sample_stream.hpp"
#include "session/carried_pointer.hpp"
#include "session/channel.hpp"
#include "session/denied_press.hpp"
#include "session/ghosts.hpp"
#include "session/resimulator.hpp"
#include "session/side_settings.hpp"
#include "session/traditional_touch.hpp"

namespace tactus {

// What of a body that a pointer rests on is felt later only.
struct TouchedBody {
    double friction = 0.0;  // static, of the pointer on it
    double mass = 0.0;      // (unit: kilograms); 0: it does not move, or nothing is touched
};

// What another friction or mass of what is touched makes of a force comes as the hand and the body go on: at
// most so much (unit: newtons).
double change_to_come(const TouchedBody& before, const TouchedBody& now, double force);
// Of a pointer's or a tool's state.
TouchedBody touched_body(const SessionLoop& loop, const auto& state) {
    const SessionLoop::Body* const under = state.contact_count > 0 ? loop.body(state.bodies[0]) : nullptr;
    return under ? TouchedBody{loop.scene().body(under->slot).material.static_friction,
                               loop.mass(state.bodies[0])}
                 : TouchedBody{};
}
// Whatever happens at the far side, to the model or to the link, changes a hand's force by no more in a tick
// (unit: newtons). What the hand's own motion changes it by comes on top.
inline constexpr double max_unexplained_step = 0.5;

// FeltStatus.
std::uint32_t felt_status(FeltState state);

class OperatorSide final : public TeleopSide {
public:
    OperatorSide(const SessionSettings& session, const OperatorRoom& room, const TeleopSettings& settings,
                 Link& link, std::shared_ptr<TeleopPort> port, const EndpointSettings& endpoint);

    void set_hands(SessionLoop& loop, Nanoseconds now) override;
    void set_forces(SessionLoop& loop, Nanoseconds now) override;
    void report(SessionLoop& loop, Nanoseconds now) override;
    const ForceLimits& limits() const override { return limits_; }
    bool simulates() const override { return !settings().traditional; }
    SessionLoop* twin() override { return resimulator_.twin(); }

private:
    using Target = Resimulator::Target;

    // What the far side has been sent of a hand.
    struct SentHand {
        bool had_room = false;    // in the model, since the hand came
        std::uint32_t start = 0;  // of its proxy: another one is a hand that comes
        OperatorSample last;
        Nanoseconds at = 0;
        SampleSequence since = no_sample;         // the first one that says what `last` says; no_sample: none
        SampleSequence acknowledged = no_sample;  // the newest one that has come there and stands
        DeniedPress denied;
    };

    struct Pointer {
        FeltPointer felt;
        CarriedPointer carried;
        SessionLoop::SceneForce uncorrected;  // in this tick if nothing were corrected
        Vec3 modelled{0.0};                   // by the model, one tick ago (unit: newtons)
        Vec3 modelled_before{0.0};            // two ticks ago, or the same where a change was in between
        Vec3 hand{0.0};                       // one tick ago (unit: meters)
        Vec3 velocity{0.0};                   // of the hand, one tick ago (unit: meters per second)
        Vec3 force{0.0};                      // given to the hand, one tick ago (unit: newtons)
        Vec3 damped{0.0};                     // traditional: by its passivity, one tick ago (unit: newtons)
        TouchedBody touched;                  // one tick ago
        bool known = false;                   // there was such a tick
        bool answered = false;                // traditional: what the far side said last still held then
        OperatorPassivity passivity;
        PassiveUpdate update;
        SentHand sent;
    };

    // The same for a tool.
    struct Tool {
        FeltTool felt;
        Wrench uncorrected;                // in this tick if nothing were corrected
        bool jumped = false;               // likewise
        Wrench modelled, modelled_before;  // one and two ticks ago
        Pose hand;                         // ToolHand::goal, one tick ago
        Vec3 place{0.0};                   // ToolHand::place, one tick ago (unit: meters)
        Wrench given;                      // to the hand, one tick ago
        Vec3 damped{0.0};                  // traditional: by its passivity, one tick ago (unit: newtons)
        TouchedBody touched;               // one tick ago
        bool known = false;
        bool answered = false;
        bool fixed = false;               // ToolHand::fixed, one tick ago
        Quat turned{1.0, 0.0, 0.0, 0.0};  // where it is, as it is turned there
        WrenchPassivity passivity;
        SentHand sent;
    };

    // A body of the model that moves by itself, while something is learnt about it.
    struct Pupil {
        SessionHandle body = no_handle;
        std::uint32_t place = 0;
        std::size_t group = 0;  // the first of those that touch each other
        double mass = 0.0;      // (unit: kilograms)
        bool has_lesson = false;
        SampleSequence from = no_sample, to = no_sample;
        MotionLesson lesson;
        ResidualMotion::Lesson residual, residual_turn;
    };

    // Of a body with a place.
    struct BodyResidual {
        ResidualMotion linear, turn;
    };

    // What the far side has found out about a body, in this side's scene.
    struct Found {
        std::uint64_t packet = 0;  // that brought it; 0: none has
        bool is_new = false;       // of what touch has taught, something has not been taken over yet
        ObjectEstimate estimate;
        SeenPose seen;
    };

    const TeleopSettings& settings() const { return channel_.settings(); }

    // --- operator_side.cpp
    void take_settings(SessionLoop& loop);
    bool waits_for_model() const;
    bool is_held_back(std::size_t hand) const;
    void hold_back_hands(SessionLoop& loop);
    void round_hands(SessionLoop& loop) const;
    void begin_model(SessionLoop& loop);
    void forget_past();
    void forget_far_side();
    void receive(SessionLoop& loop, Nanoseconds now);
    void start_over_if_peer_has();
    void bind(const ObjectBinding& binding);
    void forget_body(SessionHandle body);
    void forget_place(std::uint32_t place);
    SessionHandle body_of(ObjectId object) const;
    void take(const ObjectStates& states, std::uint64_t packet, SessionLoop& loop);
    void note_answer(SampleSequence sample);
    void take(const ForceSample& force);
    void take(const WrenchSample& wrench);
    void take(const ObjectEstimates& estimates, std::uint64_t packet);
    void take(const SampleAcknowledgements& acknowledgements);
    void follow_far_side(SessionLoop& loop);
    bool nothing_is_touched(SessionLoop& loop) const;
    // The model has not kept what it was after that sample.
    bool is_beyond_history(SampleSequence sample) const;
    bool knows_all_pushes(SampleSequence sample) const;
    bool is_news(SessionLoop& loop, SessionHandle body) const;
    bool any_news(SessionLoop& loop) const;
    void find_targets(SessionLoop& loop, Nanoseconds now);
    void derive_targets(SessionLoop& loop, bool only_without_past);
    double touched_doubt(SessionLoop& loop) const;
    DerivationInput derivation_input(const Truth& truth, const BodyMotion& then, const BodyMotion& now) const;

    // --- operator_belief.cpp
    BodyMotion believed(SessionLoop& loop, SessionHandle body, SampleSequence sample,
                        const BodyMotion& received);
    Pose on_joints(const SessionLoop& loop, SessionHandle body, const Pose& seen) const;
    void note_forbidden(const SessionLoop& loop, SessionHandle body, const Pose& seen);
    PoseStep step_to(SessionHandle body, SampleSequence sample, const BodyMotion& received) const;

    // --- operator_learning.cpp
    void learn(SessionLoop& loop);
    void gather_pupils(SessionLoop& loop);
    bool lesson_for(SessionLoop& loop, Pupil& pupil) const;
    void set_residuals(SessionLoop& loop);
    void teach(SessionLoop& loop, std::size_t group);
    void take_over_found(SessionLoop& loop);
    bool take_over(SessionLoop& loop, SessionHandle body, const ObjectEstimate& estimate);
    void set_factors(SessionLoop& loop, SessionHandle body, const ParameterEstimate& estimate);

    // --- operator_touch.cpp
    bool lands(SessionLoop& loop, Nanoseconds now);
    void correct(SessionLoop& loop, Nanoseconds now);
    void charge_motion(SessionLoop& loop, const Target& target);
    SessionLoop::SceneForce force_uncorrected(SessionLoop& loop, Pointer& pointer,
                                              SessionLoop::ProxySlot& slot, Nanoseconds now) const;
    Vec3 modelled_force(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot, bool changed,
                        Nanoseconds now);
    void hide_changes(Pointer& pointer, const Vec3& modelled, const SurfaceSpring& spring, const Vec3& way,
                      bool changed);
    OperatorPassivity::In heard(std::size_t index) const;
    Vec3 passive_force(std::size_t index, const SessionLoop::ProxySlot& slot, bool answers);
    void note_given(SessionLoop& loop, std::size_t index);
    template <typename State>  // ProxyState or ToolState
    bool has_leapt(SessionLoop& loop, const State& touch) const;
    SampleSequence silence() const;
    void add_energy(const EnergyFigures& energy);
    void note_cost(double faded, double force);
    void feel(SessionLoop& loop, std::size_t index, SessionLoop::ProxySlot& slot, Nanoseconds now);
    void tell_felt(Pointer& pointer, SessionLoop::ProxySlot& slot, std::size_t index);

    // --- operator_tools.cpp
    void hold_fixed_tools(SessionLoop& loop);
    void round_tools(SessionLoop& loop) const;
    bool waits_for_tool(SessionLoop& loop);
    void recall_tools(SessionLoop& loop);
    bool tools_land(SessionLoop& loop);
    void feel_tools(SessionLoop& loop);
    Wrench modelled_wrench(const SessionLoop& loop, Tool& tool, ToolSlot& slot, bool changed);
    Wrench far_wrench(std::size_t index, ToolSlot& slot, bool& changed);
    void feel(SessionLoop& loop, std::size_t index, ToolSlot& slot);
    void hide_changes(Tool& tool, const Wrench& modelled, const ToolSlot& slot, bool changed);
    void note_denied(const SessionLoop& loop, Tool& tool, const ToolSlot& slot) const;
    void send_tool(SessionLoop& loop, std::size_t index, const ToolSlot& slot, Nanoseconds now);

    // --- operator_sending.cpp
    void acknowledge();
    bool is_guessed(const SentHand& sent, const OperatorSample& sample) const;
    bool is_press_guessed(const Vec3& last, const Vec3& force) const;
    bool is_due(const SentHand& sent, Nanoseconds now) const;
    bool is_told(SentHand& sent, std::uint32_t start, bool is_held, bool has_room) const;
    void send_absence(SentHand& sent, Nanoseconds now);
    void send(SentHand& sent, const OperatorSample& sample, bool says_nothing_new, Nanoseconds now);
    Vec3 far_bound(const DeniedPress& denied, const Vec3& force) const;
    void note_denied(SessionLoop& loop, std::size_t index);
    void send_sample(SessionLoop& loop, std::size_t index, Nanoseconds now);
    void find_nearest(SessionLoop& loop, const SessionLoop::ProxySlot& slot, const Vec3& hand,
                      OperatorSample& sample) const;

    OperatorRoom room_;
    Channel channel_;
    SampleStream samples_;
    double seconds_;  // of a tick
    SampleSequence sample_ = no_sample;
    SampleSequence answered_ = no_sample;  // the newest that the far side has answered
    TruthStore truths_;
    ModelPast past_;
    Resimulator resimulator_;
    TraditionalTouch traditional_;
    std::vector<ParameterEstimate> estimates_;  // by place
    std::vector<BodyResidual> residuals_;       // by place
    std::vector<SampleSequence> alone_since_;   // by place: the body has touched no other that moves since
    std::vector<Pupil> pupils_;                 // of this tick
    std::vector<PoseFilter> filters_;           // by body
    FarEyes eyes_;
    std::vector<Found> found_;         // by body
    std::vector<SessionHandle> news_;  // of found_
    GhostEar ghosts_;
    FirstDescription described_ = FirstDescription::awaited;  // the far side's first
    std::vector<SessionHandle> body_of_object_;
    std::vector<ObjectId> object_of_body_;
    std::vector<Vec3> hands_;  // that are there
    std::array<Pointer, max_proxies> pointers_;
    std::array<Tool, max_tools> tools_;
    std::vector<Target> targets_;             // of this tick
    std::uint32_t replays_without_tool_ = 0;  // one after the other
    bool corrected_ = false;                  // in this tick
    bool changed_ = false;  // something else than a correction has changed what is touched in this tick
    ForceLimits limits_;    // see max_unexplained_step
    TeleopStatistics statistics_;
    bool restart_waits_ = false;  // the owner has not been told yet
};

}  // namespace tactus
