// What a sphere can touch of a mesh: enough to keep it clear of the whole.
#include "core/geometry/touchable.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/geometry/touch_shape.hpp"
#include "shared/bench_kit.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/unseen_meshes.hpp"

namespace tactus::touchable_test {
namespace {

using shared::RandomValues;

struct Named {
    std::string name;
    TriangleMesh mesh;
};

// A row of pyramids whose feet are a hundredth as wide as the row.
TriangleMesh sawtooth() {
    TriangleMesh mesh = shared::terrain(100, 1.0, 0.0);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        mesh.vertices[i].y = i % 2 == 0 ? 0.0 : 0.01;
    }
    return mesh;
}

// Open at both ends, of many long slivers.
TriangleMesh tube(double radius, int sides) {
    TriangleMesh mesh;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        const Vec3 place(radius * std::cos(angle), 0.5, radius * std::sin(angle));
        mesh.vertices.insert(mesh.vertices.end(), {place, place - Vec3(0.0, 1.0, 0.0)});
    }
    const auto index = [&](int i) { return static_cast<std::uint32_t>(i % (2 * sides)); };
    for (int i = 0; i < 2 * sides; i += 2) {
        mesh.triangles.push_back({index(i), index(i + 1), index(i + 2)});
        mesh.triangles.push_back({index(i + 2), index(i + 1), index(i + 3)});
    }
    return mesh;
}

TriangleMesh far_out(TriangleMesh mesh) {
    for (Vec3& v : mesh.vertices) {
        v += Vec3(1e4, -2e4, 3e3);
    }
    return mesh;
}

std::vector<Named> meshes() {
    std::vector<Named> all{{"scan", shared::scanned(4)},
                           {"blobs", shared::blobs(24, 0)},
                           {"branches", shared::branches(24, 0)},
                           {"displaced", shared::displaced(4)},
                           {"shell", shared::shell(3)},
                           {"box", shared::rounded_box(4)},
                           {"gear", shared::gear(960)},
                           {"graded", shared::graded(32, 60)},
                           {"clusters", shared::clustered(2, 400)},
                           {"soup", shared::soup(500, 0.5, 3)},
                           {"groove", shared::groove(0.3, 1.0)},
                           {"cube", shared::box(Vec3(0.5))},
                           {"grid", shared::grid_box(Vec3(0.5, 0.1, 0.3), 12)},
                           {"sawtooth", sawtooth()},
                           {"tube", tube(0.1, 64)}};
    all.push_back({"single", shared::in_single_precision(shared::scanned(4))});
    all.push_back({"far out", far_out(shared::scanned(3))});
    return all;
}

double distance_to(const TriangleTree& tree, const Vec3& point, double far) {
    return tree.nearest(point, far).distance;
}

// Centres of spheres that touch the mesh or are near to it: beside its triangles, edges and corners.
std::vector<Vec3> centers_about(const TriangleTree& tree, double radius, int count) {
    RandomValues random(11);
    std::vector<Vec3> centers;
    for (int i = 0; i < count; ++i) {
        const auto slot = static_cast<std::uint32_t>(random.below(static_cast<int>(4 * tree.pack_count())));
        const TriangleCorners t = tree.corners(slot);
        double u = random.unit(), v = random.unit();
        u = i % 3 == 1 ? 0.0 : u;
        v = i % 3 != 0 ? 0.0 : v * (1.0 - u);
        const Vec3 place = t.a + u * (t.b - t.a) + v * (t.c - t.a);
        const Vec3 across = glm::cross(t.b - t.a, t.c - t.a);
        const bool along_normal = i % 2 == 0 && glm::length(across) > 0.0;
        const Vec3 away =
            along_normal ? (random.flip() ? 1.0 : -1.0) * glm::normalize(across) : random.direction();
        centers.push_back(place + radius * (random.flip() ? 1.0 : random.between(1.0, 1.5)) * away);
    }
    return centers;
}

