#include "shared/teleop_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <random>

#include "core/teleop/errors.hpp"
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

BodyAddition as_believed(const TeleopBody& body, const TeleopCase& experiment) {
    BodyAddition believed = body.addition;
    if (const auto found = experiment.wrong.find(body.name); found != experiment.wrong.end()) {
        const WrongBody& wrong = found->second;
        believed.description.pose.position += wrong.move;
        believed.description.pose.rotation = wrong.turn * believed.description.pose.rotation;
        believed.description.mass *= wrong.mass;
        believed.description.material.friction *= wrong.friction;
        believed.touch_material.static_friction *= wrong.touch_friction;
        believed.touch_material.dynamic_friction *= wrong.touch_friction;
        believed.touch_material.stiffness *= wrong.stiffness;
    }
    return believed;
}

// One world with one hand in it.
struct Place {
    Place(const TeleopScene& scene, const TeleopCase& experiment)
        : session(session_settings()), device(hand_of(scene, experiment)) {}

    void fill(const TeleopScene& scene, const TeleopCase& experiment, bool believed) {
        Workspace workspace;
        workspace.force_limit = scene.force_limit;
        ProxyDescription pointer;
        pointer.device = session.add_device(device, workspace).handle;
        pointer.settings.radius = scene.radius;
        session.add_proxy(pointer);
        for (const TeleopBody& body : scene.bodies) {
            const AddResult added =
                session.add_body(believed ? as_believed(body, experiment) : body.addition);
            if (!added.error.empty()) {
                std::fprintf(stderr, "%s: %s\n", body.name.c_str(), added.error.c_str());
            }
            if (body.name == experiment.object) {
                object = added.handle;
            }
        }
        session.settle();
    }

    void tick(Nanoseconds now) {
        session.tick(now);
        session.refresh();
    }

