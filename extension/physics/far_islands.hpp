// A lower rate for what moves far from every hand, so that a tick stays on time however much is awake:
// private to physics/.
//
// While no more than `full_rate` bodies are awake, all of them take every step. When more are, islands
// (bodies that contacts and joints link) are set aside, the farthest from the hands first. Each has one of 16
// turns; every step is the turn of one sixteenth of them, which then take one step of sixteen times the
// length: 62.5 a second at a tick of 1 ms, as in an ordinary game. They come back when a hand comes near or
// there is room.
//
// Set aside means: asleep to Jolt, while what its motion depends on is kept here. So whatever runs into such
// a body, or changes it, wakes it as it would one that sleeps, and it is given its velocity back. An island
// is never divided: one of many hundred bodies takes its step at once, and a pile under the hand all of them.
//
// A long step must not change what comes of it. So only such islands are set aside as all but rest (a point
// of theirs goes less than a millimeter in a long step), and single bodies whose way through the air meets
// nothing; these end up where short steps would have led them. Everything else takes every step, however far
// from a hand: what slides, what collides, what is about to.
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

class FarIslands {
public:
    static constexpr std::uint32_t turns = 16;
    // Of the solver in a long step: what a stack begins with is sixteen times as far from right.
    static constexpr int iterations = 24;

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
    //     while (far.begin_turn()) {
    //         ... a step of `turns` times the length, of nobody but those whose turn it is ...
    //         far.end_turn();
    //     }
    //     far.finish();
    void plan(double seconds);  // the length of that step
    bool begin_turn();
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
        bool leaves = false;                       // with finish()
        JPH::Vec3 linear;
        JPH::Vec3 angular;
        std::array<std::byte, 192> motion;
    };

    struct Island {
        float distance;  // squared, of its nearest body from the nearest hand
        std::uint32_t bodies;
        bool stays;  // something in it has to take every step
        bool chosen;
        bool calm;         // all of it but rests
        JPH::BodyID last;  // of its bodies
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
        Contacts contacts, fresh_contacts;
    };

    class ContactsOfLeavers;
    enum class Stage : std::uint8_t { begin, bodies, fresh };

    const Kept& kept(const JPH::Body& body) const;
    Kept& kept(const JPH::Body& body);
    JPH::Body& body(JPH::BodyID id) const;
    std::span<const JPH::BodyID> awake() const;
    std::size_t awake_count() const;
    float distance(const JPH::Body& body) const;
    bool but_rests(const JPH::Body& body) const;
    bool flies_freely(const JPH::Body& body) const;
    bool may_wait(const Island& island) const;
    void as_in_short_steps(JPH::Body& body) const;
    void survey_islands();
    Island* island_of(JPH::BodyID id);
    void choose(std::size_t most);
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
    std::array<Turn, turns> turn_list_;
    Stage stage_ = Stage::begin;
    std::vector<JPH::BodyID> due_, fresh_due_;  // whose turn it is
    std::vector<JPH::BodyID> waiting_;          // all others, while turns last
    Contacts contacts_of_waiting_;
    std::vector<JPH::BodyID> leaving_;
    std::vector<JPH::BodyID> changed_;
    std::vector<JPH::BodyID> list_;  // scratch
    std::vector<Island> islands_;    // by Jolt's number of the last step
    std::vector<std::uint32_t> order_;
};

}  // namespace tactus
