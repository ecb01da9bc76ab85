#include "physics/physics_world.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/BodyInterface.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/jolt_runtime.hpp"
#include "physics/jolt_units.hpp"
#include "physics/limits.hpp"
#include "physics/motion_type.hpp"
#include "physics/world_state.hpp"

namespace tactus {

static_assert(JPH::BodyID::cMaxBodyIndex == 0x7fffffu, "BodyId::index() takes these bits");

namespace {

Motion motion_of(const JPH::Body& body) {
    return body.IsDynamic() ? Motion::Dynamic : body.IsKinematic() ? Motion::Kinematic : Motion::Static;
}

// Where a force can act on the body.
bool in_reach(const JPH::Body& body, const Vec3& point) {
    return glm::distance(point, units::position(body.GetCenterOfMassPosition())) <= limits::longest_arm;
}

// A force of no length has no direction.
bool is_sound(const TwistSpring& twist) {
    return std::abs(glm::length(twist.axis) - 1.0) < 1e-3 && std::isfinite(twist.twist) &&
           std::isfinite(twist.patch_spin) && twist.stiffness >= 0.0 && twist.limit >= 0.0;
}

bool is_sound(const SpringForce& spring) {
    return limits::is_number(spring.force) && glm::length(spring.force) >= limits::weakest &&
           limits::is_number(spring.hand_velocity) && spring.damping >= 0.0 && is_sound(spring.twist);
}

void apply_mass(JPH::Body& body, const BodyRecord& record) {
    JPH::MotionProperties* const motion = body.GetMotionPropertiesUnchecked();
    if (motion == nullptr || !record.may_be_dynamic)
        return;
    JPH::MassProperties scaled = record.mass_properties;
    const auto factor = static_cast<float>(record.factors.mass);
    scaled.mMass *= factor;
    scaled.mInertia *= factor;
    scaled.mInertia(3, 3) = 1.0f;
    motion->SetMassProperties(motion->GetAllowedDOFs(), scaled);
}

Pose pose_of(const JPH::Body& body) {
    return {units::position(body.GetPosition()), units::rotation(body.GetRotation())};
}

}  // namespace

PhysicsWorld::PhysicsWorld(const PhysicsSettings& settings) {
    start_jolt();
    impl_ = std::make_unique<Impl>(settings);
}

PhysicsWorld::~PhysicsWorld() = default;

BodyId PhysicsWorld::add(PreparedBody& body) {
    if (!body.ready() || impl_->body_count == impl_->settings.max_bodies)
        return {};
    const LoopMemoryScope scope(impl_->memory);
    BodyRecord& record = *body.record_;
    const std::size_t pair = impl_->layers.take(record.collision);
    if (pair == CollisionTable::no_pair)
        return {};
    JPH::Body& added = *record.body;
    if (!impl_->bodies().AssignBodyID(&added)) {
        impl_->layers.give_back(pair);
        return {};
    }
    const JPH::BodyID id = added.GetID();
    record.layer_pair = pair;
    record.body = nullptr;
    record.in_world = &added;
    impl_->records[id.GetIndex()] = body.record_.release();
    ++impl_->body_count;
    ++impl_->structure;
    added.SetUserData(reinterpret_cast<JPH::uint64>(&record));
    impl_->bodies().SetObjectLayer(
        id, object_layer(pair, added.CanBeKinematicOrDynamic() ? Tree::Awake : Tree::Still));
    impl_->bodies().AddBody(id, JPH::EActivation::Activate);
    impl_->trees.note_entry();
    impl_->wake_around(added);
    return {id.GetIndexAndSequenceNumber()};
}

PreparedBody PhysicsWorld::remove(BodyId id) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr)
        return {};
    const LoopMemoryScope scope(impl_->memory);
    const JPH::BodyID jolt_id = body->GetID();
    impl_->wake_around(*body);
    impl_->joints.remove_all_of(*body);
    impl_->far.release(*body, true);
    impl_->bodies().RemoveBody(jolt_id);
    impl_->trees.forget(jolt_id);
    impl_->forget_pushes(*body);
    set_factors(id, {});
    body->SetCollisionGroup({});
    impl_->bodies().UnassignBodyID(jolt_id);
    PreparedBody removed(
        std::unique_ptr<BodyRecord>(std::exchange(impl_->records[jolt_id.GetIndex()], nullptr)));
    ++impl_->structure;
    impl_->layers.give_back(removed.record_->layer_pair);
    removed.record_->body = body;
    removed.record_->in_world = nullptr;
    --impl_->body_count;
    return removed;
}

