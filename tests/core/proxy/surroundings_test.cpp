#include "core/proxy/surroundings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/slow_distance.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::surroundings_test {
namespace {

using shared::corners_of;
using shared::RandomValues;
using shared::slow_distance;
using shared::TouchRig;

std::shared_ptr<const TouchShape> shape_of(const TriangleMesh& mesh) {
    const PlacedShape placed{MeshShape{std::make_shared<const TriangleMesh>(mesh)}, {}};
    return make_touch_shape({&placed, 1}).shape;
}

// Where a sphere of that radius rests, drawn from there towards the origin.
Vec3 resting_place(const std::shared_ptr<const TouchShape>& shape, const Vec3& from, double radius) {
    TouchRig rig(radius);
    rig.add(shape);
    return rig.draw(from, 0.3 * from, 400).position;
}

struct Counts {
    std::size_t contacts = 0, long_lists = 0;
};

void expect_only_contacts_near(const TriangleMesh& mesh, const TouchShape& shape,
                               std::span<const Vec3> places, double radius, double ahead, Counts& counts) {
    const TriangleTree& tree = *shape.parts.front().tree();
    TouchScene scene(4, 4);
    scene.add(shape, {}, {}, 1);
    for (const Vec3& center : places) {
        Surroundings surroundings(4);
        surroundings.begin_tick(scene, center, radius, 0xffff'ffffu, WorkBudget(10'000'000));
        ContactList list;
        surroundings.find_contacts(center, list, 1e-3, ahead);
        std::set<std::uint32_t> found;
        for (const Contact& contact : list.all()) {
            found.insert(tree.triangle_at(contact.feature.triangle));
        }
        counts.contacts += found.size();
        counts.long_lists += list.count > 100;
        const double rest = radius + surroundings.tolerances().skin;
        const double unseen = surroundings.unseen_gap();
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (unseen > 0.0 && slow_distance(center, corners_of(mesh, t)) < rest + unseen) {
                EXPECT_TRUE(found.contains(static_cast<std::uint32_t>(t))) << t;
            }
        }
    }
}

// Steps that are shorter go without a sweep.
TEST(Surroundings, NothingButContactsIsNearerThanTheUnseenGap) {
    constexpr double radius = 0.1;
    RandomValues random(7);
    Counts over_rough, in_a_crowd, at_a_tip;
    for (const TriangleMesh& mesh : {shared::rough_sphere(5, 0.5, 0.1), shared::rough_sphere(5, 0.5, 1.0),
                                     shared::clustered(3, 5'000), shared::grid_box(Vec3(0.4), 20)}) {
        const std::shared_ptr<const TouchShape> shape = shape_of(mesh);
        std::vector<Vec3> places(20);
        for (Vec3& place : places) {
            const Vec3 rest = resting_place(shape, 0.9 * random.direction(), radius);
            place = rest * (1.0 + random.magnitude(1e-10, 1e-3));
        }
        for (const double ahead : {0.0, 1e-3 * radius, 1e-2 * radius}) {
            expect_only_contacts_near(mesh, *shape, places, radius, ahead, over_rough);
        }
    }
    std::vector<Vec3> places(20);
    for (Vec3& place : places) {
        place = random.between(1e-4, 4e-4) * random.direction();
    }
    const TriangleMesh ball = shared::icosphere(6, 1.006 * radius);
    expect_only_contacts_near(ball, *shape_of(ball), places, radius, 1e-3 * radius, in_a_crowd);
    for (Vec3& place : places) {
        place = Vec3(0.0, radius, 0.0) + 1e-6 * random.direction();
    }
    const TriangleMesh tip = shared::cone(200, 1.0);
    expect_only_contacts_near(tip, *shape_of(tip), places, radius, 0.0, at_a_tip);
    EXPECT_GT(over_rough.contacts, 50u);
    EXPECT_GT(in_a_crowd.contacts, 300u);
    EXPECT_GT(at_a_tip.long_lists, 0u);
}

// What is known of bodies that are not asked, and of triangles that are only remembered, is from earlier
// places of the sphere. Over large faces it is enough for many steps.
TEST(Surroundings, TheUnseenGapHoldsOnTheWayBesideOtherBodies) {
    constexpr double radius = 0.1, step = 2e-3;
    struct Body {
        TriangleMesh mesh;
        Pose pose;
    };
    std::vector<Body> bodies{{shared::grid_box({2.0, 0.05, 2.0}, 6), {{0.0, -0.05, 0.0}}},
                             {shared::grid_box({0.05, 0.4, 0.4}, 4), {{0.75, 0.4, 0.1}}}};
    std::vector<std::shared_ptr<const TouchShape>> shapes;
    TouchScene scene(4, 4);
    for (const Body& body : bodies) {
        shapes.push_back(shape_of(body.mesh));
        scene.add(*shapes.back(), body.pose, {}, 1);
    }
    const Vec3 ball(0.2, 0.35, 0.35);
    constexpr double ball_radius = 0.3;
    const PlacedShape solid{SphereShape{ball_radius}, {}};
    shapes.push_back(make_touch_shape({&solid, 1}).shape);
    scene.add(*shapes.back(), {ball}, {}, 1);
    Surroundings surroundings(4);
    Vec3 center(-1.0, radius, 0.0);
    int longer_than_a_step = 0;
    constexpr int ticks = 1'000;
    for (int tick = 0; tick < ticks; ++tick) {
        scene.begin_tick();
        surroundings.begin_tick(scene, center, radius, 0xffff'ffffu, WorkBudget(100'000));
        ContactList list;
        surroundings.find_contacts(center, list);
        const double near = radius + surroundings.tolerances().skin + surroundings.unseen_gap();
        longer_than_a_step += surroundings.unseen_gap() > step;
        const auto is_found = [&](const FeatureId& feature) {
            return std::ranges::find(list.all(), feature, &Contact::feature) != list.all().end();
        };
        EXPECT_TRUE(glm::distance(center, ball) - ball_radius >= near || is_found({2}));
        for (std::uint32_t body = 0; body < bodies.size(); ++body) {
            const TriangleTree& tree = *shapes[body]->parts.front().tree();
            for (std::uint32_t slot = 0; slot < tree.pack_count() * lane_count; ++slot) {
                const TriangleCorners t = tree.corners(slot);
                const Vec3 local = to_local(bodies[body].pose, center);
                const bool is_first =
                    slot % lane_count == 0 || tree.triangle_at(slot) != tree.triangle_at(slot - 1);
                EXPECT_TRUE(!is_first || is_found({body, slot}) ||
                            slow_distance(local, {t.a, t.b, t.c}) >= near)
                    << tick;
            }
        }
        const Vec3 way = step * glm::normalize(Vec3(1.0, 0.0, std::cos(0.02 * tick)));
        surroundings.first_stride();
        surroundings.next_stride(step, true);
        surroundings.travelled(step);
        center += way;
    }
    EXPECT_GT(longer_than_a_step, ticks / 4);
}

}  // namespace
}  // namespace tactus::surroundings_test
