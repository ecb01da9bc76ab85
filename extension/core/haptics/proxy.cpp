#include "core/haptics/proxy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "core/haptics/hand_place.hpp"

namespace tactus {

namespace {

// What throws the proxy farther than its radius, and than this, within a tick goes by faster than a hand can
// feel it come: its force fades in (unit: meters).
constexpr double max_ride = 0.01;

}  // namespace

Proxy::Proxy(std::size_t max_parts, const ProxySettings& settings)
    : settings_(settings), surroundings_(max_parts) {}

void Proxy::put(const Vec3& place) {
    surroundings_.jumped(glm::distance(place, position_));
    position_ = place;
    contacts_hold_ = false;
}

void Proxy::go_along(const Vec3& offset, int body) {
    if (!sliding_) {
        displace(offset);
        return;
    }
    Vec3 pushed(0.0);
    std::array<Vec3, TouchList::capacity> across;  // the body's normals, made orthogonal
    int count = 0;
    for (const Touch& touch : touching()) {
        Vec3 normal = touch.body == body ? touch.normal : Vec3(0.0);
        for (int i = 0; i < count; ++i) {
            normal -=
                glm::dot(normal, across[static_cast<std::size_t>(i)]) * across[static_cast<std::size_t>(i)];
        }
        if (const double length = glm::length(normal); length > 1e-6) {
            normal /= length;
            across[static_cast<std::size_t>(count++)] = normal;
            pushed += glm::dot(offset, normal) * normal;
        }
    }
    displace(pushed);
}

// A proxy cannot start inside a surface: it appears where the hand is once there is room, so touch begins
// without a kick. Until then it is absent and follows the hand. A hand that starts by just touching has room
// enough: the first step lifts the sphere off by the thousandth of its radius that may be missing.
bool Proxy::appear() {
    const double room = settings_.radius * (1.0 - 1e-3);
    present_ = surroundings_.has_room(position_, room) &&
               !is_inside_one_sided(*scene_, position_, settings_.mask, surroundings_.work());
    contacts_hold_ = false;
    return present_;
}

// Straight on as far as the way is known to be free. A long way over a rough surface mostly ends early, and
// the bounds of a short one leave out far more: it is gone in strides, each as long as the last ones let it
// be.
Hit Proxy::advance(const Vec3& motion, FeatureId& stopped_by, int except) {
    const Vec3 origin = position_;
    const double length = glm::length(motion);
    Hit hit;
    double stride = surroundings_.first_stride();
    for (double gone = 0.0; gone < 1.0 && hit.is_free();) {
        const double share = stride / std::max(length, 1e-300);
        const double end = gone + share > 0.99 ? 1.0 : gone + share;
        hit = surroundings_.sweep(position_, motion * (end - gone), stopped_by, except);
        const double free_share = (end - gone) * (hit.is_free() ? 1.0 : hit.t);
        gone = hit.is_free() ? end : gone + free_share;
        stride = surroundings_.next_stride(free_share * length, hit.is_free());
        position_ = origin + motion * gone;
        surroundings_.travelled(free_share * length);
    }
    return hit;
}

void Proxy::keep_touching(const ConstrainedStep& step) {
    touching_.clear();
    const ContactLook look = surroundings_.look_from(position_);
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts_[step.pressing[i]];
        // Where moving bodies squeeze the proxy it cannot get out of their way: what they overlap it by
        // presses, too.
        const double overlap = std::max(0.0, -contact.gap - tolerances().skin);
        touching_.add(look.touch_of(contact, step.pressure[i] + overlap));
    }
}

// Where nothing can be in the way, there is nothing to do.
bool Proxy::fly(const Vec3& hand) {
    const double way = glm::length(hand - position_);
    if (!surroundings_.is_clear(way)) {
        return false;
    }
    position_ = hand;
    surroundings_.travelled(way);
    sliding_ = false;
    slide_speed_ = 0.0;
    contacts_hold_ = false;
    return true;
}

// Up to the hand, or as near as the surfaces let it. `given_way`: of the hand and of what carries the proxy
// since the last tick (unit: meters). `changed`: what it touched then may not be there any more.
void Proxy::follow(const Vec3& hand, double given_way, bool changed, ProxyTick& tick) {
    const Vec3 start = position_;
    const bool overlapped = std::exchange(overlaps_, false);
    const bool touched = touching_.count > 0;
    if (changed) {
        touching_.clear();
        crowd_.next = CrowdHold::Next::anew;
    }
    if (fly(hand)) {
        touching_.clear();
    } else {
        descend(hand, given_way, tick);
    }
    const bool touches = touching_.count > 0;
    const bool slipped = (touched || touches) &&
                         glm::distance(position_, start) > max_sensitivity * given_way + tolerances().reach;
    const bool is_unfinished = (tick.status & proxy_unfinished) != 0;
    const bool was_unfinished = std::exchange(unfinished_, is_unfinished);
    tick.jumped = tick.jumped || slipped || overlapped || overlaps_ || is_unfinished || was_unfinished;
    const PassedBodies& passed = surroundings_.passed();
    const bool lets_out_of_squeeze = passed.any(PassedBecause::squeezes);
    const auto say = [&](ProxyStatus status, bool holds) { tick.status |= holds ? status : 0u; };
    say(proxy_touching, touches);
    say(proxy_sliding, sliding_);
    say(proxy_squeezed, overlaps_ || lets_out_of_squeeze);
    say(proxy_letting_out, lets_out_of_squeeze || passed.any(PassedBecause::overlaps));
}

ProxyTick Proxy::move(const TouchScene& scene, const Vec3& given_hand, double seconds) {
    ProxyTick tick;
    scene_ = &scene;
    seconds_ = seconds;
    const Vec3 hand_before = std::exchange(hand_, is_hand_place(given_hand) ? given_hand : hand_);
    if (!present_) {
        put(hand_);
    }
    const bool changed = surroundings_.begin_tick(scene, position_, settings_.radius, settings_.mask,
                                                  WorkBudget(settings_.max_work, settings_.max_work / 8));
    contacts_hold_ = contacts_hold_ && !changed && surroundings_.saw_all();
    const bool was_present = present_;
    tick.jumped = take_in_jumps();
    const double ridden = present_ && !scene.is_still() ? ride_along(tick) : 0.0;
    tick.jumped = tick.jumped || ridden > std::max(max_ride, settings_.radius);
    const double given_way = glm::distance(hand_, hand_before) + ridden;
    if (was_present && !present_) {
        put(hand_);
        tick.jumped = true;
    }
    const bool appears = !present_ && appear();
    if (present_) {
        surroundings_.make_sure(position_);
        follow(hand_, given_way, changed, tick);
    }
    // The work may have ended before it was lifted out of what it begins too deep in: it begins later, then.
    if (appears && contacts_hold_ && (contacts_.min_gap() < -tolerances().skin || !surroundings_.saw_all())) {
        restart();
        put(hand_);
        tick = {};
    }
    if (!present_) {
        touching_.clear();
        tick.status |= proxy_absent;
    }
    tick.position = position_;
    return tick;
}

}  // namespace tactus