bool PhysicsWorld::reshape(BodyId id, PreparedBody& other) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || !other.ready())
        return false;
    BodyRecord& record = impl_->record(*body);
    BodyRecord& spare = *other.record_;
    if (record.may_be_dynamic != spare.may_be_dynamic ||
        body->CanBeKinematicOrDynamic() != spare.body->CanBeKinematicOrDynamic())
        return false;
    const LoopMemoryScope scope(impl_->memory);
    ++impl_->structure;
    impl_->wake_around(*body);
    // Held here, and by `other` afterwards, so that nothing is freed in the loop.
    const JPH::RefConst<JPH::Shape> old_shape = body->GetShape();
    const JPH::RefConst<JPH::Shape> new_shape = spare.body->GetShape();
    impl_->joints.shape_changed(*body, new_shape->GetCenterOfMass() - old_shape->GetCenterOfMass());
    impl_->bodies().SetShape(body->GetID(), new_shape, false, JPH::EActivation::Activate);
    spare.body->SetShapeInternal(old_shape, false);
    std::swap(record.mass, spare.mass);
    std::swap(record.mass_properties, spare.mass_properties);
    apply_mass(*body, record);
    impl_->wake_around(*body);
    return true;
}

JointId PhysicsWorld::add_joint(const JointDescription& joint, BodyId first, BodyId second) {
    JPH::Body* a = first.valid() ? impl_->find(first) : &JPH::Body::sFixedToWorld;
    JPH::Body* b = second.valid() ? impl_->find(second) : &JPH::Body::sFixedToWorld;
    if (a == nullptr || b == nullptr || a == b ||
        !(a->CanBeKinematicOrDynamic() || b->CanBeKinematicOrDynamic()))
        return {};
    const LoopMemoryScope scope(impl_->memory);
    const JointId id = impl_->joints.add(joint, *a, *b, first.valid() ? pose(first) : Pose{},
                                         second.valid() ? pose(second) : Pose{});
    ++impl_->structure;
    for (JPH::Body* body : {a, b})
        if (body != &JPH::Body::sFixedToWorld) {
            impl_->wake(*body);
            impl_->bodies().InvalidateContactCache(body->GetID());
        }
    return id;
}

bool PhysicsWorld::remove_joint(JointId id) {
    const LoopMemoryScope scope(impl_->memory);
    ++impl_->structure;
    return impl_->joints.remove(id);
}

Pose PhysicsWorld::on_joints(BodyId id, const Pose& pose) const {
    const JPH::Body* const body = impl_->find(id);
    if (body == nullptr || impl_->joints.count() == 0)
        return pose;
    return impl_->joints.on_joints(*body, pose, [this](const JPH::Body& other) {
        return other.GetID().IsInvalid() ? Pose{} : this->pose({other.GetID().GetIndexAndSequenceNumber()});
    });
}

std::size_t PhysicsWorld::joint_count() const {
    return impl_->joints.count();
}

void PhysicsWorld::settle_broad_phase() {
    const LoopMemoryScope scope(impl_->memory);
    impl_->system.OptimizeBroadPhase();
}

bool PhysicsWorld::contains(BodyId id) const {
    return impl_->find(id) != nullptr;
}

std::size_t PhysicsWorld::body_count() const {
    return impl_->body_count;
}

void PhysicsWorld::set_gravity(const Vec3& gravity) {
    if (!limits::is_number(gravity))
        return;
    impl_->settings.gravity = limits::cut(gravity, limits::max_gravity);
    impl_->system.SetGravity(units::vector(impl_->settings.gravity));
}

void PhysicsWorld::set_pose(BodyId id, const Pose& pose) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || !limits::is_pose(pose))
        return;
    const LoopMemoryScope scope(impl_->memory);
    // A still body's place is remembered as if it had woken.
    if (body->IsStatic())
        impl_->journal.note(*body);
    impl_->wake(*body);
    impl_->wake_around(*body);
    impl_->bodies().SetPositionAndRotation(body->GetID(), units::position(pose.position),
                                           units::rotation(pose.rotation), JPH::EActivation::Activate);
    impl_->wake_around(*body);
}

