#include "nodes/mmt_link.hpp"

#include <algorithm>
#include <godot_cpp/variant/callable.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/model_view.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"
#include "nodes/tree_walk.hpp"
#include "session/shared_environment.hpp"

namespace tactus {

using namespace godot;

namespace {

// { "rotation": [1, 0, 0, 0.17], "mass": 1.2 }: the axis and its angle in radians; factors. "turn" is the
// same in degrees, from before 1.0.
ModelError read_error(const Dictionary& from) {
    ModelError error;
    const auto vector = [](const Array& list) {
        const auto at = [&](int i) { return i < list.size() ? static_cast<double>(list[i]) : 0.0; };
        return Vec3(at(0), at(1), at(2));
    };
    const auto read_factor = [&from](const char* what) {
        const double value = from.get(what, 1.0);
        return is_at_least_zero(value) ? value : 1.0;
    };
    error.move = vector(from.get("move", Array()));
    const auto read_turn = [&](const char* what, double unit) {
        const Array turn = from.get(what, Array());
        if (const Vec3 axis = vector(turn); turn.size() == 4 && glm::length(axis) > 0.0) {
            error.turn = glm::angleAxis(unit * static_cast<double>(turn[3]), glm::normalize(axis));
        }
    };
    read_turn("turn", glm::radians(1.0));
    read_turn("rotation", 1.0);
    error.mass = read_factor("mass");
    error.friction = read_factor("friction");
    error.touch_friction = read_factor("touch_friction");
    error.stiffness = read_factor("stiffness");
    return error;
}

// The dictionary's values are numbers, all finite.
bool are_numbers(const Array& list) {
    for (int64_t i = 0; i < list.size(); ++i) {
        const Variant::Type type = list[i].get_type();
        if ((type != Variant::INT && type != Variant::FLOAT) ||
            !std::isfinite(static_cast<double>(list[i]))) {
            return false;
        }
    }
    return true;
}

// Why what is wrong of one body cannot be read; empty where it can.
String problem_of_error(const String& key, const Variant& value) {
    const bool is_move = key == "move", is_turn = key == "turn";
    if (is_move || is_turn || key == "rotation") {
        const int64_t count = is_move ? 3 : 4;
        const Array list = value.get_type() == Variant::ARRAY ? static_cast<Array>(value) : Array();
        return list.size() == count && are_numbers(list)
                   ? String()
                   : String(is_move   ? "move must be [x, y, z] in meters"
                            : is_turn ? "turn must be [x, y, z, degrees]: an axis and an angle"
                                      : "rotation must be [x, y, z, radians]: an axis and an angle");
    }
    if (key != "mass" && key != "friction" && key != "touch_friction" && key != "stiffness") {
        return "there is no '" + key +
               "': it is one of move, rotation, mass, friction, touch_friction, stiffness";
    }
    Array one;
    one.push_back(value);
    return are_numbers(one) && static_cast<double>(value) >= 0.0
               ? String()
               : "'" + key + String("' must be a factor: a number of at least 0");
}

String problem_of_errors(const Dictionary& errors) {
    const Array bodies = errors.keys();
    for (int64_t i = 0; i < bodies.size(); ++i) {
        const String body = bodies[i];
        if (errors[bodies[i]].get_type() != Variant::DICTIONARY) {
            return "of '" + body + "' it must be a dictionary";
        }
        const Dictionary wrong = errors[bodies[i]];
        const Array keys = wrong.keys();
        for (int64_t j = 0; j < keys.size(); ++j) {
            const String problem = problem_of_error(keys[j], wrong[keys[j]]);
            if (!problem.is_empty()) {
                return "of '" + body + "': " + problem;
            }
        }
    }
    return String();
}

}  // namespace

// --- properties

void MMTLink::changed() {
    ++revision_;
    update_configuration_warnings();
}

// The world is another one by this: it starts anew, with or without a far side.
void MMTLink::restart_world() {
    if (HapticWorld* world = is_inside_tree() ? HapticWorld::above(this) : nullptr) {
        world->link_changed();
    }
}

void MMTLink::scenario_changed() {
    changed();
    const Running now = !is_networked() ? Running::alone : has_robots() ? Running::robot : Running::bodies;
    if (std::exchange(running_, now) != now) {
        restart_world();
        take_report(at_rest(), {});
    }
}

void MMTLink::side_changed() {
    wire_.reset();
    changed();
    restart_world();
}

void MMTLink::history_changed() {
    changed();
    restart_world();
}

void MMTLink::partner_changed() {
    wire_.reset();
    changed();
}

void MMTLink::set_key_file(const String& path) {
    const String file = path.strip_edges();
    if (!file.is_empty() && !file.begins_with("/")) {
        refuse(
            *this, "key_file", file,
            "the absolute path of a file outside of the project, since a scene is shared and a key is not");
        return;
    }
    key_file_ = file;
    changed();
}

void MMTLink::set_model_errors(const Dictionary& errors) {
    if (const String problem = problem_of_errors(errors); !problem.is_empty()) {
        refuse(*this, "model_errors", errors, from_godot(problem).c_str());
        return;
    }
    model_errors_ = errors.duplicate(true);
    restart_world();
}

template <class Values>
bool MMTLink::take_old(const char* place, const Ref<Values>& own, const String& name, const Variant& value) {
    const std::string old = from_godot("MMTLink." + name);
    const char* now = new_name_of<Values>(old);
    if (now == nullptr) {
        return false;
    }
    if (own.is_null()) {
        set(place, memnew(Values));
    }
    own->set(now, value);
    warn_of_rename(old, std::string(place) + "." + now);
    return true;
}

bool MMTLink::_set(const StringName& name, const Variant& value) {
    return take_old("conditions", conditions_, name, value) || take_old("tuning", tuning_, name, value);
}

// --- what the world's run takes from here

LinkPlan MMTLink::plan() {
    LinkPlan plan;
    plan.is_operator = is_operator();
    plan.scenario = static_cast<std::uint8_t>(scenario_);
    plan.problem = from_godot(problem());
    plan.revision = revision_;
    plan.teleop = tuning_.is_valid() ? tuning_->settings() : TeleopSettings{};
    plan.teleop.traditional = scenario_ == SCENARIO_DIRECT || scenario_ == SCENARIO_DIRECT_ROBOT;
    plan.teleop.robot = has_robots();
    plan.teleop.correction = correction_;
    plan.history = history_;
    plan.teleop.control = control_;
    plan.network = network_settings();
    plan.key_file = from_godot(key_file_);
    if (conditions_.is_valid()) {
        plan.teleop.skew = conditions_->skew();
        plan.trace = conditions_->trace();
        plan.trace_problem = from_godot(conditions_->trace_problem());
    }
    if (MMTLink* const partner = plan.problem.empty() ? partner_node() : nullptr) {
        plan.wire = wire(*partner);
        plan.partner = from_godot(name_of(*partner));
    }
    return plan;
}

std::unordered_map<std::string, ModelError> MMTLink::model_errors() const {
    std::unordered_map<std::string, ModelError> errors;
    const Array names = model_errors_.keys();
    for (int64_t i = 0; i < names.size(); ++i) {
        if (const Variant wrong = model_errors_[names[i]]; wrong.get_type() == Variant::DICTIONARY) {
            errors[from_godot(String(names[i]))] = read_error(wrong);
        }
    }
    return errors;
}

NetworkSettings MMTLink::network_settings() const {
    NetworkSettings settings;
    settings.udp.local_address = from_godot(local_address_.strip_edges());
    settings.udp.local_port = static_cast<std::uint16_t>(local_port_);
    settings.udp.remote_address = from_godot(remote_address_.strip_edges());
    settings.udp.remote_port = static_cast<std::uint16_t>(remote_port_);
    settings.udp = with_usual_ports(settings.udp, is_operator());
    if (conditions_.is_valid()) {
        settings.conditions = conditions_->conditions();
        // Each side emulates the way that ends there.
        settings.seed = luck_of(conditions_->seed(), is_operator() ? Way::to_operator : Way::to_teleoperator);
    }
    return settings;
}

std::vector<MMTLink*> MMTLink::of(const HapticWorld& world) {
    std::vector<MMTLink*> links;
    for (MMTLink* link : Roll<MMTLink>::all()) {
        if (!link->is_networked() || HapticWorld::above(link) != &world) {
            continue;
        }
        const bool joins = links.empty() || (!links.front()->is_operator() && !link->is_operator() &&
                                             links.size() < SharedEnvironment::max_operators);
        if (joins) {
            links.push_back(link);
        }
    }
    return links;
}

// Why it is none of those that link its world; empty where it is one, or there are none.
String MMTLink::surplus_problem(const HapticWorld& world) const {
    const std::vector<MMTLink*> active = of(world);
    if (active.empty() || std::ranges::find(active, this) != active.end()) {
        return String();
    }
    if (active.size() == SharedEnvironment::max_operators) {
        return "this world has " + String::num_int64(SharedEnvironment::max_operators) +
               " operators already, each with an MMTLink: more are not possible";
    }
    return "another MMTLink, " + name_of(*active.front()) +
           ", links this world already, and only an environment may have several: remove one of the two";
}

MMTLink* MMTLink::partner_node() const {
    return node_at<MMTLink>(*this, partner_);
}

std::shared_ptr<MemoryLinkPair> MMTLink::wire(MMTLink& partner) {
    if (wire_ == nullptr || wire_ != partner.wire_) {
        wire_ = partner.wire_ != nullptr ? partner.wire_ : std::make_shared<MemoryLinkPair>();
        partner.wire_ = wire_;
    }
    return wire_;
}

// --- looking at it

LinkReport MMTLink::at_rest() const {
    LinkReport report;
    report.text = is_networked() ? "no HapticWorld is running above this node" : "one machine, no network";
    return report;
}

void MMTLink::clear_report() {
    report_ = at_rest();
    show_ghosts();
}

TypedArray<Dictionary> MMTLink::get_ghosts() const {
    TypedArray<Dictionary> ghosts;
    const SeenGhosts& seen = report_.teleop.ghosts;
    for (std::size_t i = 0; i < seen.count; ++i) {
        Dictionary ghost;
        ghost["pointer"] = seen.ghosts[i].pointer;
        ghost["position"] = to_godot(seen.ghosts[i].position);
        ghost["radius"] = seen.ghosts[i].radius;
        ghost["touching"] = seen.ghosts[i].touches;
        ghosts.push_back(ghost);
    }
    return ghosts;
}

void MMTLink::show_ghosts() {
    if (is_inside_tree()) {
        ghosts_.show(*this, show_ghosts_ ? report_.teleop.ghosts : SeenGhosts{});
    }
}

// Where no world runs it, this node alone can say why.
MMTLink::State MMTLink::get_state() const {
    const bool idle = report_.state == LinkState::off && is_networked() && is_inside_tree();
    return static_cast<State>(idle && !problem().is_empty() ? LinkState::failed : report_.state);
}

String MMTLink::get_state_text() const {
    const bool fails_by_itself = report_.state == LinkState::off && get_state() == STATE_FAILED;
    return fails_by_itself ? problem() : to_godot(report_.text);
}

void MMTLink::take_report(const LinkReport& report, const std::vector<ModelNews>& news) {
    const LinkReport before = std::exchange(report_, report);
    const bool was_connected = before.state == LinkState::connected;
    const bool is_connected = report.state == LinkState::connected;
    const auto say = [this](const char* signal, const auto&... values) {
        post_signal(*this, signal, {values...});
    };
    if (before.state != report.state || before.text != report.text) {
        say("state_changed", static_cast<int64_t>(report.state), to_godot(report.text));
    }
    if (report.teleop.link.peer_restarts > before.teleop.link.peer_restarts) {
        say("peer_restarted");
    }
    if (is_connected && !was_connected) {
        say("peer_connected");
    } else if (was_connected && (report.state == LinkState::lost || report.state == LinkState::left)) {
        say("peer_lost");
    }
    show_ghosts();
    for (const ModelNews& one : news) {
        switch (one.kind) {
            case ModelNews::Kind::discovered:
                say("object_discovered", to_godot(one.name), SignalArgument::object(one.node));
                break;
            case ModelNews::Kind::removed:
                say("object_removed", to_godot(one.name));
                break;
            case ModelNews::Kind::refused:
                say("object_refused", to_godot(one.name), to_godot(one.why));
                break;
        }
    }
}

// What keeps it from working, whatever the far side does.
String MMTLink::problem() const {
    const HapticWorld* world = HapticWorld::above(this);
    if (world == nullptr) {
        return "there is no HapticWorld above it: put it below the HapticWorld that is to be one of the two "
               "sides";
    }
    const String surplus = surplus_problem(*world);
    return surplus.is_empty() ? way_problem() : surplus;
}

// What keeps it from having a way to the far side.
String MMTLink::way_problem() const {
    if (partner_.is_empty()) {
        return to_godot(problem_of_addresses(network_settings().udp));
    }
    const MMTLink* partner = partner_node();
    if (partner == nullptr) {
        return wrong_path("partner", partner_, "an MMTLink") + ", or leave it empty for UDP";
    }
    if (partner == this || partner->side_ == side_) {
        return "its partner plays the same side: set one of the two to the operator, the other to the "
               "teleoperator";
    }
    if (partner->partner_node() != this) {
        return "its partner does not name it: set the 'partner' of " + name_of(*partner) + " to this node";
    }
    return String();
}

String MMTLink::problem_of_bodies() const {
    const bool has_model = scenario_ == SCENARIO_MMT || scenario_ == SCENARIO_MMT_ROBOT;
    const HapticWorld* const world = has_model && !is_operator() ? HapticWorld::above(this) : nullptr;
    return world != nullptr ? problem_of_transmission(*world) : String();
}

PackedStringArray MMTLink::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (!is_inside_tree()) {
        return warnings;
    }
    warn(warnings, "This MMTLink does nothing", problem());
    warn(warnings, "This MMTLink describes bodies in part", problem_of_bodies());
    if (conditions_.is_valid()) {
        warn(warnings, "The conditions of this MMTLink emulate no trace", conditions_->trace_problem());
        for (const std::string& note : conditions_->notes()) {
            warn(warnings, "The conditions of this MMTLink are not all that they read", to_godot(note));
        }
    }
    const HapticWorld* world = HapticWorld::above(this);
    if (world != nullptr && scaling_of(frame_of(world->get_global_transform())) != Mat3(1.0)) {
        warnings.push_back(
            "The HapticWorld of this MMTLink is scaled, and lengths travel as they are: take the scale away, "
            "on both sides.");
    }
    return warnings;
}

void MMTLink::_notification(int what) {
    keep_roll(*this, what);
    if (what == NOTIFICATION_ENTER_TREE && is_networked()) {
        restart_world();
    } else if (what == NOTIFICATION_EXIT_TREE) {
        wire_.reset();
        clear_report();
    }
}

}  // namespace tactus
