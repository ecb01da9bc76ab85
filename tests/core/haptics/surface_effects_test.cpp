#include "core/haptics/surface_effects.hpp"

#include "core/haptics/surface_feel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "shared/random_values.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::surface_effects_test {
namespace {

using shared::RandomValues;
using shared::TouchRig;

// A hand pressed 0.02 into the plane y = 0; effects are asked for as often as a test likes.
struct Pressed {
    explicit Pressed(const TouchMaterial& material) : rig(0.05) {
        rig.add(PlaneShape{}, {}, material);
        tick = rig.draw({0.0, 0.1, 0.0}, hand, 10);
    }
    // What the effects add (unit: newtons).
    Vec3 added(const Vec3& at, const Vec3& velocity = Vec3(0.0), Nanoseconds now = 0) {
        tick = rig.tick(at);
        HandForce force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, velocity, 1e-3);
        const Vec3 plain = force.total;
        add_surface_effects(rig.scene, rig.proxy.touching(), {at, velocity}, now, 1e-3, memory, force);
        Vec3 sum(0.0);
        for (int i = 0; i < force.contact_count; ++i) {
            sum += force.contacts[i].on_hand;
        }
        EXPECT_LT(glm::distance(sum, force.total), 1e-9);  // the bodies feel the opposite of all of it
        return force.total - plain;
    }
    TouchRig rig;
    ProxyTick tick;
    EffectMemory memory;
    Vec3 hand{0.0, 0.03, 0.0};
};

