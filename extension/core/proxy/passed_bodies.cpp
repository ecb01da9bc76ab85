#include "core/proxy/passed_bodies.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

bool asks_for(Insides insides, const TouchPart& part) {
    return part.closed &&
           (insides == Insides::of_all || (insides == Insides::of_one_sided && part.one_sided));
}

}  // namespace

Overlap overlap_with(const TouchShape& shape, const Pose& pose, const Vec3& center, double far, double enough,
                     Insides insides, WorkBudget& work) {
    Overlap overlap{far, false, true};
    for (const TouchPart& part : shape.parts) {
        work.spend(cost::part_look);
        const Vec3 local = to_local(compose(pose, part.pose), center);
        const double to_ball = glm::length(local - part.center) - part.radius;
        if (to_ball >= overlap.distance) {
            continue;
        }
        const TriangleTree* const tree = part.tree();
        if (!tree) {
            work.spend(cost::solid_look);
            const double distance = distance_to_solid(part.solid(), local).distance;
            overlap.distance = std::min(overlap.distance, distance);
            overlap.inside = overlap.inside || distance < 0.0;
            continue;
        }
        const NearestTriangle nearest = tree->nearest(local, far, work, enough);
        overlap.distance = std::min(overlap.distance, nearest.distance);
        overlap.known = overlap.known && nearest.complete;
        if (to_ball < 0.0 && !overlap.inside && asks_for(insides, part)) {
            const Winding winding = tree->winding(local, work);
            overlap.inside = winding.inside();
            overlap.known = overlap.known && winding.known;
        }
    }
    return overlap;
}

bool PassedBodies::pass(int body, PassedBecause reason, const BrokenAt& broken) {
    if (contains(body)) {
        return true;
    }
    if (count_ == capacity) {
        return false;
    }
    passed_[count_++] = {body, reason, reason != PassedBecause::broken, broken};
    return true;
}

void PassedBodies::forget(int body) {
    for (std::size_t i = 0; i < count_; ++i) {
        if (passed_[i].body == body) {
            passed_[i] = passed_[--count_];
            return;
        }
    }
}

// A surface that broke is whole again once the sphere has been in it and is out, or has drawn back from it,
// on the side where it broke.
void PassedBodies::update(const TouchScene& scene, const Vec3& center, double room, WorkBudget& work) {
    for (std::size_t i = 0; i < count_;) {
        Passed& passed = passed_[i];
        const TouchBody& body = scene.body(passed.body);
        bool clear = !body.shape;
        if (!clear) {
            const Insides insides =
                passed.reason == PassedBecause::broken ? Insides::of_one_sided : Insides::of_all;
            // As it was when the tick began: the way of a body that is held on to again is swept.
            const TouchShape& shape = body.former ? *body.former : *body.shape;
            const double within = room * (1.0 - 1e-6);
            const Overlap at = overlap_with(shape, body.previous, center, 2.0 * room, within, insides, work);
            passed.entered = passed.entered || at.inside || at.distance < within;
            const Vec3 from_break = to_local(body.previous, center) - passed.broken.point;
            const bool is_before =
                passed.reason != PassedBecause::broken || glm::dot(from_break, passed.broken.normal) > 0.0;
            clear =
                is_before && !at.inside && at.known && at.distance >= (passed.entered ? room : 1.5 * room);
        }
        if (clear) {
            passed = passed_[--count_];
        } else {
            ++i;
        }
    }
}

}  // namespace tactus
