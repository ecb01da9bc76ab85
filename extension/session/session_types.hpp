// What goes into a session and what comes out of it: plain values, made and read off the loop.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/haptics/force_law.hpp"
#include "core/haptics/hand_aids.hpp"
#include "core/math/body_motion.hpp"
#include "core/math/pose.hpp"
#include "core/ports/device.hpp"
#include "core/proxy/proxy_settings.hpp"
#include "core/safety/hand_safety.hpp"
#include "core/safety/stiffness_limit.hpp"
#include "core/teleop/seen_pose.hpp"
#include "core/tool/soft_finger.hpp"
#include "core/tool/tool_settings.hpp"
#include "physics/physics_world.hpp"
#include "session/hand_mapping.hpp"
#include "session/touch_events.hpp"

namespace tactus {

// Names a body, device or proxy of one session; given out by the session's owner side.
using SessionHandle = std::uint32_t;
constexpr SessionHandle no_handle = 0xffff'ffffu;

constexpr std::size_t max_devices = 8;
constexpr std::size_t max_recordings = 8;
constexpr std::size_t max_proxies = 16;
constexpr std::size_t max_tools = 4;
constexpr std::size_t max_led = 64;

// Proxies and tools counted together.
constexpr SessionHandle hand_of_tool(SessionHandle tool) {
    return static_cast<SessionHandle>(max_proxies) + tool;
}

struct SessionSettings {
    Nanoseconds period = 1'000'000;   // of a tick, > 0
    std::uint32_t max_bodies = 4096;  // that may be in the session at once
    std::uint32_t max_parts = 8192;   // shapes of all of them together
    // When more are awake, physics far from every hand takes fewer, longer steps (PhysicsSettings).
    std::uint32_t full_rate_bodies = 32;
    // Taken from the owner in one tick; the rest waits for the next. A dynamic body that comes counts as
    // four: it is awake at first, and its contacts are new.
    std::uint32_t commands_per_tick = 64;
    PhysicsSettings physics;
};

struct ProxyDescription {
    SessionHandle device = no_handle;
    ProxySettings settings;
    ForceLaw force_law = ForceLaw::spring;
    SoftFinger finger;  // what bodies are held by against turning
    HandAids aids{};    // act on the hand besides what it touches
    bool enabled = true;
};

// How a hand holds a tool.
struct ToolUse {
    SessionHandle device = no_handle;
    ToolSettings settings;
    Pose grasp;       // of the tool in the hand's frame
    HandAids aids{};  // act on the hand besides what the tool touches
    bool enabled = true;
};

// Where a body is seen to be, and how it moves there.
struct BodySighting {
    BodyMotion motion;  // when it was seen
    double age = 0.0;   // since then (unit: seconds), >= 0
    PoseDoubt doubt;
};

// Bits of the TickStatus a session's tick returns (realtime/tick_status.hpp has the loop's own).
enum SessionStatus : std::uint32_t {
    session_step_pairs_full = 1u << 0,  // see StepStatus
    session_step_contacts_full = 1u << 1,
    session_step_memory_full = 1u << 2,
    session_full = 1u << 3,           // a body, device or proxy found no place
    session_force_limited = 1u << 4,  // a force was longer than its device's limit
    session_proxy_unfinished = 1u << 5,
    session_record_lost = 1u << 6,  // a recorder's ring was full
    session_commands_waiting = 1u << 7,
    session_body_lost = 1u << 8,  // a body left the range of numbers and was put back where it was, asleep
};

// That a body which moves takes the place of. Where it is not farther than `within` from where the new one is
// said to be, that goes on where it is then, and as it moves. It is to be removed next.
struct FormerBody {
    SessionHandle body = no_handle;
    double within = 0.0;  // (unit: meters)
};

// What a dynamic body is given at once, in the next tick.
struct BodyPush {
    Vec3 impulse{0.0};     // in the world (unit: newton seconds)
    Vec3 point{0.0};       // where, from the body's own place, in the world's axes (unit: meters)
    bool central = false;  // at its centre of mass instead
    Vec3 turn{0.0};        // angular impulse, in the world (unit: newton meter seconds)
};

// What puts a led body (Session::lead_body) right: it is compared elsewhere with what really moves it.
struct BodyCorrection {
    Vec3 by{0.0};    // moved by, spread over `seconds` (unit: meters)
    Vec3 turn{0.0};  // turned by meanwhile, about its own place: a vector along its axis (unit: radians)
    double seconds = 0.0;    // >= 0; 0: at once, without a way there
    Vec3 linear{0.0};        // added to its velocity at once (unit: meters per second)
    Vec3 angular{0.0};       // and to its spin (unit: radians per second)
    Vec3 acceleration{0.0};  // from now on, besides its physics (unit: meters per square second)
    Vec3 spin_up{0.0};       // and of its spin (unit: radians per square second)
    double mass = 1.0;       // from now on, of its own mass and inertia (dimensionless), > 0
};

// A led body after a tick. Sums run since it is led, and say nothing where it is not Motion::Dynamic.
struct LedState {
    SessionHandle handle = no_handle;
    BodyMotion motion;
    Vec3 impulse{0.0};  // that hands have given it, in the world (unit: newton seconds)
    Vec3 turn{0.0};     // about its centre of mass (unit: newton meter seconds)
    Vec3 spun{0.0};     // what that alone has changed its spin by (unit: radians per second)
    // Where its velocities alone have led it, without what it was moved and turned by (units: meters,
    // radians).
    Vec3 way{0.0}, turned{0.0};
    double seconds = 0.0;  // in which they did
    double mass = 0.0;     // (unit: kilograms)
    // Of all corrections, what has been carried out: sums of BodyCorrection's by, turn, linear and angular,
    // and the last mass.
    BodyCorrection corrected;
};

struct BodyState {
    SessionHandle handle = no_handle;
    Pose pose;
    Vec3 linear_velocity{0.0};     // (unit: meters per second)
    Vec3 angular_velocity{0.0};    // (unit: radians per second)
    std::uint64_t changed_at = 0;  // tick
    // So many teleport_body(), shift_body() and set_body_velocity() have been carried out on it.
    std::uint32_t asked = 0;
};

// Bits of ProxyState::status besides ProxyStatus, with a link: what is between the model's force and the
// hand.
enum FeltStatus : std::uint32_t {
    felt_carried = 1u << 16,  // a second pointer is felt, carried along with an object that was corrected
    felt_bridged = 1u << 17,  // a change of the model is hidden and fades unnoticed
    felt_letting_go =
        1u << 18,             // a change of the model was too large to hide: it fades so that it may be felt
    felt_limited = 1u << 19,  // the force was to change or to give more than is allowed
};

// A bit of ProxyState::status and ToolState::status: its device is not there, or it is switched off.
inline constexpr std::uint32_t touch_unheld = 1u << 22;

// A bit of ProxyState::status and ToolState::status: the field of its owner was made weaker, see
// HandField::is_limited.
inline constexpr std::uint32_t touch_field_limited = 1u << 23;

// A bit of ProxyState::status and ToolState::status at the far side: no operator's hand is there, and the
// place is that of the last one.
inline constexpr std::uint32_t far_hand_away = 1u << 24;

// Bits of ToolState::status besides ToolStatus, with a link to robots.
enum FarTool : std::uint32_t {
    tool_turn_fixed = 1u << 20,   // the robot that carries it cannot turn it
    tool_wrist_loose = 1u << 21,  // its robot turns, and has nothing to hold the tool by: it does not move
};

struct ProxyState {
    SessionHandle handle = no_handle;
    Vec3 position{0.0};        // of the proxy, in the world (unit: meters)
    Vec3 hand{0.0};            // HIP, in the world (unit: meters)
    Vec3 hand_velocity{0.0};   // likewise (unit: meters per second)
    Vec3 force{0.0};           // on the hand, in the world (unit: newtons)
    double residual = 0.0;     // see ProxyTick
    std::uint32_t status = 0;  // ProxyStatus
    int contact_count = 0;
    std::array<SessionHandle, HandForce::max_contacts> bodies{no_handle, no_handle, no_handle};
    std::array<Vec3, HandForce::max_contacts> points{};
    std::array<Vec3, HandForce::max_contacts> normals{};
    std::array<Vec3, HandForce::max_contacts> forces{};  // of each on the hand (unit: newtons)
};

struct ToolState {
    static constexpr std::size_t max_contacts = 6;

