#include "physics/contact_points.hpp"

#include <Jolt/Physics/Collision/ManifoldBetweenTwoFaces.h>
#include <Jolt/Physics/PhysicsSystem.h>

#include <algorithm>
#include <array>

namespace tactus {

namespace {

// All contacts between two bodies that share a normal. Lengths are in Jolt's unit, relative to the center of
// mass of body 1, along the axes of the world.
struct ContactPatch {
    JPH::Vec3 first_normal;  // unit, from body 1 to body 2
    JPH::Vec3 normal_sum;
    float depth;  // of the deepest contact
    JPH::SubShapeID shape1, shape2;
    JPH::ContactPoints on1, on2;
};

class PatchCollector final : public JPH::CollideShapeCollector {
public:
    explicit PatchCollector(const JPH::PhysicsSettings& settings) : settings_(settings) {}

    void AddHit(const JPH::CollideShapeResult& hit) override {
        ContactPatch* const patch = patch_of(hit);
        if (patch == nullptr)
            return;
        const float within = settings_.mSpeculativeContactDistance + settings_.mManifoldTolerance;
        JPH::ManifoldBetweenTwoFaces(hit.mContactPointOn1, hit.mContactPointOn2, hit.mPenetrationAxis, within,
                                     hit.mShape1Face, hit.mShape2Face, patch->on1, patch->on2);
        // One more face has at most 32 points, and the list has room for 64.
        if (patch->on1.size() > 32)
            JPH::PruneContactPoints(patch->first_normal, patch->on1, patch->on2);
    }

    JPH::StaticArray<ContactPatch, 32>& patches() { return patches_; }

private:
    // The one with the normal of the hit, or a new one. When there is no room the shallowest makes way; null
    // when that is the hit itself.
    ContactPatch* patch_of(const JPH::CollideShapeResult& hit) {
        const JPH::Vec3 normal = hit.mPenetrationAxis.Normalized();
        for (ContactPatch& patch : patches_)
            if (normal.Dot(patch.first_normal) >= settings_.mContactNormalCosMaxDeltaRotation) {
                patch.normal_sum += normal;
                patch.depth = std::max(patch.depth, hit.mPenetrationDepth);
                return &patch;
            }
        const ContactPatch fresh{normal, normal, hit.mPenetrationDepth, hit.mSubShapeID1, hit.mSubShapeID2,
                                 {},     {}};
        if (patches_.size() < patches_.capacity()) {
            patches_.push_back(fresh);
            return &patches_.back();
        }
        ContactPatch& shallowest =
            *std::min_element(patches_.begin(), patches_.end(),
                              [](const ContactPatch& a, const ContactPatch& b) { return a.depth < b.depth; });
        if (hit.mPenetrationDepth < shallowest.depth)
            return nullptr;
        shallowest = fresh;
        return &shallowest;
    }

    const JPH::PhysicsSettings& settings_;
    JPH::StaticArray<ContactPatch, 32> patches_;
};

struct NamedPoint {
    JPH::Vec3 on1, on2;
    float turn;  // grows with the angle about the patch's middle, in body 1's own frame; 0..4
};

// Grows with the angle of (x, y) as atan2 does, from 0 to 4, without a trigonometric function.
float turn_of(float x, float y) {
    const float length = std::abs(x) + std::abs(y);
    const float share = length > 0.0f ? y / length : 0.0f;
    return x >= 0.0f ? 1.0f + share : 3.0f - share;
}

// In the order of their angles about the middle, from a direction that is fixed in body 1: the order stays
// while the body moves, whichever corner the clipping or the pruning of the patch began with.
unsigned in_order(const ContactPatch& patch, JPH::Vec3Arg normal, JPH::QuatArg rotation1,
                  std::array<NamedPoint, points_of_a_patch>& points) {
    const unsigned count = std::min<unsigned>(patch.on1.size(), points_of_a_patch);
    JPH::Vec3 middle = JPH::Vec3::sZero();
    for (unsigned i = 0; i < count; ++i)
        middle += patch.on1[i];
    middle /= static_cast<float>(count);
    const JPH::Quat to_body = rotation1.Conjugated();
    const JPH::Vec3 local_normal = to_body * normal;
    const JPH::Vec3 x = local_normal.GetNormalizedPerpendicular();
    const JPH::Vec3 y = local_normal.Cross(x);
    for (unsigned i = 0; i < count; ++i) {
        const JPH::Vec3 arm = to_body * (patch.on1[i] - middle);
        points[i] = {patch.on1[i], patch.on2[i], turn_of(arm.Dot(x), arm.Dot(y))};
    }
    std::sort(points.begin(), points.begin() + count,
              [](const NamedPoint& a, const NamedPoint& b) { return a.turn < b.turn; });
    return count;
}

// Sub-shape ids fill from the lowest bit, and what no shape needs is ones.
JPH::SubShapeID named(JPH::SubShapeID shape, unsigned index) {
    JPH::SubShapeID result;
    result.SetValue(shape.GetValue() ^ (index << 30));
    return result;
}

}  // namespace

void collide_by_points(const JPH::PhysicsSettings& settings, const JPH::Body& body1, const JPH::Body& body2,
                       JPH::Mat44Arg transform1, JPH::Mat44Arg transform2,
                       JPH::CollideShapeSettings& collide_settings, JPH::CollideShapeCollector& collector,
                       const JPH::ShapeFilter& filter) {
    PatchCollector found(settings);
    JPH::PhysicsSystem::sDefaultSimCollideBodyVsBody(body1, body2, transform1, transform2, collide_settings,
                                                     found, filter);
    for (ContactPatch& patch : found.patches()) {
        const JPH::Vec3 normal = patch.normal_sum.Normalized();
        if (patch.on1.size() > points_of_a_patch)
            JPH::PruneContactPoints(normal, patch.on1, patch.on2);
        std::array<NamedPoint, points_of_a_patch> points;
        const unsigned count = in_order(patch, normal, body1.GetRotation(), points);
        for (unsigned i = 0; i < count; ++i) {
            const NamedPoint& point = points[i];
            const float depth = (point.on1 - point.on2).Dot(normal);
            collector.AddHit(JPH::CollideShapeResult(point.on1, point.on2, normal, depth, patch.shape1,
                                                     named(patch.shape2, i), JPH::BodyID()));
        }
    }
}

}  // namespace tactus
