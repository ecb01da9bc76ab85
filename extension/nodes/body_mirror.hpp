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
#include "nodes/messages.hpp"
#include "world/body_twin.hpp"

namespace tactus {

// What all mirrors of a world share in one synchronise().
struct MirrorContext {
    Session& session;
    Complaints& complaints;
    Workers& workers;  // for bodies of many triangles
    BodyDefaults defaults;
    double seconds = 0.0;            // what moved on Godot's side since the last time took so long for it
    std::uint64_t takes_effect = 0;  // the first tick that has certainly taken what is sent now
    std::shared_ptr<BodyNews> news;  // where what Godot tells of the bodies goes
};

class BodyMirror {
public:
    explicit BodyMirror(godot::CollisionObject3D& body);

    std::uint64_t id() const { return id_; }
    SessionHandle handle() const { return twin_.handle(); }
    const BodyTwin& twin() const { return twin_; }
    godot::CollisionObject3D* body() const { return is_there() ? body_ : nullptr; }  // null: it is gone

    // Brings the session up to date, and says what is wrong. `shapes_changed`: a resource of the body has
    // changed since the last time.
    void synchronise(const MirrorContext& context, bool shapes_changed);
    // Its place and speed alone.
    void follow(const MirrorContext& context);
    // Its speed alone, which Godot tells nobody of.
    void follow_speed(const MirrorContext& context);
    bool can_be_thrown() const { return rigid_ != nullptr; }
    bool moves() const { return moves_; }
    bool has_haptic_mesh() const { return !twin_.planned().form.touched.empty(); }

    // Hands over a twin that has become ready, and says what is wrong with it.
    void take_ready(const MirrorContext& context);

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
    void plan(const MirrorContext& context);
    void hand_over(const MirrorContext& context);
    void say_problems(Complaints& complaints) const;
    bool needs_a_new_twin(godot::CollisionObject3D& body, const godot::Transform3D& place,
                          bool shapes_changed);
    void listen(godot::CollisionObject3D& node, const godot::Ref<godot::PhysicsMaterial>& material,
                const MirrorContext& context);
    void send_place(const godot::Transform3D& place, const MirrorContext& context);
    void send_speed(const MirrorContext& context);
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
