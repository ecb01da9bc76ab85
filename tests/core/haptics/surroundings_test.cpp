#include "core/haptics/surroundings.hpp"

#include <gtest/gtest.h>

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

namespace tactus {
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
                               std::span<const Vec3> places, double radius, Counts& counts) {
    const TriangleTree& tree = *shape.parts.front().tree();
    TouchScene scene(4, 4);
    scene.add(shape, {}, {}, 1);
    for (const Vec3& center : places) {
        Surroundings surroundings(4);
        surroundings.begin_tick(scene, center, radius, 0xffff'ffffu, WorkBudget(10'000'000));
        ContactList list;
        surroundings.find_contacts(center, list, 1e-3);
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
        expect_only_contacts_near(mesh, *shape, places, radius, over_rough);
    }
    std::vector<Vec3> places(20);
    for (Vec3& place : places) {
        place = random.between(1e-4, 4e-4) * random.direction();
    }
    const TriangleMesh ball = shared::icosphere(6, 1.006 * radius);
    expect_only_contacts_near(ball, *shape_of(ball), places, radius, in_a_crowd);
    for (Vec3& place : places) {
        place = Vec3(0.0, radius, 0.0) + 1e-6 * random.direction();
    }
    const TriangleMesh tip = shared::cone(200, 1.0);
    expect_only_contacts_near(tip, *shape_of(tip), places, radius, at_a_tip);
    EXPECT_GT(over_rough.contacts, 50u);
    EXPECT_GT(in_a_crowd.contacts, 300u);
    EXPECT_GT(at_a_tip.long_lists, 0u);
}

}  // namespace
}  // namespace tactus
