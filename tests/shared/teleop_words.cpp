#include "shared/teleop_words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/geometric.hpp>
#include <iostream>
#include <sstream>
#include <string_view>

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

// All was read, and nothing is left over.
bool has_ended(std::istream& in) {
    return !in.fail() && (in >> std::ws).eof();
}

// X,Y,Z
bool read_vector(std::string text, Vec3& out) {
    std::ranges::replace(text, ',', ' ');
    std::istringstream in(text);
    out = read_vector(in);
    return has_ended(in);
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
    return has_ended(in);
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

// acts.NUMBER=BODY;WHAT=VALUES;…
bool read_actor(const std::string& text, TeleopActor& actor) {
    std::istringstream parts(text);
    std::getline(parts, actor.body, ';');
    bool is_read = !actor.body.empty();
    for (std::string part; is_read && std::getline(parts, part, ';');) {
        const std::size_t equals = std::min(part.find('='), part.size() - 1);
        const std::string what = part.substr(0, equals);
        std::string values = part.substr(equals + 1);
        std::ranges::replace(values, ',', ' ');
        std::istringstream in(values);
        if (what == "spring") {
            in >> actor.stiffness >> actor.damping;
        } else if (what == "plane") {
            actor.normal = glm::normalize(read_vector(in));
            in >> actor.gap;
        } else if (what == "way") {
            in >> actor.way >> actor.period;
        } else if (what == "draft") {
            actor.draft = read_vector(in);
        } else if (what == "time") {
            in >> actor.from >> actor.to;
        } else {
            return false;
        }
        is_read = has_ended(in);
    }
    return is_read && actor.period > 0.0;
}

// A key that stands for a number, and where it belongs.
struct NumberWord {
    std::string_view key;
    double least, most;
    bool is_whole;
    void (*set)(TeleopCase&, double);
};

constexpr double plenty = 1e9;
constexpr double longest_ms = 20'000.0;  // of a delay there and back

std::uint32_t natural(double number) {
    return static_cast<std::uint32_t>(number);
}

constexpr NumberWord number_words[] = {
    {"traditional", 0, 1, true, [](TeleopCase& c, double n) { c.settings.traditional = n != 0.0; }},
    {"robot", 0, 1, true,
     [](TeleopCase& c, double n) { c.robot = c.settings.robot = c.settings.traditional = n != 0.0; }},
    {"robot_mass", 0.1, 10, false, [](TeleopCase& c, double n) { c.robot_mass = n; }},
    {"robot_friction", 0, 10, false, [](TeleopCase& c, double n) { c.robot_friction = n; }},
    {"wave_impedance", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.passive.impedance = n; }},
    {"wave_cutoff", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.passive.wave_cutoff = n; }},
    {"drift_rate", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.passive.drift_rate = n; }},
    {"reserve", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.passive.reserve = n; }},
    {"lightest_hand", 0, plenty, false,
     [](TeleopCase& c, double n) { c.settings.passive.lightest_hand = n; }},
    {"far_store", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.passive.far_store = n; }},
    {"tank", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.passive.tank = n; }},
    {"refill", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.passive.refill = n; }},
    {"tank_share", 0, 1, false, [](TeleopCase& c, double n) { c.settings.passive.shared = n; }},
    {"largest_damping", 0, plenty, false,
     [](TeleopCase& c, double n) { c.settings.passive.largest_damping = n; }},
    {"largest_yield", 0, plenty, false,
     [](TeleopCase& c, double n) { c.settings.passive.largest_yield = n; }},
    {"softening_ms", 0, 1e6, false, [](TeleopCase& c, double n) { c.settings.passive.softening = 1e-3 * n; }},
    {"newest", 0, 1, true, [](TeleopCase& c, double n) { c.settings.newest_wins = n != 0.0; }},
    {"stand_in_speed", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.stand_in.speed = n; }},
    {"update_bring_in", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.update.bring_in = n; }},
    {"update_take_out", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.update.take_out = n; }},
    {"update_tank", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.update.tank = n; }},
    // There and back.
    {"delay_ms", 0, longest_ms, false,
     [](TeleopCase& c, double n) { c.forth.delay = c.back.delay = from_seconds(0.5e-3 * n); }},
    {"jitter_ms", 0, 10'000, false,
     [](TeleopCase& c, double n) { c.forth.jitter = c.back.jitter = from_seconds(1e-3 * n); }},
    {"loss", 0, 1, false, [](TeleopCase& c, double n) { c.forth.loss = c.back.loss = n; }},
    {"loss_forth", 0, 1, false, [](TeleopCase& c, double n) { c.forth.loss = n; }},
    {"loss_back", 0, 1, false, [](TeleopCase& c, double n) { c.back.loss = n; }},
    {"burst", 0, 0.95, false, [](TeleopCase& c, double n) { c.forth.burst = c.back.burst = bursts(n, 5.0); }},
    {"seed", 0, 0x1p53, true, [](TeleopCase& c, double n) { c.seed = static_cast<std::uint64_t>(n); }},
    {"states_every", 1, 1e6, true, [](TeleopCase& c, double n) { c.settings.states_every = natural(n); }},
    {"refresh_every", 0, 1e6, true, [](TeleopCase& c, double n) { c.settings.refresh_every = natural(n); }},
    {"repeats", 0, 1e6, true, [](TeleopCase& c, double n) { c.settings.repeats = natural(n); }},
    {"buffer", 0, 1e6, true, [](TeleopCase& c, double n) { c.settings.buffer_depth = natural(n); }},
    {"replay_steps", 0, 1e6, true, [](TeleopCase& c, double n) { c.settings.replay_steps = natural(n); }},
    {"share", 0, 1e6, false, [](TeleopCase& c, double n) { c.settings.stealth.share = n; }},
    {"let_go", 0, 1e6, false, [](TeleopCase& c, double n) { c.settings.stealth.let_go_seconds = n; }},
    {"hidden_bound", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.stealth.bound = n; }},
    {"estimate", 0, 1, false, [](TeleopCase& c, double n) { c.settings.estimate.gain = n; }},
    {"residual", 0, 1, false, [](TeleopCase& c, double n) { c.settings.residual.gain = n; }},
    {"residual_margin", 0, 10, false, [](TeleopCase& c, double n) { c.settings.residual.margin = n; }},
    {"residual_least", 0, 100, false,
     [](TeleopCase& c, double n) {
         c.settings.residual.least = n;
         c.settings.residual.least_turn = 20.0 * n;
     }},
    {"residual_time", 1e-3, 10, false, [](TeleopCase& c, double n) { c.settings.residual.time = n; }},
    {"fade_window", 0, 1e6, false, [](TeleopCase& c, double n) { c.settings.stealth.window = n; }},
    {"deadband", 0, 1, true, [](TeleopCase& c, double n) { c.settings.deadband.enabled = n != 0.0; }},
    {"deadband_position", 0, 1, false, [](TeleopCase& c, double n) { c.settings.deadband.position = n; }},
    {"deadband_silence_ms", 0, 1e6, false,
     [](TeleopCase& c, double n) { c.settings.deadband.longest_silence = from_seconds(1e-3 * n); }},
    {"deadband_speed", 0, 1e6, false,
     [](TeleopCase& c, double n) { c.settings.deadband.position_weber = n; }},
    {"deadband_force", 0, 1e6, false, [](TeleopCase& c, double n) { c.settings.deadband.force = n; }},
    {"deadband_weber", 0, 1e6, false, [](TeleopCase& c, double n) { c.settings.deadband.force_weber = n; }},
    {"history_ms", 1, longest_ms, false, [](TeleopCase& c, double n) { c.history = 1e-3 * n; }},
    {"seconds", 0.001, 1e5, false, [](TeleopCase& c, double n) { c.seconds = n; }},
    {"phase_us", 0, 999, false, [](TeleopCase& c, double n) { c.phase = from_seconds(1e-6 * n); }},
    {"late_ms", 0, 1e6, false, [](TeleopCase& c, double n) { c.late = from_seconds(1e-3 * n); }},
    {"near", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.stand_in.near = n; }},
    {"leash", 0, plenty, false, [](TeleopCase& c, double n) { c.settings.stand_in.leash = n; }},
    {"pose_noise", 0, 1, false, [](TeleopCase& c, double n) { c.pose_noise = n; }},
    {"correct_from_touch", 0, 1, true, [](TeleopCase& c, double n) { c.correct_from_touch = n != 0.0; }},
    {"discovers", 0, 1, true, [](TeleopCase& c, double n) { c.discovers = n != 0.0; }},
    {"measured_from", 0, plenty, false, [](TeleopCase& c, double n) { c.measured_from = n; }},
    {"measured_to", 0, plenty, false, [](TeleopCase& c, double n) { c.measured_to = n; }},
    {"known_after_ms", 0, 1e6, false, [](TeleopCase& c, double n) { c.known_after = 1e-3 * n; }},
    {"arm", 0, 1, true, [](TeleopCase& c, double n) { c.uses_arm = n != 0.0; }},
    {"settled_from", 0, 1e6, false, [](TeleopCase& c, double n) { c.settled_from = n; }},
    {"settled_to", 0, 1e6, false, [](TeleopCase& c, double n) { c.settled_to = n; }},
    {"arm_mass", 1e-3, 1e3, false, [](TeleopCase& c, double n) { c.arm.mass = n; }},
    {"arm_damping", 0, 1e6, false, [](TeleopCase& c, double n) { c.arm.damping = n; }},
    {"arm_stiffness", 0, 1e6, false, [](TeleopCase& c, double n) { c.arm.stiffness = n; }},
};

