#include "core/haptics/proxy.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

Proxy::Proxy(std::size_t most_parts, const ProxySettings& settings)
    : settings_(settings), surroundings_(most_parts) {}

// A proxy cannot start inside a surface: it appears where the hand is once there is room, so touch begins
// without a kick. Until then it is absent and follows the hand. A hand that starts by just touching has room
// enough: the first step lifts the sphere off by the thousandth of its radius that may be missing.
bool Proxy::appear(const Vec3& hand) {
    const double room = settings_.radius * (1.0 - 1e-3);
    position_ = hand;
    present_ = surroundings_.clearance(hand, 2.0 * room) >= room;
    surroundings_.invalidate();
    return present_;
}

// Straight on until something is in the way.
void Proxy::advance(const Vec3& motion, bool& free, int except) {
    const double t = surroundings_.sweep(position_, motion, except);
    free = t > 1.0;
    const Vec3 moved = free ? motion : motion * t;
    position_ += moved;
    surroundings_.travelled(glm::length(moved));
}

// The moving body that the proxy rests on most.
int Proxy::carrier() const {
    int body = -1;
    double most_pressure = 0.0;
    for (const Contact& contact : touching()) {
        if (contact.pressure > most_pressure && scene_->body(contact.body).moved) {
            body = contact.body;
            most_pressure = contact.pressure;
        }
    }
    return body;
}

// A proxy that rests on a moving body moves with it; one that a moving body runs into is pushed. Neither way
// leads through anything but the body that causes it, which stands at its new place already.
void Proxy::ride_along(ProxyTick& tick) {
    if (scene_->moved_bodies().empty()) {
        return;
    }
    bool free = true;
    const int carried_by = carrier();
    if (carried_by >= 0) {
        const TouchBody& body = scene_->body(carried_by);
        const Vec3 carried = to_parent(body.pose, to_local(body.previous, position_));
        advance(carried - position_, free, carried_by);
    }
    bool squeezed = !free;
    Surroundings::Push push;
    for (std::size_t from = 0; surroundings_.next_push(from, position_, free ? carried_by : -1, push);) {
        advance(push.displacement, free, push.body);
        squeezed = squeezed || !free;
    }
    if (squeezed) {
        tick.status |= proxy_squeezed;
    }
}

// Coulomb: contacts hold the proxy along the surface with at most friction times what they hold it back
// across (unit: meters, as all forces over the stiffness). Every wall of a groove counts.
double Proxy::friction_limit(const ConstrainedStep& step) const {
    double limit = 0.0;
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts_.items[static_cast<std::size_t>(step.pressing[i])];
        const TouchMaterial& material = scene_->body(contact.body).material;
        const bool at_rest = contact.gap <= 4.0 * surroundings_.tolerances().skin;
        const double coefficient = sliding_ ? material.dynamic_friction : material.static_friction;
        limit += at_rest ? coefficient * step.pressure[i] : 0.0;
    }
    return limit;
}

void Proxy::keep_touching(const ConstrainedStep& step) {
    touching_.clear();
    for (int i = 0; i < step.pressing_count; ++i) {
        Contact contact = contacts_.items[static_cast<std::size_t>(step.pressing[i])];
        // Where moving bodies squeeze the proxy it cannot get out of their way: what they overlap it by
        // presses, too.
        contact.pressure = step.pressure[i] + std::max(0.0, -contact.gap - surroundings_.tolerances().skin);
        touching_.add(contact);
    }
}

void Proxy::descend(const Vec3& hand, ProxyTick& tick) {
    const Tolerances& tolerances = surroundings_.tolerances();
    touching_.clear();
    if (const double way = glm::length(hand - position_); surroundings_.is_clear(way)) {
        position_ = hand;
        surroundings_.travelled(way);
        sliding_ = false;
        return;
    }
    bool slid = false;
    bool keep_all = false;
    ConstrainedStep step;
    for (tick.steps = 0; tick.steps < settings_.most_steps; ++tick.steps) {
        surroundings_.find_contacts(position_, contacts_, keep_all);
        step = constrained_step(hand - position_, contacts_.all(), tolerances.same, stretch_);
        double wanted = glm::length(step.motion);
        if (const double limit = friction_limit(step); limit > 0.0) {
            const double slide = glm::length(step.slide);
            const double left = std::max(0.0, slide - limit);
            step.motion *= slide > 0.0 ? left / slide : 0.0;
            wanted *= slide > 0.0 ? left / slide : 0.0;
            if (wanted > tolerances.step && !sliding_) {
                sliding_ = true;  // static friction has given way: what is left is held by the dynamic one
                continue;
            }
        }
        tick.residual = wanted;
        if (wanted <= tolerances.step) {
            break;
        }
        slid = slid || step.pressing_count > 0;
        bool free = true;
        const Vec3 before = position_;
        advance(step.motion, free);
        // Stopped without having moved by something that is no contact: look at every edge and corner there
        // is.
        keep_all = !free && position_ == before && contacts_.count < ContactList::capacity;
        if (free && step.pressing_count == 0) {
            ++tick.steps;
            tick.residual = 0.0;
            break;
        }
    }
    sliding_ = sliding_ && slid;
    keep_touching(step);
    tick.slide = step.pressing_count > 0 ? step.slide : Vec3(0.0);
    if (tick.residual > tolerances.step) {
        tick.status |= proxy_unfinished;
    }
}

ProxyTick Proxy::move(const TouchScene& scene, const Vec3& hand) {
    ProxyTick tick;
    scene_ = &scene;
    surroundings_.begin_tick(scene, position_, settings_.radius, settings_.mask);
    if (!present_) {
        touching_.clear();
        if (!appear(hand)) {
            tick.position = hand;
            tick.status = proxy_absent;
            return tick;
        }
        surroundings_.begin_tick(scene, position_, settings_.radius, settings_.mask);
    }
    ride_along(tick);
    descend(hand, tick);
    tick.position = position_;
    tick.status |= touching_.count > 0 ? static_cast<std::uint32_t>(proxy_touching) : 0u;
    tick.status |= sliding_ ? static_cast<std::uint32_t>(proxy_sliding) : 0u;
    return tick;
}

}  // namespace tactus
