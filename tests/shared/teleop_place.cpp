#include "shared/teleop_place.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "devices/path_device.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds period = 1'000'000;

// A scene with a mistake gives no figures.
void stop_at(const std::string& error, const std::string& what) {
    if (!error.empty()) {
        std::fprintf(stderr, "%s: %s\n", what.c_str(), error.c_str());
        std::exit(1);
    }
}

HandPath shifted(HandPath path, const Vec3& by) {
    if (auto* const circle = std::get_if<CircleWave>(&path)) {
        circle->centre += by;
    } else {
        for (Keyframe& keyframe : std::get<KeyframePath>(path).keyframes) {
            keyframe.position += by;
        }
    }
    return path;
}

Vec3 force_of(const TeleopActor& actor, const Vec3& began, const BodyState& body, double seconds) {
    if (seconds < actor.from || seconds >= actor.to) {
        return Vec3(0.0);
    }
    const Vec3 moved = body.pose.position - began;
    if (actor.normal == Vec3(0.0)) {
        return actor.draft - actor.stiffness * moved - actor.damping * body.linear_velocity;
    }
    const double turn = 2.0 * std::numbers::pi * (seconds - actor.from) / actor.period;
    const double plane = actor.gap - 0.5 * actor.way * (1.0 - std::cos(turn));
    const double speed = -0.5 * actor.way * std::sin(turn) * 2.0 * std::numbers::pi / actor.period;
    const double depth = glm::dot(moved, actor.normal) - plane;
    const double approach = glm::dot(body.linear_velocity, actor.normal) - speed;
    const double push = depth > 0.0 ? actor.stiffness * depth + actor.damping * approach : 0.0;
    return actor.draft - std::max(0.0, push) * actor.normal;
}

}  // namespace

std::unique_ptr<Device> hand_of(const TeleopScene& scene, const TeleopCase& experiment) {
    HandPath path = shifted(scene.path, experiment.path_shift);
    if (experiment.uses_arm) {
        return std::make_unique<SimulatedArm>(std::move(path), experiment.arm);
    }
    return std::make_unique<PathDevice>(std::move(path));
}

SessionSettings teleop_session_settings() {
    SessionSettings settings;
    settings.period = period;
    settings.max_bodies = 64;
    settings.max_parts = 256;
    settings.physics.max_touching_pairs = 512;
    settings.physics.max_contacts = 512;
    settings.full_rate_bodies = 0;
    return settings;
}

BodyAddition as_believed(const TeleopBody& body, const TeleopHinge* hinge, const TeleopCase& experiment) {
    BodyAddition believed = body.addition;
    if (const auto found = experiment.wrong.find(body.name); found != experiment.wrong.end()) {
        const WrongBody& wrong = found->second;
        believed.description.pose.position += wrong.move;
        if (hinge) {
            const Vec3& at = hinge->at;
            const Quat turn = glm::angleAxis(wrong.swing, hinge->axis);
            believed.description.pose.position = at + turn * (believed.description.pose.position - at);
            believed.description.pose.rotation = turn * believed.description.pose.rotation;
        }
        believed.description.pose.rotation = wrong.turn * believed.description.pose.rotation;
        believed.description.mass *= wrong.mass;
        believed.description.material.friction *= wrong.friction;
        believed.touch_material.static_friction *= wrong.touch_friction;
        believed.touch_material.dynamic_friction *= wrong.touch_friction;
        believed.touch_material.stiffness *= wrong.stiffness;
        believed.touch_material.magnet_force += wrong.magnet_force;
        if (wrong.touch_friction_is) {
            believed.touch_material.static_friction = believed.touch_material.dynamic_friction =
                *wrong.touch_friction_is;
        }
        if (wrong.ball > 0.0) {
            believed.description.shapes = {{SphereShape{wrong.ball}, Pose{}}};
        }
    }
    return believed;
}

const TeleopHinge* hinge_of(const TeleopScene& scene, std::size_t body) {
    const auto found = std::ranges::find(scene.hinges, body, &TeleopHinge::body);
    return found == scene.hinges.end() ? nullptr : &*found;
}

