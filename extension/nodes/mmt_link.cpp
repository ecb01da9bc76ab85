#include "nodes/mmt_link.hpp"

#include <algorithm>
#include <cmath>
#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/file_access.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/callable.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/roll.hpp"

namespace tactus {

using namespace godot;

namespace {

// Where a side listens when nothing else is said.
constexpr int usual_port_of_operator = 47001;
constexpr int usual_port_of_teleoperator = 47002;

struct NumberRow {
    const char* name;
    double initial;
    double least, most;  // what is accepted
    const char* hint;    // what the inspector's slider offers
};

// In the order of MMTLink::Number.
const NumberRow number_rows[] = {
    {"emulated_delay", 0.0, 0.0, 10.0, "0,1,0.001,or_greater,suffix:s"},
    {"emulated_jitter", 0.0, 0.0, 10.0, "0,0.1,0.0001,or_greater,suffix:s"},
    {"emulated_loss", 0.0, 0.0, 1.0, "0,1,0.001"},
    {"emulated_burst_loss", 0.0, 0.0, 0.95, "0,0.95,0.001"},
    {"emulated_burst_length", 5.0, 1.0, 10000.0, "1,100,0.1,or_greater"},
    {"emulated_duplication", 0.0, 0.0, 1.0, "0,1,0.001"},
    {"emulated_reordering", 0.0, 0.0, 1.0, "0,1,0.001"},
    {"emulated_reorder_by", to_seconds(LinkConditions{}.reorder_by), 0.0, 10.0,
     "0,0.1,0.0001,or_greater,suffix:s"},
    {"emulated_rate", 0.0, 0.0, 1e11, "0,10000000,1000,or_greater,suffix:bit/s"},
    {"emulated_clock_offset", 0.0, -1e6, 1e6, "-10,10,0.001,or_less,or_greater,suffix:s"},
    {"emulated_clock_drift", 0.0, -1e-3, 1e-3, "-0.001,0.001,0.000001"},
    {"stand_in_speed", StandInSettings{}.speed, 1e-3, 100.0, "0.01,5,0.01,or_greater,suffix:m/s"},
    {"stand_in_near", StandInSettings{}.near, 1e-4, 1.0, "0.001,0.2,0.001,or_greater,suffix:m"},
    {"stand_in_leash", StandInSettings{}.leash, 0.0, 1.0, "0,0.2,0.001,or_greater,suffix:m"},
    {"threshold_position", MotionThreshold{}.position, 0.0, 1.0, "0,0.01,0.00001,or_greater,suffix:m"},
    {"threshold_angle", MotionThreshold{}.angle, 0.0, 3.2, "0,0.1,0.0001,or_greater,suffix:rad"},
    {"threshold_velocity", MotionThreshold{}.linear_velocity, 0.0, 100.0,
     "0,0.1,0.0001,or_greater,suffix:m/s"},
    {"threshold_angular_velocity", MotionThreshold{}.angular_velocity, 0.0, 100.0,
     "0,1,0.001,or_greater,suffix:rad/s"},
    {"stealth_weber", StealthSettings{}.weber, 0.0, 1.0, "0,0.3,0.001"},
    {"stealth_least", StealthSettings{}.least_noticeable, 1e-4, 10.0, "0.001,0.2,0.001,or_greater,suffix:N"},
    {"stealth_share", StealthSettings{}.share, 1e-3, 100.0, "0.01,2,0.01,or_greater"},
    {"stealth_window", StealthSettings{}.window, 1e-3, 10.0, "0.01,1,0.01,or_greater,suffix:s"},
    {"stealth_free_speed", StealthSettings{}.free_speed, 1e-3, 100.0, "0.01,2,0.01,or_greater,suffix:m/s"},
    {"stealth_longest_offset", StealthSettings{}.longest_offset, 0.0, 1.0, "0,0.2,0.001,or_greater,suffix:m"},
    {"parameter_learning", EstimateSettings{}.gain, 0.0, 1.0, "0,1,0.01"},
    {"deadband_position", DeadbandSettings{}.position, 0.0, 1.0, "0,0.01,0.00001,or_greater,suffix:m"},
    {"deadband_position_weber", DeadbandSettings{}.position_weber, 0.0, 1.0, "0,0.5,0.001"},
    {"deadband_angle", DeadbandSettings{}.angle, 0.0, 3.2, "0,0.1,0.0001,or_greater,suffix:rad"},
    {"deadband_force", DeadbandSettings{}.force, 0.0, 100.0, "0,0.2,0.001,or_greater,suffix:N"},
    {"deadband_force_weber", DeadbandSettings{}.force_weber, 0.0, 1.0, "0,0.5,0.001"},
    {"deadband_longest_silence", to_seconds(DeadbandSettings{}.longest_silence), 1e-3, 0.9,
     "0.001,0.9,0.001,suffix:s"},
};
static_assert(std::size(number_rows) == MMTLink::NUMBER_COUNT);

struct CountRow {
    const char* name;
    int64_t initial, least, most;
    const char* hint;
};

// In the order of MMTLink::Count.
const CountRow count_rows[] = {
    {"emulated_seed", 1, 0, std::int64_t{1} << 62, "0,1000,1,or_greater"},
    {"states_every", TeleopSettings{}.states_every, 1, 10000, "1,100,1,or_greater,suffix:ticks"},
    {"refresh_every", TeleopSettings{}.refresh_every, 1, 100000, "1,1000,1,or_greater,suffix:ticks"},
    {"repeated_samples", TeleopSettings{}.repeats, 1, 9, "1,9,1"},
    {"buffer_depth", TeleopSettings{}.buffer_depth, 0, 200, "0,200,1,suffix:ticks"},
};
static_assert(std::size(count_rows) == MMTLink::COUNT_COUNT);

}  // namespace

MMTLink::MMTLink() {
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
        numbers_[i] = number_rows[i].initial;
    }
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        counts_[i] = count_rows[i].initial;
    }
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

