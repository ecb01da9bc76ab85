// What the far side says of where its bodies are.
//
//     moves                     often; with a deadband, when it goes on otherwise than was said
//     has come to rest          a while longer: some of it is lost
//     rests, could be moved     now and then: nobody here knows what the model has made of it
//     stands                    once: when it has been described, and when it has been put elsewhere; again
//                               until hardly a doubt is left that it has come, and, so that nothing false
//                               stays for ever, in a slow turn
//
// What is due is gathered once in a round of `states_every` ticks, and its packets are spread over the round.
// Where the way there queues, rounds are longer (network/pace.hpp).
//
// Where the owner has set a rate (TeleopSettings::body_rate) and more is due, a round has the bodies whose
// last state is oldest, measured by the time in which a hand may arrive there. Belongs to whoever ticks.
#pragma once

#include <vector>

#include "network/pace.hpp"
#include "session/channel.hpp"
#include "session/session_loop.hpp"
#include "session/state_budget.hpp"

namespace tactus {

class StateTeller {
public:
    explicit StateTeller(std::size_t max_bodies);

    // Another start of the operator: it knows nothing.
    void restart();
    // The body is described to the operator, who has nothing to hear of it until it has built it.
    void announced(SessionHandle body);
    // The operator has built it, perhaps anew.
    void described(SessionHandle body);
    void withdrawn(SessionHandle body);

    // Once a tick. `newest`: the newest sample of the operator that has been applied; `others_yield`: what
    // queues on the way there is somebody else's, who sends less.
    // `rate`: that all of it keeps to (unit: bits per second); 0: no limit.
    void tell(SessionLoop& loop, Channel& channel, SampleSequence newest, Nanoseconds now, bool others_yield,
              double rate);
    // Whether something was said in this tick of a body that moves by itself.
    bool has_said() const { return has_said_; }
    const StateLoad& load() const { return load_; }

private:
    enum class Known : std::uint8_t { unasked, awaited, built };

    // What was said about a body last.
    struct Told {
        Known known = Known::unasked;
        BodyMotion motion;
        std::uint64_t tick = 0;  // 0: never
        Nanoseconds time = 0;
        bool asleep = false;
        bool again = false;          // is to be said once more: the first may have been lost
        std::uint64_t moved_at = 0;  // the tick of the last round in which it was awake
        // Of what stands:
        Pose stands;
        std::uint32_t times = 0;  // said since it was described, or put there
        std::uint64_t due = 1;    // the tick from which on it is to be said; 0: all is said
    };

    void begin_anew(Told& told) const;
    void begin_round(SessionLoop& loop, const Channel& channel, Nanoseconds now);
    void note_load(const SessionLoop& loop);
    void keep_most_urgent(SessionLoop& loop, std::size_t room);
    double time_to_touch(SessionLoop& loop, SessionHandle body) const;
    void note_where_it_stands(SessionLoop& loop, SessionHandle body);
    void take_slow_turn(const SessionLoop& loop);
    bool has_its_turn(const TeleopSettings& settings, SessionHandle body) const;
    bool moves_otherwise(SessionLoop& loop, const TeleopSettings& settings, SessionHandle body,
                         Nanoseconds now) const;
    bool loses(const LinkStatistics& link);
    void send(SessionLoop& loop, Channel& channel, SampleSequence newest, Nanoseconds now,
              std::span<const SessionHandle> bodies);
    void note_told(SessionLoop& loop, const Channel& channel, SessionHandle body, Nanoseconds now);
    std::uint64_t ticks(Nanoseconds span) const;

    Pace pace_{PaceSettings{1.0, 32, 4}};
    std::vector<Told> told_;          // by body
    std::vector<SessionHandle> due_;  // in this round
    std::vector<double> urgency_;     // of what is due, by body
    std::vector<Vec3> hands_;         // in this round
    StateBudget budget_;
    StateLoad load_;
    std::size_t said_ = 0;  // of them
    std::uint64_t round_began_ = 0;
    std::uint64_t round_ = 1;      // ticks of this one
    std::uint64_t next_turn_ = 0;  // the tick of the next slow turn
    std::size_t turn_at_ = 0;      // the body with which it begins
    double seconds_ = 0.001;       // of a tick
    bool has_said_ = false;
    bool losing_ = false;  // some of what is said, as of this round
    std::uint64_t tick_ = 0;
    std::uint64_t missing_ = 0;  // packets of the operator, so far
    std::uint64_t lost_at_ = 0;  // the tick in which one more was
};

}  // namespace tactus
