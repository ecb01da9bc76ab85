#include "session/soft_slot.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "core/tree/deform_sweep.hpp"

namespace tactus {

namespace {

void put_ball(TouchShape& shape, const TriangleTree& tree) {
    TouchPart& part = shape.parts.front();
    part.center = tree.center();
    part.radius = tree.radius();
    shape.reach = glm::length(part.center) + part.radius;
}

}  // namespace

// From outside only: nothing is to be caught in what closes over it.
std::shared_ptr<TouchShape> soft_touch_shape(const SoftModel& model, const ParallelRunner& run) {
    auto shape = std::make_shared<TouchShape>();
    TouchPart part;
    auto tree = std::make_shared<const TriangleTree>(TriangleTree::build(model.surface, run));
    part.closed = part.one_sided = model.closed;
    part.surface = tree;
    shape->parts.push_back(std::move(part));
    shape->give = model.give;
    put_ball(*shape, *tree);
    return shape;
}

SoftSlot::SoftSlot(std::shared_ptr<const SoftModel> model, std::shared_ptr<SoftView> view,
                   std::uint32_t layers, const ParallelRunner& run)
    : body(std::move(model)), mask(layers), surface_(body.model().surface), view_(std::move(view)) {
    const std::shared_ptr<TouchShape> rest = soft_touch_shape(body.model(), run);
    for (std::size_t i = 0; i < forms_.size(); ++i) {
        trees_[i] = std::make_shared<TriangleTree>(rest->parts.front().tree()->refitted(surface_, run));
        trees_[i]->follow(surface_);
        forms_[i] = *rest;
        forms_[i].parts.front().surface = std::shared_ptr<const TriangleTree>(trees_[i]);
        put_ball(forms_[i], *trees_[i]);
    }
}

bool SoftSlot::exchange_make(SoftSlot& other) {
    if (!same_structure(body.model(), other.body.model())) {
        return false;
    }
    other.body.go_on_from(body);
    std::swap(body, other.body);
    std::swap(view_, other.view_);
    for (TouchShape& form : forms_) {
        form.give = body.model().give;
    }
    moved_ = true;
    return true;
}

bool SoftSlot::take_form() {
    if (!std::exchange(moved_, false)) {
        return false;
    }
    shown_ = 1 - shown_;
    trees_[shown_]->follow(surface_);
    put_ball(forms_[shown_], *trees_[shown_]);
    return true;
}

void SoftSlot::press(const Pose& at, const FeatureId& feature, const SpringForce& spring) {
    if (push_count_ == pushes_.size() || feature.triangle == Hit::no_triangle) {
        return;
    }
    const TriangleTree& tree = *trees_[shown_];
    pushes_[push_count_++] = {tree.triangle_at(feature.triangle),
                              weights_of(to_local(at, spring.point), tree.corners(feature.triangle)),
                              direction_to_local(at, spring.force),
                              spring.stiffness,
                              spring.damping,
                              direction_to_local(at, spring.hand_velocity),
                              spring.sticks};
}

void SoftSlot::set_near(std::span<const Obstacle> found) {
    if (!std::ranges::equal(found, near())) {
        std::ranges::copy(found, near_.begin());
        near_count_ = found.size();
        obstacles_ = {};
        body.wake();
    }
}

std::uint32_t SoftSlot::step(const Pose& at, const Vec3& gravity) {
    const std::span<const SoftPush> pushes = std::span(pushes_).first(std::exchange(push_count_, 0));
    if (body.is_asleep() && pushes.empty()) {
        return 0;
    }
    const std::uint32_t status = body.step(direction_to_local(at, gravity), pushes, obstacles());
    gave_by_ = body.write_surface(surface_.vertices);
    moved_ = true;
    if (view_) {
        view_->back() = surface_.vertices;
        view_->publish();
    }
    return status;
}

}  // namespace tactus