void MMTLink::set_local_port(int port) {
    if (port < 0 || port > 65535) {
        refuse(*this, "local_port", port, "0 (the side's usual one) or a port, 1 to 65535");
        return;
    }
    local_port_ = port;
    way_changed();
}

void MMTLink::set_remote_address(const String& address) {
    remote_address_ = address.strip_edges();
    way_changed();
}

void MMTLink::set_remote_port(int port) {
    if (port < 0 || port > 65535) {
        refuse(*this, "remote_port", port, "0 (the far side's usual one) or a port, 1 to 65535");
        return;
    }
    remote_port_ = port;
    way_changed();
}

void MMTLink::set_key(const String& key) {
    key_ = key;
    way_changed();
}

void MMTLink::set_jitter_shape(JitterShape shape) {
    jitter_shape_ = std::clamp(shape, JITTER_UNIFORM, JITTER_TRACE);
    changed();
}

void MMTLink::set_trace_file(const String& path) {
    trace_file_ = path;
    trace_.reset();
    trace_error_ = String();
    if (!path.is_empty()) {
        if (!FileAccess::file_exists(path)) {
            trace_error_ = "there is no file '" + path + "'";
        } else if (DelayTraceResult read =
                       parse_delay_trace(from_godot(FileAccess::get_file_as_string(path)));
                   read.error.empty()) {
            trace_ = std::make_shared<const DelayTrace>(std::move(read.trace));
        } else {
            trace_error_ = "'" + path + "': " + to_godot(read.error);
        }
    }
    changed();
}

void MMTLink::set_keep_order(bool keep) {
    keep_order_ = keep;
    changed();
}

void MMTLink::set_control_scheme(ControlScheme scheme) {
    control_ = std::clamp(scheme, CONTROL_SPRING, CONTROL_POSITION_FORCE_RELATIVE);
    changed();
}

void MMTLink::set_correction_scheme(CorrectionScheme scheme) {
    correction_ = std::clamp(scheme, CORRECTION_NONE, CORRECTION_STEALTHY_TURN);
    changed();
}

void MMTLink::set_derivation(Derivation derivation) {
    derivation_ = std::clamp(derivation, DERIVATION_NONE, DERIVATION_RESIMULATE);
    changed();
}

