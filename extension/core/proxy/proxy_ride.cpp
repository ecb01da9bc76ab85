// What the scene does to the proxy before it follows the hand: bodies that come to stand where it is let it
// out, those that move carry or push it, those that deform do both.
#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "core/math/shortened.hpp"
#include "core/proxy/constrained_step.hpp"
#include "core/proxy/proxy.hpp"
#include "core/tree/deform_sweep.hpp"

namespace tactus {

namespace {

// A mesh deforms, and takes a sphere along: a surface that runs into it pushes it ahead, one that it rests on
// carries it. However far the corners have gone, none of the triangles passes its centre.
//
// The time between the two forms is walked in steps. In each, no triangle comes nearer to the centre than
// half of what the nearest one was; then the sphere is lifted off again, each time by less than the distance
// to the nearest triangle. So no step and no lift leads the centre through a surface.
class DeformRide {
public:
    // `center` is the sphere's in the frame of the mesh, `same` is what counts as no distance (unit: meters).
    DeformRide(const DeformSweep& sweep, const Vec3& center, double radius, double same, WorkBudget& work)
        : sweep_(sweep), center_(center), radius_(radius), same_(same), work_(work) {}

    // `carried`: it rests on the mesh. `advance(motion)` moves the sphere by as much of the motion as nothing
    // else is in the way of, and returns that. False where the sphere is left no room, or the work does not
    // suffice: it must be let out then.
    template <class Advance>
    bool go(bool carried, Advance&& advance) {
        constexpr int max_steps = 256;
        look();
        for (int step = 0; t_ < 1.0; ++step) {
            if (!has_room() || step == max_steps) {
                return false;
            }
            const Vec3 motion = carried && nearest_.distance < around() ? motion_of_nearest() : Vec3(0.0);
            const double room = 0.5 * std::min(nearest_.distance, radius_);
            const double next = sweep_.free_until(t_, center_, motion, room, work_);
            if (motion != Vec3(0.0)) {
                center_ += advance(motion * (next - t_));
            }
            t_ = next;
            look();
            lift(advance);
        }
        return has_room();
    }

private:
    double around() const { return 1.1 * radius_; }
    bool has_room() const {
        return nearest_.distance >= (1.0 - max_overlap_share) * radius_ && !work_.is_gone();
    }
    Vec3 motion_of_nearest() const { return sweep_.motion_of(nearest_, t_, center_); }

    // What is around the sphere now.
    void look() {
        contacts_.clear();
        nearest_.distance = around();
        const double limit = around();
        sweep_.visit_near(t_, center_, limit, work_, [&](const DeformSweep::Seen& seen) {
            const double length = std::max(seen.distance, 1e-300);
            contacts_.add({seen.offset / length, seen.distance - radius_, {0, seen.slot}});
            nearest_ = seen.distance < nearest_.distance ? seen : nearest_;
        });
        work_.spend(contacts_.count);
    }

    // Off all that it overlaps at once: off one wall of a groove after the other takes for ever. Where they
    // leave nothing between them, half off the nearest.
    template <class Advance>
    void lift(Advance&& advance) {
        constexpr int max_lifts = 12;
        for (int i = 0; i < max_lifts && nearest_.distance < (1.0 - 1e-6) * radius_; ++i) {
            Vec3 way = lift_to_rest(contacts_, same_, work_);
            if (glm::length(way) <= same_) {
                way = nearest_.offset * (0.5 * (radius_ / std::max(nearest_.distance, 1e-300) - 1.0));
            }
            way = shortened(way, 0.9 * nearest_.distance);
            const Vec3 lifted = advance(way);
            center_ += lifted;
            look();
            if (glm::length(lifted) < 0.5 * glm::length(way)) {
                break;  // something else is in the way
            }
        }
    }

