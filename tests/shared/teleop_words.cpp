#include "shared/teleop_words.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <glm/geometric.hpp>
#include <iostream>
#include <sstream>

namespace tactus::shared {

namespace {

double degrees(double value) {
    return value * 3.14159265358979323846 / 180.0;
}

Vec3 read_vector(std::istream& in) {
    Vec3 v(0.0);
    in >> v.x >> v.y >> v.z;
    return v;
}

Pose read_pose(std::istream& in) {
    Pose pose;
    pose.position = read_vector(in);
    in >> pose.rotation.w >> pose.rotation.x >> pose.rotation.y >> pose.rotation.z;
    pose.rotation = glm::normalize(pose.rotation);
    return pose;
}

HandPath read_path(std::istream& in) {
    std::string kind;
    in >> kind;
    if (kind == "circle") {
        CircleWave circle;
        double turn = 10.0;
        circle.centre = read_vector(in);
        in >> circle.radius >> circle.amplitude >> turn >> circle.waves;
        circle.turn_time = from_seconds(turn);
        return circle;
    }
    KeyframePath path;
    path.interpolation = kind == "smooth" ? PathInterpolation::catmull_rom : PathInterpolation::linear;
    for (double time = 0.0; in >> time;) {
        path.keyframes.push_back({from_seconds(time), read_vector(in)});
    }
    return path;
}

TeleopBody read_body(std::istream& in) {
    TeleopBody body;
    std::string motion;
    BodyDescription& d = body.addition.description;
    TouchMaterial& touch = body.addition.touch_material;
    in >> body.name >> motion >> d.mass >> d.material.friction >> d.material.restitution >> touch.stiffness >>
        touch.damping >> touch.static_friction >> touch.dynamic_friction;
    d.motion = motion == "dynamic" ? Motion::Dynamic : Motion::Static;
    d.pose = read_pose(in);
    in >> d.linear_damping >> d.angular_damping;
    return body;
}

}  // namespace

bool read_scene(const std::string& path, TeleopScene& scene) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        std::string word;
        if (!(in >> word) || word[0] == '#') {
            continue;
        }
        if (word == "radius") {
            in >> scene.radius;
        } else if (word == "limit") {
            in >> scene.force_limit;
        } else if (word == "path") {
            scene.path = read_path(in);
        } else if (word == "body") {
            scene.bodies.push_back(read_body(in));
        } else if (word == "box" && !scene.bodies.empty()) {
            const Vec3 half = read_vector(in);
            scene.bodies.back().addition.description.shapes.push_back({BoxShape{half}, read_pose(in)});
        } else if (word == "sphere" && !scene.bodies.empty()) {
            double radius = 0.0;
            in >> radius;
            scene.bodies.back().addition.description.shapes.push_back(
                {SphereShape{radius}, {read_vector(in), {1.0, 0.0, 0.0, 0.0}}});
        } else if (word == "hinge") {
            std::string name;
            in >> name;
            const auto body = std::ranges::find(scene.bodies, name, &TeleopBody::name);
            if (body == scene.bodies.end()) {
                std::cerr << path << ": \"" << line << "\": there is no such body above\n";
                return false;
            }
            TeleopHinge& hinge = scene.hinges.emplace_back();
            hinge.body = static_cast<std::size_t>(body - scene.bodies.begin());
            hinge.at = read_vector(in);
            hinge.axis = glm::normalize(read_vector(in));
        } else {
            std::cerr << path << ": \"" << line << "\" is not understood\n";
            return false;
        }
    }
    return !scene.bodies.empty() && problem_with(scene.path).empty();
}