void PhysicsWorld::move_to(BodyId id, const Pose& pose, double seconds) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || body->IsStatic() || !limits::is_pose(pose) || !(seconds >= limits::shortest_way))
        return;
    const LoopMemoryScope scope(impl_->memory);
    impl_->wake(*body);
    impl_->bodies().MoveKinematic(body->GetID(), units::position(pose.position),
                                  units::rotation(pose.rotation), static_cast<float>(seconds));
}

void PhysicsWorld::set_velocity(BodyId id, const Vec3& linear, const Vec3& angular) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || body->IsStatic() || !limits::is_number(linear) || !limits::is_number(angular))
        return;
    const LoopMemoryScope scope(impl_->memory);
    impl_->wake(*body);
    impl_->bodies().SetLinearAndAngularVelocity(body->GetID(),
                                                units::vector(limits::cut(linear, limits::fastest)),
                                                units::plain(limits::cut(angular, limits::fastest_spin)));
}

bool PhysicsWorld::set_motion(BodyId id, Motion motion) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || (motion != Motion::Static && !body->CanBeKinematicOrDynamic()) ||
        (motion == Motion::Dynamic && !impl_->record(*body).may_be_dynamic))
        return false;
    if (motion_of(*body) == motion)
        return true;
    const LoopMemoryScope scope(impl_->memory);
    ++impl_->structure;
    impl_->forget_pushes(*body);
    impl_->wake_around(*body);
    body->SetAllowSleeping(may_sleep(motion, impl_->record(*body).can_sleep));
    impl_->bodies().SetMotionType(body->GetID(), motion_type(motion), JPH::EActivation::Activate);
    return true;
}

void PhysicsWorld::set_material(BodyId id, const SurfaceMaterial& material) {
    JPH::Body* body = impl_->find(id);
    if (body != nullptr && material.friction >= 0.0 && material.restitution >= 0.0) {
        body->SetFriction(stored_friction(material));
        body->SetRestitution(stored_restitution(material));
    }
}

void PhysicsWorld::set_factors(BodyId id, const BodyFactors& factors) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || !(factors.mass > 0.0) || !(factors.friction >= 0.0))
        return;
    BodyRecord& record = impl_->record(*body);
    const bool other_mass = factors.mass != record.factors.mass;
    record.factors = factors;
    if (other_mass)
        apply_mass(*body, record);
}

void PhysicsWorld::set_damping(BodyId id, double linear, double angular) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || !body->CanBeKinematicOrDynamic())
        return;
    impl_->record(*body).linear_damping = std::max(0.0, linear);
    impl_->record(*body).angular_damping = std::max(0.0, angular);
}

void PhysicsWorld::set_gravity_scale(BodyId id, double scale) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || !body->CanBeKinematicOrDynamic() || std::isnan(scale))
        return;
    body->GetMotionPropertiesUnchecked()->SetGravityFactor(
        static_cast<float>(limits::cut(scale, limits::max_gravity_scale)));
    wake(id);
}

void PhysicsWorld::set_collision(BodyId id, const CollisionLayers& collision) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr)
        return;
    BodyRecord& record = impl_->record(*body);
    const LoopMemoryScope scope(impl_->memory);
    impl_->wake_around(*body);
    impl_->layers.give_back(record.layer_pair);
    const std::size_t pair = impl_->layers.take(collision);
    record.collision = collision;
    record.layer_pair = pair;
    impl_->bodies().SetObjectLayer(body->GetID(), object_layer(pair, tree_of(body->GetObjectLayer())));
    impl_->bodies().InvalidateContactCache(body->GetID());
}

void PhysicsWorld::set_continuous(BodyId id, bool continuous) {
    if (JPH::Body* body = impl_->find(id))
        impl_->bodies().SetMotionQuality(
            body->GetID(), continuous ? JPH::EMotionQuality::LinearCast : JPH::EMotionQuality::Discrete);
}

