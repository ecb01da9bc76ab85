#include "nodes/hand_input.hpp"

#include <array>
#include <cstddef>
#include <godot_cpp/classes/camera3d.hpp>
#include <godot_cpp/classes/control.hpp>
#include <godot_cpp/classes/input.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/classes/viewport.hpp>
#include <godot_cpp/classes/xr_controller3d.hpp>

#include "nodes/conversions.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"
#include "world/scene_hand.hpp"

namespace tactus {

using namespace godot;

namespace {

// The share of the view that a control covers which nobody means to click beside.
constexpr double covers_view = 0.9;

constexpr int max_gamepad_buttons = 16;

// Of an XRController3D, by the names of Godot's own action map.
constexpr std::array controller_buttons = {"trigger_click", "grip_click", "ax_button", "by_button"};

double pressed(Key key) {
    return Input::get_singleton()->is_physical_key_pressed(key) ? 1.0 : 0.0;
}

// Whether the control takes all that the mouse does over most of the view.
bool takes_mouse(const Control& control) {
    const Vector2 own = control.get_global_rect().size;
    const Vector2 view = control.get_viewport_rect().size;
    return control.get_mouse_filter() == Control::MOUSE_FILTER_STOP && control.is_visible_in_tree() &&
           static_cast<double>(own.x * own.y) > covers_view * static_cast<double>(view.x * view.y);
}

const Node* control_over_view(const Node& scene) {
    const auto takes_it = [](const Node& node) {
        const auto* control = Object::cast_to<Control>(&node);
        return control != nullptr && takes_mouse(*control);
    };
    return takes_it(scene) ? &scene : find_below(scene, takes_it);
}

}  // namespace

SteeringInput read_keyboard() {
    SteeringInput input;
    input.deflection = {pressed(KEY_RIGHT) - pressed(KEY_LEFT), pressed(KEY_UP) - pressed(KEY_DOWN),
                        pressed(KEY_PAGEDOWN) - pressed(KEY_PAGEUP)};
    input.buttons = (pressed(KEY_SPACE) > 0.0 ? 1u : 0u) | (pressed(KEY_ENTER) > 0.0 ? 2u : 0u);
    return input;
}

// A stick's y points down.
SteeringInput read_gamepad(int gamepad) {
    const Input& godot_input = *Input::get_singleton();
    const auto axis = [&](JoyAxis which) {
        return static_cast<double>(godot_input.get_joy_axis(gamepad, which));
    };
    SteeringInput input;
    input.deflection = {axis(JOY_AXIS_LEFT_X), -axis(JOY_AXIS_LEFT_Y), axis(JOY_AXIS_RIGHT_Y)};
    for (int button = 0; button < max_gamepad_buttons; ++button) {
        if (godot_input.is_joy_button_pressed(gamepad, static_cast<JoyButton>(button))) {
            input.buttons |= 1u << button;
        }
    }
    return input;
}

std::uint32_t buttons_of(const Node3D& node) {
    std::uint32_t buttons = 0;
    if (const auto* controller = Object::cast_to<XRController3D>(&node)) {
        for (std::size_t i = 0; i < controller_buttons.size(); ++i) {
            buttons |= controller->is_button_pressed(controller_buttons[i]) ? 1u << i : 0u;
        }
    }
    return buttons;
}

Vec3 from_view(const Node3D& node, const Vec3& direction) {
    const Camera3D* camera = node.is_inside_tree() ? node.get_viewport()->get_camera_3d() : nullptr;
    const Transform3D view = camera != nullptr ? camera->get_camera_transform() : node.get_global_transform();
    return direction_to_parent(pose_of(view), direction);
}

String problem_of_mouse(const Node& node) {
    const Node* scene = is_edited() ? node.get_tree()->get_edited_scene_root() : nullptr;
    const bool has_camera = is_edited()
                                ? scene != nullptr && !scene->find_children("*", "Camera3D").is_empty()
                                : node.get_viewport()->get_camera_3d() != nullptr;
    if (!has_camera) {
        return "the mouse needs a camera to move the hand before: add a Camera3D that sees the hand, and "
               "make it current";
    }
    const Node* over = nullptr;
    if (is_edited()) {
        over = control_over_view(*scene);
    } else if (const Control* hovered = node.get_viewport()->gui_get_hovered_control();
               hovered != nullptr && takes_mouse(*hovered)) {
        over = hovered;
    }
    return over == nullptr ? String()
                           : "the control '" + String(over->get_name()) +
                                 "' lies over the view and takes the mouse: set its 'mouse_filter' to Ignore";
}

String problem_of_gamepad(int gamepad) {
    Input& input = *Input::get_singleton();
    const TypedArray<int> connected = input.get_connected_joypads();
    std::vector<Gamepad> there;
    for (int64_t i = 0; i < connected.size(); ++i) {
        const int number = static_cast<int>(connected[i]);
        there.push_back({number, from_godot(input.get_joy_name(number))});
    }
    return to_godot(problem_of_gamepad(gamepad, there));
}

}  // namespace tactus
