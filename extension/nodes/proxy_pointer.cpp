#include "nodes/proxy_pointer.hpp"

#include "nodes/conversions.hpp"
#include "nodes/haptic_device.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/messages.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"
#include "nodes/tree_walk.hpp"
#include "world/hand_picture.hpp"
#include "world/scene_hand.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr double min_radius = 1e-6;  // (unit: meters)
constexpr double max_radius = 1e3;

constexpr float opaque = 1.0f;
const Color proxy_color(0.1f, 0.4f, 0.9f, opaque);
// A proxy behind a body is seen through it.
const Color proxy_color_behind(0.25f, 0.55f, 1.0f, 0.3f);
const Color hand_color(0.95f, 0.15f, 0.15f, opaque);

void place(MeshInstance3D* picture, const PicturePart& part) {
    if (picture != nullptr) {
        picture->set_visible(part.is_visible);
        picture->set_global_transform(Transform3D(basis_of(part.axes), to_godot(part.center)));
    }
}

}  // namespace

void ProxyPointer::set_radius(double meters) {
    radius_was_refused_ = !(meters >= min_radius && meters <= max_radius);
    update_configuration_warnings();
    if (radius_was_refused_) {
        refuse(*this, "radius", meters, "between 0.000001 and 1,000 m");
        return;
    }
    radius_ = meters;
    place_pictures();
}

HapticDevice* ProxyPointer::device_node() const {
    return device_.of(*this);
}

String ProxyPointer::problem() const {
    if (const String wrong = device_.problem(*this); !wrong.is_empty()) {
        return wrong;
    }
    return mask_ == 0 ? String("its 'collision_mask' is empty, so it touches nothing: set a layer in it")
                      : String();
}

ProxyPointer::State ProxyPointer::get_state() const {
    return state_of<State>(!problem().is_empty(), is_present(), HapticWorld::of(this) != nullptr);
}

String ProxyPointer::get_state_text() const {
    if (const String wrong = problem(); !wrong.is_empty()) {
        return wrong;
    }
    if (is_edited()) {
        return String();
    }
    if (HapticWorld::of(this) == nullptr) {
        return "no HapticWorld is running: put one into the scene, best above this node";
    }
    return to_godot(state_of_fingertip(state_));
}

PackedStringArray ProxyPointer::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (is_inside_tree()) {
        for (const String& wrong : {problem(), problem_without_world(*this), problem_of_scene()}) {
            warn(warnings, "This ProxyPointer cannot touch", wrong);
        }
    }
    if (guide_.is_valid()) {
        warn(warnings, "This guide has no effect", guide_->get_problem());
    }
    if (radius_was_refused_) {
        warnings.push_back("'" + String(get_name()) +
                           "' was given a radius that is no length above 0 and kept " + String::num(radius_) +
                           " m: set 'radius' anew.");
    }
    return warnings;
}

// With the scene as it stands, whether it runs or not.
String ProxyPointer::problem_of_scene() const {
    const HapticDevice* device = device_node();
    const HapticWorld* world = HapticWorld::above(this);
    if (device == nullptr || world == nullptr || mask_ == 0) {
        return String();
    }
    const Vec3 start = device->start();
    const SceneReading scene = read_scene(*world, start, radius_);
    if (const String wrong = hindrance(scene.facts); !wrong.is_empty()) {
        return wrong;
    }
    return scene.around_hand == nullptr
               ? String()
               : "its hand begins inside '" + String(scene.around_hand->get_name()) +
                     "' and is not felt until it has been outside once: move the device, or the body";
}

ProxyDescription ProxyPointer::description(SessionHandle device) const {
    ProxyDescription description;
    description.device = device;
    description.settings.radius = radius_;
    description.settings.mask = mask_;
    description.force_law = force_law_;
    description.finger = finger_;
    if (guide_.is_valid()) {
        description.aids.add(guide_->guide(Transform3D()));
    }
    description.enabled = enabled_;
    return description;
}

void ProxyPointer::take_state(const ProxyState& state, const Touched::Ids& bodies) {
    state_ = state;
    touched_.take(*this, bodies);
    if (is_present() && has_places(get_parent_node_3d())) {
        set_global_position(to_godot(state.position));
    }
    place_pictures();
    told_.tell(*this);
}

void ProxyPointer::tell_broken(std::uint64_t node, double force) {
    tell_left(node);
    broken_.insert(node);
    post_signal(*this, "surface_broken", {SignalArgument::object(node), force});
}

void ProxyPointer::tell_left(std::uint64_t node) {
    if (broken_.erase(node) != 0) {
        post_signal(*this, "surface_left", {SignalArgument::object(node)});
    }
}

void ProxyPointer::end_contact(std::uint64_t node) {
    touched_.end(*this, node);
    tell_left(node);
}

void ProxyPointer::clear_state() {
    if (state_.handle == no_handle) {
        return;
    }
    state_ = {};
    touched_.take(*this, {});
    while (!broken_.empty()) {
        tell_left(*broken_.begin());
    }
    place_pictures();
    told_.tell(*this);
}

void ProxyPointer::make_pictures() {
    if (!is_inside_tree()) {
        return;
    }
    if (show_proxy_ && proxy_picture_ == nullptr) {
        const Ref<StandardMaterial3D> look = lit_material(proxy_color);
        look->set_next_pass(see_through_material(proxy_color_behind));
        proxy_picture_ = add_picture(*this, drawn_shape(SphereShape{1.0}), look);
    }
    if (show_hand_ && hand_picture_ == nullptr) {
        hand_picture_ = add_picture(*this, drawn_shape(SphereShape{1.0}), see_through_material(hand_color));
        line_picture_ =
            add_picture(*this, drawn_shape(CylinderShape{0.5, 0.5}), see_through_material(hand_color));
    }
    for (MeshInstance3D* picture : {proxy_picture_, hand_picture_, line_picture_}) {
        if (picture != nullptr) {
            picture->set_as_top_level(true);
        }
    }
    place_pictures();
}

void ProxyPointer::place_pictures() {
    if (!is_inside_tree()) {
        return;
    }
    const bool is_seen = is_visible_in_tree();
    const HandPicture picture = hand_picture({.proxy = from_godot(get_global_position()),
                                              .hand = state_.hand,
                                              .radius = radius_,
                                              .is_running = state_.handle != no_handle,
                                              .is_present = is_present(),
                                              .shows_proxy = show_proxy_ && is_seen,
                                              .shows_hand = show_hand_ && is_seen});
    place(proxy_picture_, picture.proxy);
    place(hand_picture_, picture.hand);
    place(line_picture_, picture.line);
}

void ProxyPointer::_notification(int what) {
    keep_roll(*this, what);
    switch (what) {
        case NOTIFICATION_ENTER_TREE:
            make_pictures();
            set_notify_transform(is_edited());
            break;
        case NOTIFICATION_EXIT_TREE:
            clear_state();
            break;
        case NOTIFICATION_TRANSFORM_CHANGED:
        case NOTIFICATION_VISIBILITY_CHANGED:
            place_pictures();
            break;
        default:
            break;
    }
}

}  // namespace tactus