TEST(SurfaceEffects, AMaterialWithoutEffectsAddsNothing) {
    Pressed pressed({500.0, 0.0, 0.0, 0.0});
    EXPECT_EQ(pressed.added(pressed.hand, {1.0, 2.0, 3.0}, 123'456), Vec3(0.0));
}

TEST(SurfaceEffects, ViscosityDragsAlongTheSurfaceOnly) {
    TouchMaterial material{500.0, 0.0, 0.0, 0.0};
    material.viscosity = 2.0;
    Pressed pressed(material);
    EXPECT_LT(glm::distance(pressed.added(pressed.hand, {0.3, -5.0, -0.1}), Vec3(-0.6, 0.0, 0.2)), 1e-12);
}

TEST(SurfaceEffects, VibrationIsASineAlongTheNormal) {
    TouchMaterial material{500.0, 0.0, 0.0, 0.0};
    material.vibration_force = 0.5;
    material.vibration_frequency = 100.0;
    Pressed pressed(material);
    EXPECT_LT(glm::distance(pressed.added(pressed.hand, Vec3(0.0), 2'500'000), Vec3(0.0, 0.5, 0.0)), 1e-9);
    EXPECT_LT(glm::distance(pressed.added(pressed.hand, Vec3(0.0), 7'500'000), Vec3(0.0, -0.5, 0.0)), 1e-9);
    EXPECT_LT(glm::length(pressed.added(pressed.hand, Vec3(0.0), 10'000'000)), 1e-9);
}

TEST(SurfaceEffects, StickSlipHoldsLikeASpringUntilItSlips) {
    TouchMaterial material{500.0, 0.0, 0.0, 0.0};
    material.stick_slip_stiffness = 100.0;
    material.stick_slip_force = 1.0;
    Pressed pressed(material);
    EXPECT_LT(glm::length(pressed.added({0.0, 0.03, 0.0})), 1e-12);
    EXPECT_NEAR(pressed.added({0.005, 0.03, 0.0}).x, -0.5, 1e-12);
    EXPECT_NEAR(pressed.added({0.0099, 0.03, 0.0}).x, -0.99, 1e-12);
    EXPECT_EQ(pressed.added({0.0101, 0.03, 0.0}).x, 0.0);  // slipped, stuck anew
    EXPECT_NEAR(pressed.added({0.0151, 0.03, 0.0}).x, -0.5, 1e-12);
}

TEST(SurfaceEffects, StickSlipForgetsWhenTheHandLeaves) {
    TouchMaterial material{500.0, 0.0, 0.0, 0.0};
    material.stick_slip_stiffness = 100.0;
    material.stick_slip_force = 1.0;
    Pressed pressed(material);
    pressed.added({0.0, 0.03, 0.0});
    pressed.added({0.0, 0.2, 0.0});
    EXPECT_LT(glm::length(pressed.added({0.005, 0.03, 0.0})), 1e-12);
}

TouchMaterial ringing() {
    TouchMaterial material{500.0, 0.0, 0.0, 0.0};
    material.impact_strength = 5.0;
    material.impact_frequency = 100.0;
    material.impact_decay = 0.02;
    return material;
}

constexpr Nanoseconds milliseconds = 1'000'000;

TEST(SurfaceEffects, WhatIsMetRingsByTheSpeedAndDecays) {
    Pressed pressed(ringing());
    const Vec3 into(0.4, -0.2, 0.0);
    EXPECT_EQ(pressed.added(pressed.hand, into, 0), Vec3(0.0));  // it begins without a jump
    for (int i = 1; i <= 100; ++i) {
        // However fast the hand is by now.
        const Vec3 felt = pressed.added(pressed.hand, {0.0, 3.0, 0.0}, i * milliseconds);
        const double t = 1e-3 * i;
        const double ringing = 5.0 * 0.2 * std::exp(-t / 0.02) * std::sin(2.0 * 3.14159265358979 * 100.0 * t);
        ASSERT_LT(glm::distance(felt, Vec3(0.0, ringing, 0.0)), 1e-9) << i;
    }
}

TEST(SurfaceEffects, WhatIsLetGoOfIsMetAnew) {
    Pressed pressed(ringing());
    pressed.added(pressed.hand, {0.0, -0.2, 0.0}, 0);
    pressed.added({0.0, 0.2, 0.0}, {0.0, 0.2, 0.0}, 50 * milliseconds);
    pressed.added(pressed.hand, {0.0, -0.1, 0.0}, 100 * milliseconds);
    const double quarter = pressed.added(pressed.hand, Vec3(0.0), 102'500'000).y;
    EXPECT_NEAR(quarter, 5.0 * 0.1 * std::exp(-0.0025 / 0.02), 1e-9);
}

// One that rises while the hand draws back has not been met by it.
TEST(SurfaceEffects, AHandThatLeavesFeelsNoTap) {
    Pressed pressed(ringing());
    pressed.added(pressed.hand, {0.0, 0.2, 0.0}, 0);
    EXPECT_EQ(pressed.added(pressed.hand, Vec3(0.0), 2'500'000), Vec3(0.0));
}

TEST(SurfaceEffects, StickSlipForgetsNoPull) {
    TouchMaterial material{500.0, 0.0, 0.0, 0.0};
    material.stick_slip_stiffness = 100.0;
    material.stick_slip_force = 1.0;
    Pressed pressed(material);
    pressed.memory.pulled = {0.0, -1.0, 0.0};
    pressed.added(pressed.hand);
    EXPECT_EQ(pressed.memory.pulled, Vec3(0.0, -1.0, 0.0));
}

TEST(SurfaceEffects, MagnetFadesFromTouchToItsRange) {
    TouchMaterial material;
    material.magnet_force = 3.0;
    material.magnet_range = 0.02;
    EXPECT_EQ(magnet_pull(material, 0.0), 3.0);
    EXPECT_NEAR(magnet_pull(material, 0.01), 1.5, 1e-12);
    EXPECT_EQ(magnet_pull(material, 0.02), 0.0);
    EXPECT_EQ(magnet_pull(material, 1.0), 0.0);
    EXPECT_EQ(magnet_pull(material, -0.01), 3.0);
}

ImageSample sample_texture(const TouchMaterial& material, const Vec3& point, const Vec3& normal) {
    const TouchImage& image = *material.detail->images.heights;
    return sample(image, place_in_frame(image, material.texture_size, point, normal), material.texture_depth);
}

TouchImage bumps() {
    return {3, 2, {0.0f, 0.5f, 1.0f, 0.25f, 0.75f, 0.1f}};
}

TEST(SurfaceEffects, TextureGradientIsTheSlopeOfItsHeight) {
    const auto image = std::make_shared<const TouchImage>(bumps());
    const TouchDetail detail{{image, nullptr}, {}};
    TouchMaterial material;
    material.detail = &detail;
    material.texture_size = 0.03;
    material.texture_depth = 0.002;
    RandomValues random(141);
    constexpr double h = 1e-7;
    for (const Vec3& normal : {Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)}) {
        for (int i = 0; i < 300; ++i) {
            const Vec3 p = random.in_box(0.1);
            const ImageSample at = sample_texture(material, p, normal);
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 step(0.0);
                step[axis] = h;
                const double ahead = sample_texture(material, p + step, normal).value;
                const double behind = sample_texture(material, p - step, normal).value;
                const double one_sided = (ahead - at.value) / h;
                const double slope = (ahead - behind) / (2.0 * h);
                if (std::abs(one_sided - slope) < 1e-4) {  // not across a pixel's border
                    ASSERT_NEAR(at.gradient[axis], slope, 1e-4) << "axis " << axis;
                }
            }
        }
    }
}

