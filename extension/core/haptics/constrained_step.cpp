#include "core/haptics/constrained_step.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/nearest_in_halfspaces.hpp"
#include "core/haptics/surroundings.hpp"

namespace tactus {

namespace {

using HalfSpaces = std::array<HalfSpace, ContactList::capacity>;

// The step along one direction of a surface that bends there: `pull` is what is left to go in that direction,
// `bend` the second derivative of the distance, `pressure` what the contact holds back.
//
// The Lagrangian bends by W = 1 - pressure * bend. On a cylinder or sphere the Newton step pull / W ends
// exactly above the nearest place: with the hand at depth d from the axis it is rho tan(angle). From 90
// degrees on (W <= 0) there is no resting place on this surface, only a way around it, in steps of half its
// radius at most.
double step_along(double pull, double bend, double pressure, double stretch) {
    const double curvature = 1.0 - pressure * bend;
    const double longest =
        std::max(std::abs(pull), std::min(stretch * std::abs(pull), bend > 0.0 ? 0.5 / bend : 0.0));
    const double newton = curvature > 0.0 ? std::abs(pull) / curvature : longest;
    return std::copysign(std::min(newton, longest), pull);
}

// A fine mesh is round by many small edges: a Newton step that believes in the first of them would be far too
// long. So a surface is believed for one flat step, and for twice as much each time the proxy comes down on
// the same one again.
void lengthen(Stretch& stretch, const Contact& contact) {
    const Vec3 moved = contact.pivot - stretch.pivot;
    const Vec3 v = glm::cross(contact.normal, contact.u);
    const double same = 1e-3 / std::max(contact.bend_u, contact.bend_v);
    const bool across_u = contact.bend_u > 0.0 && std::abs(glm::dot(contact.u, moved)) > same;
    const bool across_v = contact.bend_v > 0.0 && std::abs(glm::dot(v, moved)) > same;
    constexpr double longest = 1e6;
    stretch.factor = across_u || across_v ? 1.0 : std::min(2.0 * stretch.factor, longest);
    stretch.pivot = contact.pivot;
}

// (sum of pressure * bend) applied to a vector: what the surfaces' curvature takes from the distance's own.
Vec3 bend_times(std::span<const Contact> contacts, const ConstrainedStep& step, const Vec3& v) {
    Vec3 result(0.0);
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts[static_cast<std::size_t>(step.pressing[i])];
        const Vec3 w = glm::cross(contact.normal, contact.u);
        result += step.pressure[i] *
                  (contact.bend_u * glm::dot(contact.u, v) * contact.u + contact.bend_v * glm::dot(w, v) * w);
    }
    return result;
}

bool bends(std::span<const Contact> contacts, const ConstrainedStep& step) {
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts[static_cast<std::size_t>(step.pressing[i])];
        if (contact.bend_u > 0.0 || contact.bend_v > 0.0) {
            return true;
        }
    }
    return false;
}

// One contact: its principal directions are independent of each other.
Vec3 step_on_surface(const Vec3& pull, const Contact& contact, double pressure, double least,
                     double stretch) {
    const Vec3 v = glm::cross(contact.normal, contact.u);
    const double pull_u = glm::dot(contact.u, pull);
    const double pull_v = glm::dot(v, pull);
    if (contact.bend_u == contact.bend_v) {  // a corner, a ball: any direction is principal
        const double length = std::hypot(pull_u, pull_v);
        return length > least ? (contact.u * pull_u + v * pull_v) *
                                    (step_along(length, contact.bend_u, pressure, stretch) / length)
                              : Vec3(0.0);
    }
    const double along_u =
        std::abs(pull_u) > least ? step_along(pull_u, contact.bend_u, pressure, stretch) : 0.0;
    const double along_v =
        std::abs(pull_v) > least ? step_along(pull_v, contact.bend_v, pressure, stretch) : 0.0;
    return contact.u * along_u + v * along_v;
}

// Two contacts: along the line that both leave free. `base` meets both planes.
Vec3 step_on_line(const Vec3& pull, std::span<const Contact> contacts, const ConstrainedStep& flat,
                  const Vec3& direction, const Vec3& base, double least, double stretch) {
    const Vec3 residual = pull - base + bend_times(contacts, flat, base);
    const double along = glm::dot(direction, residual);
    const double bend = glm::dot(direction, bend_times(contacts, flat, direction));
    return std::abs(along) > least ? direction * step_along(along, bend, 1.0, stretch) : Vec3(0.0);
}

bool is_free(const Vec3& motion, std::span<const HalfSpace> planes, double tolerance) {
    for (const HalfSpace& plane : planes) {
        if (glm::dot(plane.normal, motion) < plane.offset - tolerance) {
            return false;
        }
    }
    return true;
}

}  // namespace

ConstrainedStep constrained_step(const Vec3& pull, std::span<const Contact> contacts, double tolerance,
                                 Stretch& stretch) {
    ConstrainedStep step;
    step.motion = pull;
    if (contacts.empty()) {
        return step;
    }
    HalfSpaces storage;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        storage[i] = {contacts[i].normal, -contacts[i].gap};
    }
    const std::span<HalfSpace> planes(storage.data(), contacts.size());
    NearestInHalfSpaces nearest = nearest_in_halfspaces(pull, planes, tolerance);
    if (!nearest.feasible) {
        // Contacts a hair below rest in a narrow place: do not try to lift off all of them at once.
        for (HalfSpace& plane : planes) {
            plane.offset = std::min(plane.offset, 0.0);
        }
        nearest = nearest_in_halfspaces(pull, planes, tolerance);
        if (!nearest.feasible) {
            nearest.point = Vec3(0.0);
        }
    }
    step.motion = nearest.point;
    step.slide = nearest.point;
    for (int i = 0; i < nearest.active_count; ++i) {
        if (nearest.multiplier[i] > 0.0) {
            step.pressing[step.pressing_count] = nearest.active[i];
            step.pressure[step.pressing_count++] = nearest.multiplier[i];
        }
    }
    if (step.pressing_count == 0 || step.pressing_count == 3 || !bends(contacts, step)) {
        return step;
    }
    const int strongest = step.pressing_count == 2 && step.pressure[1] > step.pressure[0] ? 1 : 0;
    lengthen(stretch, contacts[static_cast<std::size_t>(step.pressing[strongest])]);
    const HalfSpace& p = planes[static_cast<std::size_t>(step.pressing[0])];
    Vec3 curved;
    if (step.pressing_count == 1) {
        const Contact& contact = contacts[static_cast<std::size_t>(step.pressing[0])];
        curved =
            p.normal * p.offset + step_on_surface(pull, contact, step.pressure[0], tolerance, stretch.factor);
    } else {
        const HalfSpace& q = planes[static_cast<std::size_t>(step.pressing[1])];
        const Vec3 across = glm::cross(p.normal, q.normal);
        const double squared_sine = glm::dot(across, across);
        if (squared_sine < 1e-18) {
            return step;
        }
        const double cosine = glm::dot(p.normal, q.normal);
        const Vec3 base =
            (p.normal * (p.offset - cosine * q.offset) + q.normal * (q.offset - cosine * p.offset)) /
            squared_sine;
        curved = base + step_on_line(pull, contacts, step, across / std::sqrt(squared_sine), base, tolerance,
                                     stretch.factor);
    }
    if (is_free(curved, planes, tolerance)) {
        step.motion = curved;
    }
    return step;
}

}  // namespace tactus
