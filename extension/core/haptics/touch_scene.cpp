#include "core/haptics/touch_scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace tactus {

namespace {

// No point within `reach` of the origin moves farther than this between the two poses.
double farthest_motion(const Pose& from, const Pose& to, double reach) {
    const Quat turn = to.rotation * glm::conjugate(from.rotation);
    // |sin(angle / 2)| is the length of the vector part; a chord is 2 reach sin(angle / 2).
    const double half_sine = glm::length(Vec3(turn.x, turn.y, turn.z));
    return glm::length(to.position - from.position) + (half_sine > 0.0 ? 2.0 * reach * half_sine : 0.0);
}

bool same_pose(const Pose& p, const Pose& q) {
    return p.position == q.position && p.rotation == q.rotation;
}

}  // namespace

TouchScene::TouchScene(std::size_t max_bodies, std::size_t max_parts)
    : bodies_(max_bodies), parts_(max_parts) {
    moved_.reserve(max_bodies);
    deformed_.reserve(max_bodies);
}

// First fit: removed bodies leave gaps that later ones fill.
int TouchScene::find_parts(std::size_t count) const {
    std::size_t free = 0;
    for (std::size_t i = parts_full_below_; i < parts_.size(); ++i) {
        free = parts_[i].part ? 0 : free + 1;
        if (free == count) {
            return static_cast<int>(i + 1 - count);
        }
    }
    return -1;
}

int TouchScene::add(const TouchShape& shape, const Pose& pose, const TouchMaterial& material,
                    std::uint32_t layer) {
    const auto is_free = [](const TouchBody& body) { return !body.shape; };
    const auto slot = std::find_if(bodies_.begin() + static_cast<std::ptrdiff_t>(bodies_full_below_),
                                   bodies_.end(), is_free);
    const int first_part = find_parts(shape.parts.size());
    if (slot == bodies_.end() || first_part < 0) {
        return -1;
    }
    const int index = static_cast<int>(slot - bodies_.begin());
    *slot = {&shape, pose, pose, material, layer,
             false,  0.0,  0.0,  nullptr,  static_cast<std::uint32_t>(first_part)};
    for (std::size_t i = 0; i < shape.parts.size(); ++i) {
        const Pose placed = compose(pose, shape.parts[i].pose);
        parts_[slot->first_part + i] = {&shape.parts[i], static_cast<std::uint32_t>(index), placed, placed};
    }
    bodies_full_below_ = static_cast<std::size_t>(index) + 1;
    used_ = std::max(used_, bodies_full_below_);
    if (slot->first_part <= parts_full_below_) {
        parts_full_below_ = slot->first_part + shape.parts.size();
    }
    note_change(index, Change::Kind::came, pose, 0);
    return index;
}

void TouchScene::remove(int body) {
    TouchBody& removed = body_at(body);
    for (std::size_t i = 0; i < removed.shape->parts.size(); ++i) {
        parts_[removed.first_part + i] = {};
    }
    std::erase(moved_, body);
    std::erase(deformed_, body);
    note_change(body, Change::Kind::went, removed.pose, removed.layer);
    bodies_full_below_ = std::min(bodies_full_below_, static_cast<std::size_t>(body));
    parts_full_below_ = std::min(parts_full_below_, static_cast<std::size_t>(removed.first_part));
    removed = {};
    while (used_ > 0 && bodies_[used_ - 1].shape == nullptr) {
        --used_;
    }
}

void TouchScene::note_change(int index, Change::Kind kind, const Pose& from, std::uint32_t layer_from) {
    const TouchBody& changed = body(index);
    changes_[++revision_ % remembered_changes] = {
        kind, changed.first_part, static_cast<std::uint32_t>(changed.shape->parts.size()), index,
        from, layer_from};
}

void TouchScene::begin_tick() {
    ++ticks_;
    for (const int index : moved_) {
        TouchBody& body = body_at(index);
        body.previous = body.pose;
        body.moved = false;
        body.moved_by = 0.0;
        for (std::size_t i = 0; i < body.shape->parts.size(); ++i) {
            ScenePart& part = parts_[body.first_part + i];
            part.previous = part.pose;
        }
    }
    moved_.clear();
    for (const int index : deformed_) {
        body_at(index).former = nullptr;
        body_at(index).gave_by = 0.0;
    }
    deformed_.clear();
}

bool TouchScene::deform(int index, const TouchShape& shape) {
    if (shape.parts.size() != body(index).shape->parts.size()) {
        return false;
    }
    take_form(index, shape, Change::Kind::form);
    return true;
}

bool TouchScene::only_gives_since(std::uint64_t since) const {
    bool gives = revision_ - since <= remembered_changes;
    for (std::uint64_t revision = since + 1; gives && revision <= revision_; ++revision) {
        const Change::Kind kind = change(revision).kind;
        gives = kind == Change::Kind::gives || kind == Change::Kind::narrowed;
    }
    return gives;
}

bool TouchScene::give(int index, const TouchShape& shape, double by) {
    if (!is_deformation(*body(index).shape, shape)) {
        return false;
    }
    body_at(index).gave_by += by;
    take_form(index, shape, Change::Kind::gives);
    return true;
}

bool TouchScene::narrow(int index, const TouchShape& shape) {
    TouchBody& body = body_at(index);
    const bool is_same =
        std::ranges::equal(body.shape->parts, shape.parts,
                           [](const TouchPart& p, const TouchPart& q) { return p.tree() == q.tree(); });
    if (!is_same) {
        return false;
    }
    body.shape = &shape;
    for (std::size_t i = 0; i < shape.parts.size(); ++i) {
        parts_[body.first_part + i].part = &shape.parts[i];
    }
    note_change(index, Change::Kind::narrowed, body.pose, body.layer);
    return true;
}

void TouchScene::take_form(int index, const TouchShape& shape, Change::Kind kind) {
    TouchBody& body = body_at(index);
    if (!body.former) {
        deformed_.push_back(index);
        body.former = body.shape;
    }
    body.shape = &shape;
    for (std::size_t i = 0; i < shape.parts.size(); ++i) {
        ScenePart& part = parts_[body.first_part + i];
        part.part = &shape.parts[i];
        part.pose = compose(body.pose, shape.parts[i].pose);
        part.previous = compose(body.previous, shape.parts[i].pose);
    }
    note_change(index, kind, body.pose, body.layer);
}

void TouchScene::set_pose(int index, const Pose& pose, bool teleport) {
    TouchBody& body = body_at(index);
    if (same_pose(pose, body.pose)) {
        return;
    }
    const Pose from = std::exchange(body.pose, pose);
    if (teleport) {
        body.previous = pose;
        note_change(index, Change::Kind::elsewhere, from, body.layer);
    } else if (!body.moved) {
        body.moved = true;
        moved_.push_back(index);
    }
    body.moved_by = teleport ? 0.0 : farthest_motion(body.previous, pose, body.shape->reach);
    for (std::size_t i = 0; i < body.shape->parts.size(); ++i) {
        ScenePart& part = parts_[body.first_part + i];
        part.pose = compose(pose, body.shape->parts[i].pose);
        if (teleport) {
            part.previous = part.pose;
        }
    }
}

void TouchScene::displace(int index, const Pose& motion) {
    const TouchBody displaced = body(index);
    set_pose(index, compose(motion, displaced.previous), true);
    set_pose(index, compose(motion, displaced.pose));
}

void TouchScene::set_layer(int body, std::uint32_t layer) {
    const std::uint32_t before = std::exchange(body_at(body).layer, layer);
    note_change(body, Change::Kind::layer, this->body(body).pose, before);
}

}  // namespace tactus
