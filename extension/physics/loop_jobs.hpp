// Jolt's jobs, each carried out at once by the thread that made it.
//
// As Jolt's own single-threaded system, but without what only several threads need: of the 3.5 us that a step
// with one free body takes, making, running and freeing two dozen jobs there is a third. Free places are a
// plain stack in place of a lock-free list, and the work stands beside its job: Job::Execute() would wrap it
// in three atomic exchanges, which nobody looks at.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "physics/jolt.hpp"

#include <Jolt/Core/JobSystem.h>

namespace tactus {

class LoopJobs final : public JPH::JobSystem {
public:
    explicit LoopJobs(std::size_t most);

    int GetMaxConcurrency() const override { return 1; }
    JobHandle CreateJob(const char* name, JPH::ColorArg color, const JobFunction& work,
                        JPH::uint32 dependencies) override;
    Barrier* CreateBarrier() override { return &barrier_; }
    void DestroyBarrier(Barrier*) override {}
    void WaitForJobs(Barrier*) override {}

protected:
    void QueueJob(Job* job) override { place_of(job).work(); }
    void QueueJobs(Job** jobs, JPH::uint count) override {
        for (JPH::uint i = 0; i < count; ++i)
            place_of(jobs[i]).work();
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
    };
    static Place& place_of(Job* job) { return *reinterpret_cast<Place*>(job); }

    std::vector<Place> places_;
    const JobFunction no_work_;
    std::vector<Place*> free_;  // a stack
    NothingToWaitFor barrier_;
};

}  // namespace tactus
