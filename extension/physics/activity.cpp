#include "physics/activity.hpp"

#include "physics/jolt.hpp"

#include <Jolt/Physics/PhysicsSystem.h>

#include <algorithm>

#include "physics/body_record.hpp"
#include "physics/collision_layers.hpp"
#include "physics/far_islands.hpp"
#include "physics/memory_recorder.hpp"
#include "physics/sound_places.hpp"

namespace tactus {

TreeKeeper::TreeKeeper(JPH::PhysicsSystem& system, std::vector<BodyRecord*>& records, const FarIslands& far)
    : system_(system), records_(records), far_(far) {
    waiting_.reserve(records.size());
}

void TreeKeeper::may_differ(JPH::BodyID id) {
    BodyRecord* record = records_[id.GetIndex()];
    if (record == nullptr || record->tree_may_differ)
        return;
    record->tree_may_differ = true;
    waiting_.push_back(id);
}

void TreeKeeper::forget(JPH::BodyID id) {
    BodyRecord& record = *records_[id.GetIndex()];
    if (!record.tree_may_differ)
        return;
    record.tree_may_differ = false;
    *std::find(waiting_.begin(), waiting_.end(), id) = waiting_.back();
    waiting_.pop_back();
}

void TreeKeeper::tidy_some() {
    constexpr int most = 16;
    for (int i = 0; i < most && !waiting_.empty(); ++i) {
        const JPH::BodyID id = waiting_.back();
        waiting_.pop_back();
        BodyRecord& record = *records_[id.GetIndex()];
        record.tree_may_differ = false;
        const JPH::Body& body = *system_.GetBodyLockInterfaceNoLock().TryGetBody(id);
        const Tree tree = far_.holds(body) ? Tree::Slowed : body.IsActive() ? Tree::Awake : Tree::Resting;
        system_.GetBodyInterfaceNoLock().SetObjectLayer(id, object_layer(record.layer_pair, tree));
        note_entry();
    }
}

// Jolt has room for four nodes to three bodies, and for no fewer than 256. It builds one tree at a time,
// beside the old one.
void TreeKeeper::note_entry() {
    constexpr std::size_t in_small_worlds = 32;
    if (++entries_ < in_small_worlds + records_.size() / 32)
        return;
    entries_ = 0;
    constexpr float no_time = 0.0f;  // builds the next tree that has changed, and does nothing else
    system_.Update(no_time, 1, nullptr, nullptr);
}

WakeJournal::WakeJournal(JPH::PhysicsSystem& system, std::size_t capacity)
    : system_(system), entries_(capacity) {}

void WakeJournal::note(const JPH::Body& body) {
    if (!entries_.empty()) {
        Entry& entry = entries_[next_ % entries_.size()];
        entry.id = body.GetID();
        MemoryWriter writer(entry.state);
        constexpr bool active = false;  // as it was until now
        writer.Write(active);
        body.SaveState(writer);
        known_ = std::min<std::uint64_t>(known_ + 1, entries_.size());
    }
    ++next_;
}

void WakeJournal::rewind(std::uint64_t serial) {
    while (next_ > serial) {
        --next_;
        --known_;
        const Entry& entry = entries_[next_ % entries_.size()];
        MemoryReader reader(entry.state);
        system_.RestoreBodyState(*system_.GetBodyLockInterfaceNoLock().TryGetBody(entry.id), reader);
    }
}

void WakeJournal::restart(std::uint64_t serial) {
    next_ = serial;
    known_ = 0;
}

void ActivityListener::OnBodyActivated(const JPH::BodyID& id, JPH::uint64 body) {
    if (far_.exchanging())
        return;
    auto& woken = *reinterpret_cast<const BodyRecord*>(body)->in_world;
    far_.release(woken, true);
    journal_.note(woken);
    trees_.may_differ(id);
    if (in_step_) {
        moved_.push_back({id.GetIndexAndSequenceNumber()});
        places_.keep(woken);
    }
}

void ActivityListener::OnBodyDeactivated(const JPH::BodyID& id, JPH::uint64) {
    if (!far_.exchanging())
        trees_.may_differ(id);
}

}  // namespace tactus
