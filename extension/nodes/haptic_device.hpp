#pragma once

#include <godot_cpp/classes/camera3d.hpp>
#include <godot_cpp/classes/input_event.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <memory>
#include <optional>

#include "devices/space_mouse.hpp"
#include "nodes/haptic_path.hpp"
#include "nodes/node_state.hpp"
#include "nodes/properties.hpp"
#include "world/scene_hand.hpp"

namespace tactus {

// The hand. Its transform maps the device's workspace into the scene: move, turn or scale the node, and
// positions and forces follow.
class HapticDevice : public godot::Node3D {
    GDCLASS(HapticDevice, godot::Node3D)

public:
    enum State : int64_t { STATE_OFF, STATE_FAILED, STATE_WAITING, STATE_WORKING };

    TACTUS_PROPERTIES(HapticDevice)

    bool is_device_connected() const { return state_.connected; }
    godot::Vector3 get_hand_position() const { return to_godot(state_.position); }
    godot::Vector3 get_hand_velocity() const { return to_godot(state_.velocity); }
    double get_energy() const { return state_.work; }
    godot::Quaternion get_hand_rotation() const { return to_godot(state_.rotation); }
    godot::Vector3 get_force() const { return to_godot(state_.force); }
    godot::Vector3 get_requested_force() const { return to_godot(state_.asked); }
    godot::Vector3 get_displayed_force() const;
    godot::Dictionary get_capabilities() const;
    void restart_path();
    double get_path_time() const { return to_seconds(hand_.path_time()); }
    godot::Dictionary get_force_cuts() const;
    godot::Dictionary get_delay_distribution() const;
    godot::Vector3 get_torque() const { return to_godot(state_.torque); }
    int64_t get_buttons() const { return state_.buttons; }
    godot::String get_open_device_id() const;
    // Half a side of the box around the workspace, in the device's own frame; 0: it has none (unit: meters).
    double get_workspace_radius() const;
    static godot::TypedArray<godot::Dictionary> find_devices();
    State get_state() const;
    godot::String get_state_text() const;

    // Puts the hand of a mouse under this point of the screen, at the depth where it is now.
    void aim_mouse(const godot::Vector2& screen_position, double depth_change);

    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that runs it

    // Why its hand does not move, though it could, and what to do; empty where nothing is in the way.
    godot::String hindrance() const;
    // Null where the driver has nothing to work with; another one after a change of driver or path.
    std::shared_ptr<Device> port();
    void follow_target();  // to where that is now, where a node leads the hand
    Workspace workspace() const;
    // Where its hand begins, in the scene.
    Vec3 start() const;
    void take_state(const DeviceState& state);
    void clear_state() { take_state({}); }
    bool applies_force() const { return workspace_.force != Vec3(0.0); }
    // It has motors that a driver commands.
    bool displays_forces() const { return has_driver(kind()); }
    // An event that nothing else has handled (input_watch.hpp).
    void take_input(const godot::InputEvent& event);

protected:
    static void _bind_methods();
    void _notification(int what);
    void _validate_property(godot::PropertyInfo& property) const;

private:
    godot::String problem() const;
    std::optional<Nanoseconds> path_end() const;
    void tell_path_end();
    void changed();
    void driver_changed();
    void path_changed();
    // A property of some kinds of hands: any other hand goes on as it is.
    void changed_for(bool is_used) { is_used ? changed() : void(); }
    void target_changed() { changed_for(kind() == HandKind::node || kind() == HandKind::robot_tip); }
    void vendor_changed() { changed_for(has_driver(kind())); }
    void falcon_changed() { changed_for(kind() == HandKind::falcon); }
    void robot_changed() { changed_for(kind() == HandKind::emulated_robot); }
    void arm_changed() { hand_.change(plan_.arm); }
    // The one that is meant where that is left open.
    HandKind kind() const;
    HandPlan plan() const;
    godot::Node3D* target_node() const;
    HapticDevice* robot_node() const;  // whose tip this one is; null: none
    // Around the workspace, where it is to be seen.
    void draw_box();
    SteeringInput steering_input();
    // Tells the hand where it is wanted, where keys, a cap, a stick or a node do so.
    void lead_hand();

    HandKind driver_ = HandKind::automatic;
    godot::Ref<HapticPath> path_;
    godot::String path_problem_;  // why it cannot be followed; empty where it can
    double wheel_step_ = 0.01;
    int gamepad_ = 0;
    SteeringSettings steering_;
    godot::NodePath target_;
    godot::String firmware_;
    HandPlan plan_;        // as far as they are properties; its tip is that of an emulated robot
    Workspace workspace_;  // likewise
    bool show_workspace_ = false;

    SceneHand hand_;
    std::optional<Nanoseconds> path_end_;  // of the path that it follows; none: it never ends
    bool is_path_end_told_ = false;
    std::unique_ptr<SpaceMouse> space_mouse_;  // of that driver alone
    DeviceState state_;
    godot::MeshInstance3D* box_ = nullptr;  // made when it is first seen
    ToldState<State> told_;
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticDevice::State);