void MMTLink::set_deadband(bool enabled) {
    deadband_ = enabled;
    changed();
}

void MMTLink::set_model_errors(const Dictionary& errors) {
    model_errors_ = errors;
    restart_world();
}

void MMTLink::set_number(int which, double value) {
    if (which < 0 || which >= NUMBER_COUNT) {
        refuse(*this, "number", which, "one of the class's constants");
        return;
    }
    const NumberRow& row = number_rows[which];
    if (!(value >= row.least && value <= row.most)) {
        const std::string range =
            "between " + from_godot(String::num(row.least)) + " and " + from_godot(String::num(row.most));
        refuse(*this, row.name, value, range.c_str());
        return;
    }
    numbers_[static_cast<std::size_t>(which)] = value;
    changed();
}

double MMTLink::get_number(int which) const {
    return which >= 0 && which < NUMBER_COUNT ? numbers_[static_cast<std::size_t>(which)] : 0.0;
}

void MMTLink::set_count(int which, int64_t value) {
    if (which < 0 || which >= COUNT_COUNT) {
        refuse(*this, "count", which, "one of the class's constants");
        return;
    }
    const CountRow& row = count_rows[which];
    if (value < row.least || value > row.most) {
        const std::string range = "between " + std::to_string(row.least) + " and " + std::to_string(row.most);
        refuse(*this, row.name, value, range.c_str());
        return;
    }
    counts_[static_cast<std::size_t>(which)] = value;
    which == COUNT_SEED ? way_changed() : changed();
}

int64_t MMTLink::get_count(int which) const {
    return which >= 0 && which < COUNT_COUNT ? counts_[static_cast<std::size_t>(which)] : 0;
}

// --- what the world's run takes from here
// ---------------------------------------------------------------------------

TeleopSettings MMTLink::teleop_settings() const {
    const auto number = [this](Number which) { return get_number(which); };
    const auto count = [this](Count which) { return static_cast<std::uint32_t>(get_count(which)); };
    TeleopSettings s;
    s.traditional = scenario_ == SCENARIO_TRADITIONAL;
    s.derivation = static_cast<tactus::Derivation>(derivation_);
    s.correction = static_cast<Correction>(correction_);
    s.control = static_cast<tactus::ControlScheme>(control_);
    s.threshold = {number(NUMBER_THRESHOLD_POSITION), number(NUMBER_THRESHOLD_ANGLE),
                   number(NUMBER_THRESHOLD_VELOCITY), number(NUMBER_THRESHOLD_ANGULAR_VELOCITY)};
    s.stealth = {number(NUMBER_STEALTH_WEBER),      number(NUMBER_STEALTH_LEAST),
                 number(NUMBER_STEALTH_SHARE),      number(NUMBER_STEALTH_WINDOW),
                 number(NUMBER_STEALTH_FREE_SPEED), number(NUMBER_STEALTH_LONGEST_OFFSET)};
    s.estimate.gain = number(NUMBER_DRAG_LEARNING);
    s.stand_in = {number(NUMBER_STAND_IN_SPEED), number(NUMBER_STAND_IN_NEAR), number(NUMBER_STAND_IN_LEASH)};
    s.deadband.enabled = deadband_;
    s.deadband.position = number(NUMBER_DEADBAND_POSITION);
    s.deadband.position_weber = number(NUMBER_DEADBAND_POSITION_WEBER);
    s.deadband.angle = number(NUMBER_DEADBAND_ANGLE);
    s.deadband.force = number(NUMBER_DEADBAND_FORCE);
    s.deadband.force_weber = number(NUMBER_DEADBAND_FORCE_WEBER);
    s.deadband.longest_silence = from_seconds(number(NUMBER_DEADBAND_LONGEST_SILENCE));
    s.states_every = count(COUNT_STATES_EVERY);
    s.refresh_every = count(COUNT_REFRESH_EVERY);
    s.repeats = count(COUNT_REPEATS);
    s.buffer_depth = count(COUNT_BUFFER_DEPTH);
    s.skew = {0, from_seconds(number(NUMBER_CLOCK_OFFSET)), number(NUMBER_CLOCK_DRIFT)};
    return s;
}

