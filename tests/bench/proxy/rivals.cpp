#include "proxy/rivals.hpp"

#include <array>
#include <cstdio>
#include <filesystem>

#include "platform/shared_library.hpp"
#include "proxy/jolt_cast.hpp"
#include "support/process.hpp"

#if __has_include(<btBulletCollisionCommon.h>)
#include <btBulletCollisionCommon.h>
#define TACTUS_HAS_BULLET 1
#endif

namespace tactus::bench {

namespace {

std::vector<float> coordinates_of(const TriangleMesh& mesh) {
    std::vector<float> coordinates;
    for (const Vec3& v : mesh.vertices) {
        coordinates.insert(coordinates.end(),
                           {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
    }
    return coordinates;
}

std::vector<std::uint32_t> indices_of(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> indices;
    for (const auto& t : mesh.triangles) {
        indices.insert(indices.end(), {t[0], t[1], t[2]});
    }
    return indices;
}

std::array<float, 3> to_floats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

class JoltRival : public Rival {
public:
    JoltRival(const char* key, const TactusJoltCast& jolt, const TriangleMesh& mesh, double radius)
        : jolt_(jolt) {
        name = key;
        const std::vector<float> coordinates = coordinates_of(mesh);
        const std::vector<std::uint32_t> indices = indices_of(mesh);
        made_ = jolt.make(coordinates.data(), mesh.vertices.size(), indices.data(), mesh.triangles.size(),
                          static_cast<float>(radius));
    }
    ~JoltRival() override { jolt_.drop(made_); }

    void cast(const Segment& segment) override {
        if (made_) {
            jolt_.cast(made_, to_floats(segment.from).data(), to_floats(segment.to - segment.from).data());
        }
    }

private:
    const TactusJoltCast& jolt_;
    void* made_ = nullptr;
};

// Built beside this program where that Jolt is there: see tools/bench.py.
const TactusJoltCast* load_fast_jolt() {
    const std::filesystem::path library = testing::program_path().parent_path() / "libjolt_fast_cast.so";
    if (!std::filesystem::exists(library)) {
        return nullptr;
    }
    std::string error;
    void* const function = function_of_library(library.string(), "tactus_jolt_cast", error);
    if (!function) {
        std::fprintf(stderr, "%s\n", error.c_str());
        return nullptr;
    }
    return reinterpret_cast<const TactusJoltCast* (*)()>(function)();
}

#if TACTUS_HAS_BULLET
btVector3 to_bullet(const Vec3& v) {
    return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}

class BulletRival : public Rival {
public:
    BulletRival(const TriangleMesh& mesh, double radius)
        : coordinates_(coordinates_of(mesh)),
          indices_(indices_of(mesh)),
          sphere_(static_cast<btScalar>(radius)) {
        name = "bullet_sweep";
        btIndexedMesh part;
        part.m_numTriangles = static_cast<int>(mesh.triangles.size());
        part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices_.data());
        part.m_triangleIndexStride = 3 * sizeof(std::uint32_t);
        part.m_numVertices = static_cast<int>(mesh.vertices.size());
        part.m_vertexBase = reinterpret_cast<const unsigned char*>(coordinates_.data());
        part.m_vertexStride = 3 * sizeof(float);
        part.m_vertexType = PHY_FLOAT;
        triangles_.addIndexedMesh(part, PHY_INTEGER);
        shape_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
        object_.setCollisionShape(shape_.get());
        world_.addCollisionObject(&object_);
    }
    ~BulletRival() override { world_.removeCollisionObject(&object_); }

    void cast(const Segment& segment) override {
        const btTransform from(btQuaternion::getIdentity(), to_bullet(segment.from));
        const btTransform to(btQuaternion::getIdentity(), to_bullet(segment.to));
        btCollisionWorld::ClosestConvexResultCallback hit(from.getOrigin(), to.getOrigin());
        world_.convexSweepTest(&sphere_, from, to, hit);
    }

private:
    std::vector<float> coordinates_;
    std::vector<std::uint32_t> indices_;
    btTriangleIndexVertexArray triangles_;
    std::unique_ptr<btBvhTriangleMeshShape> shape_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broad_phase_;
    btCollisionWorld world_{&dispatcher_, &broad_phase_, &configuration_};
    btCollisionObject object_;
    btSphereShape sphere_;
};
#endif

}  // namespace

std::vector<std::unique_ptr<Rival>> make_rivals(const TriangleMesh& mesh, double radius) {
    std::vector<std::unique_ptr<Rival>> rivals;
    rivals.push_back(std::make_unique<JoltRival>("jolt_cast", *tactus_jolt_cast(), mesh, radius));
    static const TactusJoltCast* const fast = load_fast_jolt();
    if (fast) {
        rivals.push_back(std::make_unique<JoltRival>("jolt_fast_cast", *fast, mesh, radius));
    }
#if TACTUS_HAS_BULLET
    rivals.push_back(std::make_unique<BulletRival>(mesh, radius));
#endif
    return rivals;
}

}  // namespace tactus::bench