    const DeformSweep& sweep_;
    Vec3 center_;
    double radius_;
    double same_;
    WorkBudget& work_;
    double t_ = 0.0;
    DeformSweep::Seen nearest_{};
    ContactList contacts_;
};

}  // namespace

// The contact that the proxy rests on hardest; null: there is none. Friction there holds it against all
// others.
const Touch* Proxy::carrier() const {
    const auto hardest = std::ranges::max_element(touching(), {}, &Touch::pressure);
    return hardest != touching().end() && hardest->pressure > 0.0 ? &*hardest : nullptr;
}

// With the body, and then back on it: a finger does not turn, so its center moves as the body's material at
// the contact point does. The center was carried as if it were part of the body, by R a of the arm a = r n
// that leads to it from that point, and rolls back along the surface by R a - a.
bool Proxy::ride_carrier(const Touch& contact) {
    const TouchBody& body = scene().body(contact.body);
    FeatureId stopped_by;
    const Vec3 carried = to_parent(body.pose, to_local(body.previous, sphere_.position));
    if (!sphere_.advance(carried - sphere_.position, stopped_by, contact.body).is_free()) {
        return false;
    }
    if (body.pose.rotation != body.previous.rotation) {
        const Vec3 normal = direction_to_parent(body.pose, direction_to_local(body.previous, contact.normal));
        const Vec3 back = settings().radius * (contact.normal - normal);
        const Vec3 along = back - glm::dot(back, normal) * normal;
        if (sphere_.advance(along, stopped_by).is_free()) {
            // A surface that bends away is below by s^2 / 2 (1 / r + 1 / R) < s^2 / r, or farther than
            // friction reaches.
            sphere_.advance(-glm::dot(along, along) / settings().radius * normal, stopped_by);
        }
    }
    return true;
}

// The body's triangles on their way since the last tick, where the body was then. False where they leave the
// proxy no room.
bool Proxy::ride_deformation(int index) {
    const TouchBody& body = scene().body(index);
    const bool rests = std::ranges::any_of(touching(), [&](const Touch& c) { return c.body == index; });
    for (std::size_t i = 0; i < body.shape->parts.size(); ++i) {
        const TouchPart& from = body.former->parts[i];
        const TouchPart& to = body.shape->parts[i];
        const Pose placed = compose(body.previous, to.pose);
        const Vec3 local = to_local(placed, sphere_.position);
        if (glm::length(local - to.center) > std::max(from.radius, to.radius) + 1.1 * settings().radius) {
            continue;
        }
        const DeformSweep sweep(*from.tree(), *to.tree());
        const auto advanced = [&](const Vec3& motion) {
            const Vec3 before = sphere_.position;
            FeatureId stopped_by;
            sphere_.advance(direction_to_parent(placed, motion), stopped_by, index);
            return direction_to_local(placed, sphere_.position - before);
        };
        DeformRide ride(sweep, local, settings().radius, sphere_.tolerances().same, sphere_.work());
        if (!ride.go(rests, advanced)) {
            return false;
        }
    }
    return true;
}

void Proxy::ride_deformations(ProxyTick& tick) {
    for (const int index : scene().deformed_bodies()) {
        const TouchBody& body = scene().body(index);
        if ((body.layer & settings().mask) != 0 && !passed().contains(index) &&
            is_deformation(*body.former, *body.shape) && !ride_deformation(index)) {
            tick.status |= proxy_squeezed;
            let_go(passed().pass(index, PassedBecause::squeezes));
        }
    }
}

// A proxy that rests hardest on a moving body moves with it; one that a moving body runs into is pushed.
// Neither way leads through anything but the body that causes it, which stands at its new place already.
void Proxy::ride_bodies(ProxyTick& tick) {
    bool free = true;
    FeatureId stopped_by;
    int carried_by = -1;
    if (const Touch* const contact = carrier(); contact && scene().body(contact->body).moved) {
        carried_by = contact->body;
        free = ride_carrier(*contact);
    }
    bool squeezed = !free;
    Surroundings::Push push;
    for (std::size_t from = 0;
         sphere_.surroundings.next_push(from, sphere_.position, free ? carried_by : -1, push);) {
        free = sphere_.advance(push.displacement, stopped_by, push.body).is_free();
        squeezed = squeezed || !free;
    }
    if (squeezed) {
        sphere_.surroundings.doubt();
        tick.status |= proxy_squeezed;
        const std::size_t before = passed().count();
        let_go(let_out_of_squeeze(scene(), touching_sphere(), passed(), sphere_.work()));
        tick.jumped = tick.jumped || passed().count() != before;
    }
}

// With all that has moved since the last tick. Returns how far that has led (unit: meters).
double Proxy::ride_along(ProxyTick& tick) {
    const Vec3 before = sphere_.position;
    sphere_.surroundings.make_sure(sphere_.position);
    ride_deformations(tick);
    if (!scene().moved_bodies().empty()) {
        ride_bodies(tick);
    }
    return glm::distance(sphere_.position, before);
}

}  // namespace tactus
