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
    islands_.assign(awake_count(), Island{std::numeric_limits<float>::max(), 0, false, false, true, {}});
    for (const JPH::BodyID id : awake()) {
        Island* island = island_of(id);
        if (island == nullptr)
            continue;
        island->distance = std::min(island->distance, distance(body(id)));
        ++island->bodies;
        // A body that moves as told is told anew for every step.
        island->stays |= !body(id).IsDynamic();
        island->calm = island->calm && but_rests(body(id));
        island->last = id;
    }
}

// Each of its points goes less than `all_but_still` in a long step.
bool FarIslands::but_rests(const JPH::Body& body) const {
    constexpr double all_but_still = 1e-3;  // (unit: meters)
    const float speed =
        body.GetLinearVelocity().Length() +
        body.GetAngularVelocity().Length() * body.GetShape()->GetLocalBounds().GetExtent().Length();
    return speed * seconds_ * turns < units::length(all_but_still);
}

// Nothing that it collides with is near its way in the next long step. What is awake itself may come towards
// it as fast as it goes.
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
    const float seconds = seconds_ * turns;
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

bool FarIslands::may_wait(const Island& island) const {
    return !island.stays && (island.calm || (island.bodies == 1 && flies_freely(body(island.last))));
}

// A long step of n short ones falls by g (n dt)^2, and these by g dt^2 n (n + 1) / 2.
void FarIslands::as_in_short_steps(JPH::Body& flown) const {
    constexpr float same = 1e-3f;  // share of the velocity that gravity gives
    const JPH::MotionProperties& motion = *flown.GetMotionProperties();
    const JPH::Vec3 gravity = motion.GetGravityFactor() * system_.GetGravity();
    const JPH::Vec3 fallen = seconds_ * turns * gravity;
    const JPH::Vec3 rest = motion.GetLinearVelocity() - kept(flown).linear - fallen;
    if (rest.LengthSq() > same * same * fallen.LengthSq())
        return;  // something else has acted on it
    constexpr float n = turns;
    system_.GetBodyInterfaceNoLock().SetPosition(
        flown.GetID(), flown.GetPosition() - 0.5f * n * (n - 1.0f) * seconds_ * seconds_ * gravity,
        JPH::EActivation::DontActivate);
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
    std::size_t looks = 2 * most;
    for (const std::uint32_t i : order_) {
        if ((chosen > 0 && chosen + islands_[i].bodies > most) || chosen >= most || looks == 0)
            break;
        looks -= islands_[i].calm ? 0 : 1;
        if (!may_wait(islands_[i]))
            continue;
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

void FarIslands::plan(double seconds) {
    if (full_rate_ == 0)
        return;
    seconds_ = static_cast<float>(seconds);
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
    for (const JPH::BodyID id : awake())
        as_in_short_steps(body(id));
    survey_islands();
    const std::size_t low = full_rate_ - full_rate_ / 4;
    const bool all_return = waiting_.size() + awake_count() <= low;
    list_.assign(awake().begin(), awake().end());
    for (const JPH::BodyID id : list_) {
        const Island* island = island_of(id);
        const bool goes_on = !all_return && island != nullptr &&
                             island->distance > squared_length(returns_within) && may_wait(*island);
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