LinkConditions MMTLink::conditions() const {
    const auto span = [this](Number which) { return from_seconds(get_number(which)); };
    LinkConditions c;
    c.delay = span(NUMBER_DELAY);
    c.jitter = span(NUMBER_JITTER);
    c.shape = static_cast<tactus::JitterShape>(jitter_shape_);
    c.trace = trace_.get();
    c.keep_order = keep_order_;
    c.loss = get_number(NUMBER_LOSS);
    if (get_number(NUMBER_BURST_LOSS) > 0.0) {
        c.burst = bursts(get_number(NUMBER_BURST_LOSS), get_number(NUMBER_BURST_LENGTH));
    }
    c.duplication = get_number(NUMBER_DUPLICATION);
    c.reordering = get_number(NUMBER_REORDERING);
    c.reorder_by = span(NUMBER_REORDER_BY);
    c.rate = get_number(NUMBER_RATE);
    return c;
}

NetworkSettings MMTLink::network_settings() const {
    const int own = is_operator() ? usual_port_of_operator : usual_port_of_teleoperator;
    const int other = is_operator() ? usual_port_of_teleoperator : usual_port_of_operator;
    NetworkSettings settings;
    settings.udp.local_address = from_godot(local_address_);
    settings.udp.local_port = static_cast<std::uint16_t>(local_port_ > 0 ? local_port_ : own);
    settings.udp.remote_address = from_godot(remote_address_);
    settings.udp.remote_port = static_cast<std::uint16_t>(remote_port_ > 0 ? remote_port_ : other);
    settings.key = from_godot(key_);
    settings.conditions = conditions();
    settings.seed = static_cast<std::uint64_t>(get_count(COUNT_SEED));
    return settings;
}

