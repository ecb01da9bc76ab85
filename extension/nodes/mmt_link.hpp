#pragma once

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "nodes/ghost_view.hpp"
#include "nodes/mmt_network_conditions.hpp"
#include "nodes/mmt_tuning.hpp"
#include "nodes/properties.hpp"
#include "world/model_error.hpp"
#include "world/world_link.hpp"

namespace tactus {

class HapticWorld;
class MMTModelStatistics;
class MMTNetworkStatistics;
class MMTPassivityStatistics;
class MMTPlayoutStatistics;
struct ModelNews;

// Touch over a network: makes the HapticWorld above it the operator's side or the far side of a
// teleoperation.
class MMTLink : public godot::Node {
    GDCLASS(MMTLink, godot::Node)

public:
    enum Scenario : int64_t {
        SCENARIO_LOCAL = 1,
        SCENARIO_DIRECT = 2,
        SCENARIO_DIRECT_ROBOT = 3,
        SCENARIO_MMT = 4,
        SCENARIO_MMT_ROBOT = 5
    };
    enum Side : int64_t { SIDE_OPERATOR, SIDE_TELEOPERATOR };
    enum State {
        STATE_OFF = static_cast<int>(LinkState::off),
        STATE_OPENING = static_cast<int>(LinkState::opening),
        STATE_FAILED = static_cast<int>(LinkState::failed),
        STATE_WAITING = static_cast<int>(LinkState::waiting),
        STATE_ONE_WAY = static_cast<int>(LinkState::one_way),
        STATE_CONNECTED = static_cast<int>(LinkState::connected),
        STATE_REFUSED = static_cast<int>(LinkState::refused),
        STATE_LOST = static_cast<int>(LinkState::lost),
        STATE_LEFT = static_cast<int>(LinkState::left),
    };
    MMTLink() { clear_report(); }

    TACTUS_PROPERTIES(MMTLink)
    void set_key_file(const godot::String& path);
    godot::String get_key_file() const { return key_file_; }

    State get_state() const;
    godot::String get_state_text() const;
    bool is_peer_connected() const { return report_.state == LinkState::connected; }
    godot::TypedArray<godot::Dictionary> get_ghosts() const;
    godot::Dictionary get_statistics() const;
    godot::Ref<MMTModelStatistics> get_model_statistics() const;
    godot::Ref<MMTNetworkStatistics> get_network_statistics() const;
    godot::Ref<MMTPassivityStatistics> get_passivity_statistics() const;
    godot::Ref<MMTPlayoutStatistics> get_playout_statistics() const;
    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that runs it

    // The links that make this world a side of a teleoperation: an operator's one, or those of an environment
    // to each of its operators. Empty: it stands alone.
    static std::vector<MMTLink*> of(const HapticWorld& world);
    bool is_networked() const { return scenario_ != SCENARIO_LOCAL; }
    // The devices of its far side are robots.
    bool has_robots() const { return scenario_ == SCENARIO_DIRECT_ROBOT || scenario_ == SCENARIO_MMT_ROBOT; }
    bool is_operator() const { return side_ == SIDE_OPERATOR; }
    LinkPlan plan();
    void set_model_errors(const godot::Dictionary& errors);
    godot::Dictionary get_model_errors() const { return model_errors_; }
    // By the name of the object.
    std::unordered_map<std::string, ModelError> model_errors() const;
    // Why it does nothing; empty where there is no reason.
    godot::String problem() const;
    // What it does not transmit of the bodies that it describes; empty where there is no such thing.
    godot::String problem_of_bodies() const;
    // In the same scene; null: none.
    MMTLink* partner_node() const;
    void take_report(const LinkReport& report, const std::vector<ModelNews>& news);
    void clear_report();

protected:
    static void _bind_methods();
    void _notification(int what);
    // Properties of scenes from before conditions and tuning.
    bool _set(const godot::StringName& name, const godot::Variant& value);

private:
    // Of the statistics that are in this class; empty: all.
    godot::Dictionary figures(std::string_view of) const;
    void changed();
    void show_ghosts();
    void restart_world();
    LinkReport at_rest() const;
    godot::String way_problem() const;
    godot::String surplus_problem(const HapticWorld& world) const;
    NetworkSettings network_settings() const;
    // The wire to the partner: both have the same one.
    std::shared_ptr<MemoryLinkPair> wire(MMTLink& partner);
    void scenario_changed();
    void side_changed();
    void history_changed();
    void partner_changed();
    template <class Values>
    bool take_old(const char* place, const godot::Ref<Values>& own, const godot::String& name,
                  const godot::Variant& value);

    Scenario scenario_ = SCENARIO_LOCAL;
    Side side_ = SIDE_OPERATOR;
    godot::NodePath partner_;
    godot::String local_address_;
    int local_port_ = 0;
    godot::String remote_address_ = "127.0.0.1";
    int remote_port_ = 0;
    godot::String key_file_;
    ControlScheme control_ = ControlScheme::spring;
    Correction correction_ = Correction::stealthy_direction;
    double history_ = LinkPlan{}.history;  // (unit: seconds)
    godot::Ref<MMTNetworkConditions> conditions_;
    godot::Ref<MMTTuning> tuning_;
    // What changes anew with the scenario: everything, or nothing.
    enum class Running : uint8_t { alone, bodies, robot };
    Running running_ = Running::alone;
    godot::Dictionary model_errors_;

    std::uint64_t revision_ = 1;
    std::shared_ptr<MemoryLinkPair> wire_;
    LinkReport report_;
    bool show_ghosts_ = true;
    GhostView ghosts_;
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::MMTLink::State);
