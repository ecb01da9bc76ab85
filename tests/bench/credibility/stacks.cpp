// Stacks that have to stand.
#include <vector>

#include "credibility/cases.hpp"

namespace tactus::bench {

namespace {

// Boxes, or cans, on each other.
struct Stack {
    int count;
    double top_mass = 0.5;  // (unit: kilograms)
    Vec3 size{0.1, 0.05, 0.1};
    bool cans = false;
};

// How long it stands: until its top is a tenth of its height below where it began (unit: seconds).
double stands(const Stack& stack, double seconds) {
    const Vec3 size = stack.size;
    PhysicsWorld world;
    enter(world, shared::ground(1.0));
    BodyId top;
    for (int i = 0; i < stack.count; ++i) {
        BodyDescription body = shared::box(size, {0.0, size.y * (i + 0.5), 0.0}, 0.5, 0.5);
        body.mass = i == stack.count - 1 ? stack.top_mass : 0.5;
        if (stack.cans)
            body.shapes = shared::one(CylinderShape{0.5 * size.x, 0.5 * size.y});
        body.can_sleep = false;
        top = enter(world, body);
    }
    const double begins = world.pose(top).position.y;
    return run_until(world, seconds,
                     [&](double) { return world.pose(top).position.y < begins - 0.1 * size.y; });
}

}  // namespace

void measure_stacks(Results& results) {
    results.add("stack20.stands_s", stands({20}, 120.0));
    results.add("cans10.stands_s", stands({10, 0.5, {0.06, 0.1, 0.06}, true}, 60.0));
    results.add("heavy_top.stands_s", stands({5, 50.0}, 20.0));
}

}  // namespace tactus::bench
