// Meshes that deform around the proxy, by more than it is large.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/surface_way.hpp"
#include "shared/deforms.hpp"
#include "shared/meshes.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_deform_test {
namespace {

using shared::TouchRig;

constexpr double radius = 0.05;

TriangleMesh lifted(TriangleMesh mesh, double by) {
    for (Vec3& v : mesh.vertices) {
        v.y += by;
    }
    return mesh;
}

class ProxyDeform : public ::testing::Test {
protected:
    void start(const TriangleMesh& mesh, const TouchMaterial& material = {}) {
        form_ = shared::touch_of(mesh);
        body_ = rig_.add(form_, {}, material);
    }
    ProxyTick deform(const TriangleMesh& mesh, const Vec3& hand) {
        former_ = form_;
        form_ = shared::refitted(*form_, mesh);
        rig_.scene.begin_tick();
        EXPECT_TRUE(gives_ ? rig_.scene.give(body_, *form_, 0.1) : rig_.scene.deform(body_, *form_));
        return rig_.proxy.move(rig_.scene, hand);
    }

    TouchRig rig_{radius};
    int body_ = -1;
    bool gives_ = false;  // else it takes another form
    std::shared_ptr<const TouchShape> form_, former_;
};

TEST_F(ProxyDeform, ASheetThatRisesTenRadiiTakesItAlong) {
    const TriangleMesh sheet = shared::terrain(20, 2.0, 0.0);
    start(sheet);
    rig_.tick({0.013, 0.2, 0.007});
    const ProxyTick tick = deform(lifted(sheet, 0.7), {0.013, 0.2, 0.007});
    EXPECT_NEAR(tick.position.y, 0.7 + radius, 1e-7);
    EXPECT_EQ(tick.status & (proxy_squeezed | proxy_letting_out), 0u);
    EXPECT_TRUE(tick.status & proxy_touching);
    EXPECT_NEAR(deform(lifted(sheet, 0.1), {0.013, 0.2, 0.007}).position.y, 0.2, 1e-12);
}

TEST_F(ProxyDeform, WhatGivesChangesNothingByAJump) {
    const TriangleMesh sheet = shared::terrain(20, 2.0, 0.0);
    start(sheet);
    const Vec3 hand(0.013, 0.03, 0.007);
    rig_.draw({0.013, 0.2, 0.007}, hand, 100);
    gives_ = true;
    for (int i = 1; i <= 10; ++i) {
        const ProxyTick tick = deform(lifted(sheet, -1e-4 * i), hand);
        EXPECT_FALSE(tick.jumped) << i;
        ASSERT_EQ(rig_.proxy.touching().size(), 1u);
        const Vec3 way = way_of_surface(rig_.scene, rig_.proxy.touching()[0]);
        EXPECT_LT(glm::distance(way, Vec3(0.0, -1e-4, 0.0)), 1e-12);
    }
    gives_ = false;
    EXPECT_TRUE(deform(lifted(sheet, -2e-3), hand).jumped);
}

TEST_F(ProxyDeform, WhatIsNoRefitDoesNotGive) {
    start(shared::terrain(20, 2.0, 0.0));
    const std::shared_ptr<const TouchShape> other = shared::touch_of(shared::terrain(20, 2.0, 0.0));
    rig_.scene.begin_tick();
    EXPECT_FALSE(rig_.scene.give(body_, *other, 0.1));
    EXPECT_EQ(rig_.scene.body(body_).shape, form_.get());
}

// Pushed off one wall after the other, it would stand between them in the limit only, after far more work
// than this. Both at once say where there is room.
TEST_F(ProxyDeform, AGrooveThatNarrowsLiftsItOut) {
    const auto groove = [](double slope, double by) {
        TriangleMesh mesh = shared::terrain(20, 2.0, 0.0);
        for (Vec3& v : mesh.vertices) {
            v.y = slope * std::abs(v.x) + by;
        }
        return mesh;
    };
    ProxySettings settings = rig_.proxy.settings();
    settings.max_work = 10'000;
    rig_.proxy.set_settings(settings);
    start(groove(0.8, 0.0));
    rig_.draw({0.013, 0.5, 0.007}, {0.013, -0.5, 0.007}, 20);
    const ProxyTick tick = deform(groove(6.0, 0.5), {0.013, -0.5, 0.007});
    EXPECT_EQ(tick.status & (proxy_squeezed | proxy_letting_out | proxy_unfinished), 0u);
    EXPECT_NEAR(tick.position.x, 0.0, 1e-7);
    EXPECT_NEAR(tick.position.y, 0.5 + radius * std::sqrt(1.0 + 6.0 * 6.0), 1e-6);
    EXPECT_TRUE(tick.status & proxy_touching);
}

TEST_F(ProxyDeform, ASheetThatItSticksToCarriesItSideways) {
    const TriangleMesh sheet = shared::terrain(20, 2.0, 0.0);
    start(sheet, TouchMaterial{500.0, 0.0, 2.0, 2.0});
    rig_.draw({0.013, 0.3, 0.007}, {0.013, 0.03, 0.007}, 20);
    TriangleMesh moved = sheet;
    for (Vec3& v : moved.vertices) {
        v.x += 0.011;
    }
    EXPECT_NEAR(deform(moved, {0.024, 0.03, 0.007}).position.x, 0.024, 1e-6);
}

TEST_F(ProxyDeform, BetweenARisingBlockAndACeilingItIsLetOut) {
    const TriangleMesh block = lifted(shared::box(Vec3(1.0, 0.1, 1.0)), -0.1);
    const auto risen = [&](double by) {
        TriangleMesh mesh = block;
        for (Vec3& v : mesh.vertices) {
            v.y += v.y > -0.1 ? by : 0.0;
        }
        return mesh;
    };
    start(block);
    rig_.add(BoxShape{Vec3(1.0, 0.1, 1.0)}, {Vec3(0.0, 0.5, 0.0), Quat(1.0, 0.0, 0.0, 0.0)});
    rig_.tick({0.013, 0.2, 0.007});
    const ProxyTick tick = deform(risen(0.37), {0.013, 0.2, 0.007});
    EXPECT_TRUE(tick.status & proxy_squeezed);
    EXPECT_TRUE(tick.status & proxy_letting_out);
    EXPECT_LE(tick.position.y, 0.4 - radius);
    // Room comes back: it is touched again, from where the hand is.
    deform(risen(0.3), {0.013, 0.2, 0.007});
    EXPECT_EQ(rig_.tick({0.013, 0.2, 0.007}).position.y, 0.2);
    deform(block, {0.013, 0.2, 0.007});
    EXPECT_NEAR(rig_.draw({0.013, 0.2, 0.007}, {0.013, -0.02, 0.007}, 30).position.y, radius, 1e-7);
}

TEST_F(ProxyDeform, WhatIsFarAwayCostsNothing) {
    const TriangleMesh sheet = shared::terrain(20, 2.0, 0.0);
    start(sheet);
    rig_.tick({5.0, 0.2, 0.0});
    EXPECT_EQ(deform(lifted(sheet, 0.7), {5.0, 0.2, 0.0}).position.x, 5.0);
}

TEST_F(ProxyDeform, OtherTrianglesLetItOutFirst) {
    start(shared::box(Vec3(0.2)));
    rig_.draw({0.0, 1.0, 0.0}, {0.0, 0.24, 0.0}, 20);
    const auto other = shared::touch_of(shared::icosphere(2, 0.6));
    rig_.scene.begin_tick();
    ASSERT_TRUE(rig_.scene.deform(body_, *other));
    const ProxyTick tick = rig_.proxy.move(rig_.scene, {0.0, 0.24, 0.0});
    EXPECT_TRUE(tick.status & proxy_letting_out);
    EXPECT_EQ(tick.position.y, 0.24);
    EXPECT_NEAR(rig_.draw({0.0, 0.24, 0.0}, {0.0, 1.0, 0.0}, 40).position.y, 1.0, 1e-12);
    EXPECT_GT(rig_.draw({0.0, 1.0, 0.0}, {0.0, 0.3, 0.0}, 40).position.y, 0.6);
}

TEST(ProxyDeformRandom, NoneOfManyPasses) {
    shared::DeformFigures figures;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const shared::DeformFigures run = shared::play_deforms(seed);
        EXPECT_EQ(run.passes, 0) << "seed " << seed;
        figures.add(run);
    }
    EXPECT_GT(figures.farthest, 9.0);
    EXPECT_GT(figures.touched, figures.deformations / 4);
    EXPECT_LT(figures.let_out, figures.deformations / 3);
    RecordProperty("let_out", figures.let_out);
}

}  // namespace
}  // namespace tactus::proxy_deform_test
