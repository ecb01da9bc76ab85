#include "core/geometry/mesh_features.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "core/geometry/triangle_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus {
namespace {

using shared::RandomValues;

unsigned edge_sides(const TriangleFeatures& t, int k) {
    return t.owned.edge_sides(k);
}

// Two triangles on the edge from (0, 0, 0) to (1, 0, 0), seen from above: the second is bent by `height`.
TriangleMesh folded(double height) {
    return {{Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, -1.0), Vec3(1.0, height, 1.0)},
            {{0, 1, 2}, {1, 0, 3}}};
}

TEST(MeshFeatures, AnEdgeBelongsToOneTriangleOnTheSideFromWhichItIsConvex) {
    const struct {
        double height;
        unsigned sides;
    } cases[] = {{-0.3, front_side}, {0.3, back_side}, {0.0, 0u}, {-1e-9, 0u}, {-1e-6, front_side}};
    for (const auto& [height, sides] : cases) {
        const auto found = find_features(folded(height));
        EXPECT_EQ(edge_sides(found[0], 0), sides) << height;
        EXPECT_EQ(edge_sides(found[1], 0), 0u) << height;
        ASSERT_TRUE(found[0].neighbour[0].exists());
        EXPECT_EQ(found[0].neighbour[0].triangle(), 1u);
        EXPECT_EQ(found[0].neighbour[0].edge(), 0);
    }
}

TEST(MeshFeatures, WhatIsBehindTheOtherFaceIsAskedFromBothSides) {
    TriangleMesh mesh = folded(0.0);
    mesh.vertices[3] = Vec3(1.0, -1.0, -0.5);  // folded back, sharper than a right angle
    EXPECT_EQ(edge_sides(find_features(mesh)[0], 0), both_sides);
}

TEST(MeshFeatures, NeighboursThatWindTheOtherWayAreNeighbours) {
    TriangleMesh mesh = folded(-0.3);
    mesh.triangles[1] = {0, 1, 3};
    const auto found = find_features(mesh);
    ASSERT_TRUE(found[0].neighbour[0].exists());
    EXPECT_EQ(edge_sides(found[0], 0), both_sides);
    EXPECT_EQ(edge_sides(found[1], 0), 0u);
}

TEST(MeshFeatures, VerticesAtOnePlaceAreOne) {
    TriangleMesh mesh = folded(-0.3);
    mesh.vertices.push_back(Vec3(-0.0, 0.0, 0.0));
    mesh.triangles[1] = {1, 4, 3};
    EXPECT_TRUE(find_features(mesh)[0].neighbour[0].exists());
}

void expect_undecided(const TriangleMesh& mesh) {
    for (const TriangleFeatures& triangle : find_features(mesh)) {
        for (int k = 0; k < 3; ++k) {
            EXPECT_FALSE(triangle.neighbour[k].exists());
            EXPECT_EQ(triangle.owned.edge_sides(k), both_sides);
            EXPECT_TRUE(triangle.owned.is_undecided(k));
        }
    }
}

TEST(MeshFeatures, ThreeTrianglesOnAnEdgeCoincidentOnesAndNeedlesAreUndecided) {
    TriangleMesh three = folded(0.2);
    three.vertices.push_back(Vec3(0.0, -1.0, 1.0));
    three.triangles.push_back({0, 1, 4});
    expect_undecided(three);
    TriangleMesh twice = folded(0.2);
    twice.triangles = {{0, 1, 2}, {0, 1, 2}, {0, 2, 1}};
    expect_undecided(twice);
    TriangleMesh needle = folded(0.2);
    needle.vertices[3] = Vec3(0.5, 0.0, 1e-8);
    expect_undecided(needle);
    TriangleMesh point = folded(0.2);
    point.triangles[1] = {1, 0, 0};
    expect_undecided(point);
}

TEST(MeshFeatures, TwoFansOnOneCornerLeaveItUndecided) {
    TriangleMesh mesh = shared::icosphere(1, 1.0);
    const TriangleMesh other = mesh;
    const Vec3 shift = 2.0 * mesh.vertices[0];
    for (const Vec3& v : other.vertices) {
        mesh.vertices.push_back(shift - v);  // touches the first in its corner 0
    }
    for (const auto& [a, b, c] : other.triangles) {
        mesh.triangles.push_back({a + 42, c + 42, b + 42});
    }
    int undecided = 0;
    for (const TriangleFeatures& triangle : find_features(mesh)) {
        for (int k = 0; k < 3; ++k) {
            EXPECT_TRUE(triangle.neighbour[k].exists());
            undecided += triangle.owned.is_undecided(k);
        }
    }
    EXPECT_EQ(undecided, 10);
}

TEST(MeshFeatures, OfAClosedBodyEveryEdgeAndCornerHasOneOwner) {
    const TriangleMesh mesh = shared::icosphere(4, 1.0);
    std::size_t edges = 0;
    std::map<std::uint32_t, int> owners;
    const auto found = find_features(mesh);
    for (std::size_t t = 0; t < found.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            edges += found[t].owned.edge_sides(k) == front_side;
            EXPECT_FALSE(found[t].owned.is_undecided(k));
            const EdgeLink other = found[t].neighbour[k];
            ASSERT_TRUE(other.exists());
            EXPECT_EQ(found[other.triangle()].neighbour[other.edge()].triangle(), t);
            if (found[t].owned.corner_sides(k) != 0) {
                EXPECT_EQ(found[t].owned.corner_sides(k), front_side);
                ++owners[mesh.triangles[t][static_cast<std::size_t>(k)]];
            }
        }
    }
    EXPECT_EQ(edges, mesh.triangles.size() * 3 / 2);
    EXPECT_EQ(owners.size(), mesh.vertices.size());
    for (const auto& [vertex, count] : owners) {
        EXPECT_EQ(count, 1) << vertex;
    }
}

