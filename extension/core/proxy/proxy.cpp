#include "core/proxy/proxy.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "core/math/along_normals.hpp"
#include "core/safety/hand_place.hpp"

namespace tactus {

namespace {

// What throws the proxy farther than its radius, and than this, within a tick goes by faster than a hand can
// feel it come: its force fades in (unit: meters).
constexpr double max_ride = 0.01;

}  // namespace

ProxyMemory Proxy::memory() const {
    return {sphere_.position,
            present_,
            hold_.friction.is_sliding(),
            overlaps_,
            unfinished_,
            hand_,
            hold_.touching,
            hold_.friction.speed(),
            hold_.crowd.hold()};
}

void Proxy::recall(const ProxyMemory& memory) {
    sphere_.put(memory.position);
    present_ = memory.present;
    overlaps_ = memory.overlaps;
    unfinished_ = memory.unfinished;
    hand_ = memory.hand;
    hold_.touching = memory.touching;
    hold_.friction.recall(memory.sliding, memory.slide_speed);
    hold_.crowd.recall(memory.crowd);
}

bool Proxy::pass_through(int body, const BrokenAt& broken) {
    sphere_.contacts_hold = false;
    return passed().pass(body, PassedBecause::broken, broken);
}

void Proxy::restart() {
    present_ = false;
    hold_.friction.set_sliding(false);
    hold_.touching.clear();
    hold_.crowd.leave();
    ++starts_;
}

void Proxy::go_along(const Vec3& offset, int body) {
    const Touch* const rests_on = carrier();
    if (!hold_.friction.is_sliding() && rests_on && rests_on->body == body) {
        displace(offset);
        return;
    }
    AlongNormals pushed;
    for (const Touch& touch : touching()) {
        if (touch.body == body) {
            pushed.add(touch.normal);
        }
    }
    displace(pushed.part_of(offset));
}

// A proxy cannot start inside a surface: it appears where the hand is once there is room, so touch begins
// without a kick. Until then it is absent and follows the hand. A hand that starts by just touching has room
// enough: the first step lifts the sphere off by the thousandth of its radius that may be missing.
bool Proxy::appear() {
    const double room = settings().radius * (1.0 - 1e-3);
    present_ = sphere_.surroundings.has_room(sphere_.position, room) &&
               !is_inside_one_sided(scene(), sphere_.position, settings().mask, sphere_.work());
    sphere_.contacts_hold = false;
    return present_;
}

// Where nothing can be in the way, there is nothing to do.
bool Proxy::fly(const Vec3& hand) {
    const double way = glm::length(hand - sphere_.position);
    if (!sphere_.surroundings.is_clear(way)) {
        return false;
    }
    sphere_.position = hand;
    sphere_.surroundings.travelled(way);
    sphere_.contacts_hold = false;
    hold_.friction.recall(false, 0.0);
    hold_.touching.clear();
    return true;
}

// Up to the hand, or as near as the surfaces let it be. `given_way`: of the hand and of what carries the
// proxy since the last tick (unit: meters). `changed`: what it touched then may not be there any more.
void Proxy::follow(const Vec3& hand, double given_way, bool changed, double seconds, ProxyTick& tick) {
    const Vec3 start = sphere_.position;
    const bool touched = hold_.touching.count > 0;
    if (changed) {
        hold_.touching.clear();
        hold_.crowd.scene_has_changed();
    }
    const DescentEnd end = fly(hand) ? DescentEnd{} : Descent(sphere_, hold_, hand, given_way).go(seconds);
    tick.steps = end.steps;
    tick.residual = end.residual;
    tick.slide = end.slide;
    const bool overlapped = std::exchange(overlaps_, end.overlaps);
    const bool was_unfinished = std::exchange(unfinished_, end.is_unfinished);
    const bool touches = hold_.touching.count > 0;
    const bool slipped = (touched || touches) && glm::distance(sphere_.position, start) >
                                                     max_sensitivity * given_way + sphere_.tolerances().reach;
    tick.jumped = tick.jumped || slipped || overlapped || overlaps_ || unfinished_ || was_unfinished;
    const bool lets_out_of_squeeze = passed().any(PassedBecause::squeezes);
    const auto say = [&](ProxyStatus status, bool holds) { tick.status |= holds ? status : 0u; };
    say(proxy_touching, touches);
    say(proxy_sliding, hold_.friction.is_sliding());
    say(proxy_unfinished, unfinished_);
    say(proxy_squeezed, overlaps_ || lets_out_of_squeeze);
    say(proxy_letting_out, lets_out_of_squeeze || passed().any(PassedBecause::overlaps));
}

ProxyTick Proxy::move(const TouchScene& scene, const Vec3& given_hand, double seconds) {
    ProxyTick tick;
    Surroundings& surroundings = sphere_.surroundings;
    sphere_.scene = &scene;
    const Vec3 hand_before = std::exchange(hand_, is_hand_place(given_hand) ? given_hand : hand_);
    if (!present_) {
        sphere_.put(hand_);
    }
    const ProxySettings& set = settings();
    const bool changed = surroundings.begin_tick(scene, sphere_.position, set.radius, set.mask,
                                                 WorkBudget(set.max_work, set.max_work / 8));
    sphere_.contacts_hold = sphere_.contacts_hold && !changed && surroundings.saw_all();
    const bool was_present = present_;
    tick.jumped = take_in_jumps();
    const double ridden = present_ && !scene.is_still() ? ride_along(tick) : 0.0;
    tick.jumped = tick.jumped || ridden > std::max(max_ride, set.radius);
    const double given_way = glm::distance(hand_, hand_before) + ridden;
    if (was_present && !present_) {
        sphere_.put(hand_);
        tick.jumped = true;
    }
    const bool appears = !present_ && appear();
    if (present_) {
        surroundings.make_sure(sphere_.position);
        follow(hand_, given_way, changed, seconds, tick);
    }
    // The work may have ended before it was lifted out of what it begins too deep in: it begins later, then.
    if (appears && sphere_.contacts_hold &&
        (sphere_.contacts.min_gap() < -sphere_.tolerances().skin || !surroundings.saw_all())) {
        restart();
        sphere_.put(hand_);
        tick = {};
    }
    if (!present_) {
        hold_.touching.clear();
        tick.status |= proxy_absent;
    }
    tick.position = sphere_.position;
    return tick;
}

// Whether the force may change although neither hand nor bodies have moved.
bool Proxy::take_in_jumps() {
    const bool missed = scene().ticks() > std::exchange(scene_ticks_, scene().ticks()) + 1;
    const bool other_sphere =
        settings().radius != settled_.radius || settings().mask != settled_.mask || missed;
    const std::uint64_t since = std::exchange(revision_, scene().revision());
    const bool other_material =
        std::exchange(material_changes_, scene().material_changes()) != scene().material_changes();
    settled_ = settings();
    if (!other_sphere && since == revision_) {
        return other_material;
    }
    if (present_) {
        let_go(let_out(scene(), since, other_sphere, touching_sphere(), passed(), sphere_.work()));
    }
    return other_sphere || other_material || !scene().only_gives_since(since);
}

// Where more bodies stand in the way than can be passed one by one, nothing is touched until there is room.
void Proxy::let_go(bool every) {
    present_ = present_ && every;
    sphere_.contacts_hold = false;
}

}  // namespace tactus
