#include "shared/teleop_run.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <memory>
#include <random>

#include "devices/path_device.hpp"
#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"
#include "session/operator_side.hpp"
#include "session/teleoperator_side.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds period = 1'000'000;
constexpr double tick_seconds = 1e-3;

// Keeps what the hand was given.
class FeltDevice final : public Device {
public:
    explicit FeltDevice(std::unique_ptr<Device> inner) : inner_(std::move(inner)) {}
    DeviceSample read(Nanoseconds now) override { return sample = inner_->read(now); }
    void write(Nanoseconds now, const Vec3& given) override {
        force = given;
        inner_->write(now, given);
    }

    DeviceSample sample;
    Vec3 force{0.0};

private:
    std::unique_ptr<Device> inner_;
};

// The same hand elsewhere: goes where another one went in the same tick, and feels nothing.
class FollowingDevice final : public Device {
public:
    explicit FollowingDevice(const FeltDevice& followed) : followed_(followed) {}
    DeviceSample read(Nanoseconds) override { return followed_.sample; }
    void write(Nanoseconds, const Vec3&) override {}

private:
    const FeltDevice& followed_;
};

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

std::unique_ptr<Device> hand_of(const TeleopScene& scene, const TeleopCase& experiment) {
    HandPath path = shifted(scene.path, experiment.path_shift);
    if (experiment.uses_arm) {
        return std::make_unique<SimulatedArm>(std::move(path), experiment.arm);
    }
    return std::make_unique<PathDevice>(std::move(path));
}

SessionSettings session_settings() {
    SessionSettings settings;
    settings.period = period;
    settings.most_bodies = 64;
    settings.most_parts = 256;
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
    }
    return believed;
}

// A scene with a mistake gives no figures.
void stop_at(const std::string& error, const std::string& what) {
    if (!error.empty()) {
        std::fprintf(stderr, "%s: %s\n", what.c_str(), error.c_str());
        std::exit(1);
    }
}

// One world with one hand in it.
struct Place {
    Place(const TeleopCase& experiment, std::unique_ptr<Device> hand)
        : session(session_settings()), device(std::move(hand)), object_name(experiment.object) {}

    void fill(const TeleopScene& scene, const TeleopCase& experiment, bool believed) {
        Workspace workspace;
        workspace.force_limit = scene.force_limit;
        ProxyDescription pointer;
        pointer.device = session.add_device(device, workspace).handle;
        pointer.settings.radius = scene.radius;
        session.add_proxy(pointer);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const TeleopBody& body = scene.bodies[i];
            const auto hinge = std::ranges::find(scene.hinges, i, &TeleopHinge::body);
            const TeleopHinge* const held = hinge == scene.hinges.end() ? nullptr : &*hinge;
            const BodyAddition addition = believed ? as_believed(body, held, experiment) : body.addition;
            const AddResult added = session.add_body(addition);
            stop_at(added.error, body.name);
            if (held) {
                hang(*held, body.addition.description.pose, added.handle);
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
    void hang(const TeleopHinge& hinge, const Pose& body, SessionHandle handle) {
        const Vec3 z(0.0, 0.0, 1.0);
        const double along = glm::dot(z, hinge.axis);
        const Vec3 half = glm::normalize(z + hinge.axis);  // of an axis that is not -z
        JointDescription joint;
        joint.kind = JointKind::Hinge;
        joint.angular[2] = JointRange::free();
        joint.frame.position = to_local(body, hinge.at);
        joint.frame.rotation =
            glm::conjugate(body.rotation) *
            (along > 1.0 - 1e-12 ? Quat(1.0, 0.0, 0.0, 0.0) : Quat(glm::dot(z, half), glm::cross(z, half)));
        const AddResult added = session.add_joint(joint, handle, no_handle);
        stop_at(added.error, "hinge");
    }

    void tick(Nanoseconds now) {
        session.tick(now);
        session.refresh();
    }

    const ProxyState& pointer() const { return session.snapshot().proxies[0]; }
    Pose pose_of(SessionHandle body) const {
        const SessionSnapshot& snapshot = session.snapshot();
        for (std::size_t i = 0; i < snapshot.body_count; ++i) {
            if (snapshot.bodies[i].handle == body) {
                return snapshot.bodies[i].pose;
            }
        }
        return {};
    }
    double depth() const {
        return pointer().contact_count > 0 ? glm::distance(pointer().hand, pointer().position) : 0.0;
    }
    bool touches_object() const {
        const auto& bodies = pointer().bodies;
        return object != no_handle && std::find(bodies.begin(), bodies.begin() + pointer().contact_count,
                                                object) != bodies.begin() + pointer().contact_count;
    }

    Session session;
    FeltDevice device;
    std::string object_name;
    SessionHandle object = no_handle;
    std::vector<SessionHandle> moving;
};

// A far side that sees bodies only roughly: what it says of their places is off by chance.
class RoughSight final : public Link {
public:
    RoughSight(Link& inner, double deviation, std::uint64_t seed)
        : inner_(inner), deviation_(deviation), random_(seed) {}

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
        return inner_.send(datagram, now);
    }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
        ReceivedDatagram received = inner_.receive(into, now);
        Packet packet;
        if (deviation_ > 0.0 && received && decode(into.first(received.bytes), packet) == Refusal::none) {
            if (auto* const states = std::get_if<ObjectStates>(&packet.message)) {
                for (std::size_t i = 0; i < states->count; ++i) {
                    states->states[i].pose.position += off();
                }
                received.bytes = encode(packet.header, packet.message, into);
            }
        }
        return received;
    }

private:
    Vec3 off() {
        std::normal_distribution<double> normal(0.0, deviation_);
        return {normal(random_), normal(random_), normal(random_)};
    }