// Two cones on one rim: as many triangles as it takes around either tip.
TEST(MeshFeatures, FansOfAnySizeAreClosedOrNot) {
    for (const std::uint32_t count : {3u, 8u, 9u, 40u}) {
        TriangleMesh mesh{{Vec3(0.0, 1.0, 0.0), Vec3(0.0, -1.0, 0.0)}, {}};
        for (std::uint32_t i = 0; i < count; ++i) {
            const double angle = 6.283185307179586 * i / count;
            mesh.vertices.emplace_back(std::cos(angle), 0.0, std::sin(angle));
            const std::uint32_t next = 2 + (i + 1) % count;
            mesh.triangles.push_back({0, next, 2 + i});
            mesh.triangles.push_back({1, 2 + i, next});
        }
        std::map<std::uint32_t, int> owners;
        const auto found = find_features(mesh);
        for (std::size_t t = 0; t < found.size(); ++t) {
            for (int k = 0; k < 3; ++k) {
                EXPECT_TRUE(found[t].neighbour[k].exists()) << count;
                EXPECT_FALSE(found[t].owned.is_undecided(k)) << count;
                owners[mesh.triangles[t][static_cast<std::size_t>(k)]] += found[t].owned.corner_sides(k) != 0;
            }
        }
        for (const auto& [vertex, number] : owners) {
            EXPECT_EQ(number, 1) << count << ", vertex " << vertex;
        }
        mesh.triangles.pop_back();  // open at both ends of the gap's edges, and at the lower tip
        const auto open = find_features(mesh);
        EXPECT_FALSE(open[0].owned.is_undecided(0)) << count;
        EXPECT_TRUE(open[1].owned.is_undecided(0)) << count;
    }
}

TEST(MeshFeatures, AFlatSheetHasNoneButItsRim) {
    const TriangleMesh mesh = shared::terrain(8, 1.0, 0.0);
    for (const TriangleFeatures& triangle : find_features(mesh)) {
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(triangle.owned.edge_sides(k), triangle.neighbour[k].exists() ? 0u : both_sides);
            EXPECT_TRUE(triangle.owned.corner_sides(k) == 0 || triangle.owned.is_undecided(k));
        }
    }
}

// The tree's labels say the same as the mesh's features, in every lane.
TEST(MeshFeatures, TheTreeKeepsThemBySlot) {
    const TriangleMesh mesh = shared::terrain(37, 1.0, 0.3);
    const auto features = find_features(mesh);
    const TriangleTree tree = TriangleTree::build(mesh);
    const auto triangle_at = [&](std::uint32_t slot) {
        return tree.labels(slot / lane_count).triangle[slot % lane_count];
    };
    for (std::uint32_t pack = 0; pack < tree.pack_count(); ++pack) {
        const PackLabels& labels = tree.labels(pack);
        for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
            const TriangleFeatures& triangle = features[labels.triangle[lane]];
            EXPECT_EQ(labels.owned[lane].bits, triangle.owned.bits);
            for (int k = 0; k < 3; ++k) {
                const EdgeLink link = labels.neighbour[k][lane];
                ASSERT_EQ(link.exists(), triangle.neighbour[k].exists());
                if (link.exists()) {
                    EXPECT_EQ(triangle_at(link.triangle()), triangle.neighbour[k].triangle());
                    EXPECT_EQ(link.edge(), triangle.neighbour[k].edge());
                }
            }
        }
    }
}

TEST(MeshFeatures, ARefitKeepsTheOwnersAndForgetsTheSides) {
    TriangleMesh mesh = shared::terrain(9, 1.0, 0.0);
    TriangleTree tree = TriangleTree::build(mesh);
    for (Vec3& v : mesh.vertices) {
        v.y = 0.2 * std::sin(40.0 * v.x + 30.0 * v.z);
    }
    tree.refit(mesh);
    const auto features = find_features(mesh);
    for (std::uint32_t pack = 0; pack < tree.pack_count(); ++pack) {
        for (int lane = 0; lane < lane_count; ++lane) {
            const std::uint32_t triangle = tree.labels(pack).triangle[lane];
            const OwnedFeatures fresh = features[triangle].owned;
            const OwnedFeatures kept = tree.labels(pack).owned[lane];
            for (int k = 0; k < 3; ++k) {
                const EdgeLink other = features[triangle].neighbour[k];
                const bool owns = !other.exists() || triangle < other.triangle();
                EXPECT_EQ(kept.edge_sides(k), owns ? both_sides : 0u);
                EXPECT_TRUE(fresh.corner_sides(k) == 0 || kept.corner_sides(k) == both_sides);
                EXPECT_EQ(kept.is_undecided(k), fresh.is_undecided(k));
            }
        }
    }
}

}  // namespace
}  // namespace tactus
