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
    for (std::size_t rate = 0; rate < slow_rates.size(); ++rate) {
        turn_list_[rate].resize(slow_rates[rate].steps);
        for (Turn& turn : turn_list_[rate]) {
            for (std::vector<JPH::BodyID>* list : {&turn.bodies, &turn.fresh, &turn.leaving})
                list->reserve(records.size());
            turn.contacts.memory.resize(contact_bytes);
            turn.fresh_contacts.memory.resize(contact_bytes);
        }
    }
    contacts_of_waiting_.memory.resize(contact_bytes);
    for (std::vector<JPH::BodyID>* list : {&waiting_, &changed_, &stepped_, &list_})
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
    Island none{std::numeric_limits<float>::max(), 0, false, slow_rates.size(), {}, {}};
    none.calm.fill(true);
    islands_.assign(awake_count(), none);
    for (const JPH::BodyID id : awake()) {
        Island* island = island_of(id);
        if (island == nullptr)
            continue;
        island->distance = std::min(island->distance, distance(body(id)));
        ++island->bodies;
        // A body that moves as told is told anew for every step.
        island->stays |= !body(id).IsDynamic();
        for (std::size_t rate = 0; rate < slow_rates.size(); ++rate)
            island->calm[rate] = island->calm[rate] && is_calm(body(id), slow_rates[rate]);
        island->last = id;
    }
}

bool FarIslands::is_calm(const JPH::Body& body, const SlowRate& rate) const {
    const JPH::Shape& shape = *body.GetShape();
    const float speed = body.GetLinearVelocity().Length() +
                        body.GetAngularVelocity().Length() * shape.GetLocalBounds().GetExtent().Length();
    return speed * seconds_ * static_cast<float>(rate.steps) <
           std::min(units::length(rate.way), 0.5f * shape.GetInnerRadius());
}

// Nothing that it collides with is near its way in the next step at the slowest rate. What is awake itself
// may come towards it as fast as it goes.
bool FarIslands::flies_freely(const JPH::Body& body) const {
    class Any final : public JPH::CollideShapeBodyCollector {
    public:
        Any(const FarIslands& far, JPH::BodyID except, const JPH::AABox& way)
            : far_(far), except_(except), way_(way) {}
        void AddHit(const JPH::BodyID& id) override {
            const JPH::Body& other = far_.body(id);
            const bool moves = other.IsActive() || far_.holds(other);
            if (id != except_ && (moves || other.GetWorldSpaceBounds().Overlaps(way_))) {
                found = true;
                ForceEarlyOut();
            }
        }
        bool found = false;

    private:
        const FarIslands& far_;
        JPH::BodyID except_;
        JPH::AABox way_;
    };
    constexpr double beside = 2e-3;  // (unit: meters)
    const float seconds = seconds_ * static_cast<float>(slow_rates.front().steps);
    const JPH::Vec3 fall =
        body.GetMotionProperties()->GetGravityFactor() * seconds * seconds * system_.GetGravity();
    const JPH::Vec3 way = seconds * body.GetLinearVelocity() + fall;
    JPH::AABox swept = body.GetWorldSpaceBounds();
    JPH::AABox there = swept;
    there.Translate(way);
    swept.Encapsulate(there);
    // What turns is no wider than its longest diagonal.
    const float turning =
        body.GetAngularVelocity().Length() * seconds * body.GetShape()->GetLocalBounds().GetExtent().Length();
    swept.ExpandBy(JPH::Vec3::sReplicate(units::length(beside) + turning));
    JPH::AABox wide = swept;
    wide.ExpandBy(JPH::Vec3::sReplicate(way.Length()));
    Any any(*this, body.GetID(), swept);
    system_.GetBroadPhaseQuery().CollideAABox(wide, any,
                                              system_.GetDefaultBroadPhaseLayerFilter(body.GetObjectLayer()),
                                              system_.GetDefaultLayerFilter(body.GetObjectLayer()));
    return !any.found;
}

bool FarIslands::may_wait(const Island& island, std::size_t rate) const {
    return !island.stays &&
           (island.calm[rate] || (rate == 0 && island.bodies == 1 && flies_freely(body(island.last))));
}

// Where a body gains v' - v evenly, a long step of n short ones goes v' n dt, and these v n dt +
// (v' - v) (n + 1) dt / 2.
void FarIslands::as_in_short_steps(JPH::Body& moved, const SlowRate& rate) const {
    constexpr double evenly = 20.0;   // what a blow gives is more (unit: meters per second squared)
    constexpr double nothing = 1e-6;  // (unit: meters)
    const JPH::Vec3 gain = moved.GetLinearVelocity() - kept(moved).linear;
    const JPH::Vec3 ahead = 0.5f * static_cast<float>(rate.steps - 1) * seconds_ * gain;
    const float seconds = static_cast<float>(rate.steps) * seconds_;
    if (gain.Length() > units::length(evenly) * seconds || ahead.Length() < units::length(nothing))
        return;
    system_.GetBodyInterfaceNoLock().SetPosition(moved.GetID(), moved.GetPosition() - ahead,
                                                 JPH::EActivation::DontActivate);
}

// Null for what the last step did not know.
FarIslands::Island* FarIslands::island_of(JPH::BodyID id) {
    const std::uint32_t number = body(id).GetMotionProperties()->GetIslandIndexInternal();
    return number < islands_.size() ? &islands_[number] : nullptr;
}

