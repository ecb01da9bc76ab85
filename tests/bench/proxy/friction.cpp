#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "core/haptics/force_law.hpp"
#include "proxy/even.hpp"
#include "shared/meshes.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::bench {

namespace {

// Largest deviation from Coulomb while the hand is drawn along a groove (180 degrees: a plane) at constant
// depth.
double friction_error_percent(double degrees) {
    constexpr double radius = 0.05;
    constexpr double depth = 0.02;
    const double half = 0.5 * degrees * std::numbers::pi / 180.0;
    double worst = 0.0;
    for (const double friction : {0.1, 0.3, 0.5, 1.0}) {
        shared::TouchRig rig(radius);
        rig.add(shared::groove(2.0 * half, 20.0), {}, TouchMaterial{1.0, 0.0, friction, friction});
        const double height = radius / std::sin(half);
        rig.draw({0.0, height + 0.01, -2.0}, {0.0, height - depth, -2.0}, 20);
        for (int i = 0; i <= 4'000; ++i) {
            const Vec3 hand(0.0, height - depth, -2.0 + 0.001 * i);
            const ProxyTick tick = rig.tick(hand);
            if (i < 1'000) {
                continue;
            }
            const Vec3 force =
                contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3).total;
            const double coulomb =
                friction * depth / std::sin(half);  // both walls: 2 * depth / (2 sin(half))
            worst = std::max(worst, 100.0 * std::abs(-force.z / coulomb - 1.0));
        }
    }
    return worst;
}

// How far the proxy strays while the hand rests for a million ticks (unit: meters).
double still_movement_max() {
    double worst = 0.0;
    const TriangleMesh sphere = shared::icosphere(4, 1.0);
    const TriangleMesh hills = shared::terrain(64, 2.0, 0.1);
    for (int scene = 0; scene < 4; ++scene) {
        shared::TouchRig rig(0.02);
        const double friction = scene % 2 ? 0.3 : 0.0;
        rig.add(scene < 2 ? sphere : hills, {}, TouchMaterial{1.0, 0.0, friction, friction});
        const Vec3 hand = scene < 2 ? Vec3(0.1, 0.95, 0.05) : Vec3(0.11, -0.2, 0.23);
        rig.draw(hand + Vec3(0.05, 0.6, 0.02), hand, 200);
        for (int i = 0; i < 200; ++i) {
            rig.tick(hand);
        }
        const Vec3 settled = rig.proxy.position();
        for (int i = 0; i < 250'000; ++i) {
            worst = std::max(worst, glm::distance(rig.tick(hand).position, settled));
        }
    }
    return worst;
}

}  // namespace

void measure_friction(shared::Report& report) {
    constexpr std::pair<const char*, double> grooves[] = {
        {"plane", 180.0}, {"groove60", 60.0}, {"groove90", 90.0}, {"groove120", 120.0}};
    for (const auto& [name, degrees] : grooves) {
        const double error = friction_error_percent(degrees);
        report.set(std::string("friction.") + name + "_error_percent", error);
        std::printf("friction, %s: %.4f %% off Coulomb\n", name, error);
    }
}

void measure_still_hand(shared::Report& report) {
    const double movement = still_movement_max();
    report.set("still.movement_max", movement);
    std::printf("still hand: proxy moved by %g m in 10^6 ticks\n", movement);
}

}  // namespace tactus::bench