void TeleopPlace::add_hand(const TeleopScene& scene) {
    Workspace workspace;
    workspace.force_limit = scene.force_limit;
    ProxyDescription pointer;
    pointer.device = session.add_device(device, workspace).handle;
    pointer.settings.radius = scene.radius;
    session.add_proxy(pointer);
}

void TeleopPlace::fill(const TeleopScene& scene, const TeleopCase& experiment, bool believed) {
    add_hand(scene);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const TeleopBody& body = scene.bodies[i];
        const auto wrong = experiment.wrong.find(body.name);
        if (!believed && wrong != experiment.wrong.end() && wrong->second.ghost) {
            handles.push_back(no_handle);
            continue;
        }
        const TeleopHinge* const hinge = hinge_of(scene, i);
        const BodyAddition addition = believed ? as_believed(body, hinge, experiment) : body.addition;
        const AddResult added = session.add_body(addition);
        stop_at(added.error, body.name);
        handles.push_back(added.handle);
        if (hinge) {
            hang(*hinge, body.addition.description.pose, added.handle);
        }
        if (const auto hidden = experiment.hidden_hinges.find(body.name);
            !believed && hidden != experiment.hidden_hinges.end()) {
            hang({i, hidden->second}, body.addition.description.pose, added.handle);
        }
        if (addition.description.motion == Motion::Dynamic) {
            moving.push_back(added.handle);
        }
        if (body.name == object_name) {
            object = added.handle;
        }
    }
    session.settle();
}

// On the body, the hinge is where the scene has it, wherever the body is believed to be.
void TeleopPlace::hang(const TeleopHinge& hinge, const Pose& body, SessionHandle handle) {
    const Vec3 z(0.0, 0.0, 1.0);
    const Vec3 half = glm::normalize(z + hinge.axis);  // of an axis that is not -z
    JointDescription joint;
    joint.kind = JointKind::Hinge;
    joint.angular[2] = JointRange::free();
    joint.frame.position = to_local(body, hinge.at);
    joint.frame.rotation = glm::conjugate(body.rotation) * Quat(glm::dot(z, half), glm::cross(z, half));
    stop_at(session.add_joint(joint, handle, no_handle).error, "hinge");
}

void TeleopPlace::act(const TeleopScene& scene, const TeleopCase& experiment, double seconds) {
    std::map<SessionHandle, Vec3> pushes;
    for (const TeleopActor& actor : experiment.actors) {
        const auto acted = std::ranges::find(scene.bodies, actor.body, &TeleopBody::name);
        stop_at(acted == scene.bodies.end() ? "no body of the scene" : "", actor.body);
        const SessionHandle body = handles[static_cast<std::size_t>(acted - scene.bodies.begin())];
        const SessionSnapshot& now = session.snapshot();
        if (const BodyState* const state = state_of(now.bodies, now.body_count, body)) {
            pushes[body] += force_of(actor, acted->addition.description.pose.position, *state, seconds);
        }
    }
    for (const auto& [body, push] : pushes) {
        session.set_body_push(body, push, Vec3(0.0));
    }
}

void TeleopPlace::tick(Nanoseconds now) {
    session.tick(now);
    session.refresh();
}

Pose TeleopPlace::pose_of(SessionHandle body) const {
    const SessionSnapshot& snapshot = session.snapshot();
    const BodyState* const state = state_of(snapshot.bodies, snapshot.body_count, body);
    return state ? state->pose : Pose{};
}

double TeleopPlace::depth() const {
    return pointer().contact_count > 0 ? glm::distance(pointer().hand, pointer().position) : 0.0;
}

bool TeleopPlace::touches(SessionHandle body) const {
    const auto& bodies = pointer().bodies;
    const auto end = bodies.begin() + pointer().contact_count;
    return body != no_handle && std::find(bodies.begin(), end, body) != end;
}

}  // namespace tactus::shared