String MMTLink::trace_problem() const {
    if (jitter_shape_ != JITTER_TRACE || trace_ != nullptr) {
        return String();
    }
    return trace_error_.is_empty()
               ? String(
                     "the jitter is that of a trace and there is none: set "
                     "'emulated_trace_file' to a file of one delay in milliseconds a line")
               : trace_error_;
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

// Handlers may free this node: nothing of it is used after the last signal, and each is sent by what its id
// still stands for.
void MMTLink::take_report(const LinkReport& report, const std::vector<ModelNews>& news) {
    const LinkReport before = std::exchange(report_, report);
    const bool was_connected = before.state == STATE_CONNECTED;
    const bool is_connected = report.state == STATE_CONNECTED;
    const bool restarted = report.teleop.link.peer_restarts > restarts_seen_;
    restarts_seen_ = report.teleop.link.peer_restarts;
    const std::uint64_t id = get_instance_id();
    const auto say = [id](const char* signal, const auto&... values) {
        if (Object* self = ObjectDB::get_instance(id)) {
            self->emit_signal(signal, values...);
        }
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
                say("object_discovered", one.name, Variant(ObjectDB::get_instance(one.node)));
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

Dictionary MMTLink::get_statistics() const {
    const TeleopStatistics& teleop = report_.teleop;
    const LinkStatistics& link = teleop.link;
    const NetworkFigures& network = report_.network;
    const auto count = [](std::uint64_t value) { return static_cast<int64_t>(value); };
    Dictionary d;
    d["state"] = report_.state;
    d["state_text"] = report_.text;
    d["objects"] = report_.objects;
    d["peer_objects"] = count(link.peer_hello.object_count);
    d["sample"] = count(teleop.sample);
    d["round_trip_s"] = teleop.round_trip;
    d["one_way_delay_s"] = link.one_way_delay * 1e-9;
    d["one_way_jitter_s"] = link.one_way_jitter * 1e-9;
    d["clock_known"] = link.clock.known;
    d["clock_offset_s"] = to_seconds(link.clock.offset);
    d["clock_drift"] = link.clock.drift;
    d["clock_uncertainty_s"] = to_seconds(link.clock.uncertainty);
    d["clock_jumps"] = count(link.clock.jumps);
    d["packets_sent"] = count(link.packets_sent);
    d["packets_sent_per_s"] = link.sent_rate.packets;
    d["bytes_sent"] = count(link.bytes_sent);
    d["bytes_sent_per_s"] = link.sent_rate.bytes;
    d["packets_received"] = count(link.packets_received);
    d["packets_received_per_s"] = link.received_rate.packets;
    d["bytes_received"] = count(link.bytes_received);
    d["bytes_received_per_s"] = link.received_rate.bytes;
    d["packets_not_sent"] = count(link.not_sent);
    d["packets_missing"] = count(link.missing);
    d["packets_late"] = count(link.late);
    d["packets_copied"] = count(link.copies);
    d["packets_refused"] = count(link.refused.total());
    d["refused_truncated"] = count(link.refused.of(Refusal::truncated));
    d["refused_oversized"] = count(link.refused.of(Refusal::oversized) + network.udp.oversized);
    d["refused_foreign"] = count(link.refused.of(Refusal::wrong_magic));
    d["refused_sealed"] = count(link.refused.of(Refusal::sealed));
    d["refused_version"] = count(link.refused.of(Refusal::wrong_version));
    d["refused_unknown_type"] = count(link.refused.of(Refusal::unknown_type));
    d["refused_not_finite"] = count(link.refused.of(Refusal::not_finite));
    d["refused_out_of_range"] = count(link.refused.of(Refusal::out_of_range));
    d["refused_epoch"] = count(link.strange_epoch);
    d["refused_key"] = count(network.udp.secure.wrong_key);
    d["refused_not_sealed"] = count(network.udp.secure.not_sealed);
    d["refused_replayed"] = count(network.udp.secure.replayed + network.udp.secure.other_start);
    d["sealed"] = network.udp.sealed;
    d["peer_restarts"] = count(link.peer_restarts);
    d["peer_vanishings"] = count(link.vanishings);
    d["emulated_delivered"] = count(network.emulator.delivered);
    d["emulated_lost"] = count(network.emulator.lost + network.emulator.squeezed + network.emulator.no_room);
    d["emulated_duplicated"] = count(network.emulator.duplicated);
    d["emulated_held_back"] = count(network.emulator.held_back);
    if (is_operator()) {
        d["corrections"] = count(teleop.corrections);
        d["replays"] = count(teleop.replays);
        d["correction_moved_m"] = teleop.cost.moved;
        d["correction_jnd_share"] = teleop.cost.jnd_share;
        d["correction_force_step_max_n"] = teleop.largest_force_step;
        d["offset_m"] = teleop.offset;
        d["unknown_objects"] = count(teleop.unknown_objects);
        d["stale_states"] = count(teleop.stale_states);
    } else {
        d["objects_waiting"] = count(teleop.discovery.waiting);
        d["objects_refused"] = count(teleop.discovery.refused + teleop.discovery.no_room);
        d["buffer_depth"] = count(teleop.buffer_depth);
        d["samples_exact"] = count(teleop.buffer.exact);
        d["samples_filled"] = count(teleop.buffer.filled);
        d["samples_guessed"] = count(teleop.buffer.guessed);
        d["samples_held"] = count(teleop.buffer.held);
        d["samples_late"] = count(teleop.buffer.late);
    }
    return d;
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
        if (const CharString key = key_.utf8(); key.length() > 0 && key.length() < 8) {
            return "the key is too short: give 64 hexadecimal digits or at least 8 characters, the same on "
                   "both "
                   "sides";
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
        warnings.push_back("This MMTLink emulates no trace: " + wrong + ".");
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
    if (Engine::get_singleton()->is_editor_hint()) {
        return;
    }
    if (what == NOTIFICATION_ENTER_TREE) {
        Roll<MMTLink>::enter(this);
        if (is_networked()) {
            if (HapticWorld* world = HapticWorld::above(this)) {
                world->call_deferred("_link_changed");
            }
        }
    } else if (what == NOTIFICATION_EXIT_TREE) {
        Roll<MMTLink>::leave(this);
        wire_.reset();
        clear_report();
    }
}

// --- the class
// -------------------------------------------------------------------------------------------------------

void MMTLink::add_number(Number which) {
    const NumberRow& row = number_rows[which];
    ADD_PROPERTYI(PropertyInfo(Variant::FLOAT, row.name, PROPERTY_HINT_RANGE, row.hint), "_set_number",
                  "_get_number", which);
}

void MMTLink::add_count(Count which) {
    const CountRow& row = count_rows[which];
    ADD_PROPERTYI(PropertyInfo(Variant::INT, row.name, PROPERTY_HINT_RANGE, row.hint), "_set_count",
                  "_get_count", which);
}

void MMTLink::add_numbers(Number first, Number last) {
    for (int which = first; which <= last; ++which) {
        add_number(static_cast<Number>(which));
    }
}

void MMTLink::bind_properties() {
    ADD_PROPERTY(
        PropertyInfo(Variant::INT, "scenario", PROPERTY_HINT_ENUM, "Single:1,Traditional:2,Model-mediated:4"),
        "set_scenario", "get_scenario");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "side", PROPERTY_HINT_ENUM, "Operator,Teleoperator"), "set_side",
                 "get_side");
    ADD_GROUP("Connection", "");
    ADD_PROPERTY(PropertyInfo(Variant::NODE_PATH, "partner", PROPERTY_HINT_NODE_PATH_VALID_TYPES, "MMTLink"),
                 "set_partner", "get_partner");
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "local_address"), "set_local_address", "get_local_address");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "local_port", PROPERTY_HINT_RANGE, "0,65535,1"), "set_local_port",
                 "get_local_port");
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "remote_address"), "set_remote_address", "get_remote_address");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "remote_port", PROPERTY_HINT_RANGE, "0,65535,1"),
                 "set_remote_port", "get_remote_port");
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "key", PROPERTY_HINT_PASSWORD), "set_key", "get_key");
    ADD_GROUP("Emulated Network", "emulated_");
    add_number(NUMBER_DELAY);
    add_number(NUMBER_JITTER);
    ADD_PROPERTY(PropertyInfo(Variant::INT, "emulated_jitter_shape", PROPERTY_HINT_ENUM,
                              "Uniform,Normal,Heavy tail,Trace"),
                 "set_jitter_shape", "get_jitter_shape");
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "emulated_trace_file", PROPERTY_HINT_FILE, "*.txt,*.csv"),
                 "set_trace_file", "get_trace_file");
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "emulated_keep_order"), "set_keep_order", "is_keeping_order");
    add_numbers(NUMBER_LOSS, NUMBER_CLOCK_DRIFT);
    add_count(COUNT_SEED);
    ADD_GROUP("Control", "");
    ADD_PROPERTY(
        PropertyInfo(Variant::INT, "control_scheme", PROPERTY_HINT_ENUM,
                     "Spring,1: Position,2: Position and force,3: Position force and relative position"),
        "set_control_scheme", "get_control_scheme");
    add_numbers(NUMBER_STAND_IN_SPEED, NUMBER_STAND_IN_LEASH);
    add_count(COUNT_BUFFER_DEPTH);
    ADD_GROUP("Correction", "");
    ADD_PROPERTY(
        PropertyInfo(Variant::INT, "correction_scheme", PROPERTY_HINT_ENUM,
                     "None,Pose,Pose and velocities,Stealthy (keep magnitude),Stealthy (keep direction),"
                     "Stealthy (translate),Stealthy (turn)"),
        "set_correction_scheme", "get_correction_scheme");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "derivation", PROPERTY_HINT_ENUM,
                              "None,Velocity,Acceleration,Averaged,History,Re-simulation"),
                 "set_derivation", "get_derivation");
    add_numbers(NUMBER_THRESHOLD_POSITION, NUMBER_DRAG_LEARNING);
    ADD_PROPERTY(PropertyInfo(Variant::DICTIONARY, "model_errors"), "set_model_errors", "get_model_errors");
    ADD_GROUP("Traffic", "");
    add_count(COUNT_STATES_EVERY);
    add_count(COUNT_REFRESH_EVERY);
    add_count(COUNT_REPEATS);
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "deadband"), "set_deadband", "has_deadband");
    add_numbers(NUMBER_DEADBAND_POSITION, NUMBER_DEADBAND_LONGEST_SILENCE);
}

