#include "session/carried_pointer.hpp"

#include <glm/geometric.hpp>

#include "core/teleop/stealth.hpp"

namespace tactus {

bool CarriedPointer::carry(SessionLoop& loop, const SessionLoop::ProxySlot& pressing,
                           const Resimulator::Target& target, const Pose& motion, bool turns,
                           double longest) {
    if (!apart_) {
        slot_.description = pressing.description;
        slot_.proxy->set_settings(pressing.description.settings);
        slot_.proxy->recall(pressing.proxy->memory());
        slot_.force = pressing.force;
        slot_.effects = pressing.effects;
        slot_.aids = pressing.aids;
        slot_.state = pressing.state;
    }
    Proxy& proxy = *slot_.proxy;
    if (!loop.rests_on(proxy, target.body)) {
        return false;
    }
    apart_ = true;
    const Pose& was = loop.scene().body(loop.body(target.body)->slot).previous;
    // It has not moved in this tick yet: it goes from where the body was to where it has been instead.
    const Pose before = target.previous_known ? displacement(was, target.previous) : motion;
    const Vec3 way = to_parent(motion, was.position) - was.position;
    proxy.displace(turns ? to_parent(before, proxy.position()) - proxy.position() : way);
    const Vec3 hand = pressing.hand + offset_;
    offset_ = turns ? to_parent(motion, hand) - pressing.hand : offset_ + way;
    if (const double length = glm::length(offset_); length > longest) {
        offset_ *= longest / length;
    }
    return true;
}

void CarriedPointer::touch(SessionLoop& loop, const SessionLoop::ProxySlot& pressing, Nanoseconds now) {
    slot_.hand = pressing.hand + offset_;
    slot_.hand_velocity = pressing.hand_velocity;
    slot_.force_before = slot_.force;
    slot_.field = pressing.field;
    if (pressing.parts.contact_count > 0) {
        slot_.proxy->set_sliding(pressing.sliding);
    }
    loop.touch(slot_, now);
}

void CarriedPointer::fade(double way) {
    offset_ = faded(offset_, way);
    apart_ = apart_ && offset_ != Vec3(0.0);
}

void CarriedPointer::forget() {
    offset_ = Vec3(0.0);
    apart_ = false;
}

}  // namespace tactus
