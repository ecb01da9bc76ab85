#include "nodes/haptic_device.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <godot_cpp/classes/file_access.hpp>
#include <godot_cpp/classes/input.hpp>
#include <godot_cpp/classes/input_event_mouse_button.hpp>
#include <godot_cpp/classes/input_event_mouse_motion.hpp>
#include <godot_cpp/classes/viewport.hpp>

#include "devices/scan.hpp"
#include "nodes/conversions.hpp"
#include "nodes/hand_input.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/input_watch.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/messages.hpp"
#include "nodes/project_settings.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"
#include "nodes/tree_walk.hpp"
#include "platform/clock.hpp"
#include "world/hand_events.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr double box_line = 0.01;  // as thick, of half a side of the box
const Color box_color(0.1f, 0.4f, 0.9f, 0.5f);

}  // namespace

void HapticDevice::path_changed() {
    path_problem_ = path_.is_valid() ? path_->get_problem() : String();
    changed_for(follows_path(kind()) || driver_ == HandKind::automatic);
}

void HapticDevice::changed() {
    path_end_ = path_end();
    hand_ = {};
    is_path_end_told_ = false;
    space_mouse_.reset();
    set_process_internal(!is_edited() && (is_steered(kind()) || kind() == HandKind::node));
    draw_box();
    update_configuration_warnings();
}

std::optional<Nanoseconds> HapticDevice::path_end() const {
    if (!follows_path(kind()) || path_.is_null() || !path_problem_.is_empty()) {
        return std::nullopt;
    }
    const HandPath path = path_->hand_path();
    return path_repeats(path) ? std::nullopt : std::optional(path_duration(path));
}

double HapticDevice::get_workspace_radius() const {
    return state_.capabilities.radius > 0.0 ? state_.capabilities.radius : usual_radius(kind(), steering_);
}

TypedArray<Dictionary> HapticDevice::find_devices() {
    TypedArray<Dictionary> found;
    for (const PluggedDevice& device : plugged_devices()) {
        Dictionary d;
        d["driver"] = static_cast<int64_t>(hand_of(device.kind));
        d["id"] = to_godot(device.id);
        d["name"] = to_godot(device.name);
        found.push_back(d);
    }
    return found;
}

// In the editor a gizmo of the addon's plugin shows it.
void HapticDevice::draw_box() {
    const double radius = get_workspace_radius();
    const bool is_seen = is_inside_tree() && radius > 0.0 && show_workspace_ && !is_edited();
    if (is_seen && box_ == nullptr) {
        box_ = add_picture(*this, drawn_cube_edges(1.0, box_line), see_through_material(box_color));
    }
    if (box_ != nullptr) {
        box_->set_visible(is_seen);
        box_->set_scale(to_godot(Vec3(radius > 0.0 ? radius : 1.0)));
    }
}

HandKind HapticDevice::kind() const {
    if (driver_ != HandKind::automatic) {
        return driver_;
    }
    return path_.is_valid() ? HandKind::path : HandKind::mouse;
}

void HapticDevice::driver_changed() {
    notify_property_list_changed();
    changed();
}

Node3D* HapticDevice::target_node() const {
    return node_at<Node3D>(*this, target_);
}

HapticDevice* HapticDevice::robot_node() const {
    auto* const robot = Object::cast_to<HapticDevice>(target_node());
    return robot != nullptr && robot->kind() == HandKind::emulated_robot ? robot : nullptr;
}

String HapticDevice::problem() const {
    const bool needs_path = follows_path(kind());
    if (needs_path && path_.is_null()) {
        return "the driver follows a path and there is none: set 'path' to a HapticPath, or choose another "
               "driver";
    }
    if (needs_path && !path_problem_.is_empty()) {
        return "its path cannot be followed: " + path_problem_;
    }
    if (kind() == HandKind::falcon && firmware_.is_empty()) {
        return "the Falcon needs its firmware at every start: set 'firmware' to the maker's image "
               "(novint.bin, from its own software)";
    }
    if (kind() == HandKind::falcon && !FileAccess::file_exists(firmware_)) {
        return "there is no file '" + firmware_ + "': set 'firmware' to the maker's image (novint.bin)";
    }
    if (kind() == HandKind::node && target_.is_empty()) {
        return "the driver follows a node and there is none: set 'target' to a Node3D, or choose another "
               "driver";
    }
    if (kind() == HandKind::node && target_node() == nullptr) {
        return wrong_path("target", target_, "a Node3D");
    }
    if (kind() == HandKind::robot_tip && robot_node() == nullptr) {
        return wrong_path("target", target_, "a HapticDevice with the driver of an emulated robot");
    }
    return is_inside_tree() ? to_godot(problem_of_place(frame_of(get_global_transform()))) : String();
}

