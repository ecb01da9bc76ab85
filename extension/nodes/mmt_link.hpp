#pragma once

#include <array>
#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <memory>
#include <string>

#include "core/teleop/control_scheme.hpp"
#include "network/link_conditions.hpp"
#include "network/memory_link.hpp"
#include "network/network_link.hpp"
#include "session/teleop_port.hpp"

namespace tactus {

class HapticWorld;

// What a link's world tells its node once a frame.
struct LinkReport {
    int state = 0;  // MMTLink::State
    godot::String text;
    TeleopStatistics teleop;
    NetworkFigures network;
    std::int64_t objects = 0;  // operator: in the model; far side: described
};

// What has happened to an object of the far side.
struct ModelNews {
    enum class Kind { discovered, removed, refused } kind = Kind::discovered;
    godot::String name;
    std::uint64_t node = 0;  // that shows it
    godot::String why;       // it was refused
};

// Touch over a network: makes the HapticWorld above it the operator's side or the far side of a
// teleoperation.
class MMTLink : public godot::Node {
    GDCLASS(MMTLink, godot::Node)

public:
    enum Scenario { SCENARIO_SINGLE = 1, SCENARIO_TRADITIONAL = 2, SCENARIO_MMT = 4 };
    enum Side { SIDE_OPERATOR, SIDE_TELEOPERATOR };
    enum JitterShape { JITTER_UNIFORM, JITTER_NORMAL, JITTER_HEAVY_TAIL, JITTER_TRACE };
    enum ControlScheme {
        CONTROL_SPRING,
        CONTROL_POSITION,
        CONTROL_POSITION_FORCE,
        CONTROL_POSITION_FORCE_RELATIVE
    };
    enum CorrectionScheme {
        CORRECTION_NONE,
        CORRECTION_POSE,
        CORRECTION_POSE_VELOCITY,
        CORRECTION_STEALTHY_MAGNITUDE,
        CORRECTION_STEALTHY_DIRECTION,
        CORRECTION_STEALTHY_TRANSLATE,
        CORRECTION_STEALTHY_TURN
    };
    enum Derivation {
        DERIVATION_NONE,
        DERIVATION_VELOCITY,
        DERIVATION_ACCELERATION,
        DERIVATION_AVERAGED,
        DERIVATION_HISTORY,
        DERIVATION_RESIMULATE
    };
    enum State {
        STATE_OFF,        // one scenario on one machine, or no world
        STATE_OPENING,    // addresses are looked up
        STATE_FAILED,     // there is no way to the far side
        STATE_WAITING,    // nothing has been heard yet
        STATE_ONE_WAY,    // the far side is heard, and does not hear this one
        STATE_CONNECTED,  // both hear each other
        STATE_REFUSED,    // what comes is not believed, or does not go together with this side
        STATE_LOST,       // nothing has been heard for a second
        STATE_LEFT        // the far side has said good-bye
    };
    // Numbers and counts, each with its range in a table in mmt_link.cpp.
    enum Number {
        NUMBER_DELAY,
        NUMBER_JITTER,
        NUMBER_LOSS,
        NUMBER_BURST_LOSS,
        NUMBER_BURST_LENGTH,
        NUMBER_DUPLICATION,
        NUMBER_REORDERING,
        NUMBER_REORDER_BY,
        NUMBER_RATE,
        NUMBER_CLOCK_OFFSET,
        NUMBER_CLOCK_DRIFT,
        NUMBER_STAND_IN_SPEED,
        NUMBER_STAND_IN_NEAR,
        NUMBER_STAND_IN_LEASH,
        NUMBER_THRESHOLD_POSITION,
        NUMBER_THRESHOLD_ANGLE,
        NUMBER_THRESHOLD_VELOCITY,
        NUMBER_THRESHOLD_ANGULAR_VELOCITY,
        NUMBER_STEALTH_WEBER,
        NUMBER_STEALTH_LEAST,
        NUMBER_STEALTH_SHARE,
        NUMBER_STEALTH_WINDOW,
        NUMBER_STEALTH_FREE_SPEED,
        NUMBER_STEALTH_LONGEST_OFFSET,
        NUMBER_DRAG_LEARNING,
        NUMBER_DEADBAND_POSITION,
        NUMBER_DEADBAND_POSITION_WEBER,
        NUMBER_DEADBAND_ANGLE,
        NUMBER_DEADBAND_FORCE,
        NUMBER_DEADBAND_FORCE_WEBER,
        NUMBER_DEADBAND_LONGEST_SILENCE,
        NUMBER_COUNT
    };
    enum Count {
        COUNT_SEED,
        COUNT_STATES_EVERY,
        COUNT_REFRESH_EVERY,
        COUNT_REPEATS,
        COUNT_BUFFER_DEPTH,
        COUNT_COUNT
    };

    MMTLink();

