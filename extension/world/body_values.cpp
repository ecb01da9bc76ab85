#include "world/body_values.hpp"

#include "core/haptics/touch_values.hpp"

namespace tactus {

namespace {

struct Row {
    bool (*same)(const BodyValues& a, const BodyValues& b);
    void (*send)(Session& session, SessionHandle body, const BodyValues& values);
    void (*put)(BodyAddition& addition, const BodyValues& values);  // null: a body is not made with it
};

using Values = BodyValues;
using Addition = BodyAddition;

constexpr Row rows[] = {
    {[](const Values& a, const Values& b) {
         return same_values(a.touch, b.touch) && same_detail(a.detail, b.detail);
     },
     [](Session& s, SessionHandle body, const Values& v) { s.set_touch_material(body, v.touch, v.detail); },
     [](Addition& to, const Values& v) {
         to.touch_material = v.touch;
         to.detail = v.detail;
     }},
    {[](const Values& a, const Values& b) {
         return a.surface.friction == b.surface.friction && a.surface.restitution == b.surface.restitution &&
                a.surface.rough == b.surface.rough && a.surface.absorbent == b.surface.absorbent;
     },
     [](Session& s, SessionHandle body, const Values& v) { s.set_body_surface(body, v.surface); },
     [](Addition& to, const Values& v) { to.description.material = v.surface; }},
    {[](const Values& a, const Values& b) {
         return a.layers.layer == b.layers.layer && a.layers.mask == b.layers.mask;
     },
     [](Session& s, SessionHandle body, const Values& v) { s.set_body_layers(body, v.layers); },
     [](Addition& to, const Values& v) { to.description.collision = v.layers; }},
    {[](const Values& a, const Values& b) { return a.motion == b.motion; },
     [](Session& s, SessionHandle body, const Values& v) { s.set_body_motion(body, v.motion); },
     [](Addition& to, const Values& v) { to.description.motion = v.motion; }},
    {[](const Values& a, const Values& b) { return a.gravity_scale == b.gravity_scale; },
     [](Session& s, SessionHandle body, const Values& v) { s.set_body_gravity_scale(body, v.gravity_scale); },
     [](Addition& to, const Values& v) { to.description.gravity_scale = v.gravity_scale; }},
    {[](const Values& a, const Values& b) {
         return a.linear_damping == b.linear_damping && a.angular_damping == b.angular_damping;
     },
     [](Session& s, SessionHandle body, const Values& v) {
         s.set_body_damping(body, v.linear_damping, v.angular_damping);
     },
     [](Addition& to, const Values& v) {
         to.description.linear_damping = v.linear_damping;
         to.description.angular_damping = v.angular_damping;
     }},
    {[](const Values& a, const Values& b) {
         return a.constant_force == b.constant_force && a.constant_torque == b.constant_torque;
     },
     [](Session& s, SessionHandle body, const Values& v) {
         s.set_body_push(body, v.constant_force, v.constant_torque);
     },
     nullptr},
};

}  // namespace

void put_into(BodyAddition& addition, const BodyValues& values) {
    for (const Row& row : rows) {
        if (row.put != nullptr) {
            row.put(addition, values);
        }
    }
}

void send_rest(Session& session, SessionHandle body, const BodyValues& values) {
    for (const Row& row : rows) {
        if (row.put == nullptr && !row.same(values, BodyValues{})) {
            row.send(session, body, values);
        }
    }
}

bool send_changes(Session& session, SessionHandle body, const BodyValues& before, const BodyValues& now) {
    bool is_described_anew = false;
    for (const Row& row : rows) {
        if (!row.same(before, now)) {
            row.send(session, body, now);
            is_described_anew = is_described_anew || row.put != nullptr;
        }
    }
    return is_described_anew;
}

}  // namespace tactus
