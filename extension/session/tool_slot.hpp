// A tool in the loop: what the hand holds it by, and what comes of it in a tick. Private to session/.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>

#include "core/haptics/fading_force.hpp"
#include "core/math/bit_hash.hpp"
#include "core/math/wrench.hpp"
#include "core/teleop/jitter_buffer.hpp"
#include "core/tool/tool_group.hpp"
#include "core/tool/tool_pair.hpp"
#include "core/tool/tool_proxy.hpp"
#include "network/messages.hpp"
#include "session/session_types.hpp"

namespace tactus {

static_assert(first_tool == max_proxies);
static_assert(max_tools <= ToolGroup::max_tools && max_tools - 1 <= ToolProxy::max_pairs);

// What holds a tool.
struct ToolHand {
    Pose goal;                            // where it would have the tool, in the world
    Vec3 velocity{0.0};                   // of that place (unit: meters per second)
    Vec3 spin{0.0};                       // (unit: radians per second)
    Vec3 place{0.0};                      // of the hand itself, which torques are about (unit: meters)
    double share = 1.0;                   // of the coupling: what of it the device can render safely
    double fade = FadingForce::max_step;  // see FadingForce::Step (unit: newtons)
    double turn_fade = FadingWrench::max_torque_step;  // likewise (unit: newton meters)
    bool holds = false;                                // else it touches nothing
    bool fixed = false;  // what carries the tool at the far side cannot turn: the hand's turn means nothing
    AidForce aid{};      // acts at the hand's place, besides what the tool touches

    Vec3 velocity_at(const Vec3& point) const { return velocity + glm::cross(spin, point - goal.position); }
};

// What a tool touches, as one that asks for its surface knows it.
inline Touch surface_of(const ToolTouch& touch) {
    Touch surface;
    surface.point = touch.point;
    surface.normal = touch.normal;
    surface.body = touch.body;
    surface.feature = touch.feature;
    return surface;
}

struct ToolSlot {
    ToolSlot(std::shared_ptr<const ToolShape> shape, std::size_t max_parts, const ToolUse& first_use)
        : proxy(std::move(shape), max_parts, first_use.settings),
          shape_number(number_of(proxy.shape())),
          use(first_use) {}

    ToolProxy proxy;
    std::uint64_t shape_number;  // alike on both sides of a link where the spheres are
    // With the tools that were there before it, by handle, and what moves all of them: null where there were
    // none.
    std::array<std::unique_ptr<ToolPair>, max_tools> pairs;
    std::unique_ptr<ToolGroup> group;
    ToolUse use;
    ToolHand hand;
    Wrench wrench;            // of the scene as it is, about the hand; what that is given is in `state`
    double source = 0.0;      // energy that bodies on their way give the hand in this tick (unit: joules)
    double own_change = 0.0;  // of the force, see ForceExit::leave
    FadingWrench fading;      // from `wrench` to what is in `state`
    Vec3 turned{0.0};         // by the hand, all its turns added up (unit: radians)
    bool jumped = false;      // see ProxyTick
    bool rested = false;      // since the last tick
    bool changed = false;     // by its owner since the last tick
    AidMemory aids;
    HandField field;        // that its owner computes, see Session::set_hand_field
    bool is_fixed = false;  // hand.fixed, as the proxy's settings have it
    ToolState state;
    ImpactWatch impacts;
    TouchEvents events;
    // Where an operator's hand holds it: what came of that. Null: no far side says so.
    std::unique_ptr<JitterBuffer<OperatorSample>> heard;
    std::uint64_t heard_settings = 0;  // see PlayedHands

    static std::uint64_t number_of(const ToolShape& shape) {
        BitHash hash;
        for (const ToolSphere& sphere : shape.spheres) {
            hash.add(sphere.center);
            hash.add(sphere.radius);
        }
        return hash.value();
    }

    // It touches nothing.
    void let_go() {
        proxy.restart();
        wrench = {};
        source = 0.0;
        aids = {};
        jumped = true;
        state = {};
        state.pose = hand.goal;
        state.hand = hand.goal;
        state.status = touch_unheld;
    }

    // What the hand's own way can have made of the force.
    FadingForce::Step step() const {
        return {hand.goal.position,
                hand.velocity,
                use.settings.stiffness * hand.share + hand.aid.wall.stiffness,
                hand.aid.wall.damping,
                hand.fade,
                state.pose.position};
    }
    // The same of its turn and the torque.
    FadingForce::Step turn() const {
        return {turned, Vec3(0.0), use.settings.turning_stiffness * hand.share, 0.0, hand.turn_fade};
    }
    // L of nearest_motion.hpp (unit: meters).
    double coupling_length() const {
        return std::sqrt(use.settings.turning_stiffness / use.settings.stiffness);
    }
    // How far the hand would have the tool from `pose`, turns counted as ways (unit: meters).
    double stretch(const Pose& pose) const {
        return glm::distance(hand.goal.position, pose.position) +
               coupling_length() * angle_between(hand.goal.rotation, pose.rotation);
    }
    // Of a tool that cannot turn, the coupling holds its rotation so firmly that a force at its rim, which
    // moves it there by some way, turns it there by a thousandth of that.
    void settle_settings() {
        constexpr double firmness = 30.0;
        ToolSettings settings = use.settings;
        if (is_fixed) {
            const double length = firmness * proxy.shape().reach;
            settings.turning_stiffness = settings.stiffness * length * length;
        }
        proxy.set_settings(settings);
    }
};

}  // namespace tactus
