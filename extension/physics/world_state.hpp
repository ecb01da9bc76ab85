// The inside of a PhysicsWorld: private to physics/.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "physics/activity.hpp"
#include "physics/body_record.hpp"
#include "physics/collision_layers.hpp"
#include "physics/contact_rules.hpp"
#include "physics/far_islands.hpp"
#include "physics/free_spin.hpp"
#include "physics/implicit_damping.hpp"
#include "physics/joint_table.hpp"
#include "physics/jolt.hpp"
#include "physics/loop_jobs.hpp"
#include "physics/loop_memory.hpp"
#include "physics/physics_world.hpp"
#include "physics/sound_places.hpp"
#include "physics/spring_push.hpp"

#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/PhysicsSystem.h>

namespace tactus {

struct PhysicsWorld::Impl {
    explicit Impl(const PhysicsSettings& wanted);
    ~Impl();

    // Nobody else is in the world, so Jolt's per-body locks have nothing to protect.
    JPH::BodyInterface& bodies() { return system.GetBodyInterfaceNoLock(); }

    // Null when it is not in the world.
    JPH::Body* find(BodyId id) const;

    BodyRecord& record(const JPH::Body& body) { return *records[body.GetID().GetIndex()]; }

    // Before anything about a resting body changes, so that the journal sees it as it rested.
    void wake(JPH::Body& body);

    // Whatever rests on, leans on or is about to touch a body that changes.
    void wake_around(const JPH::Body& body);

    // One step of Jolt with at least so many iterations, and what it moves added to `moved`. StepStatus bits.
    std::uint32_t update(double seconds, int iterations, bool builds_trees);

    // Of those in `moved` from `first` on. True where there was one.
    bool put_back_the_lost(std::size_t first);

    // Jolt keeps constraints in order: these come last and leave again in reverse, so that joints stay where
    // they are.
    void add_pushes();
    void remove_pushes();
    void note_given(double seconds);
    void forget_pushes(const JPH::Body& body);  // it leaves the world or stops being dynamic

    PhysicsSettings settings;
    LoopMemory memory;
    LayerInterface layer_interface;
    BroadPhaseFilter broad_phase_filter;
    CollisionTable layers;
    ContactRules rules;
    JPH::TempAllocatorImplWithMallocFallback step_memory;
    LoopJobs jobs;
    JPH::PhysicsSystem system;
    std::vector<BodyRecord*> records;  // by the body's index; owned
    FarIslands far;
    SoundPlaces places;
    FreeSpin spin;
    ImplicitDamping damping;
    TreeKeeper trees;
    WakeJournal journal;
    std::vector<BodyId> moved;  // by the last step
    ActivityListener activity;
    JointTable joints;
    JointSwing swing;
    std::vector<SpringPush> pushes;  // the first push_count are of the next step
    std::size_t push_count = 0;
    std::vector<HandPush> plain_pushes;  // of the next step: forces in place of impulses
    std::vector<HandPush> given;         // see hand_pushes()
    std::size_t body_count = 0;
    std::uint64_t steps = 0;

    // Changes with everything a snapshot does not hold but rests on: which bodies there are, their shapes and
    // kinds.
    std::uint64_t structure = 0;
};

}  // namespace tactus
