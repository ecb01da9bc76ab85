#include "nodes/haptic_depth_sensor.hpp"

#include <algorithm>
#include <godot_cpp/classes/file_access.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/classes/window.hpp>

#include "core/math/body_motion.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mesh_library.hpp"
#include "nodes/messages.hpp"
#include "nodes/mmt_link.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"
#include "nodes/whole_path.hpp"
#include "platform/clock.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr double never = -1.0;

// What a synthetic camera sees is to stand as worlds show it in this frame.
constexpr int after_worlds = 1;

}  // namespace

// --- properties

void HapticDepthSensor::source_changed() {
    notify_property_list_changed();
    update_configuration_warnings();
    end();
    begin();
}

void HapticDepthSensor::library_changed() {
    update_configuration_warnings();
    if (sensor_ != nullptr) {
        pass_on_library();
    }
}

void HapticDepthSensor::pictures_changed() {
    pass_on_settings();
    show();
}

void HapticDepthSensor::show() {
    if (sensor_ != nullptr) {
        SeenBodies::Looks looks = looks_;
        looks.touch_cloud = touches_cloud();
        seen_.update(*this, sight(), library_, looks, age(), get_process_delta_time());
    }
}

String HapticDepthSensor::problem() const {
    if (source_ == SOURCE_RECORDING && recording_.is_empty()) {
        return "it plays a recording and there is none: set 'recording' to an .oni file, or choose a camera";
    }
    if (source_ == SOURCE_RECORDING && !FileAccess::file_exists(recording_)) {
        return "there is no file '" + recording_ + "': set 'recording' to an .oni file";
    }
    if (source_ == SOURCE_SYNTHETIC && is_inside_tree() && !synthetic_scene_.is_empty() &&
        get_node_or_null(synthetic_scene_) == nullptr) {
        return wrong_path("synthetic_scene", synthetic_scene_, "a node");
    }
    if (is_inside_tree() && makes_bodies()) {
        return problem_of_touch();
    }
    return to_godot(library_.error());
}

// What is found is to be touched.
String HapticDepthSensor::problem_of_touch() const {
    const HapticWorld* const world = HapticWorld::above(this);
    if (world == nullptr) {
        return "what it finds cannot be touched outside of a HapticWorld: put it below one, or set 'bodies' "
               "to none and switch 'touch_cloud' off";
    }
    const std::vector<MMTLink*> links = MMTLink::of(*world);
    const bool is_far = !links.empty() && !links.front()->is_operator();
    if (is_far && looks_.objects == SeenAs::held_bodies && links.front()->has_robots()) {
        return "nothing holds bodies at a teleoperator with a robot, where nothing is simulated: set "
               "'bodies' to "
               "free";
    }
    return is_far && looks_.touch_cloud
               ? String("the cloud does not travel over the link: switch 'touch_cloud' off")
               : to_godot(library_.error());
}

bool HapticDepthSensor::touches_cloud() const {
    const HapticWorld* const world = looks_.touch_cloud ? HapticWorld::above(this) : nullptr;
    return world != nullptr && MMTLink::of(*world).empty();
}

// --- looking

const Sight& HapticDepthSensor::sight() const {
    static const Sight nothing;
    return sensor_ != nullptr ? sensor_->sight() : nothing;
}

double HapticDepthSensor::age() const {
    return std::clamp(to_seconds(monotonic_now() - sight().seen_at), 0.0, longest_guess);
}

// The rest of the scene, which a synthetic camera looks at, may not be there yet.
void HapticDepthSensor::begin() {
    if (!is_edited()) {
        set_process_priority(after_worlds);
        set_process_internal(active_ && is_inside_tree());
    }
}

void HapticDepthSensor::make_sensor() {
    const DepthSensing* const sensing = depth_sensing(load_error_);
    if (sensing != nullptr) {
        sensor_.reset(sensing->make_sensor());
        load_error_ = sensor_ != nullptr ? "" : "there is no memory or thread for the sensor";
    }
    if (sensor_ == nullptr) {
        return;
    }
    pass_on_settings();
    pass_on_library();
    open();
}

