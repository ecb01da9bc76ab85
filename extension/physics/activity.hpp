// What a world does when bodies wake or fall asleep: it keeps each in the right tree of the broad phase, and
// remembers where the woken ones had been resting, so that a snapshot need hold only what was awake.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/jolt.hpp"
#include "physics/memory_recorder.hpp"
#include "physics/physics_world.hpp"

#include <Jolt/Physics/Body/BodyActivationListener.h>
#include <Jolt/Physics/Body/BodyID.h>

namespace JPH {
class Body;
class PhysicsSystem;
}  // namespace JPH

namespace tactus {

class FarIslands;
class SoundPlaces;
struct BodyRecord;

// Bodies that woke or fell asleep move to the other tree a few a step, so that a thousand falling asleep at
// once do not make that step late. Where a body is kept changes what finding its neighbours costs, never what
// is found.
class TreeKeeper {
public:
    TreeKeeper(JPH::PhysicsSystem& system, std::vector<BodyRecord*>& records, const FarIslands& far);

    void may_differ(JPH::BodyID id);
    void forget(JPH::BodyID id);  // the body leaves the world
    void tidy_some();

    // A body has entered a tree, which may take a node for it. What leaves gives none back until Jolt builds
    // the tree anew: in its steps, and here, since where nothing moves there is none.
    void note_entry();

private:
    JPH::PhysicsSystem& system_;
    std::vector<BodyRecord*>& records_;
    const FarIslands& far_;
    std::vector<JPH::BodyID> waiting_;  // never more than there are bodies
    std::size_t entries_ = 0;           // since a tree was built here
};

// The last resting states that were left, newest last, numbered without end.
class WakeJournal {
public:
    // Room for `capacity` wakings; without room only the present can be gone back to.
    WakeJournal(JPH::PhysicsSystem& system, std::size_t capacity);

    std::uint64_t serial() const { return next_; }

    void note(const JPH::Body& body);

    // Whether all wakings since `serial` are known.
    bool reaches(std::uint64_t serial) const { return serial <= next_ && next_ - serial <= known_; }

    // Puts every body that woke since back to where it rested and forgets those wakings. reaches(serial)
    // holds.
    void rewind(std::uint64_t serial);

    // Starts anew at `serial` with nothing known before it.
    void restart(std::uint64_t serial);

private:
    struct Entry {
        JPH::BodyID id;
        std::array<std::byte, max_bytes_of_a_body> state;
    };

    JPH::PhysicsSystem& system_;
    std::vector<Entry> entries_;
    std::uint64_t next_ = 0;
    std::uint64_t known_ = 0;  // entries before next_ that are still there
};

class ActivityListener final : public JPH::BodyActivationListener {
public:
    ActivityListener(TreeKeeper& trees, WakeJournal& journal, FarIslands& far, SoundPlaces& places,
                     std::vector<BodyId>& moved)
        : trees_(trees), journal_(journal), far_(far), places_(places), moved_(moved) {}

    // What wakes during a step is part of what the step moved.
    void in_step(bool begins) { in_step_ = begins; }

    void OnBodyActivated(const JPH::BodyID& id, JPH::uint64 body) override;
    void OnBodyDeactivated(const JPH::BodyID& id, JPH::uint64 body) override;

private:
    TreeKeeper& trees_;
    WakeJournal& journal_;
    FarIslands& far_;
    SoundPlaces& places_;
    std::vector<BodyId>& moved_;
    bool in_step_ = false;
};

}  // namespace tactus