void MMTLink::bind_signals() {
    ADD_SIGNAL(MethodInfo("state_changed", PropertyInfo(Variant::INT, "state"),
                          PropertyInfo(Variant::STRING, "text")));
    ADD_SIGNAL(MethodInfo("peer_connected"));
    ADD_SIGNAL(MethodInfo("peer_lost"));
    ADD_SIGNAL(MethodInfo("peer_restarted"));
    ADD_SIGNAL(MethodInfo("object_discovered", PropertyInfo(Variant::STRING, "name"),
                          PropertyInfo(Variant::OBJECT, "node", PROPERTY_HINT_NODE_TYPE, "Node3D")));
    ADD_SIGNAL(MethodInfo("object_removed", PropertyInfo(Variant::STRING, "name")));
    ADD_SIGNAL(MethodInfo("object_refused", PropertyInfo(Variant::STRING, "name"),
                          PropertyInfo(Variant::STRING, "why")));
}

void MMTLink::_bind_methods() {
    ClassDB::bind_method(D_METHOD("get_warnings"), &MMTLink::_get_configuration_warnings);
    ClassDB::bind_method(D_METHOD("set_scenario", "scenario"), &MMTLink::set_scenario);
    ClassDB::bind_method(D_METHOD("get_scenario"), &MMTLink::get_scenario);
    ClassDB::bind_method(D_METHOD("set_side", "side"), &MMTLink::set_side);
    ClassDB::bind_method(D_METHOD("get_side"), &MMTLink::get_side);
    ClassDB::bind_method(D_METHOD("set_partner", "path"), &MMTLink::set_partner);
    ClassDB::bind_method(D_METHOD("get_partner"), &MMTLink::get_partner);
    ClassDB::bind_method(D_METHOD("set_local_address", "address"), &MMTLink::set_local_address);
    ClassDB::bind_method(D_METHOD("get_local_address"), &MMTLink::get_local_address);
    ClassDB::bind_method(D_METHOD("set_local_port", "port"), &MMTLink::set_local_port);
    ClassDB::bind_method(D_METHOD("get_local_port"), &MMTLink::get_local_port);
    ClassDB::bind_method(D_METHOD("set_remote_address", "address"), &MMTLink::set_remote_address);
    ClassDB::bind_method(D_METHOD("get_remote_address"), &MMTLink::get_remote_address);
    ClassDB::bind_method(D_METHOD("set_remote_port", "port"), &MMTLink::set_remote_port);
    ClassDB::bind_method(D_METHOD("get_remote_port"), &MMTLink::get_remote_port);
    ClassDB::bind_method(D_METHOD("set_key", "key"), &MMTLink::set_key);
    ClassDB::bind_method(D_METHOD("get_key"), &MMTLink::get_key);
    ClassDB::bind_method(D_METHOD("set_jitter_shape", "shape"), &MMTLink::set_jitter_shape);
    ClassDB::bind_method(D_METHOD("get_jitter_shape"), &MMTLink::get_jitter_shape);
    ClassDB::bind_method(D_METHOD("set_trace_file", "path"), &MMTLink::set_trace_file);
    ClassDB::bind_method(D_METHOD("get_trace_file"), &MMTLink::get_trace_file);
    ClassDB::bind_method(D_METHOD("set_keep_order", "keep"), &MMTLink::set_keep_order);
    ClassDB::bind_method(D_METHOD("is_keeping_order"), &MMTLink::is_keeping_order);
    ClassDB::bind_method(D_METHOD("set_control_scheme", "scheme"), &MMTLink::set_control_scheme);
    ClassDB::bind_method(D_METHOD("get_control_scheme"), &MMTLink::get_control_scheme);
    ClassDB::bind_method(D_METHOD("set_correction_scheme", "scheme"), &MMTLink::set_correction_scheme);
    ClassDB::bind_method(D_METHOD("get_correction_scheme"), &MMTLink::get_correction_scheme);
    ClassDB::bind_method(D_METHOD("set_derivation", "derivation"), &MMTLink::set_derivation);
    ClassDB::bind_method(D_METHOD("get_derivation"), &MMTLink::get_derivation);
    ClassDB::bind_method(D_METHOD("set_deadband", "enabled"), &MMTLink::set_deadband);
    ClassDB::bind_method(D_METHOD("has_deadband"), &MMTLink::has_deadband);
    ClassDB::bind_method(D_METHOD("set_model_errors", "errors"), &MMTLink::set_model_errors);
    ClassDB::bind_method(D_METHOD("get_model_errors"), &MMTLink::get_model_errors);
    ClassDB::bind_method(D_METHOD("_set_number", "number", "value"), &MMTLink::set_number);
    ClassDB::bind_method(D_METHOD("_get_number", "number"), &MMTLink::get_number);
    ClassDB::bind_method(D_METHOD("_set_count", "count", "value"), &MMTLink::set_count);
    ClassDB::bind_method(D_METHOD("_get_count", "count"), &MMTLink::get_count);
    ClassDB::bind_method(D_METHOD("get_state"), &MMTLink::get_state);
    ClassDB::bind_method(D_METHOD("get_state_text"), &MMTLink::get_state_text);
    ClassDB::bind_method(D_METHOD("is_peer_connected"), &MMTLink::is_peer_connected);
    ClassDB::bind_method(D_METHOD("get_statistics"), &MMTLink::get_statistics);
    bind_properties();
    bind_signals();
    bind_constants();
}

