#include "physics/prepared_body.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Body/BodyManager.h>
#include <Jolt/Physics/Collision/Shape/OffsetCenterOfMassShape.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "physics/body_record.hpp"
#include "physics/collision_layers.hpp"
#include "physics/contact_rules.hpp"
#include "physics/jolt_runtime.hpp"
#include "physics/jolt_units.hpp"
#include "physics/limits.hpp"
#include "physics/motion_type.hpp"
#include "physics/shape_conversion.hpp"
#include "physics/solid_properties.hpp"
#include "realtime/thread_role.hpp"

namespace tactus {

namespace {

bool not_negative(double value) {
    return value >= 0.0 && std::isfinite(value);
}

bool is_inertia(double value) {
    return value >= limits::least_inertia && value <= limits::max_inertia;
}

bool may_turn_dynamic(const BodyDescription& description) {
    return description.motion == Motion::Dynamic || description.may_move;
}

bool needs_motion(const BodyDescription& description) {
    return description.motion != Motion::Static || description.may_move;
}

std::string in_short(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", value);
    return text.data();
}

std::string wrong_in(const BodyDescription& d) {
    if (d.shapes.empty())
        return "the body has no shape; add a CollisionShape3D with a shape";
    if (!limits::is_pose(d.pose))
        return "the body's transform is not finite, holds a scale or is more than 10,000 km away; reset it";
    // Godot's numbers have single precision: its 0.000001 is a little less.
    constexpr double rounding = 1e-7;
    if (needs_motion(d) &&
        !(d.mass >= limits::lightest * (1.0 - rounding) && d.mass <= limits::heaviest * (1.0 + rounding)))
        return "the mass is " + in_short(d.mass) + " kg; make it between 0.000001 and 10^12 kg";
    if (d.center_of_mass && !(glm::length(*d.center_of_mass) <= limits::longest_arm))
        return "the center of mass is not a point within 100 km of the body";
    if (d.inertia && !(is_inertia(d.inertia->x) && is_inertia(d.inertia->y) && is_inertia(d.inertia->z)))
        return "the inertia must be between 10^-18 and 10^18 kg m^2 about all three axes; leave it at zero "
               "to "
               "have it computed";
    if (d.inertia && !is_possible_inertia(*d.inertia))
        return "no body has the inertia " + in_short(d.inertia->x) + ", " + in_short(d.inertia->y) + ", " +
               in_short(d.inertia->z) +
               " kg m^2: make the largest at most the sum of the other two, or leave it at zero to have it "
               "computed";
    if (!not_negative(d.material.friction) || !not_negative(d.material.restitution))
        return "friction and bounce must not be negative";
    if (!not_negative(d.linear_damping) || !not_negative(d.angular_damping) ||
        !std::isfinite(d.gravity_scale))
        return "damping must not be negative and the gravity scale must be finite";
    if (!limits::is_number(d.linear_velocity) || !limits::is_number(d.angular_velocity))
        return "the initial velocity is not finite";
    return {};
}

JPH::EAllowedDOFs allowed_axes(const BodyDescription& d) {
    int allowed = static_cast<int>(JPH::EAllowedDOFs::All);
    for (int axis = 0; axis < 3; ++axis) {
        if (d.lock_linear[axis])
            allowed &= ~(static_cast<int>(JPH::EAllowedDOFs::TranslationX) << axis);
        if (d.lock_angular[axis])
            allowed &= ~(static_cast<int>(JPH::EAllowedDOFs::RotationX) << axis);
    }
    return static_cast<JPH::EAllowedDOFs>(allowed);
}

Vec3 component_wise(JPH::Vec3Arg v) {
    return units::vector(v);
}

// Volume and inertia of Jolt's own version of a shape that encloses none of its own: a hull around an open
// mesh.
SolidProperties of_converted(const JPH::Shape& shape) {
    const JPH::MassProperties jolt = shape.GetMassProperties();
    constexpr double to_cubic_meters =
        1.0 / (units::jolt_per_meter * units::jolt_per_meter * units::jolt_per_meter);
    SolidProperties solid;
    solid.volume = static_cast<double>(shape.GetVolume()) * to_cubic_meters;
    solid.centroid = component_wise(shape.GetCenterOfMass());
    const double to_density_one =
        solid.volume / static_cast<double>(jolt.mMass) / (units::jolt_per_meter * units::jolt_per_meter);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            solid.inertia[column][row] = static_cast<double>(jolt.mInertia(static_cast<JPH::uint>(row),
                                                                           static_cast<JPH::uint>(column))) *
                                         to_density_one;
    return solid;
}

// All shapes of the body filled evenly. Shapes without an inside (a kinematic body's open mesh) add nothing;
// if none has one, the body turns like a ball of one metre, which no one will see since nothing turns it.
SolidProperties solid_of(const BodyDescription& description, const JPH::Shape& converted) {
    std::vector<SolidProperties> parts;
    for (const PlacedShape& part : description.shapes)
        if (const std::optional<SolidProperties> solid = solid_properties(part.shape))
            parts.push_back(placed(*solid, part.pose));
    if (parts.size() == description.shapes.size())
        return combined(parts);
    if (converted.GetVolume() > 0.0f && !converted.MustBeStatic())
        return of_converted(converted);
    return SolidProperties{1.0, Vec3(0.0), Mat3(0.4)};
}

JPH::MassProperties mass_properties(const BodyDescription& description, const SolidProperties& solid,
                                    const Vec3& center_of_mass) {
    Mat3 inertia = inertia_about(solid, center_of_mass) * (description.mass / solid.volume);
    if (description.inertia) {
        const Vec3 of_shapes(inertia[0][0], inertia[1][1], inertia[2][2]);
        const Vec3 own = glm::max(*description.inertia, limits::least_inertia_share * of_shapes);
        inertia = {{own.x, 0.0, 0.0}, {0.0, own.y, 0.0}, {0.0, 0.0, own.z}};
    }
    JPH::MassProperties result;
    result.mMass = static_cast<float>(description.mass);
    result.mInertia = JPH::Mat44::sIdentity();
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            result.mInertia(static_cast<JPH::uint>(row), static_cast<JPH::uint>(column)) =
                units::area(inertia[column][row]);
    return result;
}

JPH::RefConst<JPH::Shape> with_center_of_mass(const JPH::RefConst<JPH::Shape>& shape,
                                              const Vec3& center_of_mass) {
    // Nearer than this the shape's own centre is the same point (unit: meters).
    constexpr double same_point = 1e-7;
    const Vec3 offset = center_of_mass - component_wise(shape->GetCenterOfMass());
    if (glm::length(offset) < same_point)
        return shape;
    return new JPH::OffsetCenterOfMassShape(shape, units::vector(offset));
}

}  // namespace

BodyRecord::~BodyRecord() {
    if (body != nullptr)
        body_factory().FreeBody(body);
}

PreparedBody::PreparedBody() = default;
PreparedBody::PreparedBody(std::unique_ptr<BodyRecord> record) : record_(std::move(record)) {}
PreparedBody::PreparedBody(std::string error) : error_(std::move(error)) {}
PreparedBody::~PreparedBody() = default;
PreparedBody::PreparedBody(PreparedBody&&) noexcept = default;
PreparedBody& PreparedBody::operator=(PreparedBody&&) noexcept = default;

PreparedBody prepare(const BodyDescription& description) {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    start_jolt();
    if (std::string wrong = wrong_in(description); !wrong.empty())
        return PreparedBody(std::move(wrong));
    ShapeConversion converted = convert(description.shapes, may_turn_dynamic(description));
    if (converted.shape == nullptr)
        return PreparedBody(std::move(converted.error));

    auto record = std::make_unique<BodyRecord>();
    record->collision = description.collision;
    record->may_be_dynamic = may_turn_dynamic(description);
    record->linear_damping = description.linear_damping;
    record->angular_damping = description.angular_damping;
    JPH::BodyCreationSettings settings;
    if (needs_motion(description)) {
        const SolidProperties solid = solid_of(description, *converted.shape);
        const Vec3 center = description.center_of_mass.value_or(solid.centroid);
        converted.shape = with_center_of_mass(converted.shape, center);
        record->mass = description.mass;
        record->mass_properties = mass_properties(description, solid, center);
        settings.mOverrideMassProperties = JPH::EOverrideMassProperties::MassAndInertiaProvided;
        settings.mMassPropertiesOverride = record->mass_properties;
        settings.mAllowDynamicOrKinematic = true;
        settings.mAllowedDOFs = allowed_axes(description);
        if (settings.mAllowedDOFs == JPH::EAllowedDOFs::None)
            return PreparedBody("all six axes are locked; freeze the body instead");
    }
    settings.SetShape(converted.shape);
    settings.mPosition = units::position(description.pose.position);
    settings.mRotation = units::rotation(description.pose.rotation);
    settings.mLinearVelocity = units::vector(limits::cut(description.linear_velocity, limits::fastest));
    settings.mAngularVelocity = units::plain(limits::cut(description.angular_velocity, limits::fastest_spin));
    settings.mObjectLayer = object_layer(0, needs_motion(description) ? Tree::Awake : Tree::Still);
    settings.mMotionType = motion_type(description.motion);
    settings.mMotionQuality =
        description.continuous ? JPH::EMotionQuality::LinearCast : JPH::EMotionQuality::Discrete;
    record->can_sleep = description.can_sleep;
    settings.mAllowSleeping = may_sleep(description.motion, description.can_sleep);
    settings.mFriction = stored_friction(description.material);
    settings.mRestitution = stored_restitution(description.material);
    settings.mLinearDamping = settings.mAngularDamping = 0.0f;  // implicit_damping.hpp
    settings.mMaxLinearVelocity = units::length(limits::fastest);
    settings.mMaxAngularVelocity = static_cast<float>(limits::fastest_spin);
    settings.mGravityFactor =
        static_cast<float>(limits::cut(description.gravity_scale, limits::max_gravity_scale));
    record->body = body_factory().AllocateBody(settings);
    return PreparedBody(std::move(record));
}

PreparedBody duplicate(const PreparedBody& body) {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    const BodyRecord& original = *body.record_;
    auto record = std::make_unique<BodyRecord>();
    record->collision = original.collision;
    record->may_be_dynamic = original.may_be_dynamic;
    record->mass = original.mass;
    record->can_sleep = original.can_sleep;
    record->linear_damping = original.linear_damping;
    record->angular_damping = original.angular_damping;
    record->mass_properties = original.mass_properties;
    JPH::BodyCreationSettings settings = original.body->GetBodyCreationSettings();
    // Not the inverse of the inverse, which is off by a bit.
    settings.mMassPropertiesOverride = original.mass_properties;
    record->body = body_factory().AllocateBody(settings);
    return PreparedBody(std::move(record));
}

}  // namespace tactus
