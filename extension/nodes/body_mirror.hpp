// One Godot body and its twin in the session: what changes on Godot's side is passed on, and what the session
// moves is shown on Godot's side. Main thread only.
#pragma once

#include <godot_cpp/classes/collision_object3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/variant/utility_functions.hpp>
#include <memory>
#include <string>
#include <vector>

#include "nodes/body_reading.hpp"
#include "nodes/body_watch.hpp"
#include "nodes/conversions.hpp"
#include "world/body_twin.hpp"

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
    explicit BodyMirror(godot::CollisionObject3D& body);

    std::uint64_t id() const { return id_; }
    SessionHandle handle() const { return twin_.handle(); }
    const BodyTwin& twin() const { return twin_; }
    godot::CollisionObject3D* body() const { return is_there() ? body_ : nullptr; }  // null: it is gone

    // Brings the session up to date. What moved on Godot's side since the last call took `seconds` for it.
    void synchronise(Session& session, const MirrorContext& context, double seconds);

    // Its place and speed alone. Whether problems() may be other ones now.
    bool follow(Session& session, const MirrorContext& context, double seconds);
    // Its speed alone, which Godot tells nobody of.
    void follow_speed(Session& session, const MirrorContext& context);
    bool can_be_thrown() const { return rigid_ != nullptr; }
    bool has_haptic_mesh() const { return !twin_.planned().form.touched.empty(); }

    // Hands over a twin that has become ready.
    void take_ready(Session& session, const MirrorContext& context);

    // `tick` is the tick of the snapshot that the state is from.
    enum class Applied {
        no,         // it is shown already, or made without what was sent last
        yes,        // until come_to_rest(), Godot tells of its place no more
        elsewhere,  // no: a script has given the node a place or speed meanwhile: follow() that first
    };
    Applied apply(const BodyState& state, std::uint64_t tick);
    // It is shown as it is for another frame. Whether a script has given the node a place or speed meanwhile.
    bool come_to_rest();

    // Takes the twin out and gives the body back to Godot's own physics.
    void release(Session& session);

    // Why it cannot be touched, or only in part; as it was found in the last synchronise().
    std::vector<std::string> problems() const;

private:
    void plan(Session& session, const MirrorContext& context);
    bool needs_a_new_twin(godot::CollisionObject3D& body, const godot::Transform3D& place,
                          bool shapes_changed);
    void listen(godot::CollisionObject3D& node, const godot::Ref<godot::PhysicsMaterial>& material,
                const MirrorContext& context);
    void send_place(const godot::Transform3D& place, Session& session, double seconds,
                    std::uint64_t takes_effect);
    void send_speed(Session& session, std::uint64_t takes_effect);
    bool is_there() const { return godot::UtilityFunctions::is_instance_id_valid(static_cast<int64_t>(id_)); }
    // Than when the node was seen or set last; while it is there, and rigid.
    bool has_other_speed() const;
    bool has_other_place() const { return !(rigid_->get_global_transform() == place_); }
    void hold_still_in_godot(godot::CollisionObject3D& body) const;
    void remember_place(godot::CollisionObject3D& body);
    BodyPlace remembered() const;

    // What a body that moves needs in every frame stands together, with the beginning of the twin.
    std::uint64_t id_;
    godot::CollisionObject3D* body_;  // while it is there
    godot::RigidBody3D* rigid_;       // the same; null where it is none
    godot::Transform3D place_;        // of Godot's body, when it was seen or set last
    godot::Vector3 linear_velocity_;
    godot::Vector3 angular_velocity_;
    std::string place_problem_;  // of where it is now; the twin stays where it was
    ShapeKey key_;
    BodyTwin twin_;
    std::uint64_t watch_ = 0;     // id of the BodyWatch in it
    std::uint64_t material_ = 0;  // id of the PhysicsMaterial that it listens to; 0: none
    std::uint64_t mesh_changes_ = 0;
    bool moves_ = false;  // as shown last
    bool tried_ = false;
    bool was_nowhere_ = false;  // when the newest twin was planned: there could be none
};

}  // namespace tactus
