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
#include <string_view>

#include "nodes/properties.hpp"
#include "nodes/seen_bodies.hpp"
#include "nodes/synthetic_view.hpp"
#include "world/sensing_library.hpp"

namespace tactus {

class HapticSensingStatistics;

// The eyes: a depth camera, or a recording of one, in; known objects with their poses out. Its transform is
// where the camera is. What looks is a library of its own with a thread of its own
// (core/ports/depth_sensing.hpp).
class HapticDepthSensor : public godot::Node3D {
    GDCLASS(HapticDepthSensor, godot::Node3D)

public:
    enum Source : int64_t { SOURCE_CAMERA, SOURCE_RECORDING, SOURCE_SYNTHETIC };
    enum State {
        STATE_CLOSED = static_cast<int>(SensorState::closed),
        STATE_OPENING = static_cast<int>(SensorState::opening),
        STATE_WAITING = static_cast<int>(SensorState::waiting),
        STATE_SEEING = static_cast<int>(SensorState::seeing),
        STATE_ENDED = static_cast<int>(SensorState::ended),
    };

    TACTUS_PROPERTIES(HapticDepthSensor)

    State get_state() const { return static_cast<State>(sight().state); }
    godot::String get_state_text() const;
    godot::TypedArray<godot::Dictionary> get_objects() const;
    godot::Dictionary get_plane() const;
    godot::Dictionary get_statistics() const;
    godot::Ref<HapticSensingStatistics> get_sensing_statistics() const;
    double get_frame_time() const { return sight().times.frame; }
    double get_frame_ms() const { return 1e3 * sight().times.frame; }
    double get_lowest_confidence() const { return lowest_confidence(sight()); }
    static godot::Dictionary find_cameras();
    double calibrate_from_plane(double height);
    double calibrate_from_object(int64_t id, const godot::Transform3D& place);
    // Synthetic camera only.
    void set_plugged(bool is_plugged) { view_.set_plugged(is_plugged); }

    godot::PackedStringArray _get_configuration_warnings() const override;

    // Whether what it finds is to be touched.
    bool makes_bodies() const { return looks_.objects != SeenAs::pictures || looks_.touch_cloud; }

protected:
    static void _bind_methods();
    void _notification(int what);
    void _validate_property(godot::PropertyInfo& property) const;

private:
    // Of the statistics that are in this class; empty: all.
    godot::Dictionary figures(std::string_view of) const;
    void source_changed();
    void library_changed();
    void pictures_changed();
    void show();
    const Sight& sight() const;
    double age() const;  // of what was seen last (unit: seconds)
    godot::String problem() const;
    godot::String problem_of_touch() const;
    bool touches_cloud() const;
    void begin();
    void make_sensor();
    void end();
    void open();
    void pass_on_library();
    void pass_on_settings();
    void look();
    void tell(bool is_new);
    Pose synthetic_camera() const;  // where it really is
    double stand_at(const std::optional<Pose>& camera, double residual, const godot::String& why_not);
    godot::Dictionary describe(const SightedObject& object) const;

    bool active_ = true;
    Source source_ = SOURCE_CAMERA;
    godot::String camera_id_;
    godot::String recording_;
    godot::String images_path_;
    bool repeats_ = true;
    godot::NodePath synthetic_scene_;
    double synthetic_depth_error_ = 0.01;
    godot::Vector3 synthetic_place_error_;     // (unit: meters)
    godot::Vector3 synthetic_rotation_error_;  // (unit: radians)
    double synthetic_clock_error_ = 0.0;       // (unit: seconds)
    SyntheticCamera synthetic_;                // with the width of any camera
    godot::PackedStringArray meshes_;
    SensorSettings settings_;   // as far as they are properties
    double image_delay_ = 0.0;  // (unit: seconds)
    SeenBodies::Looks looks_;

    OwnedSensor sensor_;  // null: nothing is looked at
    std::string load_error_;
    SeenLibrary library_;
    SyntheticView view_;
    SeenBodies seen_;
    SightChanges changes_;
    SensorState told_state_ = SensorState::closed;
    std::string told_text_;
    double calibration_residual_ = -1.0;  // (unit: meters); below 0: never calibrated
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticDepthSensor::State);
