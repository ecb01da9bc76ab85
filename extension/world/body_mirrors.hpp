// The bodies and joints of a scene and their twins in the session: who is there, who has to be looked at in
// this frame, and who is shown. Owner's thread only.
//
// In stepped time all are looked at whenever time is advanced, so that what a script has changed is there in
// the next tick. In real time a frame has no room for that: what moves and which resources change is told by
// the engine, what nobody tells (masses, layers, a shape taken away) is looked at in turn, the bodies that a
// hand touches in every frame.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "world/body_mirror.hpp"
#include "world/body_queries.hpp"
#include "world/joint_mirror.hpp"
#include "world/rotation.hpp"
#include "world/scene_facts.hpp"

namespace tactus {

// What the engine tells of bodies: their ids, each as often as it was told of.
struct BodyNews {
    std::vector<std::uint64_t> moved;
    std::vector<std::uint64_t> changed;  // it may be made of something else now
};

class BodyMirrors {
public:
    // `in_turn`: as real time has it; else all are looked at each time.
    BodyMirrors(std::size_t max_bodies, bool in_turn) : in_turn_(in_turn), by_handle_(max_bodies) {}

    // All that there are now. Who is new is made, whose mirror there is without a body goes.
    using MakeBody = std::function<std::unique_ptr<SceneBody>(std::uint64_t id)>;
    using MakeJoint = std::function<std::unique_ptr<SceneJoint>(std::uint64_t id)>;
    void match(const std::vector<std::uint64_t>& bodies, const MakeBody& make_body,
               const std::vector<std::uint64_t>& joints, const MakeJoint& make_joint, Session& session);

    // Who speaks of a body puts it here; it is shared with what outlives its body.
    const std::shared_ptr<BodyNews>& news() const { return news_; }
    // Look at them in the next frame.
    void note_all_changed() { all_changed_ = true; }
    // Bodies that a hand touches now.
    void touched(const std::vector<std::uint64_t>& bodies) { touched_ = bodies; }

    // Brings the session up to date.
    void synchronise(const MirrorContext& context);
    // Where the engine's own physics moves the bodies: it is about to step, and the session's snapshot is the
    // newest.
    void exchange(const PhysicsFrame& frame);
    // Of the bodies that have a local model now: the largest size about its place (unit: meters); 0: none
    // has.
    double widest_led() const;
    // `tick` is the tick of the snapshot that the state is from. May call a script.
    void show(const BodyState& state, std::uint64_t tick, Session& session);
    // Gives all back to the engine's own physics.
    void release(Session& session);

    const std::vector<std::unique_ptr<BodyMirror>>& bodies() const { return bodies_; }
    const std::vector<std::unique_ptr<JointMirror>>& joints() const { return joints_; }
    const BodyMirror* of(std::uint64_t body) const;  // null: there is none; likewise below
    SessionHandle body_of(std::uint64_t node) const;
    std::uint64_t node_of(SessionHandle body) const;
    SceneFacts facts() const;
    // What can be touched, of these layers; `index` is that in bodies().
    std::vector<QueriedBody> touchable(std::uint32_t mask) const;
    // Those that are being built, and those that came with one that is new.
    std::size_t building() const { return building_.size(); }
    std::size_t in_session() const;     // that can be touched
    std::size_t without_place() const;  // that a world of more bodies would have taken
    // Of a body that gives, and is free to fall: what it would fall through, since its shape bears none;
    // empty where there is nothing like that.
    std::vector<std::pair<SceneBody*, std::string>> fallen_through() const;
    std::vector<std::string> problems() const;  // each names its node

private:
    void look_at_bodies(const MirrorContext& context);
    void look_at_joints(const MirrorContext& context);
    void narrow(const MirrorContext& context, const std::vector<BodyMirror*>& built);
    void find_carried(const std::vector<std::uint64_t>& bodies);
    void find_close(const PhysicsFrame& frame);
    bool has_to_wait(const BodyMirror& mirror) const;
    template <class Change>
    void change(BodyMirror& mirror, const Change& change);
    void take_handle(BodyMirror& mirror, SessionHandle before);

    bool in_turn_;
    std::shared_ptr<BodyNews> news_ = std::make_shared<BodyNews>();
    std::vector<std::unique_ptr<BodyMirror>> bodies_;
    std::vector<std::unique_ptr<JointMirror>> joints_;
    std::unordered_map<std::uint64_t, BodyMirror*> by_body_;
    // By the session's handle, with the change (BodyState::changed_at) that is shown: a body at rest costs no
    // look at anything else.
    struct Shown {
        BodyMirror* mirror = nullptr;
        std::uint64_t change = 0;
        bool moves = false;
        bool carries = false;  // see carried_
    };
    std::vector<Shown> by_handle_;
    std::vector<BodyMirror*> thrown_;  // of them all, those that can be
    // Those that are close to a hand, where the engine's own physics moves them, by their ids; of these, the
    // ones that came since the last synchronise().
    std::vector<BodyMirror*> close_, arrived_;
    // By the body that takes them along in the scene: those that can be thrown and stand below it, parents
    // first.
    std::unordered_map<std::uint64_t, std::vector<BodyMirror*>> carried_;
    std::uint64_t arrivals_ = 0;
    std::vector<BodyMirror*> building_;  // in the order in which they were planned
    std::vector<BodyMirror*> narrowing_;
    NarrowedTrees narrowed_trees_;
    double touch_radius_ = 0.0;  // as of the last time
    std::vector<std::uint64_t> touched_;
    bool all_changed_ = true;
    bool handles_changed_ = false;
    std::uint64_t mesh_changes_ = 0;
    Rotation body_turns_, speed_turns_, joint_turns_;
    std::vector<std::uint64_t> moved_, changed_;  // of this frame; members keep their memory
};

}  // namespace tactus
