#include "physics/loop_jobs.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

namespace tactus {

namespace {

bool is_named(const char* job, const char* name) {
    return job[0] == name[0] && std::strcmp(job, name) == 0;
}

}  // namespace

LoopJobs::LoopJobs(std::size_t most, JPH::PhysicsSystem& system) : system_(system), places_(most) {
    free_.reserve(most);
    for (std::size_t i = most; i-- > 0;)
        free_.push_back(&places_[i]);
}

JPH::JobSystem::JobHandle LoopJobs::CreateJob(const char* name, JPH::ColorArg color, const JobFunction& work,
                                              JPH::uint32 dependencies) {
    if (free_.empty())
        std::abort();  // PhysicsWorld makes room for more than a step can have
    Place* place = free_.back();
    free_.pop_back();
    JobHandle handle(new (place->job) Job(name, color, this, no_work_, dependencies));
    place->reports_ended_contacts = is_named(name, "ContactRemovedCallbacks");
    place->next = nullptr;
    if (is_named(name, "UpdateBroadPhaseFinalize"))
        exchange_of_trees_ = place;
    else if (is_named(name, "UpdateBroadPhasePrepare"))
        place->next = exchange_of_trees_->as_job();
    else if (is_named(name, "PreIntegrateVelocity"))
        exchange_of_trees_->next = handle.GetPtr();
    if (dependencies == 0)
        carry_out(*place, work);
    else
        place->work = work;
    return handle;
}

void LoopJobs::carry_out(const Place& place, const JobFunction& work) {
    if (place.next != nullptr && !builds_trees_)
        place.next->RemoveDependencyAndQueue(1);
    else if (place.reports_ended_contacts) {
        JPH::ContactListener* const listener = system_.GetContactListener();
        system_.SetContactListener(nullptr);
        work();
        system_.SetContactListener(listener);
    } else
        work();
}

void LoopJobs::FreeJob(Job* job) {
    job->~Job();
    free_.push_back(&place_of(job));
}

}  // namespace tactus
