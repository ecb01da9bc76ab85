// A lower rate for what moves far from every hand, so that a tick stays on time however much is awake:
// private to physics/.
//
// While no more than `full_rate` bodies are awake, all of them take every step. When more are, islands
// (bodies that contacts and joints link) are set aside, the farthest from the hands first, at one of two
// rates (`slow_rates`): a step of four times the length in one tick of four, or of sixteen times the length
// in one of sixteen: 250 and 62.5 a second at a tick of 1 ms. They come back when a hand comes near or there
// is room.
//
// Set aside means: asleep to Jolt, while what its motion depends on is kept here. So whatever runs into such
// a body, or changes it, wakes it as it would one that sleeps, and it is given its velocity back. An island
// is never divided: one of many hundred bodies takes its step at once, and a pile under the hand all of them.
//
// A long step must not change what comes of it. So an island is set aside at the slowest rate at which no
// point of it goes farther in a step than the rate allows and than half the way to the middle of its body,
// which keeps it from passing through anything; at the slowest also single bodies whose way through the air
// meets nothing. Everything else takes every step, however far from a hand.
//
// Places and counts decide, never a clock: the same on every run.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "physics/body_record.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/BodyID.h>

namespace JPH {
class PhysicsSystem;
class StateRecorderFilter;
}  // namespace JPH

namespace tactus {

// How what is set aside is stepped.
struct SlowRate {
    std::uint32_t steps;  // short ones that a long step replaces, and turns that bodies are shared out among
    int iterations;       // of the solver: what a stack begins with is as many times as far from right
    double way;           // the farthest that a point may go in a long step (unit: meters)
};

// The slowest first. The first is a multiple of the others.
constexpr std::array<SlowRate, 2> slow_rates{{{16, 24, 1e-3}, {4, 6, 8e-3}}};

class FarIslands {
public:
    // full_rate 0: never sets anything aside and takes no memory.
    FarIslands(JPH::PhysicsSystem& system, std::vector<BodyRecord*>& records, std::uint32_t full_rate);

    void set_hands(std::span<const Vec3> hands);

    std::size_t count() const { return count_; }  // of bodies set aside
    bool holds(const JPH::Body& body) const;
    // Of a body kept here or not.
    JPH::Vec3 linear_velocity(const JPH::Body& body) const {
        return holds(body) ? kept(body).linear : body.GetLinearVelocity();
    }
    JPH::Vec3 angular_velocity(const JPH::Body& body) const {
        return holds(body) ? kept(body).angular : body.GetAngularVelocity();
    }

    // While bodies are exchanged, waking and falling asleep mean nothing to anybody else.
    bool exchanging() const { return exchanging_; }

    // The body woke, or is about to be changed or removed. True where it had been kept here.
    bool release(JPH::Body& body, bool give_velocity_back);

    // After each step at the full rate:
    //     far.plan(seconds);
    //     while (const SlowRate* rate = far.begin_turn()) {
    //         ... a step of rate->steps times the length, of those alone whose turn it is ...
    //         far.end_turn();
    //     }
    //     far.finish();
    void plan(double seconds);     // the length of that step
    const SlowRate* begin_turn();  // null: no more in this step
    void end_turn();
    void finish();

    // Those that the last step set aside, or gave the full rate again when their turn was over.
    std::span<const JPH::BodyID> changed() const { return changed_; }

private:
    enum class Keep : std::uint8_t { no, in_turn, until_turns_end };

    // What Jolt forgets of a body that sleeps. 169 bytes of state in 5.6.0 with double precision.
    struct Kept {
        Keep keep = Keep::no;
        std::vector<JPH::BodyID>* list = nullptr;  // that names it
        bool leaves = false;                       // to the turn that finish() is at
        JPH::Vec3 linear;
        JPH::Vec3 angular;
        std::array<std::byte, 192> motion;
    };

    struct Island {
        float distance;  // squared, of its nearest body from the nearest hand
        std::uint32_t bodies;
        bool stays;                                // something in it has to take every step
        std::size_t chosen;                        // the rate that it leaves to, or slow_rates.size()
        std::array<bool, slow_rates.size()> calm;  // no point of it goes farther than the rate allows
        JPH::BodyID last;                          // of its bodies
    };

    // As Jolt writes them, in up to two parts.
    struct Contacts {
        std::vector<std::byte> memory;
        std::array<std::size_t, 2> bytes{0, 0};
    };

    // The bodies of one turn. New ones come from steps of another length, which Jolt's contact forces are
    // proportional to: they take their first step on their own.
    struct Turn {
        std::vector<JPH::BodyID> bodies, fresh;
        std::vector<JPH::BodyID> leaving;  // become fresh ones with finish()
        Contacts contacts, fresh_contacts;
    };

    class ContactsOfLeavers;
    // In each step one turn of each rate is due: first its bodies, then its fresh ones.
    static constexpr std::size_t parts_of_a_step = 2 * slow_rates.size();

    const Kept& kept(const JPH::Body& body) const;
    Kept& kept(const JPH::Body& body);
    JPH::Body& body(JPH::BodyID id) const;
    std::span<const JPH::BodyID> awake() const;
    std::size_t awake_count() const;
    float distance(const JPH::Body& body) const;
    Turn& due(std::size_t rate) { return turn_list_[rate][turn_ % slow_rates[rate].steps]; }
    bool is_calm(const JPH::Body& body, const SlowRate& rate) const;
    bool flies_freely(const JPH::Body& body) const;
    bool may_wait(const Island& island, std::size_t rate) const;
    void as_in_short_steps(JPH::Body& body, const SlowRate& rate) const;
    void survey_islands();
    Island* island_of(JPH::BodyID id);
    void choose(std::size_t rate, std::size_t most);
    void send_away(JPH::BodyID id, Keep keep, std::vector<JPH::BodyID>& list);
    void bring_back(std::vector<JPH::BodyID>& list);
    void save(Contacts& contacts, std::size_t part, const JPH::StateRecorderFilter* which = nullptr) const;
    void restore(const Contacts& contacts);

    JPH::PhysicsSystem& system_;
    std::vector<BodyRecord*>& records_;
    std::size_t full_rate_;
    float seconds_ = 0.0f;  // of a short step
    std::uint32_t turn_ = 0;
    std::size_t count_ = 0;
    bool exchanging_ = false;
    std::vector<JPH::Vec3> hands_;
    std::vector<Kept> kept_;  // by the body's index
    std::array<std::vector<Turn>, slow_rates.size()> turn_list_;
    std::size_t part_ = 0;              // of parts_of_a_step, the one that is on or the next
    bool took_turns_ = false;           // in this step
    std::vector<JPH::BodyID> waiting_;  // all that take every step, while turns last
    Contacts contacts_of_waiting_;
    std::vector<JPH::BodyID> changed_;
    std::vector<JPH::BodyID> stepped_;  // those whose turn it is
    std::vector<JPH::BodyID> list_;     // scratch
    std::vector<Island> islands_;       // by Jolt's number of the last step
    std::vector<std::uint32_t> order_;
};

}  // namespace tactus