void PhysicsWorld::set_can_sleep(BodyId id, bool can_sleep) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || !body->CanBeKinematicOrDynamic())
        return;
    impl_->record(*body).can_sleep = can_sleep;
    body->SetAllowSleeping(may_sleep(motion_of(*body), can_sleep));
    if (!can_sleep)
        wake(id);
}

void PhysicsWorld::wake(BodyId id) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || body->IsStatic())
        return;
    const LoopMemoryScope scope(impl_->memory);
    impl_->wake(*body);
}

void PhysicsWorld::sleep(BodyId id) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr)
        return;
    const LoopMemoryScope scope(impl_->memory);
    impl_->far.release(*body, false);
    impl_->bodies().DeactivateBody(body->GetID());
}

void PhysicsWorld::apply_force(BodyId id, const Vec3& force, const Vec3& world_point) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || !body->IsDynamic() || force == Vec3(0.0) || !limits::is_number(force) ||
        !in_reach(*body, world_point))
        return;
    const LoopMemoryScope scope(impl_->memory);
    impl_->wake(*body);
    impl_->bodies().AddForce(body->GetID(), units::vector(limits::cut(force, limits::strongest)),
                             units::position(world_point));
}

void PhysicsWorld::apply_spring_force(BodyId id, const SpringForce& spring) {
    if (!(spring.stiffness > 0.0) || impl_->push_count == impl_->pushes.size()) {
        apply_hand_force(id, spring.force, spring.point);
        return;
    }
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || !body->IsDynamic() || !is_sound(spring) || !in_reach(*body, spring.point))
        return;
    const LoopMemoryScope scope(impl_->memory);
    impl_->wake(*body);
    SpringPush& push = impl_->pushes[impl_->push_count++];
    push.set(*body, spring);
    for (SpringPush& other : std::span(impl_->pushes).first(impl_->push_count - 1)) {
        if (other.acts_on(*body)) {
            other.add_beside(push);
            push.add_beside(other);
        }
    }
}

void PhysicsWorld::apply_hand_force(BodyId id, const Vec3& force, const Vec3& world_point) {
    const JPH::Body* body = impl_->find(id);
    if (body == nullptr || !body->IsDynamic() || !limits::is_number(force) || !in_reach(*body, world_point))
        return;
    apply_force(id, force, world_point);
    if (impl_->plain_pushes.size() < impl_->plain_pushes.capacity()) {
        const Vec3 arm = world_point - units::position(body->GetCenterOfMassPosition());
        const Vec3 given = limits::cut(force, limits::strongest);
        impl_->plain_pushes.push_back({id, given, glm::cross(arm, given)});
    }
}

void PhysicsWorld::apply_torque(BodyId id, const Vec3& torque) {
    JPH::Body* body = impl_->find(id);
    if (body == nullptr || !body->IsDynamic() || torque == Vec3(0.0) || !limits::is_number(torque))
        return;
    const LoopMemoryScope scope(impl_->memory);
    impl_->wake(*body);
    impl_->bodies().AddTorque(body->GetID(), units::torque(limits::cut(torque, limits::strongest)));
}

std::size_t PhysicsWorld::awake_count() const {
    return impl_->system.GetNumActiveBodies(JPH::EBodyType::RigidBody) + impl_->far.count();
}

std::size_t PhysicsWorld::slowed_count() const {
    return impl_->far.count();
}

void PhysicsWorld::set_hands(std::span<const Vec3> hands) {
    impl_->far.set_hands(hands);
}

bool PhysicsWorld::anything_awake() const {
    return awake_count() > 0;
}

std::span<const BodyId> PhysicsWorld::moved() const {
    return impl_->moved;
}

std::span<const HandPush> PhysicsWorld::hand_pushes() const {
    return impl_->given;
}

std::uint64_t PhysicsWorld::steps() const {
    return impl_->steps;
}