    void set_scenario(Scenario scenario);
    Scenario get_scenario() const { return scenario_; }
    void set_side(Side side);
    Side get_side() const { return side_; }
    void set_partner(const godot::NodePath& path);
    godot::NodePath get_partner() const { return partner_; }
    void set_local_address(const godot::String& address);
    godot::String get_local_address() const { return local_address_; }
    void set_local_port(int port);
    int get_local_port() const { return local_port_; }
    void set_remote_address(const godot::String& address);
    godot::String get_remote_address() const { return remote_address_; }
    void set_remote_port(int port);
    int get_remote_port() const { return remote_port_; }
    void set_key(const godot::String& key);
    godot::String get_key() const { return key_; }
    void set_jitter_shape(JitterShape shape);
    JitterShape get_jitter_shape() const { return jitter_shape_; }
    void set_trace_file(const godot::String& path);
    godot::String get_trace_file() const { return trace_file_; }
    void set_keep_order(bool keep);
    bool is_keeping_order() const { return keep_order_; }
    void set_control_scheme(ControlScheme scheme);
    ControlScheme get_control_scheme() const { return control_; }
    void set_correction_scheme(CorrectionScheme scheme);
    CorrectionScheme get_correction_scheme() const { return correction_; }
    void set_derivation(Derivation derivation);
    Derivation get_derivation() const { return derivation_; }
    void set_deadband(bool enabled);
    bool has_deadband() const { return deadband_; }
    void set_model_errors(const godot::Dictionary& errors);
    godot::Dictionary get_model_errors() const { return model_errors_; }
    void set_number(int which, double value);
    double get_number(int which) const;
    void set_count(int which, int64_t value);
    int64_t get_count(int which) const;

    State get_state() const;
    godot::String get_state_text() const;
    bool is_peer_connected() const { return report_.state == STATE_CONNECTED; }
    godot::Dictionary get_statistics() const;
    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that runs it

    // The link that makes this world a side of a teleoperation; null: it stands alone.
    static MMTLink* of(const HapticWorld& world);
    bool is_networked() const { return scenario_ != SCENARIO_SINGLE; }
    bool is_operator() const { return side_ == SIDE_OPERATOR; }
    // Another one after every change of a property.
    std::uint64_t revision() const { return revision_; }
    // Another one after every change of what a way to the far side is opened with.
    std::uint64_t way_revision() const { return way_revision_; }
    TeleopSettings teleop_settings() const;
    LinkConditions conditions() const;
    NetworkSettings network_settings() const;
    std::shared_ptr<const DelayTrace> trace() const { return trace_; }  // conditions() points into it
    godot::String trace_problem() const;                                // empty where there is none
    // Why it does nothing; empty where there is no reason.
    godot::String problem() const;
    // In the same scene; null: none.
    MMTLink* partner_node() const;
    // The wire to the partner: both have the same one.
    std::shared_ptr<MemoryLinkPair> wire();
    // May emit signals.
    void take_report(const LinkReport& report, const std::vector<ModelNews>& news);
    void clear_report();

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    void changed();
    void way_changed();
    void restart_world();
    LinkReport at_rest() const;
    godot::String way_problem() const;
    static void add_number(Number which);
    static void add_numbers(Number first, Number last);
    static void add_count(Count which);
    static void bind_properties();
    static void bind_signals();
    static void bind_constants();

    Scenario scenario_ = SCENARIO_SINGLE;
    Side side_ = SIDE_OPERATOR;
    godot::NodePath partner_;
    godot::String local_address_;
    int local_port_ = 0;
    godot::String remote_address_ = "127.0.0.1";
    int remote_port_ = 0;
    godot::String key_;
    JitterShape jitter_shape_ = JITTER_UNIFORM;
    godot::String trace_file_;
    std::shared_ptr<const DelayTrace> trace_;
    godot::String trace_error_;
    bool keep_order_ = false;
    ControlScheme control_ = CONTROL_SPRING;
    CorrectionScheme correction_ = CORRECTION_STEALTHY_DIRECTION;
    Derivation derivation_ = DERIVATION_RESIMULATE;
    bool deadband_ = false;
    godot::Dictionary model_errors_;
    std::array<double, NUMBER_COUNT> numbers_{};
    std::array<int64_t, COUNT_COUNT> counts_{};

    std::uint64_t revision_ = 1;
    std::uint64_t way_revision_ = 1;
    std::shared_ptr<MemoryLinkPair> wire_;
    LinkReport report_;
    std::uint64_t restarts_seen_ = 0;
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::MMTLink::Scenario);
VARIANT_ENUM_CAST(tactus::MMTLink::Side);
VARIANT_ENUM_CAST(tactus::MMTLink::JitterShape);
VARIANT_ENUM_CAST(tactus::MMTLink::ControlScheme);
VARIANT_ENUM_CAST(tactus::MMTLink::CorrectionScheme);
VARIANT_ENUM_CAST(tactus::MMTLink::Derivation);
VARIANT_ENUM_CAST(tactus::MMTLink::State);
