#include "physics/loop_jobs.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

namespace tactus {

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
    if (dependencies == 0)
        work();
    else
        place->work = work;
    place->reports_ended_contacts = name[0] == 'C' && std::strcmp(name, "ContactRemovedCallbacks") == 0;
    return handle;
}

void LoopJobs::carry_out(Place& place) {
    if (!place.reports_ended_contacts) {
        place.work();
        return;
    }
    JPH::ContactListener* const listener = system_.GetContactListener();
    system_.SetContactListener(nullptr);
    place.work();
    system_.SetContactListener(listener);
}

void LoopJobs::FreeJob(Job* job) {
    job->~Job();
    free_.push_back(&place_of(job));
}

}  // namespace tactus
