#pragma once

#include <atomic>
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <memory>

#include "core/tool/tool_shape.hpp"
#include "nodes/device_choice.hpp"
#include "nodes/haptic_guide.hpp"
#include "nodes/node_state.hpp"
#include "nodes/properties.hpp"
#include "nodes/touched_bodies.hpp"
#include "session/session_types.hpp"

namespace tactus {

class TriangleSource;

// A rigid tool in the hand: it goes and turns as the hand does, and never enters a surface. Its place follows
// the tool.
class HapticTool : public godot::Node3D {
    GDCLASS(HapticTool, godot::Node3D)

public:
    enum Status : int64_t {
        STATUS_ABSENT = tool_absent,
        STATUS_TOUCHING = tool_touching,
        STATUS_SLIDING = tool_sliding,
        STATUS_UNFINISHED = tool_unfinished,
        STATUS_PINCHED = tool_squeezed,
        STATUS_TURN_FIXED = tool_turn_fixed,
        STATUS_WRIST_LOOSE = tool_wrist_loose
    };

    enum State : int64_t { STATE_OFF, STATE_FAILED, STATE_WAITING, STATE_WORKING };

    TACTUS_PROPERTIES(HapticTool)

    godot::Vector3 get_force() const { return to_godot(state_.force); }
    godot::Vector3 get_torque() const { return to_godot(state_.torque); }
    godot::Transform3D get_hand_transform() const { return to_godot(state_.hand); }
    godot::Transform3D get_tool_transform() const { return to_godot(state_.pose); }
    bool is_touching() const { return has(tool_touching); }
    bool is_present() const {
        return state_.handle != no_handle && !has(tool_absent) && !has(touch_unheld | far_hand_away);
    }
    godot::BitField<Status> get_status() const { return static_cast<Status>(state_.status); }
    double get_residual() const { return state_.residual; }
    int64_t get_sphere_count() const;
    double get_sampling_error() const;
    godot::TypedArray<godot::Dictionary> get_contacts() const { return touched_.contacts(state_); }
    State get_state() const;
    godot::String get_state_text() const;

    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that runs it

    HapticDevice* device_node() const { return device_.of(*this); }
    // Why it cannot touch anything, and what to do; empty where nothing is wrong with it.
    godot::String problem() const;
    // Begins to make its spheres where that has not been done, and where `waits` is true ends that.
    void make_shape(bool waits);
    // Null until they are made, and where the mesh is none for a tool.
    std::shared_ptr<const ToolShape> shape() const;
    godot::String problem_of_shape() const;
    // Why a robot does not carry it, and what to do; empty where nothing hinders it.
    godot::String hindrance() const;
    ToolUse use(SessionHandle device) const;
    using Touched = TouchedBodies<ToolState::max_contacts>;
    void take_state(const ToolState& state, const Touched::Ids& bodies);
    void clear_state();
    void end_contact(std::uint64_t node) { touched_.end(*this, node); }
    bool is_kept_out() const { return has(tool_absent); }
    bool has_guide() const { return guide_.is_valid(); }
    bool is_field_limited() const { return has(touch_field_limited); }
    void clear_force();

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    // Its spheres, made beside the frames.
    struct Sampling {
        std::atomic<bool> is_done = false;
        ToolShapeResult result;  // of use when it is done
    };

    void mesh_changed();
    void show_mesh();
    bool has(std::uint32_t bit) const { return (state_.status & bit) != 0; }

    DeviceChoice device_;
    godot::Ref<godot::Mesh> mesh_;
    ToolShapeSettings sampling_settings_;
    ToolSettings settings_;
    Vec3 grasp_position_{0.0};  // in the hand's frame (unit: meters)
    Vec3 grasp_rotation_{0.0};  // Euler's angles as Godot turns them (unit: radians)
    bool enabled_ = true;
    bool show_tool_ = true;
    godot::Ref<HapticGuide> guide_;

    std::shared_ptr<Sampling> sampling_;  // null: not begun
    ToolState state_;
    Touched touched_;
    godot::MeshInstance3D* picture_ = nullptr;
    ToldState<State> told_;
};

}  // namespace tactus

VARIANT_BITFIELD_CAST(tactus::HapticTool::Status);
VARIANT_ENUM_CAST(tactus::HapticTool::State);
