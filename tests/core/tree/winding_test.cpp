#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/mesh/closed_mesh.hpp"
#include "core/tree/triangle_tree.hpp"
#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/slow_distance.hpp"

namespace tactus::winding_test {
namespace {

using shared::RandomValues;

constexpr std::int64_t plenty = 1'000'000;

TriangleMesh joined(const TriangleMesh& first, const TriangleMesh& second) {
    TriangleMesh both = first;
    const auto offset = static_cast<std::uint32_t>(first.vertices.size());
    both.vertices.insert(both.vertices.end(), second.vertices.begin(), second.vertices.end());
    for (const auto& [a, b, c] : second.triangles) {
        both.triangles.push_back({a + offset, b + offset, c + offset});
    }
    return both;
}

TriangleMesh turned_over(TriangleMesh mesh) {
    for (auto& triangle : mesh.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    return mesh;
}

// A prism over an L: faces, edges and corners that many axis-parallel lines run along.
TriangleMesh l_prism() {
    const std::vector<std::array<double, 2>> outline = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    const std::array<std::uint32_t, 3> caps[] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    TriangleMesh mesh;
    for (const double z : {0.0, 1.0}) {
        for (const auto& [x, y] : outline) {
            mesh.vertices.push_back({x, y, z});
        }
    }
    for (const auto& [a, b, c] : caps) {
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({a + 6, b + 6, c + 6});
    }
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t next = (i + 1) % 6;
        mesh.triangles.push_back({i, next, next + 6});
        mesh.triangles.push_back({i, next + 6, i + 6});
    }
    return mesh;
}

void expect_same_as_slow(const TriangleMesh& mesh, const Vec3& p) {
    const TriangleTree tree = TriangleTree::build(mesh);
    WorkBudget work(plenty);
    const Winding winding = tree.winding(p, work);
    if (shared::slow_distance(p, mesh) > 1e-12L) {
        ASSERT_TRUE(winding.known) << p.x << ' ' << p.y << ' ' << p.z;
        ASSERT_EQ(winding.number, shared::winding(mesh, p)) << p.x << ' ' << p.y << ' ' << p.z;
    }
}

TEST(IsClosed, SolidsAreAndWhatHasAHoleIsNot) {
    EXPECT_TRUE(is_closed(shared::box(Vec3(1.0))));
    EXPECT_TRUE(is_closed(shared::icosphere(3, 0.1)));
    EXPECT_TRUE(is_closed(l_prism()));
    EXPECT_TRUE(is_closed(joined(shared::icosphere(2, 1.0), turned_over(shared::icosphere(1, 0.5)))));
    EXPECT_FALSE(is_closed(shared::terrain(4, 1.0, 0.1)));
    EXPECT_FALSE(is_closed(shared::soup(40, 1.0, 3)));
    EXPECT_FALSE(is_closed({}));
    TriangleMesh one_missing = shared::box(Vec3(1.0));
    one_missing.triangles.pop_back();
    EXPECT_FALSE(is_closed(one_missing));
    TriangleMesh one_turned = shared::box(Vec3(1.0));
    std::swap(one_turned.triangles[5][0], one_turned.triangles[5][1]);
    EXPECT_FALSE(is_closed(one_turned));
}

TEST(IsClosed, CornersAtOnePlaceAreOneCorner) {
    const TriangleMesh box = shared::box(Vec3(1.0, 0.0 + 2.0, 0.5));
    TriangleMesh split;
    for (const auto& triangle : box.triangles) {
        const auto first = static_cast<std::uint32_t>(split.vertices.size());
        for (const std::uint32_t corner : triangle) {
            split.vertices.push_back(box.vertices[corner]);
        }
        split.triangles.push_back({first, first + 1, first + 2});
    }
    EXPECT_TRUE(is_closed(split));
    split.vertices[4].x += 1e-7;  // a seam as single precision draws it
    EXPECT_TRUE(is_closed(split));
    split.vertices[4].x += 1e-4;
    EXPECT_FALSE(is_closed(split));
}

TEST(Winding, EveryPlaceOfAGridThatRunsThroughFacesEdgesAndCorners) {
    const TriangleMesh mesh = l_prism();
    const TriangleTree tree = TriangleTree::build(mesh);
    for (int x = -2; x <= 10; ++x) {
        for (int y = -2; y <= 10; ++y) {
            for (int z = -2; z <= 6; ++z) {
                const Vec3 p(0.25 * x, 0.25 * y, 0.25 * z);
                if (shared::slow_distance(p, mesh) < 1e-12L) {
                    continue;
                }
                WorkBudget work(plenty);
                const Winding winding = tree.winding(p, work);
                ASSERT_TRUE(winding.known);
                const bool in_l = x > 0 && y > 0 && ((x < 8 && y < 4) || (x < 4 && y < 8));
                ASSERT_EQ(winding.number, in_l && z > 0 && z < 4 ? 1 : 0) << x << ' ' << y << ' ' << z;
            }
        }
    }
}

// Lines that run within the last bits of edges and faces, far from the origin.
TEST(Winding, ALastBitBesideAnEdgeCountsOnce) {
    RandomValues random(5);
    for (const double offset : {0.0, 1.0 / 3.0, 1e3, 1e6}) {
        TriangleMesh mesh = l_prism();
        for (Vec3& v : mesh.vertices) {
            v += offset * Vec3(1.0, -0.7, 0.3);
        }
        const TriangleTree tree = TriangleTree::build(mesh);
        for (int run = 0; run < 2'000; ++run) {
            Vec3 p = mesh.vertices[static_cast<std::size_t>(random.below(12))];
            for (int axis = 0; axis < 3; ++axis) {
                const int steps = random.below(5) - 2;
                for (int i = 0; i < std::abs(steps); ++i) {
                    p[axis] = std::nextafter(p[axis], steps * 1e300);
                }
            }
            const int axis = random.below(3);
            p[axis] += random.between(-0.9, 0.9);
            WorkBudget work(plenty);
            const Winding winding = tree.winding(p, work);
            const double ulp = 1e-15 * (1.0 + offset);
            if (shared::slow_distance(p, mesh) > 8.0L * ulp) {
                ASSERT_TRUE(winding.known);
                ASSERT_EQ(winding.number, shared::winding(mesh, p)) << run << ' ' << offset;
            }
        }
    }
}

TEST(Winding, ShellsInShellsAndShellsThatCross) {
    TriangleMesh moved = shared::icosphere(2, 0.8);
    for (Vec3& v : moved.vertices) {
        v.x += 0.9;
    }
    const TriangleMesh hollow = joined(shared::icosphere(3, 1.0), turned_over(shared::icosphere(2, 0.5)));
    const TriangleMesh crossing = joined(shared::icosphere(3, 1.0), moved);
    RandomValues random(7);
    for (int run = 0; run < 400; ++run) {
        const Vec3 p = random.in_ball(1.6);
        expect_same_as_slow(hollow, p);
        expect_same_as_slow(crossing, p);
        expect_same_as_slow(turned_over(crossing), p);
    }
}

TEST(Winding, CrumpledBallsTurnedAnyWay) {
    RandomValues random(11);
    for (int run = 0; run < 60; ++run) {
        TriangleMesh mesh = shared::icosphere(2, 1.0);
        const double scale = std::pow(10.0, random.between(-3.0, 3.0));
        const double crumpled = random.between(0.0, 0.5);
        for (Vec3& v : mesh.vertices) {
            v = (v + random.in_ball(crumpled)) * scale;
        }
        const TriangleTree tree = TriangleTree::build(mesh);
        for (int i = 0; i < 40; ++i) {
            const Vec3 p = random.in_ball(1.3 * scale);
            WorkBudget work(plenty);
            const Winding winding = tree.winding(p, work);
            ASSERT_TRUE(winding.known);
            ASSERT_EQ(winding.number, shared::winding(mesh, p)) << run;
        }
    }
}

TEST(Winding, WithoutWorkNothingIsKnown) {
    const TriangleTree tree = TriangleTree::build(shared::icosphere(4, 1.0));
    WorkBudget work(10);
    EXPECT_FALSE(tree.winding(Vec3(0.01), work).known);
}

TEST(Winding, LooksAtFewOfManyTriangles) {
    const TriangleTree tree = TriangleTree::build(shared::icosphere(6, 1.0));
    RandomValues random(3);
    for (int run = 0; run < 1'000; ++run) {
        WorkBudget work(2'000);  // of a tree of 82,000 triangles
        EXPECT_TRUE(tree.winding(random.in_ball(0.9), work).known);
    }
}

}  // namespace
}  // namespace tactus::winding_test