std::uint32_t PhysicsWorld::step(double seconds) {
    impl_->moved.clear();
    impl_->given.clear();
    if (!anything_awake() || !(seconds > 0.0))
        return step_nothing_awake;
    ++impl_->steps;
    const std::uint64_t overflows = impl_->memory.overflows();
    const LoopMemoryScope scope(impl_->memory);
    impl_->add_pushes();
    constexpr std::uint64_t between_trees = 4;  // (unit: steps)
    std::uint32_t status =
        impl_->update(seconds, impl_->settings.velocity_iterations, impl_->steps % between_trees == 0);
    impl_->note_given(seconds);
    impl_->remove_pushes();
    impl_->far.plan(seconds);
    while (const SlowRate* rate = impl_->far.begin_turn()) {
        status |= impl_->update(seconds * rate->steps, rate->iterations, false);
        impl_->far.end_turn();
    }
    impl_->far.finish();
    for (const JPH::BodyID id : impl_->far.changed())
        impl_->trees.may_differ(id);
    impl_->trees.tidy_some();
    if (impl_->memory.overflows() != overflows)
        status |= step_memory_full;
    return status;
}

Pose PhysicsWorld::pose(BodyId id) const {
    const JPH::Body* body = impl_->find(id);
    return body != nullptr ? pose_of(*body) : Pose{};
}

BodyMotion PhysicsWorld::state(BodyId id) const {
    const JPH::Body* body = impl_->find(id);
    return body != nullptr ? BodyMotion{pose_of(*body), units::vector(impl_->far.linear_velocity(*body)),
                                        units::plain(impl_->far.angular_velocity(*body))}
                           : BodyMotion{};
}

Vec3 PhysicsWorld::center_of_mass(BodyId id) const {
    const JPH::Body* body = impl_->find(id);
    return body != nullptr ? units::position(body->GetCenterOfMassPosition()) : Vec3(0.0);
}

Vec3 PhysicsWorld::linear_velocity(BodyId id) const {
    const JPH::Body* body = impl_->find(id);
    return body != nullptr ? units::vector(impl_->far.linear_velocity(*body)) : Vec3(0.0);
}

Vec3 PhysicsWorld::angular_velocity(BodyId id) const {
    const JPH::Body* body = impl_->find(id);
    return body != nullptr ? units::plain(impl_->far.angular_velocity(*body)) : Vec3(0.0);
}

Vec3 PhysicsWorld::velocity_at(BodyId id, const Vec3& world_point) const {
    return linear_velocity(id) + glm::cross(angular_velocity(id), world_point - center_of_mass(id));
}

double PhysicsWorld::mass(BodyId id) const {
    const JPH::Body* body = impl_->find(id);
    return body != nullptr ? impl_->record(*body).mass * impl_->record(*body).factors.mass : 0.0;
}

Vec3 PhysicsWorld::spun_by(BodyId id, const Vec3& turn) const {
    const JPH::Body* body = impl_->find(id);
    return body != nullptr && body->IsDynamic()
               ? units::plain(body->GetInverseInertia().Multiply3x3(units::plain(turn)))
               : Vec3(0.0);
}

double PhysicsWorld::mobility(BodyId id, const Vec3& world_point, const Vec3& along) const {
    const JPH::Body* body = impl_->find(id);
    const double length = glm::length(along);
    if (body == nullptr || !body->IsDynamic() || length == 0.0) {
        return 0.0;
    }
    const JPH::Vec3 arm(units::position(world_point) - body->GetCenterOfMassPosition());
    const JPH::Vec3 lever = arm.Cross(units::plain(along / length));
    return static_cast<double>(body->GetMotionProperties()->GetInverseMass() +
                               lever.Dot(body->GetInverseInertia().Multiply3x3(lever)));
}

Motion PhysicsWorld::motion(BodyId id) const {
    const JPH::Body* body = impl_->find(id);
    return body != nullptr ? motion_of(*body) : Motion::Static;
}

bool PhysicsWorld::awake(BodyId id) const {
    const JPH::Body* body = impl_->find(id);
    return body != nullptr && (body->IsActive() || impl_->far.holds(*body));
}

bool PhysicsWorld::touching(BodyId first, BodyId second) const {
    const JPH::Body* a = impl_->find(first);
    const JPH::Body* b = impl_->find(second);
    return a != nullptr && b != nullptr && impl_->system.WereBodiesInContact(a->GetID(), b->GetID());
}

std::uint64_t PhysicsWorld::memory_overflows() const {
    return impl_->memory.overflows();
}

}  // namespace tactus
