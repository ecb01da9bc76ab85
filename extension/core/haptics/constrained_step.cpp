#include "core/haptics/constrained_step.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/nearest_in_halfspaces.hpp"
#include "core/haptics/surroundings.hpp"

namespace tactus {

namespace {

using HalfSpaces = std::array<HalfSpace, ContactList::capacity>;

// Below this the curved problem has no minimum nearby (the hand is beyond the centre of curvature, or close to it), and
// the flat step finds the way down.
constexpr double least_curvature = 0.02;

// (sum of pressure * bend) applied to a vector: what the surfaces' curvature takes from the distance's own.
Vec3 bend_times(std::span<const Contact> contacts, const ConstrainedStep& step, const Vec3& v) {
    Vec3 result(0.0);
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts[static_cast<std::size_t>(step.pressing[i])];
        const Vec3 w = glm::cross(contact.normal, contact.u);
        result += step.pressure[i] * (contact.bend_u * glm::dot(contact.u, v) * contact.u +
                                      contact.bend_v * glm::dot(w, v) * w);
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

// The Newton step in the directions that the pressing planes leave free: W = I - sum pressure * bend,
// (F^T W F) y = F^T (pull - W base), motion = base + F y, for an orthonormal basis F of the free directions.
// Returns false where W is not safely positive there.
bool newton_on_plane(const Vec3& pull, std::span<const Contact> contacts, const ConstrainedStep& flat, const Vec3& base,
                     Vec3& motion) {
    const Contact& contact = contacts[static_cast<std::size_t>(flat.pressing[0])];
    const Vec3& u = contact.u;
    const Vec3 v = glm::cross(contact.normal, u);
    // With one contact W is diagonal in its own principal directions, and base is along the normal, which does not bend.
    const double along_u = 1.0 - flat.pressure[0] * contact.bend_u;
    const double along_v = 1.0 - flat.pressure[0] * contact.bend_v;
    if (along_u < least_curvature || along_v < least_curvature) {
        return false;
    }
    motion = base + u * (glm::dot(u, pull) / along_u) + v * (glm::dot(v, pull) / along_v);
    return true;
}

bool newton_on_line(const Vec3& pull, std::span<const Contact> contacts, const ConstrainedStep& flat, const Vec3& base,
                    Vec3& motion) {
    const Vec3 across = glm::cross(contacts[static_cast<std::size_t>(flat.pressing[0])].normal,
                                   contacts[static_cast<std::size_t>(flat.pressing[1])].normal);
    const double sine = glm::length(across);
    if (sine < 1e-9) {
        return false;
    }
    const Vec3 direction = across / sine;
    const double curvature = 1.0 - glm::dot(direction, bend_times(contacts, flat, direction));
    if (curvature < least_curvature) {
        return false;
    }
    const Vec3 residual = pull - base + bend_times(contacts, flat, base);
    motion = base + direction * (glm::dot(direction, residual) / curvature);
    return true;
}

bool is_free(const Vec3& motion, std::span<const HalfSpace> planes, double tolerance) {
    for (const HalfSpace& plane : planes) {
        if (glm::dot(plane.normal, motion) < plane.offset - tolerance) {
            return false;
        }
    }
    return true;
}

// A full curved step must stay where the second-order picture holds: within the smallest radius of curvature at hand.
bool is_trusted(const Vec3& motion, std::span<const Contact> contacts, const ConstrainedStep& step) {
    const double squared_length = glm::dot(motion, motion);
    for (int i = 0; i < step.pressing_count; ++i) {
        const Contact& contact = contacts[static_cast<std::size_t>(step.pressing[i])];
        const double bend = std::max(contact.bend_u, contact.bend_v);
        if (squared_length * bend * bend > 0.25) {
            return false;
        }
    }
    return true;
}

}  // namespace

ConstrainedStep constrained_step(const Vec3& pull, std::span<const Contact> contacts, double tolerance) {
    ConstrainedStep step;
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
    // The part of the flat step that only meets the pressing planes, without moving along them.
    Vec3 base(0.0);
    Vec3 curved;
    bool found = false;
    if (step.pressing_count == 1) {
        const HalfSpace& plane = planes[static_cast<std::size_t>(step.pressing[0])];
        base = plane.normal * plane.offset;
        found = newton_on_plane(pull, contacts, step, base, curved);
    } else {
        const HalfSpace& p = planes[static_cast<std::size_t>(step.pressing[0])];
        const HalfSpace& q = planes[static_cast<std::size_t>(step.pressing[1])];
        const double cosine = glm::dot(p.normal, q.normal);
        const double squared_sine = 1.0 - cosine * cosine;
        if (squared_sine > 1e-18) {
            base = (p.normal * (p.offset - cosine * q.offset) + q.normal * (q.offset - cosine * p.offset)) / squared_sine;
            found = newton_on_line(pull, contacts, step, base, curved);
        }
    }
    if (found && is_free(curved, planes, tolerance) && is_trusted(curved - base, contacts, step)) {
        step.motion = curved;
    }
    return step;
}

}  // namespace tactus
