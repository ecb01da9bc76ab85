#include "physics/far_islands.hpp"

#include <Jolt/Physics/Body/BodyInterface.h>
#include <Jolt/Physics/PhysicsSystem.h>

#include <algorithm>

#include "physics/jolt_units.hpp"
#include "physics/memory_recorder.hpp"

namespace tactus {

namespace {

// Nothing within this of a hand is set aside: a hand and a body at 4 m/s towards each other meet in no fewer
// than two turns.
constexpr double stays_within = 0.15;  // (unit: meters)
// What comes within this takes every step again; the difference keeps islands from going to and fro.
constexpr double returns_within = 0.10;  // (unit: meters)

constexpr std::size_t contact_bytes = std::size_t{256} << 10;

float squared_length(double meters) {
    return units::area(meters * meters);
}

}  // namespace

FarIslands::FarIslands(JPH::PhysicsSystem& system, std::vector<BodyRecord*>& records, std::uint32_t full_rate)
    : system_(system), records_(records), full_rate_(full_rate) {
    if (full_rate_ == 0)
        return;
    constexpr std::size_t max_hands = 64;
    hands_.reserve(max_hands);
    kept_.resize(records.size());
    for (Turn& turn : turn_list_) {
        turn.bodies.reserve(records.size());
        turn.fresh.reserve(records.size());
        turn.contacts.memory.resize(contact_bytes);
        turn.fresh_contacts.memory.resize(contact_bytes);
    }
    contacts_of_waiting_.memory.resize(contact_bytes);
    for (std::vector<JPH::BodyID>* list : {&due_, &fresh_due_, &waiting_, &leaving_, &changed_, &list_})
        list->reserve(records.size());
    islands_.reserve(records.size());
    order_.reserve(records.size());
}

void FarIslands::set_hands(std::span<const Vec3> hands) {
    hands_.clear();
    for (const Vec3& hand : hands.first(std::min(hands.size(), hands_.capacity())))
        hands_.push_back(units::vector(hand));
}

bool FarIslands::holds(const JPH::Body& body) const {
    return !kept_.empty() && kept(body).keep == Keep::in_turn;
}

const FarIslands::Kept& FarIslands::kept(const JPH::Body& body) const {
    return kept_[body.GetID().GetIndex()];
}
FarIslands::Kept& FarIslands::kept(const JPH::Body& body) {
    return kept_[body.GetID().GetIndex()];
}

JPH::Body& FarIslands::body(JPH::BodyID id) const {
    return *records_[id.GetIndex()]->in_world;
}

std::size_t FarIslands::awake_count() const {
    return system_.GetNumActiveBodies(JPH::EBodyType::RigidBody);
}

std::span<const JPH::BodyID> FarIslands::awake() const {
    return {system_.GetActiveBodiesUnsafe(JPH::EBodyType::RigidBody), awake_count()};
}

bool FarIslands::release(JPH::Body& released, bool give_velocity_back) {
    if (kept_.empty() || released.GetMotionPropertiesUnchecked() == nullptr ||
        kept(released).keep == Keep::no)
        return false;
    Kept& state = kept(released);
    state.list->erase(std::find(state.list->begin(), state.list->end(), released.GetID()));
    count_ -= state.keep == Keep::in_turn ? 1 : 0;
    state.keep = Keep::no;
    if (give_velocity_back) {
        released.GetMotionProperties()->SetLinearVelocity(state.linear);
        released.GetMotionProperties()->SetAngularVelocity(state.angular);
    }
    return true;
}

float FarIslands::distance(const JPH::Body& body) const {
    float nearest = std::numeric_limits<float>::max();
    for (const JPH::Vec3& hand : hands_)
        nearest = std::min(nearest, body.GetWorldSpaceBounds().GetSqDistanceTo(hand));
    return nearest;
}

void FarIslands::survey_islands() {
    islands_.assign(awake_count(), Island{std::numeric_limits<float>::max(), 0, false, false});
    for (const JPH::BodyID id : awake()) {
        Island* island = island_of(id);
        if (island == nullptr)
            continue;
        island->distance = std::min(island->distance, distance(body(id)));
        ++island->bodies;
        // A body that moves as told is told anew for every step.
        island->stays |= !body(id).IsDynamic();
    }
}

// Null for what the last step did not know.
FarIslands::Island* FarIslands::island_of(JPH::BodyID id) {
    const std::uint32_t number = body(id).GetMotionProperties()->GetIslandIndexInternal();
    return number < islands_.size() ? &islands_[number] : nullptr;
}

// The farthest islands, until `most` bodies are chosen; at least one island.
void FarIslands::choose(std::size_t most) {
    order_.clear();
    for (std::uint32_t i = 0; i < islands_.size(); ++i)
        if (islands_[i].bodies > 0 && !islands_[i].stays &&
            islands_[i].distance > squared_length(stays_within))
            order_.push_back(i);
    std::sort(order_.begin(), order_.end(), [this](std::uint32_t a, std::uint32_t b) {
        return islands_[a].distance != islands_[b].distance ? islands_[a].distance > islands_[b].distance
                                                            : a < b;
    });
    std::size_t chosen = 0;
    for (const std::uint32_t i : order_) {
        if (chosen > 0 && chosen + islands_[i].bodies > most)
            break;
        islands_[i].chosen = true;
        chosen += islands_[i].bodies;
    }
}

void FarIslands::send_away(JPH::BodyID id, Keep keep, std::vector<JPH::BodyID>& list) {
    const JPH::Body& sent = body(id);
    const JPH::MotionProperties& motion = *sent.GetMotionProperties();
    Kept& state = kept(sent);
    state.keep = keep;
    state.list = &list;
    state.linear = motion.GetLinearVelocity();
    state.angular = motion.GetAngularVelocity();
    MemoryWriter writer(state.motion);
    motion.SaveState(writer);
    list.push_back(id);
    count_ += keep == Keep::in_turn ? 1 : 0;
    system_.GetBodyInterfaceNoLock().DeactivateBody(id);
}

void FarIslands::bring_back(std::vector<JPH::BodyID>& list) {
    for (const JPH::BodyID id : list) {
        JPH::Body& brought = body(id);
        Kept& state = kept(brought);
        count_ -= state.keep == Keep::in_turn ? 1 : 0;
        state.keep = Keep::no;
        system_.GetBodyInterfaceNoLock().ActivateBody(id);
        MemoryReader reader(state.motion);
        brought.GetMotionProperties()->RestoreState(reader);
    }
    list.clear();
}

// With the length of the last step, by which Jolt scales the forces it begins with. Contacts that find no
// room begin without.
void FarIslands::save(Contacts& contacts, std::size_t part, const JPH::StateRecorderFilter* which) const {
    const std::span<std::byte> room = std::span(contacts.memory).subspan(part == 0 ? 0 : contacts.bytes[0]);
    const auto written = [&](JPH::EStateRecorderState what) {
        MemoryWriter writer(room);
        system_.SaveState(writer, what, which);
        return writer.IsFailed() ? 0 : writer.used();
    };
    contacts.bytes[part] = written(JPH::EStateRecorderState::Global | JPH::EStateRecorderState::Contacts);
    if (contacts.bytes[part] == 0 && part == 0)
        contacts.bytes[part] = written(JPH::EStateRecorderState::Global);
}

void FarIslands::restore(const Contacts& contacts) {
    const JPH::Vec3 gravity = system_.GetGravity();
    std::span<const std::byte> rest(contacts.memory);
    for (std::size_t part = 0; part < 2; ++part) {
        if (contacts.bytes[part] == 0)
            continue;
        MemoryReader reader(rest.first(contacts.bytes[part]));
        reader.SetIsLastPart(part == 1 || contacts.bytes[1] == 0);
        system_.RestoreState(reader);
        rest = rest.subspan(contacts.bytes[part]);
    }
    system_.SetGravity(gravity);
}

class FarIslands::ContactsOfLeavers final : public JPH::StateRecorderFilter {
public:
    explicit ContactsOfLeavers(const FarIslands& far) : far_(far) {}
    bool ShouldSaveContact(const JPH::BodyID& a, const JPH::BodyID& b) const override {
        return far_.kept_[a.GetIndex()].leaves || far_.kept_[b.GetIndex()].leaves;
    }

private:
    const FarIslands& far_;
};

void FarIslands::plan() {
    if (full_rate_ == 0)
        return;
    changed_.clear();
    turn_ = (turn_ + 1) % turns;
    stage_ = Stage::begin;
    Turn& turn = turn_list_[turn_];
    const std::size_t share = (awake_count() + count_ + turns - 1) / turns;
    const std::size_t here = turn.bodies.size() + turn.fresh.size();
    if (awake_count() <= full_rate_ || here >= share)
        return;
    survey_islands();
    choose(std::min(share - here, awake_count() - full_rate_));
    for (const JPH::BodyID id : awake())
        if (const Island* island = island_of(id); island != nullptr && island->chosen) {
            kept(body(id)).leaves = true;
            leaving_.push_back(id);
        }
}

bool FarIslands::begin_turn() {
    if (full_rate_ == 0)
        return false;
    Turn& turn = turn_list_[turn_];
    if (stage_ == Stage::begin) {
        if (turn.bodies.empty() && turn.fresh.empty())
            return false;
        exchanging_ = true;
        save(contacts_of_waiting_, 0);
        list_.assign(awake().begin(), awake().end());
        for (const JPH::BodyID id : list_)
            send_away(id, Keep::until_turns_end, waiting_);
        due_.swap(turn.bodies);
        fresh_due_.swap(turn.fresh);
        for (const JPH::BodyID id : due_)
            kept(body(id)).list = &due_;
        for (const JPH::BodyID id : fresh_due_)
            kept(body(id)).list = &fresh_due_;
    }
    exchanging_ = true;
    if (stage_ == Stage::begin && !due_.empty()) {
        stage_ = Stage::bodies;
        restore(turn.contacts);
        bring_back(due_);
    } else if (stage_ != Stage::fresh && !fresh_due_.empty()) {
        if (stage_ == Stage::begin)
            turn.contacts.bytes = {0, 0};
        stage_ = Stage::fresh;
        restore(turn.fresh_contacts);
        bring_back(fresh_due_);
    } else {
        exchanging_ = false;
        return false;
    }
    exchanging_ = false;
    return true;
}

void FarIslands::end_turn() {
    exchanging_ = true;
    Turn& turn = turn_list_[turn_];
    if (stage_ == Stage::bodies)
        turn.contacts.bytes = {0, 0};
    save(turn.contacts, stage_ == Stage::bodies ? 0 : 1);
    survey_islands();
    const std::size_t low = full_rate_ - full_rate_ / 4;
    const bool all_return = waiting_.size() + awake_count() <= low;
    list_.assign(awake().begin(), awake().end());
    for (const JPH::BodyID id : list_) {
        const Island* island = island_of(id);
        const bool goes_on = !all_return && island != nullptr && !island->stays &&
                             island->distance > squared_length(returns_within);
        if (goes_on)
            send_away(id, Keep::in_turn, turn.bodies);
        else {
            send_away(id, Keep::until_turns_end, waiting_);
            changed_.push_back(id);
        }
    }
    exchanging_ = false;
}

// What leaves now is due in as many steps as a turn is long: no time is lost.
void FarIslands::finish() {
    if (full_rate_ == 0)
        return;
    exchanging_ = true;
    if (stage_ != Stage::begin) {
        bring_back(waiting_);
        restore(contacts_of_waiting_);
    }
    if (!leaving_.empty()) {
        Turn& turn = turn_list_[turn_];
        const ContactsOfLeavers leavers(*this);
        save(turn.fresh_contacts, 0, &leavers);
        for (const JPH::BodyID id : leaving_) {
            kept(body(id)).leaves = false;
            changed_.push_back(id);
            if (body(id).IsActive())
                send_away(id, Keep::in_turn, turn.fresh);
        }
        leaving_.clear();
    }
    exchanging_ = false;
}

}  // namespace tactus