HapticDevice::State HapticDevice::get_state() const {
    return state_of<State>(!problem().is_empty(), state_.connected, HapticWorld::of(this) != nullptr);
}

String HapticDevice::get_state_text() const {
    if (const String wrong = problem(); !wrong.is_empty()) {
        return wrong;
    }
    if (HapticWorld::of(this) == nullptr) {
        return "no HapticWorld is running: put one into the scene, best above this node";
    }
    const bool is_led = is_steered(kind()) || kind() == HandKind::node;
    const std::string said = is_led ? from_godot(hindrance()) : hand_.health().text;
    const std::string text = state_of_hand(state_, has_driver(kind()), said);
    return to_godot(said.empty() ? text + text_of_cuts(hand_.health().cuts) : text);
}

String HapticDevice::hindrance() const {
    if (!is_inside_tree()) {
        return String();
    }
    if (kind() == HandKind::node) {
        const Node3D* led_by = target_node();
        const bool is_near = led_by == nullptr || !led_by->is_inside_tree() ||
                             glm::length(from_godot(led_by->get_global_position())) < farthest_hand;
        return is_near ? String()
                       : String(
                             "it stays where it was, as its target is farther than 1000 km from the origin: "
                             "bring that nearer");
    }
    return kind() == HandKind::mouse     ? problem_of_mouse(*this)
           : kind() == HandKind::gamepad ? problem_of_gamepad(gamepad_)
           : space_mouse_ != nullptr     ? to_godot(space_mouse_->problem())
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
    if (!is_even(frame_of(get_global_transform()))) {
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
    if (hand_.port() == nullptr) {
        hand_ = SceneHand(plan(), workspace());
    }
    return hand_.port();
}

HandPlan HapticDevice::plan() const {
    HandPlan plan = plan_;
    plan.kind = kind();
    plan.start = start();
    if (const Node3D* const led_by = plan.kind == HandKind::node ? target_node() : nullptr) {
        plan.turned = pose_of(led_by->get_global_transform()).rotation;
    }
    if (plan.kind == HandKind::robot_tip) {
        plan.tip = robot_node()->plan_.tip;
    }
    if (path_.is_valid()) {
        plan.path = path_->hand_path();
    }
    if (!firmware_.is_empty()) {
        const PackedByteArray image = FileAccess::get_file_as_bytes(firmware_);
        plan.driver.firmware.assign(image.ptr(), image.ptr() + image.size());
    }
    return plan;
}

String HapticDevice::get_open_device_id() const {
    return to_godot(hand_.health().id);
}

Vector3 HapticDevice::get_displayed_force() const {
    if (!has_driver(kind()) || !is_inside_tree()) {
        return get_force();
    }
    return to_godot(direction_to_parent(workspace().pose, hand_.health().displayed.force));
}

Dictionary HapticDevice::get_force_cuts() const {
    Dictionary cuts;
    if (has_driver(kind())) {
        const char* const names[force_cut_count] = {"loop_silent", "device_silent", "driver_stuck"};
        const ForceSlot::Cuts counted = hand_.health().cuts;
        for (std::size_t i = 0; i < force_cut_count; ++i) {
            cuts[names[i]] = static_cast<int64_t>(counted[i]);
        }
    }
    return cuts;
}

Dictionary HapticDevice::get_delay_distribution() const {
    Dictionary delays;
    if (const DurationHistogram* measured = hand_.delays()) {
        delays["count"] = static_cast<int64_t>(measured->count());
        delays["p50_us"] = 1e-3 * measured->quantile(0.5);
        delays["p99_us"] = 1e-3 * measured->quantile(0.99);
        delays["max_us"] = 1e-3 * static_cast<double>(measured->max());
    }
    return delays;
}

void HapticDevice::take_state(const DeviceState& state) {
    const DeviceState before = std::exchange(state_, state);
    if (before.capabilities.radius != state.capabilities.radius) {
        draw_box();
    }
    for (const HandEvent& event : hand_events(before, state)) {
        std::vector<SignalArgument> arguments;
        if (event.button >= 0) {
            arguments.push_back(event.button);
        }
        post_signal(*this, event.name, arguments);
    }
    tell_path_end();
    told_.tell(*this);
}

void HapticDevice::restart_path() {
    hand_.restart_path();
    is_path_end_told_ = false;
}

// Once for each round that does not begin again by itself.
void HapticDevice::tell_path_end() {
    const Nanoseconds time = hand_.path_time();
    if (path_end_ && !is_path_end_told_ && time > 0 && time >= *path_end_) {
        is_path_end_told_ = true;
        post_signal(*this, "path_finished");
    }
}

Dictionary HapticDevice::get_capabilities() const {
    Dictionary told;
    if (!state_.connected) {
        return told;
    }
    const DeviceCapabilities& can = state_.capabilities;
    told["has_motors"] = can.feels;
    told["measures_rotation"] = can.rotates;
    told["max_force"] = can.max_force;
    told["max_torque"] = can.max_torque;
    told["max_force_rate"] = can.max_slew;
    told["max_speed"] = can.max_speed;
    told["damping"] = can.damping;
    told["delay"] = can.delay;
    told["rate"] = can.rate;
    told["workspace_radius"] = can.radius;
    told["safe_stiffness"] = safe_wall(state_.lag, can.damping, {DeviceCapabilities::any, 0.0}).stiffness;
    return told;
}

Workspace HapticDevice::workspace() const {
    const SceneFrame frame = frame_of(get_global_transform());
    Workspace workspace = workspace_;
    workspace.pose = pose_of(frame);
    workspace.scale = mean_scale(frame);
    workspace.force_limit = std::min(workspace.force_limit, project_force_limit());
    return workspace;
}

Vec3 HapticDevice::start() const {
    if (const Node3D* led_by = kind() == HandKind::node ? target_node() : nullptr) {
        return from_godot(led_by->get_global_position());
    }
    // Where the way begins is meant to be free, also for a hand that is led otherwise.
    const bool has_way = path_.is_valid() && path_problem_.is_empty();
    return into_scene(workspace(), has_way ? sample_path(path_->hand_path(), 0).position : Vec3(0.0));
}

void HapticDevice::aim_mouse(const Vector2& screen_position, double depth_change) {
    if (!screen_position.is_finite() || !std::isfinite(depth_change)) {
        refuse(*this, "aim_mouse", screen_position, "a place of the screen, and a finite way to it");
        return;
    }
    Camera3D* camera = is_inside_tree() ? get_viewport()->get_camera_3d() : nullptr;
    if (kind() == HandKind::mouse && camera != nullptr) {
        const ScreenRay ray{from_godot(camera->project_ray_origin(screen_position)),
                            from_godot(camera->project_ray_normal(screen_position)),
                            -from_godot(camera->get_global_transform().basis.get_column(2).normalized())};
        const auto buttons = static_cast<std::uint32_t>(Input::get_singleton()->get_mouse_button_mask());
        hand_.point(ray, depth_change, workspace(), buttons);
    }
}

SteeringInput HapticDevice::steering_input() {
    if (kind() == HandKind::keyboard) {
        return read_keyboard();
    }
    if (kind() == HandKind::gamepad) {
        return read_gamepad(gamepad_);
    }
    if (space_mouse_ == nullptr) {
        space_mouse_ = std::make_unique<SpaceMouse>();
    }
    return space_mouse_->look(monotonic_now());
}

void HapticDevice::lead_hand() {
    if (is_steered(kind())) {
        const SteeringInput input = steering_input();
        const bool is_there = !may_be_missing(kind()) || hindrance().is_empty();
        hand_.steer(from_view(*this, input.deflection), steering_, get_process_delta_time(), workspace(),
                    input.buttons, is_there);
    } else {
        follow_target();
    }
}

void HapticDevice::follow_target() {
    if (const Node3D* const led_by = kind() == HandKind::node ? target_node() : nullptr) {
        hand_.lead(pose_of(led_by->get_global_transform()), workspace(), buttons_of(*led_by));
    }
}

void HapticDevice::take_input(const InputEvent& event) {
    if (const auto* motion = Object::cast_to<InputEventMouseMotion>(&event)) {
        aim_mouse(motion->get_position(), 0.0);
    } else if (const auto* button = Object::cast_to<InputEventMouseButton>(&event)) {
        const bool away = button->is_pressed() && button->get_button_index() == MOUSE_BUTTON_WHEEL_UP;
        const bool closer = button->is_pressed() && button->get_button_index() == MOUSE_BUTTON_WHEEL_DOWN;
        aim_mouse(button->get_position(), wheel_step_ * (away ? 1.0 : closer ? -1.0 : 0.0));
    }
}

void HapticDevice::_notification(int what) {
    keep_roll(*this, what);
    if (what == NOTIFICATION_ENTER_TREE) {
        draw_box();
        InputWatch::put_into(*this);
    } else if (what == NOTIFICATION_EXIT_TREE) {
        changed();
        clear_state();
    } else if (what == NOTIFICATION_INTERNAL_PROCESS) {
        lead_hand();
    }
}

}  // namespace tactus
