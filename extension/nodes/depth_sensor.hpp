#pragma once

#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <memory>
#include <optional>

#include "nodes/properties.hpp"
#include "nodes/seen_bodies.hpp"
#include "nodes/synthetic_view.hpp"
#include "world/sensing_library.hpp"

namespace tactus {

// The eyes: a depth camera, or a recording of one, in; known objects with their poses out. Its transform is
// where the camera is. What looks is a library of its own with a thread of its own
// (core/ports/depth_sensing.hpp).
class DepthSensor : public godot::Node3D {
    GDCLASS(DepthSensor, godot::Node3D)

public:
    enum Source : int64_t { SOURCE_CAMERA, SOURCE_RECORDING, SOURCE_SYNTHETIC };
    enum State : int64_t {
        STATE_CLOSED = static_cast<int64_t>(SensorState::closed),
        STATE_OPENING = static_cast<int64_t>(SensorState::opening),
        STATE_WAITING = static_cast<int64_t>(SensorState::waiting),
        STATE_SEEING = static_cast<int64_t>(SensorState::seeing),
        STATE_ENDED = static_cast<int64_t>(SensorState::ended)
    };
    enum Bodies : int64_t {
        BODIES_NONE = static_cast<int64_t>(SeenAs::pictures),
        BODIES_HELD = static_cast<int64_t>(SeenAs::held_bodies),
        BODIES_FREE = static_cast<int64_t>(SeenAs::free_bodies)
    };

    TACTUS_PROPERTIES(DepthSensor)

    State get_state() const;
    godot::String get_state_text() const;
    godot::TypedArray<godot::Dictionary> get_objects() const;
    godot::Dictionary get_plane() const;
    godot::Dictionary get_statistics() const;
    double get_frame_ms() const { return 1e3 * sight().times.frame; }
    double get_lowest_confidence() const;
    static godot::Dictionary find_cameras();
    double calibrate_from_plane(double height);
    double calibrate_from_object(int64_t id, const godot::Transform3D& place);
    // Synthetic camera only.
    void set_plugged(bool is_plugged);

    godot::PackedStringArray _get_configuration_warnings() const override;

    // Whether what it finds is to be touched.
    bool makes_bodies() const { return bodies_ != BODIES_NONE || touch_cloud_; }

protected:
    static void _bind_methods();
    void _notification(int what);
    void _validate_property(godot::PropertyInfo& property) const;

private:
    void source_changed();
    void library_changed();
    void pictures_changed();
    void show();
    const Sight& sight() const;
    double age() const;  // of what was seen last (unit: seconds)
    godot::String problem() const;
    godot::String problem_of_touch() const;
    bool touches_cloud() const;
    godot::PackedStringArray library_names() const;
    void begin();
    void make_sensor();
    void end();
    void open();
    void pass_on_library();
    void pass_on_settings();
    void look();
    void tell(bool is_new);
    double stand_at(const std::optional<Pose>& camera, double residual, const godot::String& why_not);
    godot::Dictionary describe(const SightedObject& object) const;

    bool active_ = true;
    Source source_ = SOURCE_CAMERA;
    godot::String camera_id_;
    godot::String recording_;
    godot::String images_path_;
    bool repeats_ = true;
    godot::NodePath synthetic_scene_;
    double synthetic_error_percent_ = 1.0;
    double synthetic_noise_ = 1.0;
    int synthetic_seed_ = 1;
    int width_ = 320;
    godot::PackedStringArray meshes_;
    double min_confidence_ = 0.5;
    double rate_ = 30.0;
    double camera_delay_ = 0.0;  // (unit: milliseconds)
    bool knows_support_ = false;
    double support_height_ = 0.0;
    Bodies bodies_ = BODIES_NONE;
    bool show_objects_ = true;
    bool show_cloud_ = false;
    bool touch_cloud_ = false;

    OwnedSensor sensor_;  // null: nothing is looked at
    std::string load_error_;
    std::vector<SeenMesh> library_;
    std::string library_error_;
    SyntheticView view_;
    SeenBodies seen_;
    SightChanges changes_;
    SensorState told_state_ = SensorState::closed;
    std::string told_text_;
    double calibration_residual_ = -1.0;  // (unit: meters); below 0: never calibrated
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::DepthSensor::Source);
VARIANT_ENUM_CAST(tactus::DepthSensor::State);
VARIANT_ENUM_CAST(tactus::DepthSensor::Bodies);
