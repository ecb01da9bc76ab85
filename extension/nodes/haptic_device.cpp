#include "nodes/haptic_device.hpp"

#include <cmath>
#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/file_access.hpp>
#include <godot_cpp/classes/input.hpp>
#include <godot_cpp/classes/input_event_mouse_button.hpp>
#include <godot_cpp/classes/input_event_mouse_motion.hpp>
#include <godot_cpp/classes/viewport.hpp>

#include "devices/drivers.hpp"
#include "devices/path_device.hpp"
#include "devices/robot_table.hpp"
#include "nodes/conversions.hpp"
#include "nodes/hand_input.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"

namespace tactus {

using namespace godot;

namespace {

// How far the three factors of a scale may differ and still count as one: single precision leaves about 1e-6.
constexpr double even_scale = 1e-3;

}  // namespace

void HapticDevice::changed() {
    path_problem_ = path_.is_valid() ? path_->get_problem() : String();
    port_.reset();
    follower_.reset();
    arm_.reset();
    driven_.reset();
    steered_ = Vec3(0.0);
    set_process_internal(!Engine::get_singleton()->is_editor_hint() &&
                         (is_steered() || driver() == DRIVER_NODE));
    update_configuration_warnings();
}

HapticDevice::Driver HapticDevice::driver() const {
    if (driver_ != DRIVER_AUTOMATIC) {
        return driver_;
    }
    return path_.is_valid() ? DRIVER_PATH : DRIVER_MOUSE;
}

void HapticDevice::driver_changed() {
    notify_property_list_changed();
    changed();
}

void HapticDevice::arm_changed() {
    if (arm_ != nullptr) {
        arm_->change(arm_settings_);
    }
}

Node3D* HapticDevice::target_node() const {
    return is_inside_tree() && !target_.is_empty() ? Object::cast_to<Node3D>(get_node_or_null(target_))
                                                   : nullptr;
}

String HapticDevice::problem() const {
    if (follows_path() && path_.is_null()) {
        return "the driver follows a path and there is none: set 'path' to a HapticPath, or choose another "
               "driver";
    }
    if (follows_path() && !path_problem_.is_empty()) {
        return "its path cannot be followed: " + path_problem_;
    }
    if (driver() == DRIVER_FALCON && firmware_.is_empty()) {
        return "the Falcon needs its firmware at every start: set 'firmware' to the maker's image "
               "(novint.bin, from its own software)";
    }
    if (driver() == DRIVER_FALCON && !FileAccess::file_exists(firmware_)) {
        return "there is no file '" + firmware_ + "': set 'firmware' to the maker's image (novint.bin)";
    }
    if (driver() == DRIVER_NODE && target_node() == nullptr) {
        return target_.is_empty()
                   ? String(
                         "the driver follows a node and there is none: set 'target' to a "
                         "Node3D, or choose another driver")
                   : "its target '" + String(target_) + "' is not a Node3D of the scene: set 'target' anew";
    }
    return is_inside_tree() ? to_godot(problem_of_place(frame_of(get_global_transform()))) : String();
}

String HapticDevice::get_state_text() const {
    const String wrong = problem();
    if (!wrong.is_empty()) {
        return wrong;
    }
    if (HapticWorld::of(this) == nullptr) {
        return "no HapticWorld is running: put one into the scene, best above this node";
    }
    if (const std::string said = driven_ != nullptr ? driven_->health().text : ""; !said.empty()) {
        return to_godot(said);
    }
    if (!state_.connected) {
        return driven_ != nullptr ? "waiting for the device" : "waiting for the first tick";
    }
    const std::string too_stiff =
        explain_stiffness(state_.stiffness_wanted, state_.stiffness_used, state_.lag);
    const String safety = state_.safety == HandState::working ? String() : String(text_of(state_.safety));
    const String wall = too_stiff.empty() ? String() : to_godot(too_stiff);
    return "connected" + (safety.is_empty() ? String() : "; " + safety) +
           (wall.is_empty() ? String() : "; " + wall);
}

String HapticDevice::hindrance() const {
    if (!is_inside_tree()) {
        return String();
    }
    return driver() == DRIVER_MOUSE     ? problem_of_mouse(*this)
           : driver() == DRIVER_GAMEPAD ? problem_of_gamepad(gamepad_)
                                        : String();
}

PackedStringArray HapticDevice::_get_configuration_warnings() const {
    PackedStringArray warnings;
    warn(warnings, "This HapticDevice does nothing", problem());
    if (!is_inside_tree()) {
        return warnings;
    }
    warn(warnings, "The hand of this HapticDevice will not move", hindrance());
    warn(warnings, "This HapticDevice does nothing", problem_without_world(*this));
    const Vector3 scale = get_global_transform().basis.get_scale().abs();
    if (std::abs(scale.x - scale.y) > even_scale * scale.x ||
        std::abs(scale.x - scale.z) > even_scale * scale.x) {
        warnings.push_back(
            "This HapticDevice is scaled differently along its axes; the mean is used. Scale it "
            "evenly.");
    }
    return warnings;
}

std::shared_ptr<Device> HapticDevice::port() {
    if (!problem().is_empty()) {
        return nullptr;
    }
    if (port_ == nullptr && driver() == DRIVER_PATH) {
        port_ = std::make_shared<PathDevice>(path_->hand_path());
    }
    if (port_ == nullptr && driver() == DRIVER_ARM) {
        arm_ = std::make_shared<SimulatedArm>(path_->hand_path(), arm_settings_);
        port_ = arm_;
    }
    if (port_ == nullptr && driver() == DRIVER_EMULATED_ROBOT) {
        RobotTable::Settings table;
        table.height = table_height_;
        port_ = std::make_shared<EmulatedRobot>(EmulatedRobotSettings{}, std::make_shared<RobotTable>(table));
    }
    if (port_ == nullptr && is_driven()) {
        driven_ = open_driver();
        port_ = driven_;
    }
    if (port_ == nullptr) {
        const Workspace mapping = workspace();
        mouse_target_ = start();
        follower_ = std::make_shared<FollowingDevice>(
            FollowingDevice::Settings{.rest = tactus::to_local(mapping.pose, mouse_target_) / mapping.scale});
        port_ = follower_;
    }
    return port_;
}

std::shared_ptr<DriverDevice> HapticDevice::open_driver() const {
    DriverSettings settings;
    settings.id = from_godot(device_id_);
    settings.weight = gravity_compensation_;
    if (!firmware_.is_empty()) {
        const PackedByteArray image = FileAccess::get_file_as_bytes(firmware_);
        settings.firmware.assign(image.ptr(), image.ptr() + image.size());
    }
    const DriverKind kind = driver() == DRIVER_FALCON            ? DriverKind::falcon
                            : driver() == DRIVER_FORCE_DIMENSION ? DriverKind::force_dimension
                            : driver() == DRIVER_OPENHAPTICS     ? DriverKind::openhaptics
                                                                 : DriverKind::inverse3;
    return std::make_shared<DriverDevice>(make_driver(kind, std::move(settings)));
}

String HapticDevice::get_open_device_id() const {
    return driven_ != nullptr ? to_godot(driven_->health().id) : String();
}

void HapticDevice::take_state(const DeviceState& state) {
    const DeviceState before = std::exchange(state_, state);
    if (before.connected != state.connected) {
        post_signal(*this, state.connected ? "connected" : "disconnected");
    }
    if (before.limited == 0 && state.limited != 0) {
        post_signal(*this, "force_limited");
    }
    const std::uint32_t changed = before.buttons ^ state.buttons;
    for (int64_t button = 0; changed >> button != 0; ++button) {
        if ((changed >> button & 1u) != 0) {
            const bool pressed = (state.buttons >> button & 1u) != 0;
            post_signal(*this, pressed ? "button_pressed" : "button_released", {button});
        }
    }
}

Workspace HapticDevice::workspace() const {
    const Transform3D transform = get_global_transform();
    const double volume = std::abs(static_cast<double>(transform.basis.determinant()));
    return {pose_of(transform),
            std::cbrt(volume),
            force_limit_,
            clutch_,
            static_cast<std::uint32_t>(dead_man_buttons_),
            force_scale_,
            edge_speed_};
}

Vec3 HapticDevice::start() const {
    if (const Node3D* led_by = driver() == DRIVER_NODE ? target_node() : nullptr) {
        return from_godot(led_by->get_global_position());
    }
    const Workspace mapping = workspace();
    const bool is_followed = follows_path() && path_.is_valid() && path_problem_.is_empty();
    const Vec3 hand = is_followed ? sample_path(path_->hand_path(), 0).position : Vec3(0.0);
    return tactus::to_parent(mapping.pose, mapping.scale * hand);
}

void HapticDevice::aim_mouse(const Vector2& screen_position, double depth_change) {
    if (!screen_position.is_finite() || !std::isfinite(depth_change)) {
        refuse(*this, "aim_mouse", screen_position, "a place of the screen, and a finite way to it");
        return;
    }
    Camera3D* camera = is_inside_tree() ? get_viewport()->get_camera_3d() : nullptr;
    if (driver() != DRIVER_MOUSE || follower_ == nullptr || camera == nullptr) {
        return;
    }
    const ScreenRay ray{from_godot(camera->project_ray_origin(screen_position)),
                        from_godot(camera->project_ray_normal(screen_position)),
                        -from_godot(camera->get_global_transform().basis.get_column(2).normalized())};
    const std::optional<Vec3> target = under_pointer(ray, mouse_target_, depth_change);
    if (!target) {
        return;
    }
    mouse_target_ = *target;
    const Workspace mapping = workspace();
    const auto buttons = static_cast<std::uint32_t>(Input::get_singleton()->get_mouse_button_mask());
    follower_->aim({tactus::to_local(mapping.pose, mouse_target_) / mapping.scale, buttons});
}

void HapticDevice::lead_hand(double seconds) {
    if (follower_ == nullptr) {
        return;
    }
    const Workspace mapping = workspace();
    if (is_steered()) {
        const SteeringInput input = driver() == DRIVER_KEYBOARD ? read_keyboard() : read_gamepad(gamepad_);
        const Vec3 deflection = direction_to_local(mapping.pose, from_view(*this, input.deflection));
        steered_ = steered(steered_, deflection, steering_, seconds);
        follower_->aim({steered_, input.buttons});
    } else if (const Node3D* led_by = target_node()) {
        const Vec3 place = from_godot(led_by->get_global_position());
        if (glm::length(place) < farthest_hand) {
            follower_->aim({tactus::to_local(mapping.pose, place) / mapping.scale, buttons_of(*led_by)});
        }
    }
}

void HapticDevice::_unhandled_input(const Ref<InputEvent>& event) {
    if (Engine::get_singleton()->is_editor_hint()) {
        return;
    }
    if (const auto* motion = Object::cast_to<InputEventMouseMotion>(event.ptr())) {
        aim_mouse(motion->get_position(), 0.0);
    } else if (const auto* button = Object::cast_to<InputEventMouseButton>(event.ptr())) {
        const bool away = button->is_pressed() && button->get_button_index() == MOUSE_BUTTON_WHEEL_UP;
        const bool closer = button->is_pressed() && button->get_button_index() == MOUSE_BUTTON_WHEEL_DOWN;
        aim_mouse(button->get_position(), wheel_step_ * (away ? 1.0 : closer ? -1.0 : 0.0));
    }
}

void HapticDevice::_notification(int what) {
    if (what == NOTIFICATION_ENTER_TREE) {
        Roll<HapticDevice>::enter(this);
        watch_warnings(*this);
    } else if (what == NOTIFICATION_EXIT_TREE) {
        Roll<HapticDevice>::leave(this);
        changed();
        clear_state();
    } else if (what == NOTIFICATION_INTERNAL_PROCESS) {
        lead_hand(get_process_delta_time());
    }
}

void HapticDevice::_validate_property(PropertyInfo& property) const {
    const String name = property.name;
    const bool is_of_another = (name == "path" && !follows_path() && driver_ != DRIVER_AUTOMATIC) ||
                               (name == "wheel_step" && driver() != DRIVER_MOUSE) ||
                               (name.begins_with("arm_") && driver() != DRIVER_ARM) ||
                               (name.begins_with("steering") && !is_steered()) ||
                               (name == "gamepad" && driver() != DRIVER_GAMEPAD) ||
                               (name == "target" && driver() != DRIVER_NODE) ||
                               (name == "firmware" && driver() != DRIVER_FALCON) ||
                               (name == "gravity_compensation" && driver() != DRIVER_FALCON) ||
                               (name == "table_height" && driver() != DRIVER_EMULATED_ROBOT) ||
                               (name == "device_id" && !is_driven());
    if (is_of_another) {
        property.usage = PROPERTY_USAGE_STORAGE;
    }
}

}  // namespace tactus
