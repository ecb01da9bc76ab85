#include "core/tool/tool_pair.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "core/tool/tool_proxy.hpp"

namespace tactus {

namespace {

// Tools that were put where they are hold each other back nevertheless while no sphere is entered deeper, of
// its radius.
constexpr double shallow = 0.5;

constexpr double anywhere = 1e9;  // (unit: meters)

std::shared_ptr<const TouchShape> surface_of(const ToolShape& shape) {
    const PlacedShape placed{MeshShape{shape.mesh}, {}};
    return shape.mesh ? make_touch_shape({&placed, 1}).shape : nullptr;
}

}  // namespace

std::unique_ptr<ToolPair> ToolPair::make(const std::shared_ptr<const ToolShape>& first,
                                         const std::shared_ptr<const ToolShape>& second) {
    const bool first_has_spheres =
        second->mesh && (!first->mesh || first->spheres.size() <= second->spheres.size());
    std::shared_ptr<const TouchShape> surface = surface_of(first_has_spheres ? *second : *first);
    return surface ? std::unique_ptr<ToolPair>(new ToolPair(first_has_spheres ? first : second,
                                                            std::move(surface), first_has_spheres))
                   : nullptr;
}

ToolPair::ToolPair(std::shared_ptr<const ToolShape> spheres, std::shared_ptr<const TouchShape> surface,
                   bool first_has_spheres)
    : shape_(std::move(surface)),
      first_has_spheres_(first_has_spheres),
      scene_(1, 1),
      around_(std::move(spheres), 1) {
    scene_.add(*shape_, {}, {}, 1);
    around_.begin_tick(scene_, 1, {}, anywhere);
}

void ToolPair::join(ToolProxy& first, ToolProxy& second) {
    spheres_ = first_has_spheres_ ? &first : &second;
    surface_ = first_has_spheres_ ? &second : &first;
    seen_ = relative();
    apart_ = sliding_ = false;
    first.meet(*this);
    second.meet(*this);
}

void ToolPair::part() {
    if (is_joined()) {
        std::exchange(spheres_, nullptr)->leave(*this);
        std::exchange(surface_, nullptr)->leave(*this);
    }
}

bool ToolPair::may_touch() const {
    const ToolSettings& a = spheres_->settings();
    const ToolSettings& b = surface_->settings();
    return spheres_->is_present() && surface_->is_present() && (a.mask & b.layer) != 0 &&
           (b.mask & a.layer) != 0;
}

bool ToolPair::holds() const {
    return apart_ && may_touch();
}

double ToolPair::friction(bool sliding) const {
    const ToolSettings& a = spheres_->settings();
    const ToolSettings& b = surface_->settings();
    const double dynamic = std::min(a.dynamic_friction, b.dynamic_friction);
    return sliding ? dynamic : std::max(dynamic, std::min(a.static_friction, b.static_friction));
}

Pose ToolPair::relative() const {
    return compose(inverse(surface_->pose()), spheres_->pose());
}

void ToolPair::follow() {
    const Pose now = relative();
    if (now.position != seen_.position || now.rotation != seen_.rotation) {
        around_.went(motion_between(seen_, now));
        seen_ = now;
    }
}

void ToolPair::begin_tick(WorkBudget& work) {
    around_.begin_tick(scene_, 1, seen_, anywhere);
    const bool was_displaced = std::exchange(displaced_, false);
    if (!may_touch()) {
        apart_ = false;
    } else if (was_displaced) {
        apart_ = fits_now(work);
    } else if (!apart_) {
        try_apart(work);
    }
}

bool ToolPair::fits_now(WorkBudget& work) {
    if (!may_touch() || !is_near(0.0)) {
        return true;
    }
    follow();
    return around_.is_free(seen_, work, shallow);
}

bool ToolPair::try_apart(WorkBudget& work) {
    apart_ = true;
    if (is_near(0.0)) {
        follow();
        apart_ = around_.is_free(seen_, work);
    }
    return apart_;
}

bool ToolPair::is_near(double ways) const {
    const double apart = glm::distance(spheres_->pose().position, surface_->pose().position);
    return apart <= around_.shape().reach + shape_->reach + ways + around_.skin();
}

ToolPair::Motions ToolPair::of_one(const ToolProxy& tool, const RigidMotion& motion) const {
    return &tool == spheres_ ? Motions{motion, {}} : Motions{{}, motion};
}

bool ToolPair::cannot_meet(const Motions& motions) const {
    return !is_near(2.0 * (glm::length(motions.spheres.way) + glm::length(motions.surface.way)));
}

// In the surface's frame a centre is at x = R^T y, with y from the surface's origin in the world. y'' is at
// most w^2 a (w: the spheres' turn, a: its arm), y' at most V + w a with V the difference of both ways, y at
// most D + V + a with D between the origins. With the surface's turn W,
//     |x''| <= |y''| + 2 W |y'| + W^2 |y| <= (w + W)^2 a + 2 W V + W^2 (D + V).
ToolWay ToolPair::way_of(const Motions& motions) const {
    const Pose to =
        compose(inverse(moved(surface_->pose(), motions.surface)), moved(spheres_->pose(), motions.spheres));
    const double turns = glm::length(motions.spheres.turn) + glm::length(motions.surface.turn);
    const double turn = glm::length(motions.surface.turn);
    const double way = glm::length(motions.spheres.way - motions.surface.way);
    const double between = glm::distance(spheres_->pose().position, surface_->pose().position);
    return {seen_, to, motion_between(seen_, to), turn * (2.0 * way + turn * (between + way)), turns * turns};
}

void ToolPair::collect(const Motions& motions, double far, ToolContacts& contacts, WorkBudget& work) {
    follow();
    around_.collect(seen_, way_of(motions).motion, far, contacts, work);
    const Pose& frame = surface_->pose();
    for (ToolContact& contact : std::span(contacts.items).first(static_cast<std::size_t>(contacts.count))) {
        contact.point = to_parent(frame, contact.point);
        contact.normal = direction_to_parent(frame, contact.normal);
    }
}

double ToolPair::straight_share(const Motions& motions) {
    if (cannot_meet(motions)) {
        return 1.0;
    }
    follow();
    return around_.straight_share(way_of(motions));
}

double ToolPair::free_share(const Motions& motions, WorkBudget& work) {
    if (cannot_meet(motions)) {
        return 1.0;
    }
    follow();
    return around_.free_share(way_of(motions), work);
}

}  // namespace tactus