void MMTLink::bind_constants() {
    BIND_ENUM_CONSTANT(SCENARIO_SINGLE);
    BIND_ENUM_CONSTANT(SCENARIO_TRADITIONAL);
    BIND_ENUM_CONSTANT(SCENARIO_MMT);
    BIND_ENUM_CONSTANT(SIDE_OPERATOR);
    BIND_ENUM_CONSTANT(SIDE_TELEOPERATOR);
    BIND_ENUM_CONSTANT(JITTER_UNIFORM);
    BIND_ENUM_CONSTANT(JITTER_NORMAL);
    BIND_ENUM_CONSTANT(JITTER_HEAVY_TAIL);
    BIND_ENUM_CONSTANT(JITTER_TRACE);
    BIND_ENUM_CONSTANT(CONTROL_SPRING);
    BIND_ENUM_CONSTANT(CONTROL_POSITION);
    BIND_ENUM_CONSTANT(CONTROL_POSITION_FORCE);
    BIND_ENUM_CONSTANT(CONTROL_POSITION_FORCE_RELATIVE);
    BIND_ENUM_CONSTANT(CORRECTION_NONE);
    BIND_ENUM_CONSTANT(CORRECTION_POSE);
    BIND_ENUM_CONSTANT(CORRECTION_POSE_VELOCITY);
    BIND_ENUM_CONSTANT(CORRECTION_STEALTHY_MAGNITUDE);
    BIND_ENUM_CONSTANT(CORRECTION_STEALTHY_DIRECTION);
    BIND_ENUM_CONSTANT(CORRECTION_STEALTHY_TRANSLATE);
    BIND_ENUM_CONSTANT(CORRECTION_STEALTHY_TURN);
    BIND_ENUM_CONSTANT(DERIVATION_NONE);
    BIND_ENUM_CONSTANT(DERIVATION_VELOCITY);
    BIND_ENUM_CONSTANT(DERIVATION_ACCELERATION);
    BIND_ENUM_CONSTANT(DERIVATION_AVERAGED);
    BIND_ENUM_CONSTANT(DERIVATION_HISTORY);
    BIND_ENUM_CONSTANT(DERIVATION_RESIMULATE);
    BIND_ENUM_CONSTANT(STATE_OFF);
    BIND_ENUM_CONSTANT(STATE_OPENING);
    BIND_ENUM_CONSTANT(STATE_FAILED);
    BIND_ENUM_CONSTANT(STATE_WAITING);
    BIND_ENUM_CONSTANT(STATE_ONE_WAY);
    BIND_ENUM_CONSTANT(STATE_CONNECTED);
    BIND_ENUM_CONSTANT(STATE_REFUSED);
    BIND_ENUM_CONSTANT(STATE_LOST);
    BIND_ENUM_CONSTANT(STATE_LEFT);
}

}  // namespace tactus
