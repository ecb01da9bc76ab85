// Two sessions with the same bodies and tools, joined by a link: what a test of tools over a link stands on.
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "core/tool/tool_shape.hpp"
#include "linked_places.hpp"
#include "shared/meshes.hpp"

namespace tactus::session_test {

// A bar of 200 mm along x, 20 mm thick.
inline std::shared_ptr<const ToolShape> bar() {
    static const ToolShapeResult made = make_tool_shape(shared::box({0.1, 0.01, 0.01}), {1e-3, 200});
    return made.shape;
}

inline ToolUse held_by(SessionHandle device) {
    ToolUse use;
    use.device = device;
    return use;
}

// As the far side is told of it: the same hand without a link is the same.
inline void put(HeldDevice& device, const Vec3& position, const Quat& rotation,
                const Vec3& velocity = Vec3(0.0)) {
    device.position = position_as_sent(position);
    device.rotation = rotation_as_sent(rotation);
    device.velocity = velocity_as_sent(velocity);
}

// Both sides with tools in place of fingertips: one for each hand, in the order of `shapes`.
class LinkedTools : public LinkedPlaces {
public:
    using Shapes = std::vector<std::shared_ptr<const ToolShape>>;

    explicit LinkedTools(double delay, double loss = 0.0, const TeleopSettings& here = {},
                         const TeleopSettings& there = {}, InputRecorder* near_inputs = nullptr,
                         InputRecorder* far_inputs = nullptr, const Shapes& shapes = {bar()})
        : LinkedPlaces(delay, loss, static_cast<int>(shapes.size()), here, there, 64, near_inputs,
                       far_inputs) {
        for (Place* const place : {&near, &far}) {
            for (std::size_t i = 0; i < shapes.size(); ++i) {
                place->session.remove_proxy(static_cast<SessionHandle>(i));
                let_turn(place->devices[i]);
                EXPECT_EQ(place->session.add_tool(shapes[i], held_by(static_cast<SessionHandle>(i))).error,
                          "");
            }
        }
    }
    HeldDevice& hand(std::size_t tool = 0) { return near.devices[tool]; }
    const ToolState& ours(std::size_t tool = 0) const { return near.session.snapshot().tools[tool]; }
    const ToolState& theirs(std::size_t tool = 0) const { return far.session.snapshot().tools[tool]; }
};

inline BodyAddition floor_of(double friction) {
    BodyAddition made = ground();
    made.description.material.friction = friction;
    made.touch_material = {1000.0, 0.0, friction, friction};
    return made;
}

inline BodyAddition block(double mass, double friction, double x = 0.2) {
    BodyAddition made = body(BoxShape{Vec3(0.05)}, {x, 0.05, 0.0}, Motion::Dynamic, mass);
    made.description.material.friction = friction;
    made.touch_material = {1000.0, 0.0, friction, friction};
    return made;
}

}  // namespace tactus::session_test
