#pragma once

#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <set>

#include "nodes/device_choice.hpp"
#include "nodes/haptic_guide.hpp"
#include "nodes/node_state.hpp"
#include "nodes/properties.hpp"
#include "nodes/touched_bodies.hpp"
#include "session/session_types.hpp"
#include "world/scene_facts.hpp"

namespace tactus {

class HapticDevice;

// The fingertip that never enters a surface. Its place follows the proxy.
class ProxyPointer : public godot::Node3D {
    GDCLASS(ProxyPointer, godot::Node3D)

public:
    enum Status : int64_t {
        STATUS_ABSENT = proxy_absent,
        STATUS_TOUCHING = proxy_touching,
        STATUS_SLIDING = proxy_sliding,
        STATUS_UNFINISHED = proxy_unfinished,
        STATUS_PINCHED = proxy_squeezed
    };

    enum State : int64_t { STATE_OFF, STATE_FAILED, STATE_WAITING, STATE_WORKING };

    TACTUS_PROPERTIES(ProxyPointer)
    void set_radius(double meters);
    double get_radius() const { return radius_; }

    godot::Vector3 get_force() const { return to_godot(state_.force); }
    godot::Vector3 get_hand_position() const { return to_godot(state_.hand); }
    godot::Vector3 get_proxy_position() const { return to_godot(state_.position); }
    bool is_touching() const { return has(proxy_touching); }
    bool is_present() const {
        return state_.handle != no_handle && !has(proxy_absent) && !has(touch_unheld | far_hand_away);
    }
    bool is_depenetrating() const { return has(proxy_letting_out); }
    bool is_pinched() const { return has(proxy_squeezed); }
    bool has_guide() const { return guide_.is_valid(); }
    bool is_field_limited() const { return has(touch_field_limited); }
    godot::BitField<Status> get_status() const { return static_cast<Status>(state_.status); }
    double get_residual() const { return state_.residual; }
    godot::TypedArray<godot::Dictionary> get_contacts() const { return touched_.contacts(state_); }
    State get_state() const;
    godot::String get_state_text() const;

    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that runs it

    // The one that 'device' names; where that is empty, the nearest one in the scene tree.
    HapticDevice* device_node() const;
    // Why it cannot touch anything, and what to do; empty where nothing is wrong with it.
    godot::String problem() const;
    // Why it will not touch what there is; empty where it can.
    godot::String hindrance(const SceneFacts& facts) const {
        return to_godot(problem_of_fingertip(radius_, mask_, facts));
    }
    ProxyDescription description(SessionHandle device) const;
    using Touched = TouchedBodies<HandForce::max_contacts>;
    void take_state(const ProxyState& state, const Touched::Ids& bodies);
    void clear_state();
    void end_contact(std::uint64_t node);
    // Once for each, in turns: what is left without having broken is not told.
    void tell_broken(std::uint64_t node, double force);
    void tell_left(std::uint64_t node);
    // Its hand began inside a body.
    bool is_kept_out() const { return has(proxy_absent); }
    void clear_force() { state_.force = Vec3(0.0); }

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    godot::String problem_of_scene() const;
    void guide_changed() { update_configuration_warnings(); }
    void make_pictures();
    void place_pictures();

    bool has(std::uint32_t bit) const { return (state_.status & bit) != 0; }

    DeviceChoice device_;
    double radius_ = 0.01;
    bool radius_was_refused_ = false;  // the last one that was asked for
    std::uint32_t mask_ = 0xffff'ffffu;
    ForceLaw force_law_ = ForceLaw::spring;
    SoftFinger finger_;
    godot::Ref<HapticGuide> guide_;
    bool enabled_ = true;
    bool show_proxy_ = true;
    bool show_hand_ = true;

    ProxyState state_;
    Touched touched_;
    std::set<std::uint64_t> broken_;  // bodies whose surface is told as broken
    godot::MeshInstance3D* proxy_picture_ = nullptr;
    godot::MeshInstance3D* hand_picture_ = nullptr;
    godot::MeshInstance3D* line_picture_ = nullptr;
    ToldState<State> told_;
};

}  // namespace tactus

VARIANT_BITFIELD_CAST(tactus::ProxyPointer::Status);
VARIANT_ENUM_CAST(tactus::ProxyPointer::State);