    const ProxyState& pointer() const { return session.snapshot().proxies[0]; }
    Pose object_pose() const {
        const SessionSnapshot& snapshot = session.snapshot();
        for (std::size_t i = 0; i < snapshot.body_count; ++i) {
            if (snapshot.bodies[i].handle == object) {
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
    SessionHandle object = no_handle;
};

// A second-order Butterworth high-pass (bilinear transform), one component.
class HighPass {
public:
    explicit HighPass(double hertz) {
        const double k = std::tan(3.14159265358979 * hertz * tick_seconds);
        const double norm = 1.0 / (1.0 + std::sqrt(2.0) * k + k * k);
        b0_ = norm;
        a1_ = 2.0 * (k * k - 1.0) * norm;
        a2_ = (1.0 - std::sqrt(2.0) * k + k * k) * norm;
    }
    double operator()(double x) {
        const double y = b0_ * (x - 2.0 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
        x2_ = std::exchange(x1_, x);
        y2_ = std::exchange(y1_, y);
        return y;
    }

private:
    double b0_ = 0.0, a1_ = 0.0, a2_ = 0.0, x1_ = 0.0, x2_ = 0.0, y1_ = 0.0, y2_ = 0.0;
};

// What one tick of the operator and what answers it were like, by sample.
struct Row {
    Nanoseconds time = 0;
    Vec3 hand{0.0}, force{0.0}, direct{0.0}, far{0.0};
    Pose model, truth, direct_object;
    bool far_known = false;
    bool touches = false;         // the operator's pointer, the object
    bool direct_touches = false;  // anything
    double jnd_share = 0.0;
    double offset = 0.0;
    Vec3 velocity{0.0};  // of the hand
    double depth = 0.0;  // of the far side's hand below the surface there, after this sample
    Vec3 direct_hand{0.0}, direct_velocity{0.0};
    double direct_depth = 0.0;
};

double percentile(std::vector<double> values, double share) {
    if (values.empty()) {
        return 0.0;
    }
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void write_rows(const std::string& path, const std::vector<Row>& rows) {
    std::ofstream file(path);
    file << "time_us,hand_x,hand_y,hand_z,force_x,force_y,force_z,direct_x,direct_y,direct_z,far_x,far_y,"
            "far_z,model_x,model_y,model_z,truth_x,truth_y,truth_z,box_error_m,offset_m,jnd_share,depth_m,"
            "direct_depth_m\n";
    const auto put = [&file](const Vec3& v) {
        char text[96];
        std::snprintf(text, sizeof text, ",%.9g,%.9g,%.9g", v.x, v.y, v.z);
        file << text;
    };
    for (const Row& row : rows) {
        file << row.time / 1000;
        put(row.hand);
        put(row.force);
        put(row.direct);
        put(row.far);
        put(row.model.position);
        put(row.truth.position);
        file << ',' << (row.far_known ? position_error(row.model, row.truth) : 0.0) << ',' << row.offset
             << ',' << row.jnd_share << ',' << row.depth << ',' << row.direct_depth << '\n';
    }
}

// What a pushed hand did: how deep it went, how far beyond where it came to rest, and how much energy the
// device gave it (a wall that is really there takes some).
struct Pushing {
    double deepest = 0.0, settled = 0.0, energy = 0.0;
    std::size_t settled_ticks = 0;

    void add(const TeleopCase& experiment, double time, double depth, const Vec3& force,
             const Vec3& velocity) {
        deepest = std::max(deepest, depth);
        energy += glm::dot(force, velocity) * tick_seconds;
        if (time >= experiment.settled_from && time < experiment.settled_to) {
            settled += depth;
            ++settled_ticks;
        }
    }
    void tell(const std::string& prefix, TeleopFigures& figures) const {
        const double rest = settled_ticks > 0 ? settled / static_cast<double>(settled_ticks) : 0.0;
        figures[prefix + "penetration_max_mm"] = 1e3 * deepest;
        figures[prefix + "settled_depth_mm"] = 1e3 * rest;
        figures[prefix + "overshoot_mm"] = 1e3 * (deepest - rest);
        figures[prefix + "energy_J"] = energy;
    }
};

void evaluate_arm(const std::vector<Row>& rows, const TeleopCase& experiment, TeleopFigures& figures) {
    Pushing over_the_link, local;
    Series deviation;
    for (const Row& row : rows) {
        const double time = to_seconds(row.time);
        over_the_link.add(experiment, time, row.depth, row.force, row.velocity);
        local.add(experiment, time, row.direct_depth, row.direct, row.direct_velocity);
        deviation.add(glm::distance(row.hand, row.direct_hand));
    }
    over_the_link.tell("", figures);
    local.tell("local_", figures);
    figures["hand_deviation_rms_mm"] = 1e3 * deviation.rms();
}

// How long after each leave-taking the object needs to be where it is at the far side (unit: seconds).
double longest_until_right(const std::vector<Row>& rows) {
    constexpr double right = 1e-4;
    constexpr std::size_t apart = 250;  // ticks without touch that make a leave-taking
    double longest = 0.0;
    for (std::size_t i = 1; i + apart < rows.size(); ++i) {
        if (!rows[i - 1].touches || rows[i].touches) {
            continue;
        }
        std::size_t end = i;
        while (end < rows.size() && !rows[end].touches) {
            ++end;
        }
        if (end - i < apart) {
            continue;
        }
        std::size_t wrong_at = i;
        for (std::size_t j = i; j < end; ++j) {
            if (rows[j].far_known && position_error(rows[j].model, rows[j].truth) > right) {
                wrong_at = j;
            }
        }
        longest = std::max(longest, static_cast<double>(wrong_at - i) * tick_seconds);
    }
    return longest;
}

TeleopFigures evaluate(const std::vector<Row>& rows, const TeleopCase& experiment, double largest_step) {
    TeleopFigures figures;
    Series error, shifted, box, turn, jitter;
    std::vector<double> errors, shares;
    std::array<HighPass, 3> filters{HighPass(30.0), HighPass(30.0), HighPass(30.0)};
    const std::size_t shift =
        experiment.settings.traditional
            ? static_cast<std::size_t>((experiment.forth.delay + experiment.back.delay) / period + 1)
            : 0;
    double last_wrong = 0.0, first_touch = -1.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Row& row = rows[i];
        const double wrong = force_error(row.force, row.direct);
        error.add(wrong);
        errors.push_back(wrong);
        if (i >= shift && rows[i - shift].far_known) {
            shifted.add(force_error_shifted(row.force, rows[i - shift].far));
        }
        if (row.far_known) {
            box.add(position_error(row.model, row.truth));
            turn.add(rotation_error(row.model, row.truth));
        }
        const Vec3 fast(filters[0](row.force.x), filters[1](row.force.y), filters[2](row.force.z));
        jitter.add(glm::length(fast));
        if (row.jnd_share > 0.0) {
            shares.push_back(row.jnd_share);
        }
        if (first_touch < 0.0 && row.direct_touches) {
            first_touch = to_seconds(row.time);
        }
        if (wrong > 0.02) {
            last_wrong = to_seconds(row.time);
        }
    }
    figures["force_error_mean_N"] = error.mean();
    figures["force_error_p95_N"] = percentile(errors, 0.95);
    figures["force_error_max_N"] = error.largest;
    figures["force_error_shifted_mean_N"] = shifted.mean();
    figures["force_jitter_rms_N"] = jitter.rms();
    figures["correction_force_step_max_N"] = largest_step;
    figures["correction_cost_jnd_p99"] = percentile(shares, 0.99);
    figures["seconds_until_right"] = first_touch < 0.0 ? 0.0 : std::max(0.0, last_wrong - first_touch);
    if (experiment.uses_arm) {
        evaluate_arm(rows, experiment, figures);
    }
    if (!experiment.object.empty()) {
        const auto last =
            std::find_if(rows.rbegin(), rows.rend(), [](const Row& row) { return row.far_known; });
        figures["box_position_error_rms_mm"] = 1e3 * box.rms();
        figures["box_position_error_max_mm"] = 1e3 * box.largest;
        figures["box_position_error_final_mm"] =
            last == rows.rend() ? 0.0 : 1e3 * position_error(last->model, last->truth);
        if (last != rows.rend()) {
            for (int axis = 0; axis < 3; ++axis) {
                const std::string name = std::string("_final_") + "xyz"[axis];
                figures["model" + name] = last->model.position[axis];
                figures["truth" + name] = last->truth.position[axis];
            }
        }
        figures["box_rotation_error_rms_deg"] = 57.29577951308232 * turn.rms();
        figures["box_right_after_letting_go_s"] = longest_until_right(rows);
    }
    return figures;
}

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

TeleopFigures run_teleop(const TeleopScene& scene, const TeleopCase& experiment) {
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

    Place model(scene, experiment), truth(scene, experiment), direct(scene, experiment);
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
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        operator_port->bindings.try_push({static_cast<ObjectId>(i), static_cast<SessionHandle>(i)});
    }

    const auto ticks = static_cast<std::size_t>(experiment.seconds / tick_seconds);
    std::vector<Row> rows(ticks);
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
        Row& row = rows[i];
        row.time = static_cast<Nanoseconds>(i) * period;
        row.hand = model.device.sample.position;
        row.force = model.device.force;
        row.direct = direct.device.force;
        row.velocity = model.device.sample.velocity;
        row.direct_hand = direct.device.sample.position;
        row.direct_velocity = direct.device.sample.velocity;
        row.direct_depth = direct.depth();
        row.model = model.object_pose();
        row.direct_object = direct.object_pose();
        row.touches = model.touches_object();
        row.direct_touches = direct.pointer().contact_count > 0;
        operator_port->statistics.refresh();
        const TeleopStatistics& statistics = operator_port->statistics.front();
        row.jnd_share = statistics.cost.jnd_share;
        row.offset = statistics.offset;
        largest_step = std::max(largest_step, statistics.cost.force_step);
        far_port->statistics.refresh();
        if (const std::uint64_t sample = far_port->statistics.front().sample; sample > 0 && sample <= ticks) {
            Row& answered = rows[sample - 1];
            if (!answered.far_known) {
                answered.far_known = true;
                answered.truth = truth.object_pose();
                answered.far = truth.device.force;
                answered.depth = truth.depth();
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
    TeleopFigures figures = evaluate(rows, experiment, largest_step);
    const TeleopStatistics& ours = operator_port->statistics.front();
    const TeleopStatistics& theirs = far_port->statistics.front();
    figures["packets_per_s"] =
        static_cast<double>(ours.link.packets_sent + theirs.link.packets_sent) / experiment.seconds;
    figures["bytes_per_s"] =
        static_cast<double>(ours.link.bytes_sent + theirs.link.bytes_sent) / experiment.seconds;
    figures["packets_forth_per_s"] = static_cast<double>(ours.link.packets_sent) / experiment.seconds;
    figures["packets_back_per_s"] = static_cast<double>(theirs.link.packets_sent) / experiment.seconds;
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
