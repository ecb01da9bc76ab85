// Stacks that have to stand.
#include <vector>

#include "credibility/cases.hpp"

namespace tactus::bench {

namespace {

// How long it stands: until its top is a tenth of its edge below where it began (unit: seconds).
double stands(int boxes, double top_mass, double seconds) {
    constexpr Vec3 size{0.1, 0.05, 0.1};
    PhysicsWorld world;
    enter(world, shared::ground(1.0));
    BodyId top;
    for (int i = 0; i < boxes; ++i) {
        BodyDescription body = shared::box(size, {0.0, size.y * (i + 0.5), 0.0}, 0.5, 0.5);
        body.mass = i == boxes - 1 ? top_mass : 0.5;
        body.can_sleep = false;
        top = enter(world, body);
    }
    const double begins = world.pose(top).position.y;
    return run_until(world, seconds,
                     [&](double) { return world.pose(top).position.y < begins - 0.1 * size.y; });
}

}  // namespace

void measure_stacks(Results& results) {
    results.add("stack20.stands_s", stands(20, 0.5, 120.0));
    results.add("heavy_top.stands_s", stands(5, 50.0, 20.0));
}

}  // namespace tactus::bench