TEST(SurfaceEffects, TextureRepeatsAndIsContinuousAcrossItsBorder) {
    const auto image = std::make_shared<const TouchImage>(bumps());
    const TouchDetail detail{{image, nullptr}, {}};
    TouchMaterial material;
    material.detail = &detail;
    material.texture_size = 0.03;
    material.texture_depth = 0.002;
    const Vec3 up(0.0, 1.0, 0.0);
    RandomValues random(142);
    for (int i = 0; i < 300; ++i) {
        const Vec3 p = random.in_box(0.1);
        const double here = sample_texture(material, p, up).value;
        EXPECT_NEAR(sample_texture(material, p + Vec3(0.03, 0.0, -0.06), up).value, here, 1e-9);
        EXPECT_GE(here, 0.0);
        EXPECT_LE(here, 0.002);
    }
    EXPECT_NEAR(sample_texture(material, {0.03 - 1e-12, 0.0, 0.011}, up).value,
                sample_texture(material, {0.03 + 1e-12, 0.0, 0.011}, up).value, 1e-9);
}

// The relief's force is the slope of an energy: drawn around a closed way at constant depth it does no work.
TEST(SurfaceEffects, ATextureGivesBackWhatItTook) {
    const auto image = std::make_shared<const TouchImage>(bumps());
    const TouchDetail detail{{image, nullptr}, {}};
    TouchMaterial material{500.0, 0.0, 0.0, 0.0};
    material.detail = &detail;
    material.texture_size = 0.03;
    material.texture_depth = 0.001;
    Pressed pressed(material);
    double work = 0.0;
    double size = 0.0;
    Vec3 before(0.0, 0.03, 0.0);
    Vec3 force_before = pressed.added(before);
    constexpr int steps = 20'000;
    for (int i = 1; i <= steps; ++i) {
        const double a = 2.0 * 3.14159265358979 * i / steps;
        const Vec3 at(0.02 * std::sin(a), 0.03, 0.02 - 0.02 * std::cos(a));
        const Vec3 force = pressed.added(at);
        const double part = glm::dot(0.5 * (force + force_before), at - before);
        work += part;
        size += std::abs(part);
        before = at;
        force_before = force;
    }
    EXPECT_LT(std::abs(work), 2e-3 * size);
}

TEST(SurfaceEffects, APullTurnsGradually) {
    EffectMemory memory;
    Vec3 before(0.0);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 spinning = 1e6 * Vec3(std::cos(2.0 * i), std::sin(2.0 * i), 0.0);
        const Vec3 pull = gradual_pull(spinning, 1e-3 * max_pull_rate, 0, memory);
        ASSERT_LE(glm::distance(pull, before), 1e-3 * max_pull_rate * (1.0 + 1e-12));
        before = pull;
    }
    for (int i = 0; i < 100; ++i) {
        before = gradual_pull({0.0, 3.0, 0.0}, 1e-3 * max_pull_rate, 0, memory);
    }
    EXPECT_EQ(before, Vec3(0.0, 3.0, 0.0));
    EXPECT_EQ(gradual_pull({0.0, 9.0, 0.0}, 1e-3 * max_pull_rate, 1, memory), Vec3(0.0, 9.0, 0.0));
}

}  // namespace
}  // namespace tactus::surface_effects_test
