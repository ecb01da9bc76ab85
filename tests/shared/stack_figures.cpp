#include "shared/stack_figures.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>

#include "core/geometry/solid.hpp"
#include "session/session.hpp"
#include "shared/bench_kit.hpp"
#include "shared/meshes.hpp"

namespace tactus::shared {

namespace {

constexpr double half_edge = 0.03;

class Hand final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        return {position, Quat(1.0, 0.0, 0.0, 0.0), velocity, 0, true};
    }
    void write(Nanoseconds, const Vec3&) override {}

    Vec3 position{0.0, 0.12, 0.0};
    Vec3 velocity{0.0};
};

BodyAddition body(const Shape& shape, const Vec3& position, Motion motion) {
    BodyAddition addition;
    addition.description.shapes = {PlacedShape{shape, Pose{}}};
    addition.description.pose.position = position;
    addition.description.motion = motion;
    addition.description.mass = 0.2;
    addition.touch_material = {1000.0, 0.0, 0.5, 0.4};
    return addition;
}

// Four, three, two and one.
void build_stack(Session& session) {
    for (int row = 0; row < 4; ++row) {
        for (int i = 0; i < 4 - row; ++i) {
            const Vec3 place{0.2, half_edge * (1 + 2 * row), 0.064 * (i - 0.5 * (3 - row))};
            session.add_body(body(BoxShape{Vec3(half_edge)}, place, Motion::Dynamic));
        }
    }
}

double least_gap(const SessionSnapshot& snapshot, const ToolShape& shape) {
    double least = std::numeric_limits<double>::infinity();
    const Solid solid = BoxShape{Vec3(half_edge)};
    for (const ToolSphere& sphere : shape.spheres) {
        const Vec3 center = to_parent(snapshot.tools[0].pose, sphere.center);
        for (std::size_t i = 0; i < snapshot.body_count; ++i) {
            const SolidDistance at = distance_to_solid(solid, to_local(snapshot.bodies[i].pose, center));
            least = std::min(least, at.distance - sphere.radius);
        }
    }
    return least;
}

}  // namespace

StackFigures push_stack(double speed, double aside) {
    const auto shape = make_tool_shape(box({0.02, 0.1, 0.02}), {2e-3, 500}).shape;
    Session session{SessionSettings{}};
    Hand hand;
    hand.position.z = aside;
    hand.velocity.x = speed;
    Workspace workspace;
    workspace.force_limit = 1e6;
    ToolUse use;
    use.device = session.add_device(hand, workspace).handle;
    session.add_tool(shape, use);
    session.add_body(body(PlaneShape{}, Vec3(0.0), Motion::Static));
    build_stack(session);
    session.settle();
    StackFigures figures;
    const SpanClock clock;
    for (int i = 0; hand.position.x < 0.4; ++i) {
        hand.position.x += speed * 1e-3;
        const std::uint64_t from = clock.now();
        session.tick((i + 1) * Nanoseconds{1'000'000});
        const std::uint64_t to = clock.now();
        session.refresh();
        const ToolState& tool = session.snapshot().tools[0];
        ++figures.tool.ticks;
        if ((tool.status & (tool_absent | tool_squeezed)) != 0) {
            ++figures.lost;
            continue;
        }
        figures.tool.unfinished += (tool.status & tool_unfinished) != 0;
        if ((tool.status & tool_touching) != 0) {
            ++figures.tool.contact_ticks;
            figures.tool.microseconds.push_back(1e-3 * clock.nanoseconds(from, to));
        }
        const double gap = least_gap(session.snapshot(), *shape);
        figures.tool.penetrations += gap < -shape->tolerance;
        figures.tool.deepest = std::max(figures.tool.deepest, -gap);
    }
    const SessionSnapshot& end = session.snapshot();
    for (std::size_t i = 0; i < end.body_count; ++i) {
        figures.highest = std::max(figures.highest, end.bodies[i].pose.position.y);
    }
    return figures;
}

}  // namespace tactus::shared
