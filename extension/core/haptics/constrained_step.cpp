#include "core/haptics/constrained_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "core/haptics/nearest_in_halfspaces.hpp"

namespace tactus {

namespace {

static_assert(ContactList::capacity <= most_halfspaces);

using HalfSpaces = std::array<HalfSpace, ContactList::capacity>;

const Contact& pressing(const ContactList& contacts, const ConstrainedStep& step, int i) {
    return contacts.items[static_cast<std::size_t>(step.pressing[i])];
}

// How far along the unit vector `direction` the bends of the contact are true.
double belief(const ContactList& contacts, const Contact& contact, const Vec3& direction) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const SurfaceEnd& end : contacts.ends_of(contact)) {
        const double approach = glm::dot(end.direction, direction);
        if (approach * shortest > end.room) {
            shortest = end.room / approach;
        }
    }
    // A little beyond the end, where what comes next is seen clearly.
    return 1.001 * shortest;
}

// What of `motion` is along all the surfaces that hold the proxy back.
Vec3 along_surfaces(const Vec3& motion, const ContactList& contacts, const ConstrainedStep& step) {
    if (step.pressing_count == 0 || step.pressing_count == 3) {
        return step.pressing_count == 0 ? motion : Vec3(0.0);
    }
    const Vec3& normal = pressing(contacts, step, 0).normal;
    if (step.pressing_count == 1) {
        return motion - normal * glm::dot(normal, motion);
    }
    const Vec3 line = glm::cross(normal, pressing(contacts, step, 1).normal);
    return line * (glm::dot(line, motion) / std::max(glm::dot(line, line), 1e-300));
}

// The step along one direction of a surface that bends there with the given radius: `pull` > 0 is what is
// left to go, `curvature` that of the Lagrangian, W = 1 - pressure / radius.
//
// On a cylinder or sphere the Newton step pull / W ends exactly above the nearest place: with the hand at
// depth d from the axis it is rho tan(angle). From 90 degrees on (W <= 0) there is no resting place on this
// surface, only a way around it, in steps of half its radius at most. A fine mesh is round by many small
// edges: each is believed in up to where it ends. A flat step is always right.
double step_along(double pull, double curvature, double radius, double belief) {
    const double newton = curvature > 0.0 ? std::min(pull / curvature, 2.0 * radius) : 0.5 * radius;
    return std::max(pull, std::min(newton, belief));
}

// (sum of pressure * bend) applied to a vector: what the surfaces' curvature takes from the distance's own.
Vec3 bend_times(const ContactList& contacts, const ConstrainedStep& step, const Vec3& v) {
    Vec3 result(0.0);
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = pressing(contacts, step, i);
        const Vec3 w = glm::cross(contact.normal, contact.u);
        result += step.pressure[i] *
                  (contact.bend_u * glm::dot(contact.u, v) * contact.u + contact.bend_v * glm::dot(w, v) * w);
    }
    return result;
}

bool bends(const ContactList& contacts, const ConstrainedStep& step) {
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = pressing(contacts, step, i);
        if (contact.bend_u > 0.0 || contact.bend_v > 0.0) {
            return true;
        }
    }
    return false;
}

// One contact: its principal directions are independent of each other.
Vec3 step_on_surface(const Vec3& pull, const ContactList& contacts, const Contact& contact, double pressure,
                     double least) {
    const Vec3 v = glm::cross(contact.normal, contact.u);
    const auto along = [&](const Vec3& axis, double bend) {
        const double wanted = glm::dot(axis, pull);
        const Vec3 direction = wanted < 0.0 ? -axis : axis;
        if (std::abs(wanted) <= least || bend <= 0.0) {
            return std::abs(wanted) <= least ? Vec3(0.0) : axis * wanted;
        }
        return direction * step_along(std::abs(wanted), 1.0 - pressure * bend, 1.0 / bend,
                                      belief(contacts, contact, direction));
    };
    if (contact.bend_u == contact.bend_v) {  // a corner, a ball: any direction is principal
        const Vec3 across = contact.u * glm::dot(contact.u, pull) + v * glm::dot(v, pull);
        const double length = glm::length(across);
        return length > 0.0 ? along(across / length, contact.bend_u) : Vec3(0.0);
    }
    return along(contact.u, contact.bend_u) + along(v, contact.bend_v);
}

// Two contacts: along the line that both leave free. `base` meets both planes.
Vec3 step_on_line(const Vec3& pull, const ContactList& contacts, const ConstrainedStep& flat,
                  const Vec3& line, const Vec3& base, double least) {
    const double wanted = glm::dot(line, pull - base + bend_times(contacts, flat, base));
    const Vec3 direction = wanted < 0.0 ? -line : line;
    if (std::abs(wanted) <= least) {
        return Vec3(0.0);
    }
    const double curvature = 1.0 - glm::dot(direction, bend_times(contacts, flat, direction));
    const Contact& p = pressing(contacts, flat, 0);
    const Contact& q = pressing(contacts, flat, 1);
    const double radius = 1.0 / std::max({p.bend_u, p.bend_v, q.bend_u, q.bend_v});
    return direction * step_along(std::abs(wanted), curvature, radius,
                                  std::min(belief(contacts, p, direction), belief(contacts, q, direction)));
}

bool is_free(const Vec3& motion, std::span<const HalfSpace> planes, double tolerance) {
    for (const HalfSpace& plane : planes) {
        if (glm::dot(plane.normal, motion) < plane.offset - tolerance) {
            return false;
        }
    }
    return true;
}

NearestInHalfSpaces nearest_free(const Vec3& pull, std::span<HalfSpace> planes, double tolerance) {
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
    return nearest;
}

std::span<HalfSpace> half_spaces(const ContactList& contacts, HalfSpaces& storage) {
    for (std::size_t i = 0; i < contacts.all().size(); ++i) {
        storage[i] = {contacts.items[i].normal, -contacts.items[i].gap};
    }
    return {storage.data(), contacts.all().size()};
}

}  // namespace

Vec3 lift_to_rest(const ContactList& contacts, double tolerance) {
    HalfSpaces storage;
    return nearest_free(Vec3(0.0), half_spaces(contacts, storage), tolerance).point;
}

ConstrainedStep constrained_step(const Vec3& pull, const ContactList& contacts, double tolerance) {
    ConstrainedStep step;
    step.motion = pull;
    if (contacts.count == 0) {
        return step;
    }
    HalfSpaces storage;
    const std::span<HalfSpace> planes = half_spaces(contacts, storage);
    const NearestInHalfSpaces nearest = nearest_free(pull, planes, tolerance);
    step.motion = nearest.point;
    for (int i = 0; i < nearest.active_count; ++i) {
        if (nearest.multiplier[i] > 0.0) {
            step.pressing[step.pressing_count] = nearest.active[i];
            step.pressure[step.pressing_count++] = nearest.multiplier[i];
        }
    }
    step.slide = along_surfaces(nearest.point, contacts, step);
    step.drop = nearest.point - step.slide;
    if (step.pressing_count == 0 || step.pressing_count == 3 || !bends(contacts, step)) {
        return step;
    }
    const HalfSpace& p = planes[static_cast<std::size_t>(step.pressing[0])];
    Vec3 curved;
    if (step.pressing_count == 1) {
        curved = p.normal * p.offset +
                 step_on_surface(pull, contacts, pressing(contacts, step, 0), step.pressure[0], tolerance);
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
        curved = base + step_on_line(pull, contacts, step, across / std::sqrt(squared_sine), base, tolerance);
    }
    if (is_free(curved, planes, tolerance)) {
        step.motion = curved;
    }
    return step;
}

}  // namespace tactus
