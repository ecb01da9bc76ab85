#include "nodes/body_mirrors.hpp"

#include <algorithm>
#include <unordered_set>

#include "nodes/conversions.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

// Of all the bodies: no more than cost a tenth of a millisecond, in a large scene.
constexpr Turns looks{.frames_a_round = 96, .min = 4, .max = 32};

// Speeds are cheaper to ask for, and a throw should not wait.
constexpr Turns looks_at_speeds{.frames_a_round = 16, .min = 12, .max = 256};

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
    return handle < by_handle_.size() ? by_handle_[handle].mirror : nullptr;
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

void BodyMirrors::find(const Node& root, const MirrorContext& context) {
    std::vector<CollisionObject3D*> bodies;
    std::vector<Joint3D*> joints;
    for_each_below(root, [&](Node& node) {
        if (is_solid_body(&node)) {
            bodies.push_back(Object::cast_to<CollisionObject3D>(&node));
        } else if (auto* joint = Object::cast_to<Joint3D>(&node)) {
            joints.push_back(joint);
        } else if (is_first_look_) {
            context.complaints.say(node, problem_of_kind(node));
        }
    });
    is_first_look_ = false;
    match(joints_, joints, context.session);
    match(bodies_, bodies, context.session);
    by_node_.clear();
    building_.clear();
    rigid_.clear();
    std::ranges::fill(by_handle_, Shown{});
    for (const auto& mirror : bodies_) {
        by_node_[mirror->id()] = mirror.get();
        if (mirror->can_be_thrown()) {
            rigid_.push_back(mirror.get());
        }
        take_handle(*mirror, no_handle);
    }
    handles_changed_ = true;
}

void BodyMirrors::take_handle(BodyMirror& mirror, SessionHandle before) {
    if (mirror.handle() != before) {
        handles_changed_ = true;
        if (before != no_handle && by_handle_[before].mirror == &mirror) {
            by_handle_[before] = {};
        }
        if (mirror.handle() != no_handle) {
            by_handle_[mirror.handle()] = {&mirror, mirror.twin().shown_change(), mirror.moves()};
        }
    }
    std::erase(building_, &mirror);
    if (mirror.twin().is_building()) {
        building_.push_back(&mirror);
    }
}

// Whoever changes a mirror may have given it another handle.
template <class Change>
void BodyMirrors::change(BodyMirror& mirror, const Change& change) {
    const SessionHandle before = mirror.handle();
    change(mirror);
    take_handle(mirror, before);
}

void BodyMirrors::look_at_bodies(const MirrorContext& context) {
    moved_.clear();
    changed_.clear();
    std::swap(moved_, news_->moved);
    std::swap(changed_, news_->changed);
    const bool meshes_changed = std::exchange(mesh_changes_, HapticMesh::changes()) != HapticMesh::changes();
    const auto look_at = [&](BodyMirror& mirror, bool shapes_changed = false) {
        change(mirror, [&](BodyMirror& one) { one.synchronise(context, shapes_changed); });
    };
    const auto each = [this](const std::vector<std::uint64_t>& ids, const auto& look) {
        for (const std::uint64_t id : ids) {
            if (BodyMirror* mirror = of(id)) {
                look(*mirror);
            }
        }
    };
    if (!in_turn_ || std::exchange(all_changed_, false)) {
        for (const auto& mirror : bodies_) {
            look_at(*mirror, !changed_.empty());
        }
        return;
    }
    each(changed_, [&](BodyMirror& mirror) { look_at(mirror, true); });
    each(moved_, [&](BodyMirror& mirror) { mirror.follow(context); });
    for (const auto& mirror : bodies_) {
        if (meshes_changed && mirror->has_haptic_mesh()) {
            look_at(*mirror);
        }
    }
    each(touched_, look_at);
    body_turns_.take(looks, bodies_, [&](const auto& mirror) { look_at(*mirror); });
    speed_turns_.take(looks_at_speeds, rigid_, [&](BodyMirror* mirror) { mirror->follow_speed(context); });
}

void BodyMirrors::look_at_joints(const MirrorContext& context) {
    const FindMirror mirror_of = [this](const Node* node) {
        return node != nullptr ? of(node->get_instance_id()) : nullptr;
    };
    const auto look_at = [&](const std::unique_ptr<JointMirror>& joint) {
        joint->synchronise(context.session, mirror_of);
        if (joint->node() != nullptr) {
            context.complaints.say(*joint->node(), joint->problem());
        }
    };
    if (std::exchange(handles_changed_, false) || !in_turn_) {
        std::ranges::for_each(joints_, look_at);
    } else {
        joint_turns_.take(looks, joints_, look_at);
    }
}

void BodyMirrors::synchronise(const Node& root, MirrorContext context) {
    context.news = news_;
    for (const std::uint64_t id : std::exchange(others_, {})) {
        auto* other = Object::cast_to<Node>(ObjectDB::get_instance(id));
        if (other != nullptr && root.is_ancestor_of(other)) {
            context.complaints.say(*other, problem_of_kind(*other));
        }
    }
    if (std::exchange(tree_changed_, false)) {
        find(root, context);
    }
    look_at_bodies(context);
    // Stepped time waits, so that every run has the same bodies in the same ticks.
    if (!in_turn_ && !building_.empty()) {
        context.workers.wait();
    }
    for (BodyMirror* mirror : std::vector(building_)) {
        change(*mirror, [&](BodyMirror& one) { one.take_ready(context); });
    }
    look_at_joints(context);
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
    BodyMirror* const mirror = of_handle(state.handle);
    if (mirror == nullptr) {
        return;
    }
    Shown& shown = by_handle_[state.handle];
    bool is_elsewhere = false;
    if (shown.change != state.changed_at) {
        const BodyMirror::Applied applied = mirror->apply(state, tick);
        is_elsewhere = applied == BodyMirror::Applied::elsewhere;
        if (applied == BodyMirror::Applied::yes) {
            shown = {mirror, state.changed_at, true};
        }
    } else if (std::exchange(shown.moves, false)) {
        is_elsewhere = mirror->come_to_rest();
    }
    if (is_elsewhere) {
        news_->moved.push_back(mirror->id());
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
