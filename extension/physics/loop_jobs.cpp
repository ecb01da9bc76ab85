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
    Job* job = new (place->bytes) Job(name, color, this, work, dependencies);
    JobHandle handle(job);
    if (dependencies == 0)
        job->Execute();
    return handle;
}

void LoopJobs::FreeJob(Job* job) {
    job->~Job();
    free_.push_back(reinterpret_cast<Place*>(job));
}

}  // namespace tactus
