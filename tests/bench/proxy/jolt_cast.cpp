#include "proxy/jolt_cast.hpp"

#include <cstdio>

#include <Jolt/Jolt.h>
// Jolt's own headers need its first one before them.
#include <Jolt/Core/Factory.h>
#include <Jolt/Core/Memory.h>
#include <Jolt/Physics/Collision/CastResult.h>
#include <Jolt/Physics/Collision/CollisionCollectorImpl.h>
#include <Jolt/Physics/Collision/CollisionDispatch.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Collision/ShapeCast.h>
#include <Jolt/RegisterTypes.h>

#if !TACTUS_JOLT_ALONE
#include "physics/jolt_runtime.hpp"
#endif

namespace {

struct Cast {
    JPH::ShapeRefC mesh;
    JPH::SphereShape sphere;

    explicit Cast(float radius) : sphere(radius) { sphere.SetEmbedded(); }
};

void start() {
#if TACTUS_JOLT_ALONE
    if (JPH::Factory::sInstance == nullptr) {
        JPH::RegisterDefaultAllocator();
        JPH::Factory::sInstance = new JPH::Factory();
        JPH::RegisterTypes();
    }
#else
    tactus::start_jolt();
#endif
}

void* make(const float* coordinates, std::size_t corners, const std::uint32_t* indices, std::size_t triangles,
           float radius) {
    start();
    JPH::VertexList vertices;
    for (std::size_t i = 0; i < corners; ++i) {
        vertices.push_back({coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]});
    }
    JPH::IndexedTriangleList list;
    for (std::size_t i = 0; i < triangles; ++i) {
        list.push_back({indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]});
    }
    const auto made = JPH::MeshShapeSettings(std::move(vertices), std::move(list)).Create();
    if (made.HasError()) {
        std::fprintf(stderr, "Jolt refuses the mesh: %s\n", made.GetError().c_str());
        return nullptr;
    }
    Cast* const cast = new Cast(radius);
    cast->mesh = made.Get();
    return cast;
}

void cast(const void* made, const float* from, const float* motion) {
    const Cast& one = *static_cast<const Cast*>(made);
    const JPH::ShapeCastSettings settings;
    const JPH::ShapeFilter everything;
    const JPH::ShapeCast way(&one.sphere, JPH::Vec3::sOne(),
                             JPH::Mat44::sTranslation({from[0], from[1], from[2]}),
                             {motion[0], motion[1], motion[2]});
    JPH::ClosestHitCollisionCollector<JPH::CastShapeCollector> hit;
    JPH::CollisionDispatch::sCastShapeVsShapeLocalSpace(
        way, settings, one.mesh, JPH::Vec3::sOne(), everything, JPH::Mat44::sIdentity(),
        JPH::SubShapeIDCreator(), JPH::SubShapeIDCreator(), hit);
}

void drop(void* made) {
    delete static_cast<Cast*>(made);
}

constexpr TactusJoltCast functions{make, cast, drop};

}  // namespace

const TactusJoltCast* tactus_jolt_cast() {
    return &functions;
}
