// Jolt's jobs, each carried out at once by the thread that made it.
//
// As Jolt's own single-threaded system, but without what only several threads need: of the 3.5 us that a step
// with one free body takes, making, running and freeing two dozen jobs there is a third. Free places are a
// plain stack in place of a lock-free list, and the work stands beside its job: Job::Execute() would wrap it
// in three atomic exchanges, which nobody looks at.
//
// One of the jobs reports the contacts that have ended. For that it walks through the 1024 and more buckets
// of Jolt's table, a tenth of a tick with one box, and only where there is a listener. Nothing here asks for
// these contacts, so that job is carried out without the listener.
//
// Two jobs build a tree of the broad phase anew, so that the boxes in it, which only grow while bodies move,
// fit again. In a thousandth of a second none moves far: that is left out of most steps, where each of the
// two lets go on the job that waits for it.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "physics/jolt.hpp"

#include <Jolt/Core/JobSystem.h>
#include <Jolt/Physics/PhysicsSystem.h>

namespace tactus {

class LoopJobs final : public JPH::JobSystem {
public:
    LoopJobs(std::size_t most, JPH::PhysicsSystem& system);

    // Whether the next step builds one.
    void build_trees(bool builds) { builds_trees_ = builds; }

    int GetMaxConcurrency() const override { return 1; }
    JobHandle CreateJob(const char* name, JPH::ColorArg color, const JobFunction& work,
                        JPH::uint32 dependencies) override;
    Barrier* CreateBarrier() override { return &barrier_; }
    void DestroyBarrier(Barrier*) override {}
    void WaitForJobs(Barrier*) override {}

protected:
    void QueueJob(Job* job) override { carry_out(place_of(job), place_of(job).work); }
    void QueueJobs(Job** jobs, JPH::uint count) override {
        for (JPH::uint i = 0; i < count; ++i)
            QueueJob(jobs[i]);
    }
    void FreeJob(Job* job) override;

private:
    // Jobs are done before anybody could wait for them.
    class NothingToWaitFor final : public Barrier {
    public:
        void AddJob(const JobHandle&) override {}
        void AddJobs(const JobHandle*, JPH::uint) override {}

    protected:
        void OnJobFinished(Job*) override {}
    };

    struct Place {
        alignas(Job) std::byte job[sizeof(Job)];  // first: a job's address is its place's
        JobFunction work;
        bool reports_ended_contacts = false;
        Job* next = nullptr;  // that waits for one of the two that build trees

        Job* as_job() { return reinterpret_cast<Job*>(job); }
    };
    static Place& place_of(Job* job) { return *reinterpret_cast<Place*>(job); }

    void carry_out(const Place& place, const JobFunction& work);

    JPH::PhysicsSystem& system_;
    std::vector<Place> places_;
    const JobFunction no_work_;
    std::vector<Place*> free_;            // a stack
    Place* exchange_of_trees_ = nullptr;  // the second of the two, of the sub-step that is made last
    bool builds_trees_ = true;
    NothingToWaitFor barrier_;
};

}  // namespace tactus
