// How bodies on their way take a tool along.
#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/haptics/surface_way.hpp"
#include "core/math/along_normals.hpp"
#include "core/math/body_motion.hpp"
#include "core/tool/tool_pair.hpp"
#include "core/tool/tool_proxy.hpp"
#include "core/tool/tool_steps.hpp"

namespace tactus {

using namespace tool_steps;

namespace {

// Of a sphere's radius: where the tool is let go since it could come out on the other side.
constexpr double lost = 0.9;
constexpr int takes_along = 6;  // by what gives, in a tick: each sphere that it enters most

}  // namespace

// What of the motion is a small enough turn, to other tools as well.
double ToolProxy::straight_share(const RigidMotion& motion) const {
    double share = around_.straight_share(motion);
    for (ToolPair* const pair : pairs()) {
        if (pair->holds()) {
            share = std::min(share, pair->straight_share(pair->of_one(*this, motion)));
        }
    }
    return share;
}

// What of it no sphere meets anything on, nor another tool, but the body `except`.
double ToolProxy::free_share(const RigidMotion& motion, int except) {
    double share = around_.free_share(pose_, motion, work_, except);
    for (ToolPair* const pair : pairs()) {
        if (pair->holds()) {
            share = std::min(share, pair->free_share(pair->of_one(*this, motion), work_));
        }
    }
    return share;
}

void ToolProxy::go_free(const RigidMotion& motion, int except) {
    const double straight = straight_share(motion);
    go(motion * (straight * free_share(motion * straight, except)));
}

// Other tools where they are.
bool ToolProxy::fits_beside_tools() {
    present_ = true;
    return std::ranges::all_of(pairs(),
                               [&](ToolPair* pair) { return !pair->may_touch() || pair->try_apart(work_); });
}

std::span<const ToolTouch>::iterator ToolProxy::hardest_touch() const {
    return std::ranges::max_element(
        touching(), {}, [](const ToolTouch& touch) { return glm::dot(touch.force, touch.normal); });
}

// The body that the tool rests on hardest; -1: none.
int ToolProxy::carrier() const {
    const auto hardest = hardest_touch();
    return hardest == touching().end() ? -1 : hardest->body;
}

// In this tick (unit: meters).
double ToolProxy::longest_ride() const {
    double fastest = 0.0;
    for (const int index : scene_->moved_bodies()) {
        fastest = std::max(fastest, scene_->body(index).moved_by);
    }
    return farthest_ride * shape().reach + std::min(fastest, fastest_way);
}

// As far as there is room, and no farther than a tick may: `taken` is how far all together have led.
void ToolProxy::take_along(const RigidMotion& motion, int body, double& taken) {
    taken += around_.farthest_way(motion);
    if (taken <= longest_ride()) {
        go_free(motion, body);
    }
}

// The tool's own, if it went with the body since the last tick.
RigidMotion ToolProxy::way_with(int index) const {
    const TouchBody& body = scene_->body(index);
    return motion_between(pose_, compose(displacement(body.previous, body.pose), pose_));
}

// What has moved takes the tool along: all the way, as far as there is room, where it rests on it; and what
// is left of the way where it would enter its spheres so far that the next step could lose them. False where
// something else leaves no room for that.
bool ToolProxy::ride() {
    const Pose before = pose_;
    double taken = 0.0;
    if (const int carries = carrier(); carries >= 0 && scene_->body(carries).moved) {
        take_along(way_with(carries), carries, taken);
    }
    const bool has_room = ride_bodies(before, taken);
    return ride_forms(taken) && has_room && taken <= longest_ride();
}

// However many move, half of the work is left for what gives, and for the tool's own way. What could not be
// asked may have gone anywhere: the tool has no room then, either.
bool ToolProxy::ride_bodies(const Pose& before, double& taken) {
    if (scene_->moved_bodies().empty()) {
        return true;
    }
    const WorkShare half(work_, work_.left() / 2);
    bool has_room = true;
    std::span<const std::uint32_t> enterable;
    const auto look = [&] {
        enterable = around_.enterable(entered);
        around_.find_entering(enterable, before, pose_, entered, work_);
    };
    look();
    for (const int index : scene_->moved_bodies()) {
        if (enterable.empty() || work_.is_gone()) {
            break;
        }
        if (!around_.may_have_entered(index)) {
            continue;
        }
        const double share = around_.share_until_entered(enterable, index, before, pose_, entered, work_);
        if (share < 1.0) {
            take_along(way_with(index) * (1.0 - share), index, taken);
            has_room = has_room && around_.share_until_entered(around_.enterable(lost), index, before, pose_,
                                                               lost, work_) == 1.0;
            look();
        }
    }
    return has_room && !work_.is_gone();
}

// The rigid motion nearest to how the surface has gone under the tool, by what each contact presses with.
// About axes that the contacts say nothing of it does not turn.
RigidMotion ToolProxy::way_of_form(int body) const {
    constexpr double steadies = 0.01;  // of the tool's reach
    double pressing = 0.0;
    Vec3 center(0.0), mean(0.0);
    const auto for_each = [&](auto&& use) {
        for (const ToolTouch& touch : touching()) {
            const double weight = glm::dot(touch.force, touch.normal);
            if (touch.body == body && weight > 0.0) {
                Touch place;
                place.point = touch.point;
                place.body = touch.body;
                place.feature = touch.feature;
                use(weight, touch.point - pose_.position, tactus::way_of_surface(*scene_, place));
            }
        }
    };
    for_each([&](double weight, const Vec3& arm, const Vec3& way) {
        pressing += weight;
        center += weight * arm;
        mean += weight * way;
    });
    if (pressing <= 0.0) {
        return {};
    }
    center /= pressing;
    mean /= pressing;
    const double steady = steadies * shape().reach;
    Mat3 inertia(pressing * steady * steady);
    Vec3 momentum(0.0);
    for_each([&](double weight, const Vec3& arm, const Vec3& way) {
        const Vec3 r = arm - center;
        inertia += weight * (Mat3(glm::dot(r, r)) - glm::outerProduct(r, r));
        momentum += weight * glm::cross(r, way - mean);
    });
    const Vec3 turn = glm::inverse(inertia) * momentum;
    return {mean - glm::cross(turn, center), turn};
}

// What gives carries a tool that rests on it, and takes it along where it would enter its spheres too far.
bool ToolProxy::ride_forms(double& taken) {
    const Pose before = pose_;
    bool has_room = true;
    for (const int index : scene_->deformed_bodies()) {
        const TouchBody& body = scene_->body(index);
        if ((body.layer & settings_.mask) == 0 || !is_deformation(*body.former, *body.shape)) {
            continue;
        }
        if (const RigidMotion rests = way_of_form(index); rests.way != Vec3(0.0)) {
            take_along(rests, index, taken);
        }
        double share = 0.0;
        for (int i = 0; i < takes_along && share < 1.0; ++i) {
            const auto entering = around_.entered_by_form(index, before, pose_, entered, work_);
            share = entering.share;
            if (entering.way != Vec3(0.0)) {
                take_along({entering.way, Vec3(0.0)}, index, taken);
            }
        }
        has_room = has_room &&
                   (share == 1.0 || around_.entered_by_form(index, before, pose_, lost, work_).share == 1.0);
    }
    return has_room;
}

// Where a correction takes the tool: with the body where friction holds it there, and else out of its way.
Pose ToolProxy::place_after(const Pose& motion, int body) const {
    if (!sliding_ && body == carrier()) {
        return compose(motion, pose_);
    }
    AlongNormals pushed;
    Vec3 way(0.0);
    double most = 0.0;
    for (const ToolTouch& touch : touching()) {
        const double pressing = glm::dot(touch.force, touch.normal);
        if (touch.body == body) {
            pushed.add(touch.normal);
            if (pressing > most) {
                most = pressing;
                way = to_parent(motion, touch.point) - touch.point;
            }
        }
    }
    return {pose_.position + pushed.part_of(way), pose_.rotation};
}

void ToolProxy::go_along(const TouchScene& scene, const Pose& motion, int body) {
    constexpr int max_parts_of_turn = 16;
    scene_ = &scene;
    const Pose there = place_after(motion, body);
    give_work(settings_.max_work);
    around_.begin_tick(scene, settings_.mask, pose_,
                       2.0 * around_.farthest_way(motion_between(pose_, there)));
    for (int i = 0; i < max_parts_of_turn; ++i) {
        const RigidMotion left = motion_between(pose_, there);
        const double straight = straight_share(left);
        const double free = free_share(left * straight, body);
        go(left * (straight * free));
        if (straight * free >= 1.0 || free < 1.0 || work_.is_gone()) {
            return;
        }
    }
}

}  // namespace tactus
