#include "proxy/kernels.hpp"

#include <array>
#include <cstdio>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "core/proxy/constrained_step.hpp"
#include "core/proxy/nearest_in_halfspaces.hpp"
#include "core/proxy/tolerances.hpp"
#include "core/tree/pack_memory.hpp"
#include "core/tree/triangle_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus::bench {

namespace {

constexpr double radius = 0.05;
constexpr int calls = 2'000;

volatile double kept = 0.0;  // so that no call is left out

struct Kernels {
    const shared::SpanClock& clock;
    int rounds;
    shared::Report& report;

    // Median time of call(i) for i below `calls`.
    template <class Call>
    void measure(const char* name, Call&& call) const {
        std::vector<double> times;
        for (int round = 0; round < rounds; ++round) {
            double sum = 0.0;
            const std::uint64_t start = clock.now();
            for (int i = 0; i < calls; ++i) {
                sum += call(i);
            }
            times.push_back(clock.nanoseconds(start, clock.now()) / calls);
            kept = kept + sum;
        }
        const double median = shared::quantile(times, 0.5);
        report.set(std::string("kernel.") + name + "_ns", median);
        std::printf("kernel %-24s %9.1f ns\n", name, median);
    }
};

// Contact planes around a place, no two alike: the cap of a sphere seen from its middle.
std::vector<HalfSpace> planes_of(int count) {
    shared::RandomValues random(31);
    std::vector<HalfSpace> planes;
    for (int i = 0; i < count; ++i) {
        const Vec3 normal = glm::normalize(Vec3(0.0, 1.0, 0.0) + 0.3 * random.in_ball(1.0));
        planes.push_back({normal, -random.between(0.0, 1e-3) * radius});
    }
    return planes;
}

}  // namespace

void measure_kernels(const shared::SpanClock& clock, int rounds, shared::Report& report) {
    const TriangleTree tree = TriangleTree::build(shared::icosphere(6, 1.0), shared::run_on_two_threads);
    shared::RandomValues random(30);
    struct Way {
        Vec3 start, motion;
        std::uint32_t pack;
    };
    std::vector<Way> ways;  // from above the surface, into it
    for (int i = 0; i < calls; ++i) {
        const Vec3 direction = random.direction();
        const Vec3 start = direction * (1.0 + radius * 1.001);
        ways.push_back(
            {start, 0.002 * random.direction() - 1e-3 * direction, tree.nearest(start, 2.0 * radius).pack});
    }
    const auto way = [&](int i) -> const Way& { return ways[static_cast<std::size_t>(i)]; };
    const auto sphere = [&](int i) { return SphereWay{way(i).start, way(i).motion, radius, 1e-9}; };
    constexpr std::int64_t plenty = 1'000'000;
    const Kernels kernels{clock, rounds, report};

    kernels.measure("pack_distance", [&](int i) {
        return smallest(tree.offset_from_pack(way(i).pack, splat(way(i).start)).squared);
    });
    kernels.measure("pack_sweep", [&](int i) {
        TrianglePack room;
        return sweep_to_triangles(tree.pack(way(i).pack, room), sphere(i), 1.0).t;
    });
    kernels.measure("tree_nearest", [&](int i) { return tree.nearest(way(i).start, 2.0 * radius).distance; });
    kernels.measure("tree_least_distance", [&](int i) {
        WorkBudget work(plenty);
        return tree.least_distance(1.5 * way(i).start, work);
    });
    kernels.measure("tree_gather", [&](int i) {
        std::array<FoundPack, PackMemory::capacity> packs;
        WorkBudget work(plenty);
        return tree.packs_around(way(i).start, 1.02 * radius, work, packs).radius;
    });
    kernels.measure("tree_sweep", [&](int i) {
        WorkBudget work(plenty);
        return tree.sweep(sphere(i), 1.0, work).t;
    });
    for (const int count : {3, 16, 128}) {
        const std::vector<HalfSpace> planes = planes_of(count);
        const std::string name = "solver_" + std::to_string(count);
        kernels.measure(name.c_str(), [&](int i) {
            WorkBudget work(plenty);
            return nearest_in_halfspaces(radius * way(i).motion - Vec3(0.0, 0.01, 0.0), planes, 1e-14, work)
                .point.y;
        });
        ContactList contacts;
        for (const HalfSpace& plane : planes) {
            Contact contact;
            contact.normal = plane.normal;
            contact.gap = -plane.offset;
            contacts.add(contact);
        }
        const std::string step = "constrained_step_" + std::to_string(count);
        kernels.measure(step.c_str(), [&](int i) {
            WorkBudget work(plenty);
            return flat_step(radius * way(i).motion - Vec3(0.0, 0.01, 0.0), contacts, 1e-14, work).motion.y;
        });
    }
}

}  // namespace tactus::bench