    SessionHandle handle = no_handle;
    Pose pose;                 // in the world
    Pose hand;                 // where the hand would have it, in the world
    Vec3 force{0.0};           // on the hand, in the world (unit: newtons)
    Vec3 torque{0.0};          // likewise, about its place (unit: newton meters)
    double residual = 0.0;     // see ToolTick
    std::uint32_t status = 0;  // ToolStatus, FarTool
    int contact_count = 0;
    std::array<SessionHandle, max_contacts> bodies{no_handle, no_handle, no_handle,
                                                   no_handle, no_handle, no_handle};
    // Other tools that it touches, where `bodies` has none; after those.
    std::array<SessionHandle, max_contacts> tools{no_handle, no_handle, no_handle,
                                                  no_handle, no_handle, no_handle};
    std::array<Vec3, max_contacts> points{};
    std::array<Vec3, max_contacts> normals{};
    std::array<Vec3, max_contacts> forces{};  // of each on the hand (unit: newtons)
};

struct DeviceState {
    SessionHandle handle = no_handle;
    Vec3 position{0.0};  // in the world (unit: meters)
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    Vec3 velocity{0.0};  // (unit: meters per second)
    Vec3 force{0.0};     // given to the device, in the world (unit: newtons)
    Vec3 asked{0.0};     // the same before every limit
    Vec3 torque{0.0};    // likewise, to its handle (unit: newton meters)
    std::uint32_t buttons = 0;
    bool connected = false;
    HandState safety = HandState::working;
    std::uint32_t limited = 0;  // HandLimited
    // What was touched last that the device cannot render safely, and what it was given instead.
    double stiffness_wanted = 0.0;  // (unit: newtons per meter); 0: all of it was safe
    double stiffness_used = 0.0;
    LoopLag lag;  // of the device, for which that holds
    DeviceCapabilities capabilities;
    double work = 0.0;  // on the hand since it came (unit: joules); below zero: taken from it
};

// Everything Godot shows of one tick. Bodies: those that can move, each with where it is now.
struct SessionSnapshot {
    std::uint64_t tick = 0;
    Nanoseconds time = 0;
    std::vector<BodyState> bodies;
    std::size_t body_count = 0;
    std::array<ProxyState, max_proxies> proxies;
    std::size_t proxy_count = 0;
    std::array<ToolState, max_tools> tools;
    std::size_t tool_count = 0;
    // Of all hands, by hand_of_tool() where it is that of a tool.
    std::array<TouchEvents, max_proxies + max_tools> touch_events;
    // By proxy: what contacts have given it in all, and those that had its handle before (unit: newton
    // seconds).
    std::array<Vec3, max_proxies> received{};
    std::array<DeviceState, max_devices> devices;
    std::size_t device_count = 0;
    std::array<LedState, max_led> led;
    std::size_t led_count = 0;
    std::size_t awake_bodies = 0;
    std::size_t slowed_bodies =
        0;  // of those awake: far from every hand, at a sixteenth of the tick rate, or soft
    std::uint64_t physics_steps = 0;  // that physics has taken so far; a scene at rest takes none
};

// That of one body, proxy or device among the first `count` of a snapshot; null: there is none.
template <class States>
const typename States::value_type* state_of(const States& states, std::size_t count, SessionHandle handle) {
    for (std::size_t i = 0; i < count; ++i) {
        if (states[i].handle == handle) {
            return &states[i];
        }
    }
    return nullptr;
}

// One row of a recording: the proxy or tool of a hand and, where a body is followed, that body (thesis 4.5).
struct SessionRecord {
    Nanoseconds time = 0;  // when the tick was due, on the session's clock
    Nanoseconds ran = 0;   // when it began, on that clock: `time` where no clock drives the session
    SessionHandle proxy = no_handle;  // or hand_of_tool() of a tool
    Vec3 hand{0.0};                   // of a tool where the hand would have it, in the world (unit: meters)
    Vec3 proxy_position{0.0};         // of proxy or tool, in the world (unit: meters)
    Vec3 force{0.0};                  // that it asks for, in the world (unit: newtons)
    // That its device was given by all limits, in the world (unit: newtons); where a driver knows it, what
    // the motors were given up to this tick's reading, and DisplayedForce::cuts.
    Vec3 displayed{0.0};
    std::uint32_t cuts = 0;
    Vec3 object_position{0.0};  // of the followed body (unit: meters); zero where none is followed
    Quat object_rotation{1.0, 0.0, 0.0, 0.0};
    std::uint32_t proxy_status = 0;
    std::uint32_t contacts = 0;
};

}  // namespace tactus
