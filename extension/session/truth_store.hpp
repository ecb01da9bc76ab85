// What the far side said last about each body, each at its own sample of the operator.
//
// Any number of bodies has its last truth here. The model's past, which a truth of something that moves is
// compared with, has room for some of them: whoever comes takes a free place, or that of the body farthest
// from every hand where it is nearer itself. A body without a place is put where the far side last saw it,
// moved on with its velocity.
#pragma once

#include <span>
#include <vector>

#include "core/math/body_motion.hpp"
#include "network/messages.hpp"
#include "session/session_types.hpp"

namespace tactus {

struct Truth {
    bool fresh = false;  // not dealt with yet
    SampleSequence sample = no_sample;
    std::uint64_t packet = 0;  // that brought it; 0: none has
    BodyMotion motion;
    SampleSequence sample_before = no_sample;  // of the state before that one
    BodyMotion before;
};

class TruthStore {
public:
    static constexpr std::uint32_t no_place = 0xffff'ffffu;

    TruthStore(std::size_t max_bodies, std::size_t places);

    // Newest wins, by the number of the packet that brought it: times are the far side's word. False, and
    // nothing has changed, where it is older than what is known.
    bool take(SessionHandle body, SampleSequence sample, std::uint64_t packet, const BodyMotion& motion);

    bool is_newer(SessionHandle body, std::uint64_t packet) const {
        return truths_[body].packet == 0 || packet > truths_[body].packet;
    }
    bool knows(SessionHandle body) const { return body < truths_.size(); }
    const Truth& of(SessionHandle body) const { return truths_[body]; }
    // Bodies whose truth is fresh, in the order in which it came.
    std::span<const SessionHandle> fresh() const { return fresh_; }
    // All of them are dealt with.
    void settle();

    // A place in the model's past for a body that moves; no_place where all are taken by bodies nearer to a
    // hand. `evicted` is the body that has lost its place, or no_handle.
    std::uint32_t give_place(SessionHandle body, std::span<const Vec3> hands, SessionHandle& evicted);
    std::uint32_t place_of(SessionHandle body) const {
        return body < place_of_.size() ? place_of_[body] : no_place;
    }
    SessionHandle body_at(std::size_t place) const { return body_at_[place]; }
    std::size_t places() const { return body_at_.size(); }

    // The body is another one now, or gone.
    void forget(SessionHandle body);
    // Another start of the far side.
    void forget_all();

private:
    double distance(SessionHandle body, std::span<const Vec3> hands) const;

    std::vector<Truth> truths_;            // by body
    std::vector<SessionHandle> fresh_;     // those in `truths_`
    std::vector<std::uint32_t> place_of_;  // by body
    std::vector<SessionHandle> body_at_;   // by place
};

}  // namespace tactus
