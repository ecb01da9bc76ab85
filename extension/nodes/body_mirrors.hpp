// The bodies and joints of a scene and their twins in the session: who is there, who has to be looked at in
// this frame, and who is shown. Main thread only.
//
// In stepped time all are looked at whenever time is advanced, so that what a script has changed is there in
// the next tick. In real time a frame has no room for that: what moves and which resources change is told by
// Godot (body_watch.hpp), what nobody tells (masses, layers, a shape taken away) is looked at in turn, the
// bodies that a hand touches in every frame.
#pragma once

#include <godot_cpp/classes/joint3d.hpp>
#include <memory>
#include <unordered_map>
#include <vector>

#include "nodes/body_mirror.hpp"
#include "nodes/body_watch.hpp"
#include "nodes/joint_mirror.hpp"
#include "nodes/messages.hpp"
#include "nodes/scene_view.hpp"
#include "world/body_queries.hpp"
#include "world/rotation.hpp"
#include "world/scene_facts.hpp"

namespace tactus {

class BodyMirrors final : public SceneView {
public:
    // `in_turn`: as real time has it; else all are looked at each time.
    BodyMirrors(std::size_t max_bodies, bool in_turn);

    void scene_changed(const godot::Node& node) override;
    SessionHandle body_of(std::uint64_t node) const override;
    std::uint64_t node_of(SessionHandle body) const override;
    std::size_t body_count() const override { return bodies_.size(); }
    void show(const BodyState& state, std::uint64_t tick) override;
    void release(Session& session) override;
    // Look at it in the next frame: it may be made of something else now.
    void note_change(std::uint64_t body) { news_->changed.push_back(body); }
    void note_all_changed() { all_changed_ = true; }

    // Brings the session up to date with all that stands below `root`.
    void synchronise(const godot::Node& root, MirrorContext context);
    // Bodies that a hand touches now.
    void touched(const std::vector<std::uint64_t>& bodies) { touched_ = bodies; }

    const std::vector<std::unique_ptr<BodyMirror>>& bodies() const { return bodies_; }
    const std::vector<std::unique_ptr<JointMirror>>& joints() const { return joints_; }
    BodyMirror* of(std::uint64_t node) const;
    BodyMirror* of_handle(SessionHandle handle) const;
    SceneFacts facts() const;
    // What can be touched, of these layers; `index` is that in bodies().
    std::vector<QueriedBody> touchable(std::uint32_t mask) const;
    std::size_t building() const { return building_.size(); }

private:
    template <class Mirror, class NodeType>
    void match(std::vector<std::unique_ptr<Mirror>>& mirrors, const std::vector<NodeType*>& found,
               Session& session);
    void find(const godot::Node& root, const MirrorContext& context);
    void look_at_bodies(const MirrorContext& context);
    void look_at_joints(const MirrorContext& context);
    template <class Change>
    void change(BodyMirror& mirror, const Change& change);
    void take_handle(BodyMirror& mirror, SessionHandle before);

    bool in_turn_;
    std::shared_ptr<BodyNews> news_ = std::make_shared<BodyNews>();
    std::vector<std::unique_ptr<BodyMirror>> bodies_;
    std::vector<std::unique_ptr<JointMirror>> joints_;
    std::unordered_map<std::uint64_t, BodyMirror*> by_node_;
    // By the session's handle, with the change (BodyState::changed_at) that is shown: a body at rest costs no
    // look at anything else.
    struct Shown {
        BodyMirror* mirror = nullptr;
        std::uint64_t change = 0;
        bool moves = false;
    };
    std::vector<Shown> by_handle_;
    std::vector<BodyMirror*> rigid_;     // of them all, those that can be thrown
    std::vector<BodyMirror*> building_;  // in the order in which they were planned
    std::vector<std::uint64_t> touched_;
    std::vector<std::uint64_t> others_;  // nodes that have come and are none of ours
    bool is_first_look_ = true;
    bool tree_changed_ = true;
    bool all_changed_ = true;
    bool handles_changed_ = false;
    std::uint64_t mesh_changes_ = 0;
    Rotation body_turns_, speed_turns_, joint_turns_;
    std::vector<std::uint64_t> moved_, changed_;  // of this frame; members keep their memory
};

}  // namespace tactus