// Empty, or what is allowed.
std::string set_number(const NumberWord& word, const std::string& value, TeleopCase& c) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    const bool is_number =
        error == std::errc{} && end == value.data() + value.size() && std::isfinite(number);
    if (!is_number || number < word.least || number > word.most ||
        (word.is_whole && number != std::floor(number))) {
        std::ostringstream allowed;
        allowed.precision(16);
        allowed << "it must be a " << (word.is_whole ? "whole number" : "number") << " from " << word.least
                << " to " << word.most;
        return allowed.str();
    }
    word.set(c, number);
    return {};
}

// Empty, or what is wrong with it.
std::string chosen(bool found, const char* names) {
    return found ? std::string() : std::string("it must be one of ") + names;
}

std::string set(const std::string& key, const std::string& value, TeleopCase& c) {
    const auto* const word = std::ranges::find(number_words, key, &NumberWord::key);
    if (word != std::end(number_words)) {
        return set_number(*word, value, c);
    }
    TeleopSettings& s = c.settings;
    if (key == "passivity") {
        return chosen(choose(value, {"none", "wave_variables", "time_domain", "two_layers"}, s.passivity),
                      "none, wave_variables, time_domain, two_layers");
    }
    if (key == "correction") {
        return chosen(
            choose(value,
                   {"none", "pose", "pose_velocity", "stealthy_magnitude", "stealthy_direction",
                    "stealthy_translate", "stealthy_turn", "passive"},
                   s.correction),
            "none, pose, pose_velocity, stealthy_magnitude, stealthy_direction, stealthy_translate, "
            "stealthy_turn, passive");
    }
    if (key == "derivation") {
        return chosen(choose(value, {"none", "velocity", "acceleration", "averaged", "history", "resimulate"},
                             s.derivation),
                      "none, velocity, acceleration, averaged, history, resimulate");
    }
    if (key == "control") {
        return chosen(
            choose(value, {"spring", "position", "position_force", "position_force_relative"}, s.control),
            "spring, position, position_force, position_force_relative");
    }
    if (key == "path_shift" || key == "gravity_believed") {
        return read_vector(value, key == "path_shift" ? c.path_shift : c.gravity_believed)
                   ? ""
                   : "it must be X,Y,Z";
    }
    if (key.rfind("event.", 0) == 0) {
        return read_event(value, c.events.emplace_back()) ? "" : "it must be SECONDS,KIND[,BODY or AMOUNT]";
    }
    if (key.rfind("acts.", 0) == 0) {
        return read_actor(value, c.actors.emplace_back())
                   ? ""
                   : "it must be BODY;spring=NEWTONS_A_METER,DAMPING;plane=X,Y,Z,GAP;way=METERS,SECONDS;"
                     "draft=X,Y,Z;time=FROM,TO, of which all but the body may be left out";
    }
    if (key.rfind("hinge.", 0) == 0) {
        return read_vector(value, c.hidden_hinges[key.substr(6)]) ? "" : "it must be X,Y,Z";
    }
    if (key == "object" || key == "rows") {
        (key == "object" ? c.object : c.rows) = value;
        return {};
    }
    return set_wrong(key, value, c) ? "" : "there is no such key, or its value is of another kind";
}

}  // namespace

bool read_case(std::istream& in, TeleopCase& c) {
    in >> c.name;
    for (std::string word; in >> word;) {
        const std::size_t equals = word.find('=');
        const std::string problem = equals == std::string::npos
                                        ? "it must be KEY=VALUE"
                                        : set(word.substr(0, equals), word.substr(equals + 1), c);
        if (!problem.empty()) {
            std::cerr << c.name << ": " << word << " is refused: " << problem << "\n";
            return false;
        }
    }
    return true;
}

}  // namespace tactus::shared
