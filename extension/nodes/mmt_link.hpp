#pragma once

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
#include "nodes/network_conditions.hpp"
#include "nodes/teleop_tuning.hpp"
#include "session/teleop_port.hpp"

namespace tactus {

class HapticWorld;

// What a link's world tells its node once a frame.
struct LinkReport {
    std::int64_t state = 0;  // MMTLink::State
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
    enum Scenario : int64_t { SCENARIO_SINGLE = 1, SCENARIO_TRADITIONAL = 2, SCENARIO_MMT = 4 };
    enum Side : int64_t { SIDE_OPERATOR, SIDE_TELEOPERATOR };
    enum State : int64_t {
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
    MMTLink();

    void set_scenario(Scenario scenario);
    Scenario get_scenario() const { return scenario_; }
    void set_side(Side side);
    Side get_side() const { return side_; }
    void set_partner(const godot::NodePath& path);
    godot::NodePath get_partner() const { return partner_; }
    void set_local_address(const godot::String& address);
    godot::String get_local_address() const { return local_address_; }
    void set_local_port(int64_t port);
    int get_local_port() const { return local_port_; }
    void set_remote_address(const godot::String& address);
    godot::String get_remote_address() const { return remote_address_; }
    void set_remote_port(int64_t port);
    int get_remote_port() const { return remote_port_; }
    void set_key_file(const godot::String& path);
    godot::String get_key_file() const { return key_file_; }
    void set_control_scheme(int64_t scheme);
    int get_control_scheme() const { return static_cast<int>(control_); }
    void set_correction_scheme(int64_t scheme);
    int get_correction_scheme() const { return static_cast<int>(correction_); }
    void set_conditions(const godot::Ref<NetworkConditions>& conditions);
    godot::Ref<NetworkConditions> get_conditions() const { return conditions_; }
    void set_tuning(const godot::Ref<TeleopTuning>& tuning);
    godot::Ref<TeleopTuning> get_tuning() const { return tuning_; }
    void set_model_errors(const godot::Dictionary& errors);
    godot::Dictionary get_model_errors() const { return model_errors_; }

    State get_state() const;
    godot::String get_state_text() const;
    bool is_peer_connected() const { return report_.state == STATE_CONNECTED; }
    godot::Dictionary get_statistics() const;
    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that runs it

    // The links that make this world a side of a teleoperation: an operator's one, or those of an environment
    // to each of its operators. Empty: it stands alone.
    static std::vector<MMTLink*> of(const HapticWorld& world);
    bool is_networked() const { return scenario_ != SCENARIO_SINGLE; }
    bool is_operator() const { return side_ == SIDE_OPERATOR; }
    // Another one after every change of a property.
    std::uint64_t revision() const { return revision_; }
    // Another one after every change of what a way to the far side is opened with.
    std::uint64_t way_revision() const { return way_revision_; }
    TeleopSettings teleop_settings() const;
    LinkConditions conditions() const;
    NetworkSettings network_settings() const;
    std::shared_ptr<const DelayTrace> trace() const;  // conditions() points into it
    godot::String trace_problem() const;              // empty where there is none
    // Why it does nothing; empty where there is no reason.
    godot::String problem() const;
    // In the same scene; null: none.
    MMTLink* partner_node() const;
    // The wire to the partner: both have the same one.
    std::shared_ptr<MemoryLinkPair> wire();
    void take_report(const LinkReport& report, const std::vector<ModelNews>& news);
    void clear_report();

protected:
    static void _bind_methods();
    void _notification(int what);
    // Properties of scenes from before conditions and tuning.
    bool _set(const godot::StringName& name, const godot::Variant& value);

private:
    void changed();
    void way_changed();
    void restart_world();
    LinkReport at_rest() const;
    godot::String way_problem() const;
    godot::String surplus_problem(const HapticWorld& world) const;
    void values_changed();
    template <class Values>
    void exchange(godot::Ref<Values>& own, const godot::Ref<Values>& other);
    template <class Values>
    bool take_old(godot::Ref<Values>& own, const char* place, const godot::String& name,
                  const godot::Variant& value);

    Scenario scenario_ = SCENARIO_SINGLE;
    Side side_ = SIDE_OPERATOR;
    godot::NodePath partner_;
    godot::String local_address_;
    int local_port_ = 0;
    godot::String remote_address_ = "127.0.0.1";
    int remote_port_ = 0;
    godot::String key_file_;
    ControlScheme control_ = ControlScheme::spring;
    Correction correction_ = Correction::stealthy_direction;
    godot::Ref<NetworkConditions> conditions_;
    godot::Ref<TeleopTuning> tuning_;
    std::uint64_t seed_;  // that the way was opened with
    bool is_old_ = false;
    godot::Dictionary model_errors_;

    std::uint64_t revision_ = 1;
    std::uint64_t way_revision_ = 1;
    std::shared_ptr<MemoryLinkPair> wire_;
    LinkReport report_;
    std::uint64_t restarts_seen_ = 0;
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::MMTLink::Scenario);
VARIANT_ENUM_CAST(tactus::MMTLink::Side);
VARIANT_ENUM_CAST(tactus::MMTLink::State);