TEST(Touchable, WhereverTheSphereFitsTheNearestTriangleIsOneItCanTouch) {
    int fitting = 0;
    for (const Named& one : meshes()) {
        const TriangleTree whole = TriangleTree::build(one.mesh);
        for (const double radius : {0.01, 0.05, 0.2}) {
            const auto touchable = touchable_triangles(whole, radius);
            if (!touchable) {
                continue;
            }
            EXPECT_EQ(touchable->whole, &whole);
            const double rounding = 0x1p-48 * whole.magnitude();
            for (const Vec3& center : centers_about(whole, radius, 4'000)) {
                const double distance = distance_to(whole, center, 4.0 * radius);
                if (distance >= radius * (1.0 - 1e-9)) {
                    ++fitting;
                    ASSERT_NEAR(distance_to(*touchable->tree, center, 4.0 * radius), distance, rounding)
                        << one.name << " " << radius;
                }
            }
        }
    }
    EXPECT_GT(fitting, 10'000);
}

TEST(Touchable, ItIsFarLessWhereTheSurfaceIsFinerThanTheSphere) {
    const TriangleTree teeth = TriangleTree::build(sawtooth());
    const TriangleTree bore = TriangleTree::build(tube(0.1, 512));
    const TriangleTree pores = TriangleTree::build(shared::displaced(5));
    const auto share = [](const TriangleTree& tree, double radius) {
        return static_cast<double>(touchable_slots(tree, radius).size()) /
               static_cast<double>(tree.triangle_count());
    };
    EXPECT_LT(share(teeth, 0.05), 0.6);
    EXPECT_LT(share(pores, 0.2), 0.2);
    EXPECT_GT(share(pores, 1e-4), 0.95);
    EXPECT_EQ(share(bore, 0.05), 1.0);
}

// Of a sphere's outside and inside alike: nothing is left out that it may touch.
TEST(Touchable, OfARoundBallItIsAll) {
    const TriangleTree ball = TriangleTree::build(shared::icosphere(4, 0.5));
    EXPECT_EQ(touchable_triangles(ball, 0.1), nullptr);
    EXPECT_EQ(touchable_slots(ball, 0.1).size(), ball.triangle_count());
}

// Its names are slots of the whole, with the same corners.
TEST(Touchable, ItsTrianglesAreThoseOfTheWhole) {
    const TriangleTree whole = TriangleTree::build(shared::scanned(4));
    const auto touchable = touchable_triangles(whole, 0.1);
    ASSERT_NE(touchable, nullptr);
    for (std::uint32_t slot = 0; slot < 4 * touchable->tree->pack_count(); ++slot) {
        const TriangleCorners own = touchable->tree->corners(slot);
        const TriangleCorners named = whole.corners(touchable->tree->triangle_at(slot));
        ASSERT_TRUE(own.a == named.a && own.b == named.b && own.c == named.c);
    }
}

TEST(Touchable, TheRunnerDoesNotMatter) {
    const TriangleTree whole = TriangleTree::build(shared::scanned(5));
    EXPECT_EQ(touchable_slots(whole, 0.05), touchable_slots(whole, 0.05, shared::run_on_two_threads));
}

// Whether it is still wanted is asked for each face, edge and corner: so often they are looked at.
struct CountedLooks {
    int asked = 0, until = std::numeric_limits<int>::max();

    std::shared_ptr<const TouchableTriangles> find(const TriangleTree& tree, double radius) {
        return touchable_triangles(tree, radius, run_serially, [this] { return ++asked <= until; });
    }
};

TEST(Touchable, WhatIsNotWantedAnyMoreIsGivenUp) {
    const TriangleTree whole = TriangleTree::build(shared::scanned(5));
    CountedLooks all;
    EXPECT_NE(all.find(whole, 0.05), nullptr);
    EXPECT_GT(all.asked, 20'000);
    CountedLooks some{.until = 100};
    EXPECT_EQ(some.find(whole, 0.05), nullptr);
    EXPECT_LT(some.asked, 300) << "once a part, and at the end";
}

// A ball in a socket that is wider by a hundredth touches all of it, and each face takes a thousand looks.
TEST(Touchable, WhereNearlyAllCanBeTouchedAFewTell) {
    CountedLooks looks;
    EXPECT_EQ(looks.find(TriangleTree::build(shared::icosphere(6, 0.202)), 0.2), nullptr);
    EXPECT_EQ(looks.asked, 0);
}

// Of needles that all point at the same place thousands lie in every ball: to look at all takes a minute.
TEST(Touchable, WhatWouldTakeTooLongIsNotBegun) {
    CountedLooks looks;
    EXPECT_EQ(looks.find(TriangleTree::build(shared::urchin(25'000, 12)), 0.19), nullptr);
    EXPECT_EQ(looks.asked, 0);
    EXPECT_NE(looks.find(TriangleTree::build(shared::urchin(1'500, 12)), 0.19), nullptr);
}

// Where rounding is not small beside the radius nothing is claimed.
TEST(Touchable, OfASpeckFarOutNothingIsSaid) {
    const TriangleTree whole = TriangleTree::build(far_out(shared::scanned(3)));
    EXPECT_EQ(touchable_triangles(whole, 1e-4), nullptr);
}

TEST(Touchable, ANarrowedShapeSaysNothingOfAnotherTree) {
    const PlacedShape placed{MeshShape{std::make_shared<const TriangleMesh>(shared::scanned(4))}, {}};
    const auto shape = make_touch_shape({&placed, 1}).shape;
    const auto narrower = narrowed(*shape, 0.1);
    ASSERT_NE(narrower, nullptr);
    TouchPart part = narrower->parts.front();
    EXPECT_EQ(part.tree_for(0.1), part.touchable->tree.get());
    EXPECT_EQ(part.tree_for(0.09), part.tree());
    part.surface = std::make_shared<const TriangleTree>(TriangleTree::build(shared::scanned(4)));
    EXPECT_EQ(part.tree_for(0.1), part.tree());
    const PlacedShape ball{SphereShape{}, {}};
    EXPECT_EQ(narrowed(*make_touch_shape({&ball, 1}).shape, 0.1), nullptr);
}

}  // namespace
}  // namespace tactus::touchable_test
