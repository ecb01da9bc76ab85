#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "physics/scenes.hpp"

namespace tactus::bench {

namespace {

// The finger pushes the box at 30 mm/s for ten seconds; the first half second is the start.
void push(Results& results) {
    constexpr double speed = 0.03;
    Rig rig(8, 1000.0);
    rig.add(ground());
    const SessionHandle handle = rig.add(box(Vec3(edge), {0.0, 0.5 * edge, 0.0}, 1.0));
    rig.settle();
    double x = -0.5 * edge - Rig::radius - 0.002;
    double largest_gap = 0.0;
    int lost = 0;
    std::vector<double> forces;
    for (int i = 0; i < 10'000; ++i) {
        x += speed * tick;
        rig.hand.position = {x, 0.4 * edge, 0.0};
        rig.hand.velocity = {speed, 0.0, 0.0};
        rig.step();
        const SessionSnapshot& snapshot = rig.look();
        if (i < 500)
            continue;
        const double face = rig.pose(handle).position.x - 0.5 * edge;
        largest_gap = std::max(largest_gap, std::abs(face - Rig::radius - snapshot.proxies[0].position.x));
        forces.push_back(-snapshot.proxies[0].force.x);
        lost += snapshot.proxies[0].contact_count > 0 ? 0 : 1;
    }
    double mean = 0.0;
    for (const double force : forces)
        mean += force / static_cast<double>(forces.size());
    // First-order high pass at 30 Hz.
    const double keep = 1.0 / (1.0 + 2.0 * std::numbers::pi * 30.0 * tick);
    double passed = 0.0;
    double square = 0.0;
    for (std::size_t i = 1; i < forces.size(); ++i) {
        passed = keep * (passed + forces[i] - forces[i - 1]);
        square += passed * passed / static_cast<double>(forces.size());
    }
    results.add("push_gap_max_um", largest_gap * 1e6);
    results.add("push_mean_force", mean);
    results.add("push_force_noise_percent", 100.0 * std::sqrt(square) / mean);
    results.add("push_ticks_lost", lost);
}

// Pressed with 8 N a little off its middle; the largest way of a corner to and fro in the last of three
// seconds.
void press(Results& results, const std::string& name, double size) {
    constexpr double stiffness = 1000.0;
    Rig rig(8, stiffness);
    rig.add(ground());
    const Vec3 start{0.0, 0.5 * size, 0.0};
    BodyDescription cube = box(Vec3(size), start, 1000.0 * size * size * size);
    cube.can_sleep = false;
    const SessionHandle handle = rig.add(cube);
    rig.settle();
    const Vec3 above{0.1 * size, size + Rig::radius, 0.05 * size};
    std::array<Vec3, 8> low;
    std::array<Vec3, 8> high;
    double force = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const double depth = std::min(1.0, i / 300.0) * 8.0 / stiffness;
        rig.hand.position = above + Vec3(0.0, 0.001 - depth * (1.0 + 0.001 / (8.0 / stiffness)), 0.0);
        rig.step();
        if (i < 2000)
            continue;
        const Pose pose = rig.pose(handle);
        force = rig.hand.force.y;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const Vec3 side((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                            (corner & 4) != 0 ? 0.5 : -0.5);
            const Vec3 at = to_parent(pose, size * side);
            low[corner] = i == 2000 ? at : glm::min(low[corner], at);
            high[corner] = i == 2000 ? at : glm::max(high[corner], at);
        }
    }
    double most = 0.0;
    for (std::size_t corner = 0; corner < 8; ++corner)
        most = std::max(most, glm::length(high[corner] - low[corner]));
    results.add(name + "_force", force);
    results.add(name + "_rest_um", most * 1e6);
}

}  // namespace

void measure_feel(Results& results) {
    push(results);
    press(results, "press_20mm", 0.02);
    press(results, "press_5mm", 0.005);
}

}  // namespace tactus::bench
