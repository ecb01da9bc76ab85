#include "nodes/mmt_link.hpp"

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/variant/callable.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"

namespace tactus {

using namespace godot;

namespace {

// Where a side listens when nothing else is said.
constexpr int usual_port_of_operator = 47001;
constexpr int usual_port_of_teleoperator = 47002;

// Every value of a side without resources of its own.
const NetworkConditions::Values& usual_conditions() {
    static const NetworkConditions::Values values;
    return values;
}

}  // namespace

MMTLink::MMTLink() : seed_(usual_conditions().seed) {
    clear_report();
}

// --- properties
// ------------------------------------------------------------------------------------------------------

void MMTLink::changed() {
    ++revision_;
    update_configuration_warnings();
}

void MMTLink::way_changed() {
    ++way_revision_;
    changed();
}

// The world is another one by this: it starts anew, with or without a far side.
void MMTLink::restart_world() {
    changed();
    if (HapticWorld* world = is_inside_tree() ? HapticWorld::above(this) : nullptr) {
        world->link_changed();
    }
}

void MMTLink::set_scenario(Scenario scenario) {
    if (scenario != SCENARIO_SINGLE && scenario != SCENARIO_TRADITIONAL && scenario != SCENARIO_MMT) {
        refuse(*this, "scenario", static_cast<int64_t>(scenario), "1, 2 or 4");
        return;
    }
    const bool was_networked = is_networked();
    scenario_ = scenario;
    if (was_networked != is_networked()) {
        restart_world();
        take_report(at_rest(), {});
    } else {
        changed();
    }
}

void MMTLink::set_side(Side side) {
    if (side != SIDE_OPERATOR && side != SIDE_TELEOPERATOR) {
        refuse(*this, "side", static_cast<int64_t>(side), "0 (operator) or 1 (teleoperator)");
        return;
    }
    if (side_ != side) {
        side_ = side;
        wire_.reset();
        ++way_revision_;
        restart_world();
    }
}

void MMTLink::set_partner(const NodePath& path) {
    partner_ = path;
    wire_.reset();
    way_changed();
}

void MMTLink::set_local_address(const String& address) {
    local_address_ = address.strip_edges();
    way_changed();
}

void MMTLink::set_local_port(int64_t port) {
    if (port < 0 || port > 65535) {
        refuse(*this, "local_port", port, "0 (the side's usual one) or a port, 1 to 65535");
        return;
    }
    local_port_ = static_cast<int>(port);
    way_changed();
}

void MMTLink::set_remote_address(const String& address) {
    remote_address_ = address.strip_edges();
    way_changed();
}

void MMTLink::set_remote_port(int64_t port) {
    if (port < 0 || port > 65535) {
        refuse(*this, "remote_port", port, "0 (the far side's usual one) or a port, 1 to 65535");
        return;
    }
    remote_port_ = static_cast<int>(port);
    way_changed();
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
    way_changed();
}

void MMTLink::set_control_scheme(int64_t scheme) {
    if (!is_one_of(*this, "control_scheme", scheme,
                   static_cast<int64_t>(ControlScheme::position_force_relative), "CONTROL")) {
        return;
    }
    control_ = static_cast<ControlScheme>(scheme);
    changed();
}

void MMTLink::set_correction_scheme(int64_t scheme) {
    if (!is_one_of(*this, "correction_scheme", scheme, static_cast<int64_t>(Correction::passive),
                   "CORRECTION")) {
        return;
    }
    correction_ = static_cast<Correction>(scheme);
    changed();
}

template <class Values>
void MMTLink::exchange(Ref<Values>& own, const Ref<Values>& other) {
    const Callable on_change(this, "_values_changed");
    if (own.is_valid()) {
        own->disconnect("changed", on_change);
    }
    own = other;
    if (own.is_valid()) {
        own->connect("changed", on_change);
    }
    values_changed();
}

void MMTLink::set_conditions(const Ref<NetworkConditions>& conditions) {
    exchange(conditions_, conditions);
}

void MMTLink::set_tuning(const Ref<TeleopTuning>& tuning) {
    exchange(tuning_, tuning);
}

void MMTLink::values_changed() {
    const std::uint64_t seed = conditions_.is_valid() ? conditions_->seed() : usual_conditions().seed;
    std::exchange(seed_, seed) != seed ? way_changed() : changed();
}

template <class Values>
bool MMTLink::take_old(Ref<Values>& own, const char* place, const String& name, const Variant& value) {
    const char* now = new_name_of(Values::rows(), "MMTLink." + name);
    if (now == nullptr) {
        return false;
    }
    if (own.is_null()) {
        exchange(own, Ref<Values>(memnew(Values)));
    }
    own->set(now, value);
    if (!std::exchange(is_old_, true)) {
        UtilityFunctions::push_warning(name_of(*this), ": ", name, " is ", place, ".", now,
                                       " now, and other properties have moved likewise. They were taken "
                                       "over: save the scene to keep them there.");
    }
    return true;
}

bool MMTLink::_set(const StringName& name, const Variant& value) {
    return take_old(conditions_, "conditions", name, value) || take_old(tuning_, "tuning", name, value);
}

void MMTLink::set_model_errors(const Dictionary& errors) {
    model_errors_ = errors;
    restart_world();
}

// --- what the world's run takes from here
// ---------------------------------------------------------------------------

TeleopSettings MMTLink::teleop_settings() const {
    TeleopSettings settings = tuning_.is_valid() ? tuning_->settings() : TeleopSettings{};
    settings.traditional = scenario_ == SCENARIO_TRADITIONAL;
    settings.correction = correction_;
    settings.control = control_;
    settings.skew = conditions_.is_valid() ? conditions_->skew() : ClockSkew{};
    return settings;
}

LinkConditions MMTLink::conditions() const {
    return conditions_.is_valid() ? conditions_->conditions() : LinkConditions{};
}

std::shared_ptr<const DelayTrace> MMTLink::trace() const {
    return conditions_.is_valid() ? conditions_->trace() : nullptr;
}

NetworkSettings MMTLink::network_settings() const {
    const int own = is_operator() ? usual_port_of_operator : usual_port_of_teleoperator;
    const int other = is_operator() ? usual_port_of_teleoperator : usual_port_of_operator;
    NetworkSettings settings;
    settings.udp.local_address = from_godot(local_address_);
    settings.udp.local_port = static_cast<std::uint16_t>(local_port_ > 0 ? local_port_ : own);
    settings.udp.remote_address = from_godot(remote_address_);
    settings.udp.remote_port = static_cast<std::uint16_t>(remote_port_ > 0 ? remote_port_ : other);
    settings.conditions = conditions();
    settings.seed = seed_;
    return settings;
}

String MMTLink::trace_problem() const {
    return conditions_.is_valid() ? conditions_->trace_problem() : String();
}

MMTLink* MMTLink::of(const HapticWorld& world) {
    for (MMTLink* link : Roll<MMTLink>::all()) {
        if (link->is_networked() && HapticWorld::above(link) == &world) {
            return link;
        }
    }
    return nullptr;
}

MMTLink* MMTLink::partner_node() const {
    return is_inside_tree() && !partner_.is_empty() ? cast_to<MMTLink>(get_node_or_null(partner_)) : nullptr;
}

std::shared_ptr<MemoryLinkPair> MMTLink::wire() {
    MMTLink* const partner = partner_node();
    if (partner == nullptr) {
        return nullptr;
    }
    if (wire_ == nullptr || wire_ != partner->wire_) {
        wire_ = partner->wire_ != nullptr ? partner->wire_ : std::make_shared<MemoryLinkPair>();
        partner->wire_ = wire_;
    }
    return wire_;
}

// --- looking at it
// ---------------------------------------------------------------------------------------------------

LinkReport MMTLink::at_rest() const {
    LinkReport report;
    report.state = STATE_OFF;
    report.text = is_networked() ? "no HapticWorld is running above this node" : "one machine, no network";
    return report;
}

void MMTLink::clear_report() {
    report_ = at_rest();
    restarts_seen_ = 0;
}

// Where no world runs it, this node alone can say why.
MMTLink::State MMTLink::get_state() const {
    const bool idle = report_.state == STATE_OFF && is_networked() && is_inside_tree();
    return idle && !problem().is_empty() ? STATE_FAILED : static_cast<State>(report_.state);
}

String MMTLink::get_state_text() const {
    const bool fails_by_itself = report_.state == STATE_OFF && get_state() == STATE_FAILED;
    return fails_by_itself ? problem() : report_.text;
}

void MMTLink::take_report(const LinkReport& report, const std::vector<ModelNews>& news) {
    const LinkReport before = std::exchange(report_, report);
    const bool was_connected = before.state == STATE_CONNECTED;
    const bool is_connected = report.state == STATE_CONNECTED;
    const bool restarted = report.teleop.link.peer_restarts > restarts_seen_;
    restarts_seen_ = report.teleop.link.peer_restarts;
    const auto say = [this](const char* signal, const auto&... values) {
        post_signal(*this, signal, {values...});
    };
    if (before.state != report.state || before.text != report.text) {
        say("state_changed", static_cast<int64_t>(report.state), report.text);
    }
    if (restarted) {
        say("peer_restarted");
    }
    if (is_connected && !was_connected) {
        say("peer_connected");
    } else if (was_connected && (report.state == STATE_LOST || report.state == STATE_LEFT)) {
        say("peer_lost");
    }
    for (const ModelNews& one : news) {
        switch (one.kind) {
            case ModelNews::Kind::discovered:
                say("object_discovered", one.name, NodeId{one.node});
                break;
            case ModelNews::Kind::removed:
                say("object_removed", one.name);
                break;
            case ModelNews::Kind::refused:
                say("object_refused", one.name, one.why);
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
    if (const MMTLink* active = of(*world); active != nullptr && active != this) {
        return "another MMTLink, " + name_of(*active) + ", links this world already: remove one of the two";
    }
    return way_problem();
}

// What keeps it from having a way to the far side.
String MMTLink::way_problem() const {
    if (partner_.is_empty()) {
        if (remote_address_.is_empty()) {
            return "the far side has no address: set 'remote_address'";
        }
        const NetworkSettings settings = network_settings();
        const bool loops = remote_address_ == String("127.0.0.1") || remote_address_ == String("localhost") ||
                           remote_address_ == String("::1");
        if (loops && settings.udp.local_port == settings.udp.remote_port) {
            return "it would talk to itself: on one machine the two sides need different ports";
        }
        return String();
    }
    const MMTLink* partner = partner_node();
    if (partner == nullptr) {
        return "its partner '" + String(partner_) +
               "' is not an MMTLink of the scene: set 'partner' anew, or leave it empty for UDP";
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

PackedStringArray MMTLink::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (!is_inside_tree()) {
        return warnings;
    }
    if (const String wrong = problem(); !wrong.is_empty()) {
        warnings.push_back("This MMTLink does nothing: " + wrong + ".");
    }
    if (const String wrong = trace_problem(); !wrong.is_empty()) {
        warnings.push_back("The conditions of this MMTLink emulate no trace: " + wrong + ".");
    }
    const HapticWorld* world = HapticWorld::above(this);
    if (world != nullptr && !world->get_global_transform().is_equal_approx(Transform3D())) {
        warnings.push_back(
            "The HapticWorld of this MMTLink is moved, turned or scaled. Places travel as they are in the "
            "scene: put "
            "it at the origin, on both sides.");
    }
    return warnings;
}

void MMTLink::_notification(int what) {
    if (what == NOTIFICATION_ENTER_TREE) {
        watch_warnings(*this);
    }
    if (Engine::get_singleton()->is_editor_hint()) {
        return;
    }
    if (what == NOTIFICATION_ENTER_TREE) {
        Roll<MMTLink>::enter(this);
        if (is_networked()) {
            if (HapticWorld* world = HapticWorld::above(this)) {
                world->link_changed();
            }
        }
    } else if (what == NOTIFICATION_EXIT_TREE) {
        Roll<MMTLink>::leave(this);
        wire_.reset();
        clear_report();
    }
}

}  // namespace tactus
