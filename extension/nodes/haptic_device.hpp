#pragma once

#include <godot_cpp/classes/camera3d.hpp>
#include <godot_cpp/classes/input_event.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <memory>

#include "devices/space_mouse.hpp"
#include "nodes/haptic_path.hpp"
#include "nodes/properties.hpp"
#include "world/scene_hand.hpp"

namespace tactus {

// The hand. Its transform maps the device's workspace into the scene: move, turn or scale the node, and
// positions and forces follow.
class HapticDevice : public godot::Node3D {
    GDCLASS(HapticDevice, godot::Node3D)

public:
    enum Driver : int64_t {
        DRIVER_PATH = static_cast<int64_t>(HandKind::path),
        DRIVER_MOUSE = static_cast<int64_t>(HandKind::mouse),
        DRIVER_ARM = static_cast<int64_t>(HandKind::arm),
        DRIVER_AUTOMATIC = static_cast<int64_t>(HandKind::automatic),
        DRIVER_KEYBOARD = static_cast<int64_t>(HandKind::keyboard),
        DRIVER_GAMEPAD = static_cast<int64_t>(HandKind::gamepad),
        DRIVER_NODE = static_cast<int64_t>(HandKind::node),
        DRIVER_SPACE_MOUSE = static_cast<int64_t>(HandKind::space_mouse),
        DRIVER_FALCON = static_cast<int64_t>(HandKind::falcon),
        DRIVER_FORCE_DIMENSION = static_cast<int64_t>(HandKind::force_dimension),
        DRIVER_OPENHAPTICS = static_cast<int64_t>(HandKind::openhaptics),
        DRIVER_INVERSE3 = static_cast<int64_t>(HandKind::inverse3),
        DRIVER_EMULATED_ROBOT = static_cast<int64_t>(HandKind::emulated_robot),
        DRIVER_ROBOT_TIP = static_cast<int64_t>(HandKind::robot_tip),
    };
    enum Steering : int64_t {
        STEERING_RATE = static_cast<int64_t>(SteeringMode::rate),
        STEERING_POSITION = static_cast<int64_t>(SteeringMode::position)
    };

    TACTUS_PROPERTIES(HapticDevice)

    bool is_device_connected() const { return state_.connected; }
    godot::Vector3 get_hand_position() const { return to_godot(state_.position); }
    godot::Vector3 get_hand_velocity() const { return to_godot(state_.velocity); }
    double get_energy() const { return state_.work; }
    godot::Quaternion get_hand_rotation() const { return to_godot(state_.rotation); }
    godot::Vector3 get_force() const { return to_godot(state_.force); }
    godot::Vector3 get_torque() const { return to_godot(state_.torque); }
    int64_t get_buttons() const { return state_.buttons; }
    godot::String get_open_device_id() const;
    // Half a side of the box around the workspace, in the device's own frame; 0: it has none (unit: meters).
    double get_workspace_radius() const;
    static godot::TypedArray<godot::Dictionary> find_devices();
    godot::String get_state_text() const;

    // Puts the hand of a mouse under this point of the screen, at the depth where it is now.
    void aim_mouse(const godot::Vector2& screen_position, double depth_change);

    void _unhandled_input(const godot::Ref<godot::InputEvent>& event) override;
    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that runs it

    // Why its hand does not move, though it could, and what to do; empty where nothing is in the way.
    godot::String hindrance() const;
    // Null where the driver has nothing to work with; another one after a change of driver or path.
    std::shared_ptr<Device> port();
    Workspace workspace() const;
    // Where its hand begins, in the scene.
    Vec3 start() const;
    void take_state(const DeviceState& state);
    void clear_state() { take_state({}); }

protected:
    static void _bind_methods();
    void _notification(int what);
    void _validate_property(godot::PropertyInfo& property) const;

private:
    godot::String problem() const;
    void changed();
    void driver_changed();
    void arm_changed() { hand_.change(arm_settings_); }
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
    ArmSettings arm_settings_;
    godot::String firmware_;
    godot::String device_id_;
    double gravity_compensation_ = 0.0;
    double table_height_ = -0.01;
    double force_limit_ = 8.0;
    double force_scale_ = 1.0;
    double edge_speed_ = 0.0;
    Vec3 applied_torque_{0.0};  // (unit: newton meters)
    bool show_workspace_ = false;
    bool clutch_ = false;
    int dead_man_buttons_ = 0;

    SceneHand hand_;
    std::unique_ptr<SpaceMouse> space_mouse_;                             // of that driver alone
    std::shared_ptr<TipExchange> tip_ = std::make_shared<TipExchange>();  // as an emulated robot
    DeviceState state_;
    godot::MeshInstance3D* box_ = nullptr;  // made when it is first seen
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticDevice::Driver);
VARIANT_ENUM_CAST(tactus::HapticDevice::Steering);
