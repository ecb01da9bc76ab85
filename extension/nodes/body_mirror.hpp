// One Godot body and its twin in the session: what changes on Godot's side is passed on, and what the session
// moves is shown on Godot's side. Main thread only.
#pragma once

#include <atomic>
#include <godot_cpp/classes/collision_object3d.hpp>
#include <memory>
#include <string>
#include <vector>

#include "nodes/body_building.hpp"
#include "nodes/body_watch.hpp"
#include "nodes/conversions.hpp"
#include "realtime/workers.hpp"
#include "session/session.hpp"

namespace tactus {

// What all mirrors of a world share in one synchronise().
struct MirrorContext {
    BodyDefaults defaults;
    std::shared_ptr<BodyNews> news;  // where what Godot tells of the bodies goes
    bool shapes_changed = false;     // a resource of the body has changed since the last time
    std::uint64_t takes_effect = 0;  // the first tick that has certainly taken what is sent now
    Workers* workers = nullptr;      // for bodies of many triangles
};

class BodyMirror {
public:
    explicit BodyMirror(godot::CollisionObject3D& body) : id_(body.get_instance_id()) {}

    std::uint64_t id() const { return id_; }
    SessionHandle handle() const { return handle_; }
    godot::CollisionObject3D* body() const;  // null when the node is gone

    // Brings the session up to date. What moved on Godot's side since the last call took `seconds` for it.
    void synchronise(Session& session, const MirrorContext& context, double seconds);

    // Its place and speed alone. Whether problems() may be other ones now.
    bool follow(Session& session, const MirrorContext& context, double seconds);
    // Whether its speed is the physics'.
    bool is_thrown() const { return handle_ != no_handle && values_.motion == Motion::Dynamic; }
    // What is touched, and where it stands; null where it is not in the session.
    const TouchShape* touch() const { return handle_ != no_handle ? addition_.touch.get() : nullptr; }
    Pose pose() const { return pose_of(place_); }
    // Its size about its own place, 0 where it is not in the session (unit: meters).
    double reach() const { return addition_.touch != nullptr ? addition_.touch->reach : 0.0; }
    std::uint32_t layers() const { return values_.layers.layer; }
    bool has_haptic_mesh() const { return !shapes_.touched.empty(); }

    // Another one whenever the session's body is to be described anew (see addition()).
    std::uint64_t revision() const { return revision_; }
    // The session's body as it is now: what one like it is made from.
    BodyAddition addition() const;

    // A twin of many triangles is built beside the loop; until it is ready the body is as it was before, or
    // absent.
    bool is_building() const { return job_ != nullptr; }
    // Hands over a twin that has become ready.
    void take_ready(Session& session, const MirrorContext& context);

    // `tick` is the tick of the snapshot that the state is from.
    void apply(const BodyState& state, std::uint64_t tick);

    // Takes the twin out and gives the body back to Godot's own physics.
    void release(Session& session);

    // Why it cannot be touched, or only in part; as it was found in the last synchronise().
    std::vector<std::string> problems() const;

private:
    // What is built, and what came of it. Shared with the thread that builds it.
    struct Job {
        BodyPlan plan;
        BuiltBody built;
        std::atomic<bool> done{false};
    };

    void plan(Session& session, const MirrorContext& context);
    void remove(Session& session);
    bool deform(Session& session, Job& job);
    void catch_up(Session& session, const BodyPlan& plan);
    bool needs_a_new_twin(godot::CollisionObject3D& body, bool shapes_changed);
    void listen(const MirrorContext& context);
    void send_values(Session& session, const MirrorContext& context);
    void send_motion(Session& session, double seconds, std::uint64_t takes_effect);
    void hold_still_in_godot(godot::CollisionObject3D& body) const;
    void remember_place(godot::CollisionObject3D& body);

    std::uint64_t id_;
    std::uint64_t watch_ = 0;  // id of the BodyWatch in it
    SessionHandle handle_ = no_handle;
    BodyAddition addition_;  // that the twin was made from
    std::uint64_t revision_ = 0;
    ShapeKey key_;
    std::uint64_t mesh_changes_ = 0;
    BodyMakings makings_;
    BodyMakings made_of_;  // the makings of the session's body
    BodyValues values_;
    BodyReading shapes_;        // as they were when the newest twin was planned
    std::shared_ptr<Job> job_;  // null: nothing is being built
    godot::Transform3D place_;  // of Godot's body, when we last saw or set it
    godot::Vector3 linear_velocity_;
    godot::Vector3 angular_velocity_;
    std::uint64_t shown_change_ = 0;  // BodyState::changed_at that Godot's side shows
    std::uint64_t shown_from_ = 0;    // earlier ticks do not know yet what was sent last
    bool tried_ = false;
    bool was_nowhere_ = false;  // when the newest twin was planned: there could be none
    std::vector<std::string> problems_;
    std::string place_problem_;  // of where it is now; the twin stays where it was
};

}  // namespace tactus