void HapticDepthSensor::open() {
    if (!problem().is_empty()) {
        sensor_->close();
        return;
    }
    CameraChoice choice;
    choice.width = synthetic_.width;
    choice.repeats = repeats_;
    std::string uri = from_godot(camera_id_);
    if (source_ == SOURCE_RECORDING) {
        uri = from_godot(ProjectSettings::get_singleton()->globalize_path(recording_));
    } else if (source_ == SOURCE_SYNTHETIC) {
        SyntheticCamera camera = synthetic_;
        camera.height = camera.width * 3 / 4;
        camera.rate = settings_.max_rate;
        camera.depth_error = synthetic_depth_error_;
        std::string ignored;
        Node* const root =
            synthetic_scene_.is_empty() ? get_tree()->get_root() : get_node_or_null(synthetic_scene_);
        load_error_ = view_.begin(*depth_sensing(ignored), camera, *root, *this);
        view_.show(synthetic_camera());
        uri = view_.uri();
        if (uri.empty()) {
            sensor_->close();
            return;
        }
    }
    const std::string images = whole_path(images_path_);
    choice.uri = uri.c_str();
    choice.record_to = images.c_str();
    sensor_->open(choice);
}

Pose HapticDepthSensor::synthetic_camera() const {
    const Pose error{from_godot(synthetic_place_error_), turn_by(from_godot(synthetic_rotation_error_), 1.0)};
    return compose(pose_of(get_global_transform()), error);
}

void HapticDepthSensor::pass_on_library() {
    library_ = {};
    const PackedStringArray names = meshes_.is_empty() ? mesh_library_names() : meshes_;
    for (int64_t i = 0; i < names.size(); ++i) {
        library_.add(from_godot(names[i]), load_library_mesh(names[i])->triangles(),
                     mesh_library_entry(names[i]).mass);
    }
    sensor_->set_library(library_.known());
}

void HapticDepthSensor::pass_on_settings() {
    if (sensor_ == nullptr) {
        return;
    }
    settings_.camera = pose_of(get_global_transform());
    settings_.camera_delay = source_ == SOURCE_CAMERA      ? image_delay_
                             : source_ == SOURCE_SYNTHETIC ? synthetic_clock_error_
                                                           : 0.0;
    settings_.wants_cloud = looks_.show_cloud;
    settings_.wants_surface = touches_cloud();
    sensor_->set_settings(settings_);
}

void HapticDepthSensor::end() {
    sensor_.reset();
    load_error_.clear();
    view_.end();
    seen_.clear();
    changes_.forget();
    told_state_ = SensorState::closed;
    told_text_.clear();
    set_process_internal(false);
}

void HapticDepthSensor::look() {
    if (sensor_ == nullptr && load_error_.empty()) {
        make_sensor();
    }
    if (sensor_ == nullptr) {
        return;
    }
    pass_on_settings();
    if (view_.is_there() && view_.show(synthetic_camera())) {
        open();  // something is drawn no longer, or as another mesh
    }
    const bool is_new = sensor_->take();
    if (is_new) {
        show();
    } else {
        seen_.go_on(sight(), age());
    }
    tell(is_new);
}

// Signals for what has changed since the last frame.
void HapticDepthSensor::tell(bool is_new) {
    const Sight& now = sight();
    if (told_state_ != now.state || told_text_ != now.text) {
        told_state_ = now.state;
        told_text_ = now.text;
        post_signal(*this, "state_changed", {static_cast<int64_t>(now.state), get_state_text()});
    }
    if (!is_new) {
        return;
    }
    for (const SightChange& change : changes_.since_last(now)) {
        const auto id = static_cast<int64_t>(change.id);
        const String name = to_godot(library_.name_of(change.mesh));
        switch (change.kind) {
            case SightChange::Kind::found:
                post_signal(*this, "object_found", {id, name});
                break;
            case SightChange::Kind::updated:
                post_signal(*this, "object_updated", {id, to_godot(change.pose)});
                break;
            case SightChange::Kind::lost:
                post_signal(*this, "object_lost", {id, name});
                break;
        }
    }
}

