#include "physics/jolt_runtime.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/Memory.h>
#include <Jolt/Physics/Body/BodyManager.h>
#include <Jolt/RegisterTypes.h>

#include <mutex>

#include "physics/collision_layers.hpp"
#include "physics/loop_memory.hpp"

namespace tactus {

namespace {

struct BodyFactory {
    LayerInterface layers;
    JPH::BodyManager manager;
};

BodyFactory* factory = nullptr;

void start_once() {
    JPH::Allocate = jolt_allocation::allocate;
    JPH::Reallocate = jolt_allocation::reallocate;
    JPH::Free = jolt_allocation::release;
    JPH::AlignedAllocate = jolt_allocation::allocate_aligned;
    JPH::AlignedFree = jolt_allocation::release;
    // A process may hold several users of the same Jolt; the first one makes its registry.
    if (JPH::Factory::sInstance == nullptr)
        JPH::Factory::sInstance = new JPH::Factory();
    JPH::RegisterTypes();
    // Lives as long as the process: bodies may be unmade while it ends.
    factory = new BodyFactory;
    factory->manager.Init(1, 1, factory->layers);
}

}  // namespace

void start_jolt() {
    static std::once_flag started;
    std::call_once(started, start_once);
}

const JPH::BodyManager& body_factory() {
    start_jolt();
    return factory->manager;
}

}  // namespace tactus