    Link& inner_;
    double deviation_;
    std::mt19937_64 random_;
};

// Nobody listens yet.
void drop_all(Link& link, Nanoseconds now) {
    std::array<std::byte, most_datagram_bytes> ignored;
    while (link.receive(ignored, now)) {
    }
}

}  // namespace

TeleopFigures run_teleop(const TeleopScene& scene, const TeleopCase& experiment, TeleopBins* bins) {
    MemoryLinkPair wire(4096);
    LinkEmulator at_far(wire.second(), experiment.forth, experiment.seed);
    LinkEmulator at_operator(wire.first(), experiment.back, experiment.seed + 1);
    RoughSight seen(at_operator, experiment.pose_noise, experiment.seed + 2);
    const auto operator_port = std::make_shared<TeleopPort>();
    const auto far_port = std::make_shared<TeleopPort>();
    const SessionSettings settings = session_settings();
    OperatorRoom room;
    room.most_tracked = 16;
    room.samples = 2048;
    room.memento_bytes = 16384;
    room.pointers = 1;
    room.replays = !experiment.settings.traditional &&
                   experiment.settings.derivation == Derivation::resimulate &&
                   experiment.settings.correction != Correction::none;

    Place model(experiment, hand_of(scene, experiment)), truth(experiment, hand_of(scene, experiment));
    Place direct(experiment, std::make_unique<FollowingDevice>(model.device));
    Place local(experiment, hand_of(scene, experiment));
    const auto endpoint = [&](Side side, std::uint64_t epoch) {
        EndpointSettings one;
        one.side = side;
        one.scenario = experiment.settings.traditional ? 2 : 4;
        one.epoch = epoch;
        one.period = period;
        return one;
    };
    TeleopSettings at_first = experiment.settings;
    at_first.correction = experiment.correct_from_touch ? Correction::none : at_first.correction;
    model.session.attach(std::make_unique<OperatorSide>(settings, room, at_first, seen, operator_port,
                                                        endpoint(Side::operator_side, 11)));
    truth.session.attach(std::make_unique<TeleoperatorSide>(settings, experiment.settings, at_far, far_port,
                                                            endpoint(Side::teleoperator_side, 12)));
    model.fill(scene, experiment, true);
    truth.fill(scene, experiment, false);
    direct.fill(scene, experiment, false);
    if (experiment.uses_arm) {
        local.fill(scene, experiment, false);
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        operator_port->bindings.try_push({static_cast<ObjectId>(i), static_cast<SessionHandle>(i)});
    }

    const auto ticks = static_cast<std::size_t>(experiment.seconds / tick_seconds);
    std::vector<TeleopRow> rows(ticks);
    const std::size_t moving = model.moving.size();
    std::vector<Pose> believed(ticks * moving);  // by tick and moving body
    TeleopPorts ports;
    Vec3 far_hand(0.0), far_force(0.0);
    bool waiting_for_touch = experiment.correct_from_touch;
    double largest_step = 0.0;
    for (std::size_t i = 0; i < ticks; ++i) {
        const Nanoseconds now = static_cast<Nanoseconds>(i + 1) * period;
        model.tick(now);
        direct.tick(now);
        if (now > experiment.late) {
            truth.tick(now + experiment.phase);
        } else {
            drop_all(at_far, now);
        }
        TeleopRow& row = rows[i];
        row.time = static_cast<Nanoseconds>(i) * period;
        row.hand = model.device.sample.position;
        row.velocity = model.device.sample.velocity;
        row.force = model.device.force;
        row.direct = direct.device.force;
        if (experiment.uses_arm) {
            local.tick(now);
            row.local_hand = local.device.sample.position;
            row.local_velocity = local.device.sample.velocity;
            row.local_force = local.device.force;
            row.local_depth = local.depth();
        }
        row.model = model.pose_of(model.object);
        for (std::size_t body = 0; body < moving; ++body) {
            believed[i * moving + body] = model.pose_of(model.moving[body]);
        }
        row.touches = model.touches_object();
        row.direct_touches = direct.pointer().contact_count > 0;
        operator_port->statistics.refresh();
        const TeleopStatistics& statistics = operator_port->statistics.front();
        row.jnd_share = statistics.cost.jnd_share;
        row.offset = statistics.offset;
        largest_step = std::max(largest_step, statistics.cost.force_step);
        if (i > 0) {
            ports.hand.add(rows[i - 1].force, row.hand - rows[i - 1].hand);
        }
        const ProxyState& there = truth.pointer();
        ports.far.add(-far_force, there.hand - far_hand);
        ports.link_created = std::max(ports.link_created, ports.hand.total() + ports.far.total());
        far_hand = there.hand;
        far_force = truth.device.force;
        far_port->statistics.refresh();
        if (const std::uint64_t sample = far_port->statistics.front().sample; sample > 0 && sample <= ticks) {
            TeleopRow& answered = rows[sample - 1];
            if (!answered.far_known) {
                answered.far_known = true;
                answered.truth = truth.pose_of(truth.object);
                answered.far = truth.device.force;
                answered.depth = truth.depth();
                for (std::size_t body = 0; body < moving; ++body) {
                    const Pose& ours = believed[(sample - 1) * moving + body];
                    const Pose theirs = truth.pose_of(truth.moving[body]);
                    answered.box_error = std::max(answered.box_error, position_error(ours, theirs));
                    answered.turn_error = std::max(answered.turn_error, rotation_error(ours, theirs));
                }
            }
        }
        if (waiting_for_touch && model.pointer().contact_count > 0) {
            waiting_for_touch = false;
            operator_port->settings.publish(experiment.settings);
        }
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
        rows[i].depth = rows[i].far_known ? rows[i].depth : rows[i - 1].depth;  // a sample was left out
    }
    TeleopFigures figures = evaluate(rows, experiment, ports, bins);
    figures["correction_force_step_max_N"] = largest_step;
    const TeleopStatistics& ours = operator_port->statistics.front();
    const TeleopStatistics& theirs = far_port->statistics.front();
    const auto per_second = [&](std::uint64_t count) {
        return static_cast<double>(count) / experiment.seconds;
    };
    figures["packets_forth_per_s"] = per_second(ours.link.packets_sent);
    figures["packets_back_per_s"] = per_second(theirs.link.packets_sent);
    figures["packets_per_s"] = per_second(ours.link.packets_sent + theirs.link.packets_sent);
    figures["bytes_per_s"] = per_second(ours.link.bytes_sent + theirs.link.bytes_sent);
    figures["bits_per_s"] = 8.0 * figures["bytes_per_s"];
    figures["bits_forth_per_s"] = 8.0 * per_second(ours.link.bytes_sent);
    figures["bits_back_per_s"] = 8.0 * per_second(theirs.link.bytes_sent);
    figures["corrections"] = static_cast<double>(ours.corrections);
    figures["replays"] = static_cast<double>(ours.replays);
    figures["samples_held"] = static_cast<double>(theirs.buffer.held);
    figures["samples_filled"] = static_cast<double>(theirs.buffer.filled);
    figures["round_trip_ms"] = 1e3 * ours.round_trip;
    if (!experiment.rows.empty()) {
        write_rows(experiment.rows, rows);
    }
    return figures;
}

}  // namespace tactus::shared
