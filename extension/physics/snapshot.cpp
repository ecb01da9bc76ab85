// Saving and restoring a world (physics_world.hpp).
//
// A snapshot is a header, the bodies and Jolt's contacts and joints. In the header stands how many wakings
// there had been: what was asleep then and is not now finds its resting place in the journal of wakings.
#include <array>
#include <cstring>

#include "physics/memory_recorder.hpp"
#include "physics/world_state.hpp"

namespace tactus {

namespace {

struct Header {
    std::uint64_t structure;
    std::uint64_t wake_serial;
    std::uint32_t bodies;
    std::uint32_t everything;
};

constexpr JPH::EStateRecorderState all_but_bodies = JPH::EStateRecorderState::Global |
                                                    JPH::EStateRecorderState::Contacts |
                                                    JPH::EStateRecorderState::Constraints;

}  // namespace

std::size_t PhysicsWorld::save_state(std::span<std::byte> memory, bool everything) const {
    if (impl_->far.count() > 0)
        return 0;
    const LoopMemoryScope scope(impl_->memory);
    const JPH::PhysicsSystem& system = impl_->system;
    const JPH::BodyLockInterface& bodies = system.GetBodyLockInterfaceNoLock();
    const JPH::uint awake = system.GetNumActiveBodies(JPH::EBodyType::RigidBody);
    const JPH::BodyID* active = system.GetActiveBodiesUnsafe(JPH::EBodyType::RigidBody);

    MemoryWriter writer(memory);
    Header header{impl_->structure, impl_->journal.serial(), awake, everything ? 1u : 0u};
    writer.Write(header);
    const auto write_body = [&](const JPH::Body& body) {
        writer.Write(body.GetID());
        system.SaveBodyState(body, writer);
    };
    // In the order Jolt keeps them, which restore() brings back.
    for (JPH::uint i = 0; i < awake; ++i)
        write_body(*bodies.TryGetBody(active[i]));
    if (everything)
        for (const BodyRecord* record : impl_->records)
            if (record != nullptr && !record->in_world->IsActive() &&
                record->in_world->CanBeKinematicOrDynamic()) {
                write_body(*record->in_world);
                ++header.bodies;
            }
    system.SaveState(writer, all_but_bodies);
    impl_->joints.save(writer);
    if (writer.IsFailed())
        return 0;
    std::memcpy(memory.data(), &header, sizeof(header));
    return writer.used();
}

std::size_t PhysicsWorld::save(std::span<std::byte> memory) const {
    return save_state(memory, false);
}

std::size_t PhysicsWorld::save_everything(std::span<std::byte> memory) const {
    return save_state(memory, true);
}

bool PhysicsWorld::restore(std::span<const std::byte> snapshot) {
    MemoryReader reader(snapshot);
    Header header{};
    reader.Read(header);
    if (reader.IsFailed() || header.structure != impl_->structure)
        return false;
    const bool journal_reaches = impl_->journal.reaches(header.wake_serial);
    if (header.everything == 0 && !journal_reaches)
        return false;

    const LoopMemoryScope scope(impl_->memory);
    JPH::PhysicsSystem& system = impl_->system;
    const JPH::BodyLockInterface& bodies = system.GetBodyLockInterfaceNoLock();
    impl_->push_count = 0;
    while (const JPH::uint awake = system.GetNumActiveBodies(JPH::EBodyType::RigidBody))
        impl_->bodies().DeactivateBody(system.GetActiveBodiesUnsafe(JPH::EBodyType::RigidBody)[awake - 1]);
    if (journal_reaches)
        impl_->journal.rewind(header.wake_serial);
    else
        impl_->journal.restart(header.wake_serial);
    for (std::uint32_t i = 0; i < header.bodies; ++i) {
        JPH::BodyID id;
        reader.Read(id);
        system.RestoreBodyState(*bodies.TryGetBody(id), reader);
        impl_->trees.may_differ(id);
    }
    system.RestoreState(reader);
    impl_->joints.restore(reader);
    return true;
}

void PhysicsWorld::take_state(BodyId id, const PhysicsWorld& other) {
    JPH::Body* body = impl_->find(id);
    const JPH::Body* same = other.impl_->find(id);
    if (body == nullptr || same == nullptr)
        return;
    const LoopMemoryScope scope(impl_->memory);
    impl_->far.release(*body, false);
    std::array<std::byte, max_bytes_of_a_body> state;
    MemoryWriter writer(state);
    other.impl_->system.SaveBodyState(*same, writer);
    MemoryReader reader(state);
    impl_->system.RestoreBodyState(*body, reader);
    impl_->trees.may_differ(body->GetID());
}

}  // namespace tactus
