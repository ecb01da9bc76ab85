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
    void synchronise(const godot::Node& root, Session& session, const MirrorContext& context, double seconds,
                     Complaints& complaints);
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
    void find(const godot::Node& root, Session& session, Complaints& complaints);
    void look_at_bodies(Session& session, const MirrorContext& context, double seconds,
                        Complaints& complaints);
    // Those that wait for their triangles get them.
    void take_ready(Session& session, const MirrorContext& context, Complaints& complaints);
    void look_at_joints(Session& session, Complaints& complaints);
    void look_at(BodyMirror& mirror, Session& session, const MirrorContext& context, double seconds,
                 Complaints& complaints);
    void look_at_motion(BodyMirror& mirror, Session& session, const MirrorContext& context, double seconds,
                        Complaints& complaints);
    void take_handle(BodyMirror& mirror, SessionHandle before);
    static void say_kind(const godot::Node& node, Complaints& complaints);
    static void say_problems(const BodyMirror& mirror, Complaints& complaints);

    bool in_turn_;
    std::shared_ptr<BodyNews> news_ = std::make_shared<BodyNews>();
    std::vector<std::unique_ptr<BodyMirror>> bodies_;
    std::vector<std::unique_ptr<JointMirror>> joints_;
    std::unordered_map<std::uint64_t, BodyMirror*> by_node_;
    std::vector<BodyMirror*> by_handle_;
    std::vector<BodyMirror*> building_;  // in the order in which they were planned
    std::vector<std::uint64_t> touched_;
    std::vector<std::uint64_t> others_;  // nodes that have come and are none of ours
    bool is_first_look_ = true;
    bool tree_changed_ = true;
    bool all_changed_ = true;
    bool handles_changed_ = false;
    std::uint64_t mesh_changes_ = 0;
    std::size_t next_body_ = 0;   // whose turn it is
    std::size_t next_rigid_ = 0;  // likewise, for its speed
    std::size_t next_joint_ = 0;
    std::vector<std::uint64_t> moved_, changed_;  // of this frame; members keep their memory
};

}  // namespace tactus
