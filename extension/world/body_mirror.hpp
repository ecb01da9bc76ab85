// One body of a scene and its twin in the session: what changes in the scene is passed on, and what the
// session moves is shown in the scene. Owner's thread only.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "world/body_twin.hpp"
#include "world/led_motion.hpp"
#include "world/scene_body.hpp"

namespace tactus {

// What all mirrors of a world share in one synchronise().
struct MirrorContext {
    Session& session;
    Workers& workers;  // for bodies of many triangles
    BodyDefaults defaults;
    double seconds = 0.0;            // what moved in the scene since the last time took so long for it
    std::uint64_t takes_effect = 0;  // the first tick that has certainly taken what is sent now
    bool ticks = true;               // false: none is made yet; what moved since the last time is put there
    bool together = false;           // what came at once waits for what of it is still being built
    std::uint64_t mesh_changes = 0;  // another one when the mesh that a body is touched by may be
    double touch_radius = 0.0;       // the smallest of a fingertip (unit: meters); 0: there is none
    bool engine_moves = false;       // the engine's own physics moves its bodies, see BodyMirror::exchange
};

// One frame of the engine's own physics, which is about to step.
struct PhysicsFrame {
    Session& session;
    std::span<const Vec3> hands;           // where they are (unit: meters)
    std::span<const std::uint64_t> close;  // ids of the bodies that are close to one of them
    double seconds = 0.0;                  // of a frame, > 0
    double tick = 0.0;                     // seconds of one of the session's ticks, > 0
    bool keeps_time = true;  // false: the engine's time goes at another rate than the session's, or stands
};

class BodyMirror {
public:
    // `arrival`: the same for all that came at once.
    explicit BodyMirror(std::unique_ptr<SceneBody> body, std::uint64_t arrival = 0)
        : body_(std::move(body)), id_(body_->id()), arrival_(arrival) {}

    std::uint64_t id() const { return id_; }
    std::uint64_t arrival() const { return arrival_; }
    // It has never been in the session.
    bool is_awaited() const { return handle() == no_handle && twin_.is_building(); }
    SessionHandle handle() const { return twin_.handle(); }
    const BodyTwin& twin() const { return twin_; }
    SceneBody* body() const { return body_->is_there() ? body_.get() : nullptr; }  // null: it is gone

    // Brings the session up to date, and says what is wrong. `shapes_changed`: what the body is made of says
    // that it has changed since the last time.
    void synchronise(const MirrorContext& context, bool shapes_changed);
    // Its place and speed alone.
    void follow(const MirrorContext& context);
    // Its speed alone, which engines tell nobody of.
    void follow_speed(const MirrorContext& context);
    bool can_be_thrown() const { return body_->can_be_thrown(); }
    bool moves() const { return moves_; }
    bool has_touched_mesh() const { return !twin_.planned().form.touched.empty(); }

    // Hands over a twin that has become ready, and says what is wrong with it.
    void take_ready(const MirrorContext& context);

    // What fingertips cannot touch of it is found out meanwhile, and then left out (see BodyTwin).
    void narrow(const MirrorContext& context, NarrowedTrees& trees) {
        twin_.narrow(context.touch_radius, trees);
    }
    void take_narrowed(const MirrorContext& context) { twin_.take_narrowed(context.session); }

    // `tick` is the tick of the snapshot that the state is from. What a script has written of it meanwhile is
    // sent first. False: it is shown already, or cannot be; true: until come_to_rest(), the scene tells of
    // its place no more.
    bool apply(const BodyState& state, std::uint64_t tick, Session& session);
    // It is shown as it is for another frame. Whether a script has given it a place or speed meanwhile.
    bool come_to_rest();

    // Where the engine's own physics moves it. Far from every hand it is on no layer, and is not read at all:
    // it may be anywhere by now.
    bool is_far() const { return may_be_far_ && !is_close(); }
    bool may_be_far() const { return may_be_far_; }
    bool is_close() const { return frames_close_ > 0; }
    bool is_led() const { return is_near_; }
    // It is close to a hand in this frame, and counts as close for some more.
    void come_close(Session& session);
    // Another frame. False: it is far by now.
    bool stays_close(const PhysicsFrame& frame);
    // Close to a hand it goes where the engine has it. Near one, it is felt as a local model that is put
    // right by each frame, and what hands give that goes to the engine's body; not where `may_be_led` is
    // false. Whether it has a local model from now on.
    bool exchange(const PhysicsFrame& frame, bool may_be_led);

    // As the scene has it now, where it is far; else as it was seen last.
    Pose pose() const;
    // Of the scene's body, as it was seen last.
    const CollisionLayers& layers() const { return layers_; }

    // The id of the nearest body above it that can be thrown; 0: none.
    std::uint64_t carrier() const { return body_->is_there() ? body_->carrier() : 0; }
    // Where the scene has it, while what carries it is moved to where physics has that: nothing of that is a
    // script's, and a body that moves by itself stays where it is. stay() puts it back.
    struct Staying {
        SceneFrame frame;
        bool stays = false;
    };
    Staying hold_on() const;
    void stay(const Staying& staying);

    // Takes the twin out and gives the body back to the engine's own physics.
    void release(Session& session);

    // Why it cannot be touched, or only in part; as it was found in the last synchronise().
    std::vector<std::string> problems() const;

private:
    void plan(const MirrorContext& context);
    void hand_over(const MirrorContext& context);
    void say_problems() const;
    bool needs_a_new_twin(const SceneFrame& frame, bool shapes_changed, std::uint64_t mesh_changes);
    void send(const SceneFrame& frame, Session& session, double seconds);
    BodyValues values(const MirrorContext& context);
    void go_along(const SceneFrame& frame, const MirrorContext& context);
    void exchange_led(const PhysicsFrame& frame);
    void come_near(Session& session, double seconds, bool is_near);
    void send_place(const SceneFrame& frame, Session& session, double seconds, bool is_thrown);
    bool has_other_speed(const SceneSpeed& speed) const;
    bool is_elsewhere() const;
    void remember();
    BodyPlace remembered() const;

    // What a body that moves needs in every frame stands together, with the beginning of the twin.
    std::unique_ptr<SceneBody> body_;
    std::uint64_t id_;
    std::uint64_t arrival_;
    SceneFrame frame_;           // of the scene's body, when it was seen or set last
    SceneSpeed speed_;           // likewise
    SceneSpeed shown_;           // that the scene's body was given last; `speed_` is what it kept of it
    bool moves_ = false;         // as shown last
    std::string place_problem_;  // of where it is now; the twin stays where it was
    ShapeKey key_;               // as it was read
    Mat3 seen_{1.0};             // the scaling, as it was seen last
    BodyTwin twin_;
    std::uint64_t mesh_changes_ = 0;
    bool tried_ = false;
    bool is_moved_by_engine_ = false;  // it is dynamic, and the engine's own physics moves it
    bool may_be_far_ = false;          // it is not still, and the engine's own physics moves the bodies
    int frames_close_ = 0;             // so many more it counts as close to a hand
    CollisionLayers layers_;
    bool is_near_ = false;      // a hand, in the last frame
    LedMotion led_;             // while it is
    bool was_nowhere_ = false;  // when the newest twin was planned: there could be none
};

}  // namespace tactus
