#pragma once

#include <algorithm>
#include <godot_cpp/classes/collision_object3d.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <memory>
#include <string_view>
#include <utility>

#include "core/haptics/touch_material.hpp"
#include "core/teleop/seen_pose.hpp"
#include "nodes/haptic_material.hpp"
#include "nodes/node_state.hpp"
#include "nodes/properties.hpp"
#include "realtime/tick_loop.hpp"
#include "world/body_queries.hpp"
#include "world/scene_body.hpp"

namespace tactus {

class HapticLoadStatistics;
class HapticRecorder;
class HapticTimingStatistics;
class InputRecording;
class WorldRun;
struct BodyPush;

// Where a world began, and whether it has been moved since: a jump shows at once, a motion when it has ended.
class PlaceWatch {
public:
    void begin(const godot::Transform3D& place) { began_ = place; }
    // Once a frame.
    bool is_elsewhere(const godot::Transform3D& place) {
        const bool moves = std::exchange(seen_, place) != place;
        const bool went_on = std::exchange(moves_, moves) && moves;
        return place != began_ && !went_on;
    }

private:
    godot::Transform3D began_, seen_;
    bool moves_ = false;
};

// Its subtree is what can be touched. While the scene plays, it runs the haptic loop with a physics world of
// its own, and moves the RigidBody3D nodes of its subtree.
class HapticWorld : public godot::Node3D {
    GDCLASS(HapticWorld, godot::Node3D)

public:
    enum Clock : int64_t { CLOCK_REAL_TIME, CLOCK_STEPPED };
    enum Authority : int64_t { AUTHORITY_HAPTIC, AUTHORITY_GODOT, AUTHORITY_AUTOMATIC };
    enum State { STATE_OFF, STATE_FAILED, STATE_WAITING, STATE_WORKING };

    HapticWorld();
    ~HapticWorld() override;

    TACTUS_PROPERTIES(HapticWorld)

    int64_t advance(double seconds);
    bool is_running() const { return run_ != nullptr; }
    Authority get_authority_in_use() const;
    int64_t get_ticks() const;
    double get_time() const;
    State get_state() const;
    godot::String get_state_text() const;
    godot::Dictionary get_statistics() const;
    godot::Ref<HapticLoadStatistics> get_load_statistics() const;
    godot::Ref<HapticTimingStatistics> get_timing_statistics() const;
    void reset_statistics();
    godot::Dictionary get_period_distribution() const;
    godot::Dictionary get_baseline_period_distribution() const;
    godot::PackedStringArray get_problems() const;
    godot::String get_inputs_problem() const { return inputs_problem_; }

    // Bodies of this world, as RigidBody3D has it. Forces act for the time of one frame. A body comes as a
    // Variant, so that one that has been freed is an error and no pointer to freed memory.
    using Body = godot::CollisionObject3D;
    void apply_central_impulse(const godot::Variant& body, const godot::Vector3& impulse);
    void apply_impulse(const godot::Variant& body, const godot::Vector3& impulse,
                       const godot::Vector3& position);
    void apply_torque_impulse(const godot::Variant& body, const godot::Vector3& impulse);
    void apply_central_force(const godot::Variant& body, const godot::Vector3& force);
    void apply_force(const godot::Variant& body, const godot::Vector3& force, const godot::Vector3& position);
    void apply_torque(const godot::Variant& body, const godot::Vector3& torque);
    // What is there to touch: of all bodies of this world whose layers are in the mask.
    godot::Array get_tree_boxes(const godot::Vector3& point, double radius, int64_t most) const;
    godot::Dictionary get_nearest_surface(const godot::Vector3& point, double max_distance,
                                          int64_t mask) const;
    godot::Dictionary intersect_ray(const godot::Vector3& from, const godot::Vector3& to, int64_t mask) const;
    godot::TypedArray<Body> intersect_sphere(const godot::Vector3& center, double radius, int64_t mask) const;
    godot::Vector3 get_linear_velocity(const godot::Variant& body) const;
    godot::Vector3 get_angular_velocity(const godot::Variant& body) const;

    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the other nodes

    // The running world above the node; else the first one that runs anywhere; null where none does.
    static HapticWorld* of(const godot::Node* node);
    // The nearest one above, whether it runs or not.
    static HapticWorld* above(const godot::Node* node);
    double tick_seconds() const { return 1.0 / tick_rate_; }
    // It becomes a side of a teleoperation, or none, or another one: it starts anew.
    void link_changed() { world_changed(); }
    godot::Vector3 get_gravity() const { return gravity_; }
    // A camera sees the body. False where it is not in the session.
    bool see(const godot::Node* body, const BodySighting& sighting);
    // The last rows are written before the recorder closes its files.
    static void finish_recording(HapticRecorder& recorder);
    BodyDefaults body_defaults() const;

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    // What a change of a property asks for. It is done at the beginning of the next frame, or of advance():
    // many changes at once are one start, and none happens while something of the world is in use.
    enum class Change : std::uint8_t { none, loop, world };

    // By the script's `method`; for_a_frame: see RunningWorld::push().
    void push(const char* method, const godot::Variant& body, const BodyPush& push, bool for_a_frame);
    BodyState state_of(const char* method, const godot::Variant& body) const;
    std::vector<QueriedBody> touchable(int64_t mask) const;
    bool can_ask(const char* method, const godot::Vector3& where, double size) const;
    void start();
    void stop();
    void world_changed() { change_ = Change::world; }
    void loop_changed() { change_ = std::max(change_, Change::loop); }
    void gravity_changed();
    void look_at_place();
    bool may_choose_godot() const;
    bool chooses_godot();
    void look_at_arrivals();
    static void hold_arrived();
    void catch_up();
    std::unique_ptr<InputRecording> record_inputs(const SessionSettings& settings);
    void start_loop();
    TickLoopSettings loop_settings() const;
    bool is_urgent() const;
    double frame_seconds() const;
    // In every frame. No virtual method: a script's _process() would take its place.
    void process(double seconds);
    void physics_process();
    void node_added(const godot::Variant& node);
    void node_removed(const godot::Variant& node);
    void report_status(double seconds);
    // Of the statistics that are in this class; empty: all.
    godot::Dictionary figures(std::string_view of) const;

    int tick_rate_ = 1000;
    Clock clock_ = CLOCK_REAL_TIME;
    Authority authority_ = AUTHORITY_AUTOMATIC;
    godot::Vector3 gravity_;
    godot::Ref<HapticMaterial> default_material_;
    int max_bodies_ = 1024;
    RealtimeRequest realtime_;  // as the project permits it
    bool measure_baseline_ = false;
    godot::String inputs_path_;
    int starts_ = 0;  // with inputs that are recorded
    godot::String inputs_problem_;

    // Null while nothing runs: in the editor, always. Shared with whoever is at work in it.
    std::shared_ptr<WorldRun> run_;
    std::shared_ptr<WorldRun> former_;  // before it started anew, until its trees are in the new one
    Change change_ = Change::none;
    PlaceWatch place_;
    std::vector<std::uint64_t> arrivals_;  // ids of nodes that may ask for Godot's own physics
    double since_report_ = 0.0;            // (unit: seconds)
    godot::String loop_error_;             // why the haptic thread could not start
    ToldState<State> told_;
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticWorld::Authority);
VARIANT_ENUM_CAST(tactus::HapticWorld::State);
