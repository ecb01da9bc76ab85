#include "physics/world_state.hpp"

#include <algorithm>

#include "physics/contact_points.hpp"
#include "physics/jolt_units.hpp"
#include "physics/limits.hpp"
#include "physics/world_settings.hpp"

#include <Jolt/Physics/Collision/Shape/CompoundShape.h>
#include <Jolt/Physics/Collision/Shape/DecoratedShape.h>
#include <Jolt/Physics/Collision/Shape/RotatedTranslatedShape.h>
#include <Jolt/Physics/Constraints/ContactConstraintManager.h>

namespace tactus {

namespace {

constexpr std::size_t mebibyte = std::size_t{1} << 20;

// The broad phase takes up to four tree nodes of 128 bytes a body while it rebuilds, in pages rounded up to
// powers of two; saving and restoring takes a few words a body.
std::size_t loop_memory_size(std::uint32_t max_bodies) {
    return 8 * mebibyte + std::size_t{2048} * max_bodies;
}

// Scratch of a single step: the contact constraints, the bodies' and contacts' links to islands, the pairs
// found.
JPH::uint step_memory_size(const PhysicsSettings& settings) {
    constexpr std::size_t per_contact =
        points_of_a_patch * (JPH::ContactConstraintManager::cMaxConstraintSize + sizeof(JPH::uint32) + 64);
    constexpr std::size_t per_body = 64;
    return static_cast<JPH::uint>(4 * mebibyte + per_contact * settings.max_contacts +
                                  per_body * settings.max_bodies);
}

// Far more jobs than the single-threaded system holds at any time.
constexpr std::size_t jobs_per_sub_step = 64;

PhysicsSettings within_range(PhysicsSettings settings) {
    settings.max_bodies = std::clamp(settings.max_bodies, 1u, 65536u);
    settings.max_touching_pairs = std::clamp(settings.max_touching_pairs, 16u, 65536u);
    settings.max_contacts = std::clamp(settings.max_contacts, 16u, 65536u);
    settings.max_joints = std::clamp(settings.max_joints, 1u, 32768u);
    settings.sub_steps = std::clamp(settings.sub_steps, 1, 16);
    settings.gravity = limits::is_number(settings.gravity)
                           ? limits::cut(settings.gravity, limits::max_gravity)
                           : Vec3(0.0, -9.81, 0.0);
    return settings;
}

// Whether a round shape rolls at that angular velocity. A cylinder that stands does not. `spin` and `up`, of
// length 1 or 0, are in the shape's frame.
bool rolls(const JPH::Shape& shape, JPH::Vec3Arg spin, JPH::Vec3Arg up) {
    constexpr float slowest = 0.01f;  // what is slower falls asleep (unit: radians per second)
    constexpr float upright = 0.7f;   // cosine of 45 degrees
    switch (shape.GetSubType()) {
        case JPH::EShapeSubType::Sphere:
        case JPH::EShapeSubType::Capsule:
            return spin.LengthSq() > slowest * slowest;
        case JPH::EShapeSubType::Cylinder:
            return std::abs(spin.GetY()) > slowest && std::abs(up.GetY()) < upright;
        case JPH::EShapeSubType::RotatedTranslated: {
            const auto& turned = static_cast<const JPH::RotatedTranslatedShape&>(shape);
            const JPH::Quat to_inner = turned.GetRotation().Conjugated();
            return rolls(*turned.GetInnerShape(), to_inner * spin, to_inner * up);
        }
        case JPH::EShapeSubType::OffsetCenterOfMass:
            return rolls(*static_cast<const JPH::DecoratedShape&>(shape).GetInnerShape(), spin, up);
        case JPH::EShapeSubType::StaticCompound:
            return std::ranges::any_of(static_cast<const JPH::CompoundShape&>(shape).GetSubShapes(),
                                       [&](const JPH::CompoundShape::SubShape& part) {
                                           const JPH::Quat to_part = part.GetRotation().Conjugated();
                                           return rolls(*part.mShape, to_part * spin, to_part * up);
                                       });
        default:
            return false;
    }
}

// Jolt keeps the contacts of two bodies that have moved little against each other, each at its points of
// their material. Where one of them rolls on the other they fall behind, and the weight drives it on: a ball
// of 30 mm went from 4 to 26 mm/s in two seconds, and a box that rocked on a round body by 0.1 rad did so by
// 0.34 rad after 20 s. So the contacts of what rolls are found anew in each step, and those of all whose
// surface turns faster than a tower trembles.
bool outruns_its_contacts(const JPH::Body& body, JPH::Vec3Arg up) {
    constexpr float fastest_trembling = units::length(0.01);  // (unit: Jolt's length per second)
    const JPH::Shape& shape = *body.GetShape();
    const JPH::Vec3 spin = body.GetAngularVelocity();
    const JPH::Quat to_body = body.GetRotation().Conjugated();
    return spin.LengthSq() * shape.GetLocalBounds().GetExtent().LengthSq() >
               fastest_trembling * fastest_trembling ||
           rolls(shape, to_body * spin, to_body * up);
}

// More hands and contacts than a scene has.
constexpr std::size_t max_pushes = 64;

// Only what can move can be asleep.
class MovingOnly final : public JPH::BroadPhaseLayerFilter {
public:
    bool ShouldCollide(JPH::BroadPhaseLayer layer) const override {
        return layer != broad_phase_layer(Tree::Still);
    }
};

}  // namespace

PhysicsWorld::Impl::Impl(const PhysicsSettings& wanted)
    : settings(within_range(wanted)),
      memory(loop_memory_size(settings.max_bodies)),
      layers(settings.max_bodies),
      rules(layers, records),
      step_memory(step_memory_size(settings)),
      jobs(jobs_per_sub_step * static_cast<std::size_t>(settings.sub_steps), system),
      records(settings.max_bodies),
      far(system, records, settings.full_rate_bodies),
      places(system, settings.max_bodies),
      spin(settings.max_bodies),
      damping(settings.max_bodies),
      trees(system, records, far),
      journal(system, settings.remembered_wakings),
      activity(trees, journal, far, places, moved),
      joints(system, settings.max_joints),
      swing(settings.max_joints),
      pushes(max_pushes) {
    constexpr JPH::uint one_mutex = 1;
    system.Init(settings.max_bodies, one_mutex, settings.max_touching_pairs,
                points_of_a_patch * settings.max_contacts, layer_interface, broad_phase_filter, layers);
    system.SetPhysicsSettings(jolt_settings(settings));
    system.SetSimCollideBodyVsBody(
        [this](const JPH::Body& body1, const JPH::Body& body2, JPH::Mat44Arg transform1,
               JPH::Mat44Arg transform2, JPH::CollideShapeSettings& collide,
               JPH::CollideShapeCollector& collector, const JPH::ShapeFilter& filter) {
            collide_by_points(system.GetPhysicsSettings(), body1, body2, transform1, transform2, collide,
                              collector, filter);
        });
    system.SetCombineFriction(combined_friction);
    system.SetCombineRestitution(combined_restitution);
    system.SetGravity(units::vector(settings.gravity));
    system.SetBodyActivationListener(&activity);
    system.SetContactListener(&rules);
    moved.reserve(2 * settings.max_bodies);
    plain_pushes.reserve(max_pushes);
    given.reserve(2 * max_pushes);
}

PhysicsWorld::Impl::~Impl() {
    system.SetBodyActivationListener(nullptr);
    for (const BodyRecord* record : records) {
        if (record != nullptr)
            record->in_world->SetCollisionGroup({});  // it names `joints`, which go before the bodies
        delete record;
    }
}

JPH::Body* PhysicsWorld::Impl::find(BodyId id) const {
    return id.valid() ? system.GetBodyLockInterfaceNoLock().TryGetBody(JPH::BodyID(id.value)) : nullptr;
}

void PhysicsWorld::Impl::wake(JPH::Body& body) {
    if (!body.IsStatic())
        bodies().ActivateBody(body.GetID());
}

void PhysicsWorld::Impl::wake_around(const JPH::Body& body) {
    constexpr double reach = 2e-3;  // (unit: meters)
    JPH::AABox box = body.GetWorldSpaceBounds();
    box.ExpandBy(JPH::Vec3::sReplicate(units::length(reach)));
    bodies().ActivateBodiesInAABox(box, MovingOnly(), JPH::ObjectLayerFilter());
}

std::uint32_t PhysicsWorld::Impl::update(double seconds, int iterations, bool builds_trees) {
    const std::span<const JPH::BodyID> active{system.GetActiveBodiesUnsafe(JPH::EBodyType::RigidBody),
                                              system.GetNumActiveBodies(JPH::EBodyType::RigidBody)};
    if (active.empty())
        return step_ok;
    const std::size_t first = moved.size();
    const JPH::Vec3 up = -system.GetGravity().NormalizedOr(JPH::Vec3::sZero());
    for (const JPH::BodyID id : active) {
        JPH::Body& body = *records[id.GetIndex()]->in_world;
        moved.push_back({id.GetIndexAndSequenceNumber()});
        places.keep(body);
        // Contacts of this step may ask for more.
        body.GetMotionProperties()->SetNumVelocityStepsOverride(static_cast<JPH::uint>(iterations));
        if (outruns_its_contacts(body, up))
            bodies().InvalidateContactCache(id);
    }
    rules.begin_step(system.GetGravity(), static_cast<float>(seconds / settings.sub_steps));
    spin.begin_step(active, records, static_cast<float>(seconds));
    damping.begin_step(active, records, static_cast<float>(seconds));
    joints.begin_step(swing);
    jobs.build_trees(builds_trees);
    activity.in_step(true);
    const JPH::EPhysicsUpdateError error =
        system.Update(static_cast<float>(seconds), settings.sub_steps, &step_memory, &jobs);
    activity.in_step(false);
    damping.end_step();
    spin.end_step();
    swing.end_step();
    const auto has = [error](JPH::EPhysicsUpdateError bit) {
        return (error & bit) != JPH::EPhysicsUpdateError::None;
    };
    std::uint32_t status = step_ok;
    if (has(JPH::EPhysicsUpdateError::BodyPairCacheFull))
        status |= step_pairs_full;
    if (has(JPH::EPhysicsUpdateError::ContactConstraintsFull) ||
        has(JPH::EPhysicsUpdateError::ManifoldCacheFull))
        status |= step_contacts_full;
    if (put_back_the_lost(first))
        status |= step_body_lost;
    return status;
}

bool PhysicsWorld::Impl::put_back_the_lost(std::size_t first) {
    bool any = false;
    for (const BodyId id : std::span(moved).subspan(first)) {
        JPH::Body& body = *records[id.index()]->in_world;
        if (SoundPlaces::is_sound(body)) [[likely]]
            continue;
        any = true;
        far.release(body, false);
        places.put_back(body);
        joints.forget_impulses_of(body);
    }
    return any;
}

void PhysicsWorld::Impl::add_pushes() {
    for (std::size_t i = 0; i < push_count; ++i)
        system.AddConstraint(&pushes[i]);
}

void PhysicsWorld::Impl::remove_pushes() {
    while (push_count > 0)
        system.RemoveConstraint(&pushes[--push_count]);
}

void PhysicsWorld::Impl::note_given(double seconds) {
    given.clear();
    for (const SpringPush& push : std::span(pushes).first(push_count))
        given.push_back({BodyId{push.body().GetID().GetIndexAndSequenceNumber()},
                         units::vector(push.impulse()), units::untorque(push.turn())});
    for (const HandPush& push : plain_pushes)
        given.push_back({push.body, push.impulse * seconds, push.turn * seconds});
    plain_pushes.clear();
}

void PhysicsWorld::Impl::forget_pushes(const JPH::Body& body) {
    std::erase_if(plain_pushes, [id = body.GetID()](const HandPush& push) {
        return push.body.value == id.GetIndexAndSequenceNumber();
    });
    for (std::size_t i = 0; i < push_count; ++i)
        if (pushes[i].acts_on(body))
            pushes[i--].take(pushes[--push_count]);
}

}  // namespace tactus
