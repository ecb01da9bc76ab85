// A proxy that is told what it can touch of a mesh goes where it went, and enters nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "core/proxy/proxy.hpp"
#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/reference_descent.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/rough_paths.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_narrowed_test {
namespace {

using shared::JudgeTree;
using shared::RandomValues;
using shared::TouchRig;

struct Scene {
    TriangleMesh mesh;
    JudgeTree tree;
    std::shared_ptr<const TouchShape> whole, narrower;

    Scene(TriangleMesh of, double radius) : mesh(std::move(of)), tree(mesh) {
        const PlacedShape placed{MeshShape{std::make_shared<const TriangleMesh>(mesh)}, {}};
        whole = make_touch_shape({&placed, 1}).shape;
        narrower = narrowed(*whole, radius);
    }
    bool is_clear(const Vec3& position, double radius) const {
        return tree.nearest(position, 2.0 * radius).distance >= radius * (1.0 - 1e-9);
    }
};

TEST(ProxyNarrowed, ItNeverEntersWhatItIsNotToldOf) {
    constexpr double radius = 0.1;
    const Scene scene(shared::scanned(4), radius);
    ASSERT_NE(scene.narrower, nullptr);
    for (const shared::RoughPath& path : shared::rough_paths()) {
        TouchRig rig(radius);
        rig.add(scene.narrower);
        int touching = 0;
        for (const Vec3& hand : path.make(scene.tree, radius, 600)) {
            const ProxyTick tick = rig.tick(hand);
            touching += (tick.status & proxy_touching) != 0;
            ASSERT_TRUE((tick.status & proxy_absent) || scene.is_clear(tick.position, radius)) << path.name;
        }
        EXPECT_GT(touching, 100) << path.name;
    }
}

TEST(ProxyNarrowed, ItEndsWhereExactDescentOverTheWholeMeshEnds) {
    constexpr double radius = 0.1;
    const Scene scene(shared::scanned(3), radius);
    ASSERT_NE(scene.narrower, nullptr);
    shared::ReferenceDescent reference(scene.tree, radius);
    TouchRig rig(radius);
    rig.add(scene.narrower);
    int checked = 0;
    for (const Vec3& hand : shared::rough_paths()[0].make(scene.tree, radius, 400)) {
        const ProxyTick tick = rig.tick(hand);
        if ((tick.status & proxy_touching) && !(tick.status & proxy_unfinished)) {
            const shared::ReferencePlace place = reference.settle(tick.position, hand);
            EXPECT_LT(static_cast<double>(glm::distance(place.position, shared::SlowVec3(tick.position))),
                      1e-7);
            ++checked;
        }
    }
    EXPECT_GT(checked, 100);
}

// Put into a bore that is too narrow for it, it does not count as free: its walls cannot be touched, and are
// asked for all the same.
TEST(ProxyNarrowed, ItDoesNotAppearWhereItDoesNotFit) {
    constexpr double radius = 0.2;
    const Scene scene(shared::gear(2'400), radius);
    ASSERT_NE(scene.narrower, nullptr);
    TouchRig rig(radius);
    rig.add(scene.narrower);
    for (int i = 0; i < 10; ++i) {
        EXPECT_TRUE(rig.tick(Vec3(0.0, 0.0, 0.0)).status & proxy_absent);
    }
    rig.draw({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 100);
    EXPECT_FALSE(rig.tick({0.0, 1.0, 0.0}).status & proxy_absent);
}

// Whoever carries it along may have put it anywhere: in the next tick the whole mesh is asked, and it is
// lifted out of what it can never touch by itself.
TEST(ProxyNarrowed, PutIntoANarrowPlaceItIsHeldByAllOfIt) {
    constexpr double radius = 0.2;
    const Scene scene(shared::gear(2'400), radius);
    TouchRig told(radius), knows(radius);
    told.add(scene.narrower);
    knows.add(scene.whole);
    for (TouchRig* rig : {&told, &knows}) {
        rig->draw({0.0, 0.6, 0.0}, {0.0, 0.5, 0.0}, 20);
        rig->proxy.displace({0.0, -0.45, 0.0});
    }
    const Vec3 wall(0.3, 0.05, 0.0);  // beyond the bore's
    for (int i = 0; i < 50; ++i) {
        const ProxyTick tick = told.tick(wall);
        EXPECT_EQ(tick.position, knows.tick(wall).position);
        EXPECT_LT(tick.position.x, 0.1);
    }
}

TEST(ProxyNarrowed, ASmallerSphereAsksTheWhole) {
    constexpr double radius = 0.02;
    const Scene scene(shared::scanned(4), 0.1);
    TouchRig told(radius), knows(radius);
    told.add(scene.narrower);
    knows.add(scene.whole);
    for (const Vec3& hand : shared::rough_paths()[0].make(scene.tree, radius, 300)) {
        ASSERT_EQ(told.tick(hand).position, knows.tick(hand).position);
    }
}

// A tick with little work still says whether it is at the end.
TEST(ProxyNarrowed, OverNoiseItTakesLessWork) {
    constexpr double radius = 0.2;
    const Scene scene(shared::scanned(5), radius);
    int unfinished[2] = {0, 0};
    for (const bool narrow : {false, true}) {
        TouchRig rig(radius);
        rig.add(narrow ? scene.narrower : scene.whole);
        ProxySettings settings = rig.proxy.settings();
        settings.max_work = 1'500;
        rig.proxy.set_settings(settings);
        for (const Vec3& hand : shared::rough_paths()[1].make(scene.tree, radius, 600)) {
            unfinished[narrow] += (rig.tick(hand).status & proxy_unfinished) != 0;
        }
    }
    EXPECT_LT(2 * unfinished[1], unfinished[0]);
}

}  // namespace
}  // namespace tactus::proxy_narrowed_test
