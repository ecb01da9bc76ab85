#include "nodes/body_mirrors.hpp"

#include <algorithm>
#include <unordered_set>

#include "nodes/conversions.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/scene_warnings.hpp"

namespace tactus {

using namespace godot;

namespace {

// Bodies that are looked at in a frame whatever was told: as many as cost a few hundredths of a millisecond,
// and in a large scene so many that each has its turn within about a second.
constexpr std::size_t min_turns = 12;
constexpr std::size_t frames_a_round = 96;

// Speeds are cheaper to ask for, and a throw should not wait.
constexpr std::size_t frames_a_round_of_speeds = 16;

std::size_t turns(std::size_t count, std::size_t frames) {
    return std::min(count, std::max(min_turns, count / frames));
}

void collect(const Node& node, std::vector<CollisionObject3D*>& bodies, std::vector<Joint3D*>& joints,
             std::vector<Node*>& others) {
    const int count = node.get_child_count();
    for (int i = 0; i < count; ++i) {
        Node* child = node.get_child(i);
        if (is_solid_body(child)) {
            bodies.push_back(Object::cast_to<CollisionObject3D>(child));
        } else if (auto* joint = Object::cast_to<Joint3D>(child)) {
            joints.push_back(joint);
        } else {
            others.push_back(child);
        }
        collect(*child, bodies, joints, others);
    }
}

}  // namespace

BodyMirrors::BodyMirrors(std::size_t max_bodies, bool in_turn) : in_turn_(in_turn), by_handle_(max_bodies) {}

// A shape or mesh that comes or goes changes the body above it.
void BodyMirrors::scene_changed(const Node& node) {
    const bool is_mirrored = is_solid_body(&node) || Object::cast_to<Joint3D>(&node) != nullptr;
    tree_changed_ |= is_mirrored;
    if (!is_mirrored) {
        others_.push_back(node.get_instance_id());
    }
    if (const Node* parent = node.get_parent(); parent != nullptr && is_solid_body(parent)) {
        note_change(parent->get_instance_id());
    }
}

BodyMirror* BodyMirrors::of(std::uint64_t node) const {
    const auto found = by_node_.find(node);
    return found != by_node_.end() ? found->second : nullptr;
}

BodyMirror* BodyMirrors::of_handle(SessionHandle handle) const {
    return handle < by_handle_.size() ? by_handle_[handle] : nullptr;
}

// Mirrors of what has come; those of what has gone are let go.
template <class Mirror, class NodeType>
void BodyMirrors::match(std::vector<std::unique_ptr<Mirror>>& mirrors, const std::vector<NodeType*>& found,
                        Session& session) {
    std::unordered_set<std::uint64_t> there;
    for (const NodeType* node : found) {
        there.insert(node->get_instance_id());
    }
    std::erase_if(mirrors, [&](const auto& mirror) {
        const bool gone = !there.contains(mirror->id());
        if (gone) {
            mirror->release(session);
        }
        return gone;
    });
    for (const auto& mirror : mirrors) {
        there.erase(mirror->id());
    }
    for (NodeType* node : found) {
        if (there.contains(node->get_instance_id())) {
            mirrors.push_back(std::make_unique<Mirror>(*node));
            if constexpr (std::is_same_v<Mirror, BodyMirror>) {
                note_change(node->get_instance_id());
            }
        }
    }
}

void BodyMirrors::find(const Node& root, Session& session, Complaints& complaints) {
    std::vector<CollisionObject3D*> bodies;
    std::vector<Joint3D*> joints;
    std::vector<Node*> others;
    collect(root, bodies, joints, others);
    for (const Node* other : std::exchange(is_first_look_, false) ? others : std::vector<Node*>()) {
        say_kind(*other, complaints);
    }
    match(joints_, joints, session);
    match(bodies_, bodies, session);
    by_node_.clear();
    building_.clear();
    std::ranges::fill(by_handle_, nullptr);
    for (const auto& mirror : bodies_) {
        by_node_[mirror->id()] = mirror.get();
        take_handle(*mirror, no_handle);
    }
    handles_changed_ = true;
}

void BodyMirrors::say_kind(const Node& node, Complaints& complaints) {
    if (const String problem = problem_of_kind(node); !problem.is_empty()) {
        complaints.say(node, problem);
    }
}

void BodyMirrors::take_handle(BodyMirror& mirror, SessionHandle before) {
    if (mirror.handle() != before) {
        handles_changed_ = true;
        if (before != no_handle && by_handle_[before] == &mirror) {
            by_handle_[before] = nullptr;
        }
        if (mirror.handle() != no_handle) {
            by_handle_[mirror.handle()] = &mirror;
        }
    }
    std::erase(building_, &mirror);
    if (mirror.twin().is_building()) {
        building_.push_back(&mirror);
    }
}

void BodyMirrors::say_problems(const BodyMirror& mirror, Complaints& complaints) {
    const CollisionObject3D* body = mirror.body();
    if (body == nullptr) {
        return;
    }
    for (const std::string& problem : mirror.problems()) {
        complaints.say(*body, to_godot(problem));
    }
}

void BodyMirrors::look_at(BodyMirror& mirror, Session& session, const MirrorContext& context, double seconds,
                          Complaints& complaints) {
    const SessionHandle before = mirror.handle();
    mirror.synchronise(session, context, seconds);
    take_handle(mirror, before);
    say_problems(mirror, complaints);
}

void BodyMirrors::look_at_motion(BodyMirror& mirror, Session& session, const MirrorContext& context,
                                 double seconds, Complaints& complaints) {
    if (mirror.follow(session, context, seconds)) {
        say_problems(mirror, complaints);
    }
}

void BodyMirrors::look_at_bodies(Session& session, const MirrorContext& context, double seconds,
                                 Complaints& complaints) {
    moved_.clear();
    changed_.clear();
    std::swap(moved_, news_->moved);
    std::swap(changed_, news_->changed);
    const bool meshes_changed = std::exchange(mesh_changes_, HapticMesh::changes()) != HapticMesh::changes();
    if (!in_turn_ || std::exchange(all_changed_, false)) {
        MirrorContext whole = context;
        whole.shapes_changed = whole.shapes_changed || !changed_.empty();
        for (const auto& mirror : bodies_) {
            look_at(*mirror, session, whole, seconds, complaints);
        }
        return;
    }
    MirrorContext changed = context;
    changed.shapes_changed = true;
    for (const std::uint64_t id : changed_) {
        if (BodyMirror* mirror = of(id)) {
            look_at(*mirror, session, changed, seconds, complaints);
        }
    }
    for (const std::uint64_t id : moved_) {
        if (BodyMirror* mirror = of(id)) {
            look_at_motion(*mirror, session, context, seconds, complaints);
        }
    }
    for (const auto& mirror : bodies_) {
        if (meshes_changed && mirror->has_haptic_mesh()) {
            look_at(*mirror, session, context, seconds, complaints);
        }
    }
    for (const std::uint64_t id : touched_) {
        if (BodyMirror* mirror = of(id)) {
            look_at(*mirror, session, context, seconds, complaints);
        }
    }
    for (std::size_t i = turns(bodies_.size(), frames_a_round); i > 0; --i) {
        next_body_ = next_body_ + 1 < bodies_.size() ? next_body_ + 1 : 0;
        look_at(*bodies_[next_body_], session, context, seconds, complaints);
    }
    for (std::size_t i = turns(bodies_.size(), frames_a_round_of_speeds); i > 0; --i) {
        next_rigid_ = next_rigid_ + 1 < bodies_.size() ? next_rigid_ + 1 : 0;
        if (bodies_[next_rigid_]->is_thrown()) {
            bodies_[next_rigid_]->follow_speed(session, context);
        }
    }
}

void BodyMirrors::look_at_joints(Session& session, Complaints& complaints) {
    const FindMirror mirror_of = [this](const Node* node) {
        return node != nullptr ? of(node->get_instance_id()) : nullptr;
    };
    const bool all = std::exchange(handles_changed_, false) || !in_turn_;
    for (std::size_t i = all ? joints_.size() : turns(joints_.size(), frames_a_round); i > 0; --i) {
        next_joint_ = next_joint_ + 1 < joints_.size() ? next_joint_ + 1 : 0;
        JointMirror& joint = *joints_[next_joint_];
        joint.synchronise(session, mirror_of);
        if (joint.node() != nullptr && !joint.problem().empty()) {
            complaints.say(*joint.node(), to_godot(joint.problem()));
        }
    }
}

void BodyMirrors::synchronise(const Node& root, Session& session, const MirrorContext& context,
                              double seconds, Complaints& complaints) {
    MirrorContext with_news = context;
    with_news.news = news_;
    for (const std::uint64_t id : std::exchange(others_, {})) {
        auto* other = Object::cast_to<Node>(ObjectDB::get_instance(id));
        if (other != nullptr && root.is_ancestor_of(other)) {
            say_kind(*other, complaints);
        }
    }
    if (std::exchange(tree_changed_, false)) {
        find(root, session, complaints);
    }
    look_at_bodies(session, with_news, seconds, complaints);
    // Stepped time waits, so that every run has the same bodies in the same ticks.
    if (!in_turn_ && !building_.empty()) {
        context.workers->wait();
    }
    take_ready(session, with_news, complaints);
    look_at_joints(session, complaints);
}

void BodyMirrors::take_ready(Session& session, const MirrorContext& context, Complaints& complaints) {
    for (BodyMirror* mirror : std::vector(building_)) {
        const SessionHandle before = mirror->handle();
        mirror->take_ready(session, context);
        take_handle(*mirror, before);
        say_problems(*mirror, complaints);
    }
}

SessionHandle BodyMirrors::body_of(std::uint64_t node) const {
    const BodyMirror* mirror = of(node);
    return mirror != nullptr ? mirror->handle() : no_handle;
}

std::uint64_t BodyMirrors::node_of(SessionHandle body) const {
    const BodyMirror* mirror = of_handle(body);
    return mirror != nullptr ? mirror->id() : 0;
}

void BodyMirrors::show(const BodyState& state, std::uint64_t tick) {
    if (BodyMirror* mirror = of_handle(state.handle)) {
        mirror->apply(state, tick);
    }
}

SceneFacts BodyMirrors::facts() const {
    SceneFacts facts;
    for (const auto& mirror : bodies_) {
        if (mirror->handle() != no_handle) {
            facts.add(mirror->twin().values().layers.layer, mirror->twin().reach());
        }
    }
    return facts;
}

std::vector<QueriedBody> BodyMirrors::touchable(std::uint32_t mask) const {
    std::vector<QueriedBody> touchable;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const BodyTwin& twin = bodies_[i]->twin();
        if (twin.touch() != nullptr && (twin.values().layers.layer & mask) != 0) {
            touchable.push_back({twin.touch(), twin.pose(), i});
        }
    }
    return touchable;
}

void BodyMirrors::release(Session& session) {
    for (const auto& mirror : bodies_) {
        mirror->release(session);
    }
}

}  // namespace tactus