// The farthest islands, until `most` bodies are chosen; at least one island. None that is calm enough for a
// slower rate, which has room for it soon.
void FarIslands::choose(std::size_t rate, std::size_t most) {
    order_.clear();
    for (std::uint32_t i = 0; i < islands_.size(); ++i) {
        const Island& island = islands_[i];
        if (island.bodies > 0 && !island.stays && island.chosen == slow_rates.size() &&
            island.distance > squared_length(stays_within) && (rate == 0 || !island.calm[rate - 1]))
            order_.push_back(i);
    }
    std::sort(order_.begin(), order_.end(), [this](std::uint32_t a, std::uint32_t b) {
        return islands_[a].distance != islands_[b].distance ? islands_[a].distance > islands_[b].distance
                                                            : a < b;
    });
    std::size_t chosen = 0;
    std::size_t looks = 2 * most;
    for (const std::uint32_t i : order_) {
        if ((chosen > 0 && chosen + islands_[i].bodies > most) || chosen >= most || looks == 0)
            break;
        looks -= islands_[i].calm[rate] ? 0 : 1;
        if (!may_wait(islands_[i], rate))
            continue;
        islands_[i].chosen = rate;
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

void FarIslands::plan(double seconds) {
    if (full_rate_ == 0)
        return;
    seconds_ = static_cast<float>(seconds);
    changed_.clear();
    turn_ = (turn_ + 1) % slow_rates.front().steps;
    part_ = 0;
    std::size_t stay = awake_count();
    const std::size_t all = stay + count_;
    bool surveyed = false;
    for (std::size_t rate = 0; rate < slow_rates.size(); ++rate) {
        Turn& turn = due(rate);
        const std::size_t share = (all + slow_rates[rate].steps - 1) / slow_rates[rate].steps;
        const std::size_t here = turn.bodies.size() + turn.fresh.size();
        if (stay <= full_rate_ || here >= share)
            continue;
        if (!surveyed)
            survey_islands();
        surveyed = true;
        choose(rate, std::min(share - here, stay - full_rate_));
        for (const JPH::BodyID id : awake())
            if (const Island* island = island_of(id); island != nullptr && island->chosen == rate)
                turn.leaving.push_back(id);
        stay -= std::min(stay, turn.leaving.size());
    }
}

const SlowRate* FarIslands::begin_turn() {
    if (full_rate_ == 0)
        return nullptr;
    const auto list_of_part = [this]() -> std::vector<JPH::BodyID>& {
        Turn& turn = due(part_ / 2);
        return part_ % 2 == 0 ? turn.bodies : turn.fresh;
    };
    while (part_ < parts_of_a_step && list_of_part().empty())
        ++part_;
    if (part_ == parts_of_a_step)
        return nullptr;
    exchanging_ = true;
    if (!took_turns_) {
        took_turns_ = true;
        save(contacts_of_waiting_, 0);
        list_.assign(awake().begin(), awake().end());
        for (const JPH::BodyID id : list_)
            send_away(id, Keep::until_turns_end, waiting_);
    }
    Turn& turn = due(part_ / 2);
    if (part_ % 2 == 1 && turn.bodies.empty())
        turn.contacts.bytes = {0, 0};
    restore(part_ % 2 == 0 ? turn.contacts : turn.fresh_contacts);
    stepped_ = list_of_part();
    bring_back(list_of_part());
    exchanging_ = false;
    return &slow_rates[part_ / 2];
}

void FarIslands::end_turn() {
    exchanging_ = true;
    const std::size_t rate = part_ / 2;
    Turn& turn = due(rate);
    if (part_ % 2 == 0)
        turn.contacts.bytes = {0, 0};
    save(turn.contacts, part_ % 2);
    ++part_;
    for (const JPH::BodyID id : stepped_)
        if (body(id).IsActive())
            as_in_short_steps(body(id), slow_rates[rate]);
    survey_islands();
    const std::size_t low = full_rate_ - full_rate_ / 4;
    const bool all_return = waiting_.size() + awake_count() <= low;
    list_.assign(awake().begin(), awake().end());
    for (const JPH::BodyID id : list_) {
        const Island* island = island_of(id);
        const bool goes_on = !all_return && island != nullptr &&
                             island->distance > squared_length(returns_within) && may_wait(*island, rate) &&
                             (rate == 0 || !island->calm[rate - 1]);
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
    if (took_turns_) {
        bring_back(waiting_);
        restore(contacts_of_waiting_);
    }
    took_turns_ = false;
    for (std::size_t rate = 0; rate < slow_rates.size(); ++rate) {
        Turn& turn = due(rate);
        if (turn.leaving.empty())
            continue;
        for (const JPH::BodyID id : turn.leaving)
            kept(body(id)).leaves = true;
        const ContactsOfLeavers leavers(*this);
        save(turn.fresh_contacts, 0, &leavers);
        for (const JPH::BodyID id : turn.leaving) {
            kept(body(id)).leaves = false;
            changed_.push_back(id);
            if (body(id).IsActive())
                send_away(id, Keep::in_turn, turn.fresh);
        }
        turn.leaving.clear();
    }
    exchanging_ = false;
}

}  // namespace tactus
