#include "nodes/haptic_device.hpp"

#include <cmath>
#include <godot_cpp/classes/control.hpp>
#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/file_access.hpp>
#include <godot_cpp/classes/input.hpp>
#include <godot_cpp/classes/input_event_mouse_button.hpp>
#include <godot_cpp/classes/input_event_mouse_motion.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/classes/viewport.hpp>

#include "devices/drivers.hpp"
#include "devices/path_device.hpp"
#include "devices/robot_table.hpp"
#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"

namespace tactus {

using namespace godot;

namespace {

// The hand of a mouse stays at least this far in front of the camera (unit: meters).
constexpr double nearest_depth = 0.02;

// No hand goes farther from the origin (unit: meters).
constexpr double farthest_hand = 1e6;

// How far the three factors of a scale may differ and still count as one: single precision leaves about 1e-6.
constexpr double even_scale = 1e-3;

// The share of the view that a control covers which nobody means to click beside.
constexpr double covers_view = 0.9;

// Whether the control takes all that the mouse does over most of the view.
bool takes_mouse(const Control& control) {
    const Vector2 own = control.get_global_rect().size;
    const Vector2 view = control.get_viewport_rect().size;
    return control.get_mouse_filter() == Control::MOUSE_FILTER_STOP && control.is_visible_in_tree() &&
           static_cast<double>(own.x * own.y) > covers_view * static_cast<double>(view.x * view.y);
}

const Control* control_over_view(const Node& node) {
    const auto* control = Object::cast_to<Control>(&node);
    if (control != nullptr && takes_mouse(*control)) {
        return control;
    }
    for (int i = 0; i < node.get_child_count(); ++i) {
        if (const Control* below = control_over_view(*node.get_child(i))) {
            return below;
        }
    }
    return nullptr;
}

}  // namespace

void HapticDevice::changed() {
    path_problem_ = path_.is_valid() ? path_->get_problem() : String();
    port_.reset();
    mouse_.reset();
    arm_.reset();
    driven_.reset();
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

Vector3 HapticDevice::get_hand_position() const {
    return to_godot(state_.position);
}
Vector3 HapticDevice::get_hand_velocity() const {
    return to_godot(state_.velocity);
}
Vector3 HapticDevice::get_force() const {
    return to_godot(state_.force);
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
               "(novint.bin, "
               "from its own software)";
    }
    if (driver() == DRIVER_FALCON && !FileAccess::file_exists(firmware_)) {
        return "there is no file '" + firmware_ + "': set 'firmware' to the maker's image (novint.bin)";
    }
    return is_inside_tree() ? to_godot(problem_of_place(get_global_transform())) : String();
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

String HapticDevice::problem_of_mouse() const {
    const bool is_edited = Engine::get_singleton()->is_editor_hint();
    const Node* scene = is_edited ? get_tree()->get_edited_scene_root() : nullptr;
    const bool has_camera = is_edited ? scene != nullptr && !scene->find_children("*", "Camera3D").is_empty()
                                      : get_viewport()->get_camera_3d() != nullptr;
    if (!has_camera) {
        return "the mouse needs a camera to move the hand before: add a Camera3D that sees the hand, and "
               "make "
               "it current";
    }
    const Control* over = nullptr;
    if (is_edited) {
        over = control_over_view(*scene);
    } else if (const Control* hovered = get_viewport()->gui_get_hovered_control();
               hovered != nullptr && takes_mouse(*hovered)) {
        over = hovered;
    }
    return over == nullptr ? String()
                           : "the control '" + String(over->get_name()) +
                                 "' lies over the view and takes the mouse: set its 'mouse_filter' to Ignore";
}

String HapticDevice::hindrance() const {
    return is_inside_tree() && driver() == DRIVER_MOUSE ? problem_of_mouse() : String();
}

PackedStringArray HapticDevice::_get_configuration_warnings() const {
    PackedStringArray warnings;
    const String wrong = problem();
    if (!wrong.is_empty()) {
        warnings.push_back("This HapticDevice does nothing: " + wrong + ".");
    }
    if (!is_inside_tree()) {
        return warnings;
    }
    if (const String hindered = hindrance(); !hindered.is_empty()) {
        warnings.push_back("The hand of this HapticDevice will not move: " + hindered + ".");
    }
    if (const String lost = problem_without_world(*this); !lost.is_empty()) {
        warnings.push_back("This HapticDevice does nothing: " + lost + ".");
    }
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
    if (port_ == nullptr && driver() == DRIVER_MOUSE) {
        mouse_ = std::make_shared<MouseDevice>(MouseDevice::Settings{});
        port_ = mouse_;
        mouse_target_ = from_godot(get_global_position());
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
                                                                 : DriverKind::openhaptics;
    return std::make_shared<DriverDevice>(make_driver(kind, std::move(settings)));
}

String HapticDevice::get_device_id() const {
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
    return {pose_of(transform), std::cbrt(volume), force_limit_, clutch_,
            static_cast<std::uint32_t>(dead_man_buttons_)};
}

Vec3 HapticDevice::start() const {
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
    if (mouse_ == nullptr || camera == nullptr) {
        return;
    }
    const Vec3 eye = from_godot(camera->project_ray_origin(screen_position));
    const Vec3 ray = from_godot(camera->project_ray_normal(screen_position));
    const Vec3 forward = -from_godot(camera->get_global_transform().basis.get_column(2).normalized());
    const double depth = std::max(nearest_depth, glm::dot(mouse_target_ - eye, forward) + depth_change);
    const double slant = glm::dot(ray, forward);
    if (!(slant > 0.0)) {
        return;
    }
    const Vec3 target = eye + ray * (depth / slant);
    if (!(glm::length(target) < farthest_hand)) {
        return;  // a camera that is nowhere sees no place
    }
    mouse_target_ = target;
    const Workspace mapping = workspace();
    const auto buttons = static_cast<std::uint32_t>(Input::get_singleton()->get_mouse_button_mask());
    mouse_->aim({tactus::to_local(mapping.pose, mouse_target_) / mapping.scale, buttons});
}

void HapticDevice::_unhandled_input(const Ref<InputEvent>& event) {
    if (mouse_ == nullptr || Engine::get_singleton()->is_editor_hint()) {
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
    }
}

void HapticDevice::_validate_property(PropertyInfo& property) const {
    const bool of_path = property.name == StringName("path");
    const bool of_mouse = property.name == StringName("wheel_step");
    const bool of_falcon =
        property.name == StringName("firmware") || property.name == StringName("gravity_compensation");
    const bool of_robot = property.name == StringName("table_height");
    const bool of_driver = property.name == StringName("device_id");
    const bool of_arm = String(property.name).begins_with("arm_");
    if ((of_path && !follows_path() && driver_ != DRIVER_AUTOMATIC) ||
        (of_falcon && driver() != DRIVER_FALCON) || (of_driver && !is_driven()) || (of_robot && driver() != DRIVER_EMULATED_ROBOT) ||
        (of_mouse && driver() != DRIVER_MOUSE) || (of_arm && driver() != DRIVER_ARM)) {
        property.usage = PROPERTY_USAGE_STORAGE;
    }
}

}  // namespace tactus
