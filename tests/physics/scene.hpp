// Bodies and small worlds that the tests share.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "physics/physics_world.hpp"
#include "shared/bodies.hpp"

namespace tactus::scene {

constexpr double tick = 1e-3;  // (unit: seconds)

using shared::ball;
using shared::box;
using shared::ground;
using shared::one;

inline BodyId add(PhysicsWorld& world, const BodyDescription& description) {
    PreparedBody body = prepare(description);
    EXPECT_TRUE(body.ready()) << body.error();
    const BodyId id = world.add(body);
    EXPECT_TRUE(id.valid());
    return id;
}

inline void run(PhysicsWorld& world, int ticks) {
    for (int i = 0; i < ticks; ++i)
        world.step(tick);
}

// A cube from -half to half as triangles, outside counter-clockwise.
inline std::shared_ptr<const TriangleMesh> cube_mesh(double half) {
    auto mesh = std::make_shared<TriangleMesh>();
    for (int i = 0; i < 8; ++i)
        mesh->vertices.emplace_back((i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half,
                                    (i & 4) != 0 ? half : -half);
    mesh->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

}  // namespace tactus::scene
