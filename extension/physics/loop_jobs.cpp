#include "physics/loop_jobs.hpp"

#include <cstdlib>
#include <new>

namespace tactus {

LoopJobs::LoopJobs(std::size_t most) : places_(most) {
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
    return handle;
}

void LoopJobs::FreeJob(Job* job) {
    job->~Job();
    free_.push_back(&place_of(job));
}

}  // namespace tactus