namespace {

template <typename Enum>
bool choose(const std::string& value, std::initializer_list<const char*> names, Enum& out) {
    int index = 0;
    for (const char* name : names) {
        if (value == name) {
            out = static_cast<Enum>(index);
            return true;
        }
        ++index;
    }
    return false;
}

// X,Y,Z
bool read_vector(std::string text, Vec3& out) {
    std::ranges::replace(text, ',', ' ');
    std::istringstream in(text);
    out = read_vector(in);
    return !in.fail();
}

// wrong.NAME.what
bool set_wrong(const std::string& key, const std::string& value, TeleopCase& c) {
    const std::size_t dot = key.rfind('.');
    if (key.rfind("wrong.", 0) != 0 || dot <= 6) {
        return false;
    }
    WrongBody& wrong = c.wrong[key.substr(6, dot - 6)];
    const std::string what = key.substr(dot + 1);
    std::string text = value;
    for (char& letter : text) {
        letter = letter == ',' ? ' ' : letter;
    }
    std::istringstream in(text);
    if (what == "move") {
        wrong.move = read_vector(in);
    } else if (what == "turn") {  // axis, degrees
        const Vec3 axis = read_vector(in);
        double angle = 0.0;
        in >> angle;
        wrong.turn = glm::angleAxis(degrees(angle), glm::normalize(axis));
    } else if (what == "swing") {  // degrees
        in >> wrong.swing;
        wrong.swing = degrees(wrong.swing);
    } else if (what == "mass") {
        in >> wrong.mass;
    } else if (what == "friction") {
        in >> wrong.friction;
    } else if (what == "touch_friction") {
        in >> wrong.touch_friction;
    } else if (what == "stiffness") {
        in >> wrong.stiffness;
    } else if (what == "touch_friction_is") {
        in >> wrong.touch_friction_is.emplace();
    } else if (what == "magnet_force") {
        in >> wrong.magnet_force;
    } else if (what == "ball") {
        in >> wrong.ball;
    } else if (what == "absent") {
        in >> wrong.absent;
    } else if (what == "ghost") {
        in >> wrong.ghost;
    } else {
        return false;
    }
    return !in.fail();
}

// SECONDS,KIND[,BODY or AMOUNT]
bool read_event(std::string text, TeleopEvent& event) {
    std::ranges::replace(text, ',', ' ');
    std::istringstream in(text);
    std::string kind;
    in >> event.at >> kind;
    if (in.fail() ||
        !choose(kind, {"told", "removed", "gravity", "correct", "scheme", "scenario", "restart", "cut"},
                event.kind)) {
        return false;
    }
    in >> event.body;
    event.amount = std::strtod(event.body.c_str(), nullptr);
    return true;
}

bool set(const std::string& key, const std::string& value, TeleopCase& c) {
    const double number = std::strtod(value.c_str(), nullptr);
    const auto natural = static_cast<std::uint32_t>(number);
    TeleopSettings& s = c.settings;
    if (key == "traditional") {
        s.traditional = number != 0.0;
    } else if (key == "robot") {
        c.robot = s.robot = s.traditional = number != 0.0;
    } else if (key == "passivity") {
        return choose(value, {"none", "wave_variables", "time_domain", "two_layers"}, s.passivity);
    } else if (key == "wave_impedance") {
        s.passive.impedance = number;
    } else if (key == "wave_cutoff") {
        s.passive.wave_cutoff = number;
    } else if (key == "drift_rate") {
        s.passive.drift_rate = number;
    } else if (key == "reserve") {
        s.passive.reserve = number;
    } else if (key == "lightest_hand") {
        s.passive.lightest_hand = number;
    } else if (key == "far_store") {
        s.passive.far_store = number;
    } else if (key == "tank") {
        s.passive.tank = number;
    } else if (key == "refill") {
        s.passive.refill = number;
    } else if (key == "tank_share") {
        s.passive.shared = number;
    } else if (key == "largest_damping") {
        s.passive.largest_damping = number;
    } else if (key == "largest_yield") {
        s.passive.largest_yield = number;
    } else if (key == "update_bring_in") {
        s.update.bring_in = number;
    } else if (key == "update_take_out") {
        s.update.take_out = number;
    } else if (key == "update_tank") {
        s.update.tank = number;
    } else if (key == "delay_ms") {  // there and back
        c.forth.delay = c.back.delay = from_seconds(0.5e-3 * number);
    } else if (key == "jitter_ms") {
        c.forth.jitter = c.back.jitter = from_seconds(1e-3 * number);
    } else if (key == "loss") {
        c.forth.loss = c.back.loss = number;
    } else if (key == "loss_forth") {
        c.forth.loss = number;
    } else if (key == "loss_back") {
        c.back.loss = number;
    } else if (key == "burst") {
        c.forth.burst = c.back.burst = bursts(number, 5.0);
    } else if (key == "seed") {
        c.seed = natural;
    } else if (key == "correction") {
        return choose(value,
                      {"none", "pose", "pose_velocity", "stealthy_magnitude", "stealthy_direction",
                       "stealthy_translate", "stealthy_turn", "passive"},
                      s.correction);
    } else if (key == "derivation") {
        return choose(value, {"none", "velocity", "acceleration", "averaged", "history", "resimulate"},
                      s.derivation);
    } else if (key == "control") {
        return choose(value, {"spring", "position", "position_force", "position_force_relative"}, s.control);
    } else if (key == "states_every") {
        s.states_every = natural;
    } else if (key == "refresh_every") {
        s.refresh_every = natural;
    } else if (key == "repeats") {
        s.repeats = natural;
    } else if (key == "buffer") {
        s.buffer_depth = natural;
    } else if (key == "replay_steps") {
        s.replay_steps = natural;
    } else if (key == "share") {
        s.stealth.share = number;
    } else if (key == "let_go") {
        s.stealth.let_go_seconds = number;
    } else if (key == "hidden_bound") {
        s.stealth.bound = number;
    } else if (key == "estimate") {
        s.estimate.gain = number;
    } else if (key == "residual") {
        s.residual.gain = number;
    } else if (key == "fade_window") {
        s.stealth.window = number;
    } else if (key == "deadband") {
        s.deadband.enabled = number != 0.0;
    } else if (key == "deadband_position") {
        s.deadband.position = number;
    } else if (key == "deadband_silence_ms") {
        s.deadband.longest_silence = from_seconds(1e-3 * number);
    } else if (key == "deadband_speed") {
        s.deadband.position_weber = number;
    } else if (key == "deadband_force") {
        s.deadband.force = number;
    } else if (key == "deadband_weber") {
        s.deadband.force_weber = number;
    } else if (key == "seconds") {
        c.seconds = number;
    } else if (key == "phase_us") {
        c.phase = from_seconds(1e-6 * number);
    } else if (key == "late_ms") {
        c.late = from_seconds(1e-3 * number);
    } else if (key == "path_shift") {
        return read_vector(value, c.path_shift);
    } else if (key == "near") {
        s.stand_in.near = number;
    } else if (key == "leash") {
        s.stand_in.leash = number;
    } else if (key == "pose_noise") {
        c.pose_noise = number;
    } else if (key == "correct_from_touch") {
        c.correct_from_touch = number != 0.0;
    } else if (key == "discovers") {
        c.discovers = number != 0.0;
    } else if (key == "gravity_believed") {
        return read_vector(value, c.gravity_believed);
    } else if (key.rfind("event.", 0) == 0) {
        return read_event(value, c.events.emplace_back());
    } else if (key == "measured_from") {
        c.measured_from = number;
    } else if (key == "known_after_ms") {
        c.known_after = 1e-3 * number;
    } else if (key == "measured_to") {
        c.measured_to = number;
    } else if (key == "object") {
        c.object = value;
    } else if (key == "rows") {
        c.rows = value;
    } else if (key == "arm") {
        c.uses_arm = number != 0.0;
    } else if (key == "settled_from") {
        c.settled_from = number;
    } else if (key == "settled_to") {
        c.settled_to = number;
    } else if (key == "arm_mass") {
        c.arm.mass = number;
    } else if (key == "arm_damping") {
        c.arm.damping = number;
    } else if (key == "arm_stiffness") {
        c.arm.stiffness = number;
    } else {
        return set_wrong(key, value, c);
    }
    return true;
}

}  // namespace

bool read_case(std::istream& in, TeleopCase& c) {
    in >> c.name;
    for (std::string word; in >> word;) {
        const std::size_t equals = word.find('=');
        if (equals == std::string::npos || !set(word.substr(0, equals), word.substr(equals + 1), c)) {
            std::cerr << c.name << ": " << word << " is not understood\n";
            return false;
        }
    }
    return true;
}

}  // namespace tactus::shared