// --- what it says

String HapticDepthSensor::get_state_text() const {
    if (const String wrong = problem(); !wrong.is_empty()) {
        return wrong;
    }
    if (!active_) {
        return "it is switched off: set 'active'";
    }
    if (!load_error_.empty()) {
        return to_godot(load_error_);
    }
    return sensor_ != nullptr ? to_godot(std::string(sight().text))
                              : String("it begins with the next frame of the scene");
}

Dictionary HapticDepthSensor::describe(const SightedObject& object) const {
    Dictionary d;
    d["id"] = static_cast<int64_t>(object.id);
    d["name"] = to_godot(library_.name_of(object.mesh));
    d["is_known"] = object.mesh >= 0;
    d["state"] = word_of(object.state);
    d["transform"] = to_godot(object.pose);
    d["confidence"] = object.confidence;
    d["rests"] = object.rests;
    d["position_deviation"] = place_deviation(object.covariance);
    d["rotation_deviation"] = turn_deviation(object.covariance);
    d["linear_velocity"] = to_godot(object.linear_velocity);
    d["angular_velocity"] = to_godot(object.angular_velocity);
    d["node"] = seen_.node_of(object.id);
    return d;
}

TypedArray<Dictionary> HapticDepthSensor::get_objects() const {
    TypedArray<Dictionary> objects;
    for (const SightedObject& object : sight().objects) {
        objects.push_back(describe(object));
    }
    return objects;
}

Dictionary HapticDepthSensor::get_plane() const {
    Dictionary d;
    if (const SupportPlane& plane = sight().plane; plane.is_found) {
        d["normal"] = to_godot(plane.normal);
        d["offset"] = plane.offset;
        d["residual"] = plane.residual;
    }
    return d;
}

Dictionary HapticDepthSensor::find_cameras() {
    Dictionary cameras;
    std::string error;
    for (const FoundCamera& one : found_cameras(error)) {
        cameras[String::utf8(one.uri.data())] = String::utf8(one.name.data());
    }
    if (!error.empty()) {
        UtilityFunctions::push_warning("HapticDepthSensor: ", to_godot(error), ".");
    }
    return cameras;
}

// --- where the camera is

double HapticDepthSensor::stand_at(const std::optional<Pose>& camera, double residual,
                                   const String& why_not) {
    if (!camera) {
        UtilityFunctions::push_warning(name_of(*this), ": ", why_not);
        return never;
    }
    set_global_transform(to_godot(*camera));
    pass_on_settings();
    return calibration_residual_ = residual;
}

double HapticDepthSensor::calibrate_from_plane(double height) {
    return stand_at(camera_over_plane(sight(), height), sight().plane.residual,
                    "no plane is seen that could be calibrated by: let the camera see the table, and little "
                    "else, and try again.");
}

double HapticDepthSensor::calibrate_from_object(int64_t id, const Transform3D& place) {
    const auto known = static_cast<std::uint64_t>(id);
    const SightedObject* const object = object_of(sight(), known);
    return stand_at(place.is_finite() ? camera_by_object(sight(), known, pose_of(place)) : std::nullopt,
                    object != nullptr ? place_deviation(object->covariance) : never,
                    "object " + String::num_int64(id) +
                        " is not one that is seen and known: take an id of get_objects().");
}

// --- Godot

PackedStringArray HapticDepthSensor::_get_configuration_warnings() const {
    PackedStringArray warnings;
    warn(warnings, "This HapticDepthSensor sees nothing", problem());
    return warnings;
}

void HapticDepthSensor::_notification(int what) {
    if (what == NOTIFICATION_ENTER_TREE) {
        // Only what is to be touched needs a world.
        if (is_edited() || makes_bodies()) {
            watch_warnings(*this);
        }
        begin();
    } else if (what == NOTIFICATION_EXIT_TREE) {
        end();
    } else if (what == NOTIFICATION_INTERNAL_PROCESS) {
        look();
    }
}

}  // namespace tactus
