#include "core/proxy/constrained_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "core/proxy/nearest_in_halfspaces.hpp"

namespace tactus {

namespace {

static_assert(ContactList::capacity <= max_halfspaces);

constexpr double least_bent_share = 1e-3;  // of a bent step, where contacts stand in its way

// The contacts that count, as the solver takes them.
struct HalfSpaces {
    std::array<HalfSpace, ContactList::capacity> planes;
    std::array<int, ContactList::capacity> contact;  // which each one is
    std::size_t count = 0;

    explicit HalfSpaces(const ContactList& contacts) {
        for (int i = 0; i < contacts.count; ++i) {
            if (contacts[i].state != ContactState::covered) {
                planes[count] = {contacts[i].normal, -contacts[i].gap};
                contact[count++] = i;
            }
        }
    }
    std::span<HalfSpace> all() { return {planes.data(), count}; }
};

const Contact& pressing(const ContactList& contacts, const ConstrainedStep& step, int i) {
    return contacts[step.pressing[i]];
}

// How far along the unit vector `direction` the bends of the contact are true.
double belief(const Curvature& curvature, const Vec3& direction) {
    double shortest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < curvature.end_count; ++i) {
        const SurfaceEnd& end = curvature.ends[static_cast<std::size_t>(i)];
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

// A bent surface at a pressing contact.
struct Bend {
    Vec3 normal, u, v;
    double pressure;
    const Curvature* curvature;
};

// (sum of pressure * bend) applied to a vector: what the surfaces' curvature takes from the distance's own.
Vec3 bend_times(std::span<const Bend> bends, const Vec3& x) {
    Vec3 result(0.0);
    for (const Bend& b : bends) {
        result += b.pressure * (b.curvature->bend_u * glm::dot(b.u, x) * b.u +
                                b.curvature->bend_v * glm::dot(b.v, x) * b.v);
    }
    return result;
}

// One contact: its principal directions are independent of each other.
Vec3 step_on_surface(const Vec3& pull, const Bend& at, double least, double trust) {
    const auto along = [&](const Vec3& axis, double bend) {
        const double wanted = glm::dot(axis, pull);
        const Vec3 direction = wanted < 0.0 ? -axis : axis;
        if (std::abs(wanted) <= least || bend <= 0.0) {
            return std::abs(wanted) <= least ? Vec3(0.0) : axis * wanted;
        }
        return direction * step_along(std::abs(wanted), 1.0 - at.pressure * bend, 1.0 / bend,
                                      std::min(trust, belief(*at.curvature, direction)));
    };
    if (at.curvature->bend_u == at.curvature->bend_v) {  // a corner, a ball: any direction is principal
        const Vec3 across = at.u * glm::dot(at.u, pull) + at.v * glm::dot(at.v, pull);
        const double length = glm::length(across);
        return length > 0.0 ? along(across / length, at.curvature->bend_u) : Vec3(0.0);
    }
    return along(at.u, at.curvature->bend_u) + along(at.v, at.curvature->bend_v);
}

// Two contacts: along the line that both leave free. `base` meets both planes.
Vec3 step_on_line(const Vec3& pull, std::span<const Bend, 2> bends, const Vec3& line, const Vec3& base,
                  double least, double trust) {
    const double wanted = glm::dot(line, pull - base + bend_times(bends, base));
    const Vec3 direction = wanted < 0.0 ? -line : line;
    if (std::abs(wanted) <= least) {
        return Vec3(0.0);
    }
    const double curvature = 1.0 - glm::dot(direction, bend_times(bends, direction));
    const Curvature& p = *bends[0].curvature;
    const Curvature& q = *bends[1].curvature;
    const double radius = 1.0 / std::max({p.bend_u, p.bend_v, q.bend_u, q.bend_v});
    return direction * step_along(std::abs(wanted), curvature, radius,
                                  std::min({trust, belief(p, direction), belief(q, direction)}));
}

NearestInHalfSpaces nearest_free(const Vec3& pull, std::span<HalfSpace> planes, double tolerance,
                                 WorkBudget& work) {
    NearestInHalfSpaces nearest = nearest_in_halfspaces(pull, planes, tolerance, work);
    if (!nearest.feasible) {
        // Contacts a hair below rest in a narrow place: do not try to lift off all of them at once.
        for (HalfSpace& plane : planes) {
            plane.offset = std::min(plane.offset, 0.0);
        }
        nearest = nearest_in_halfspaces(pull, planes, tolerance, work);
        if (!nearest.feasible) {
            nearest.point = Vec3(0.0);
        }
    }
    return nearest;
}

// Of the contact's plane.
bool ends_in_front(const Vec3& motion, const Contact& contact, double tolerance) {
    return glm::dot(contact.normal, motion) >= -contact.gap - tolerance;
}

// Whether a straight way is free of the contact, as far as that is known. A face is its plane. Beside an edge
// or corner there is room: a sphere's centre is on a sphere around the point that it touches, which falls
// away from the plane by x^2 / 2r after x. The way begins at the gap g, and is above that sphere by g - f t +
// h t^2 after the share t of itself, with f what it leads down and h = length^2 / 2r. An edge falls away less
// along itself, so a way may be called free that is not: the sweep tells.
bool leads_past(const Vec3& motion, const Contact& contact, double radius, double tolerance) {
    if (contact.state == ContactState::covered || ends_in_front(motion, contact, tolerance)) {
        return true;
    }
    if (contact.state == ContactState::face || contact.state == ContactState::solid) {
        return false;
    }
    const double fall = -glm::dot(contact.normal, motion);
    const double height = 0.5 * glm::dot(motion, motion) / radius;
    const double lowest = std::min(1.0, 0.5 * fall / height);
    return contact.gap - (fall - height * lowest) * lowest >= -tolerance;
}

}  // namespace

bool stays_in_front_of_all(const Vec3& motion, const ContactList& contacts, double tolerance) {
    return std::ranges::all_of(
        contacts.all(), [&](const Contact& contact) { return ends_in_front(motion, contact, tolerance); });
}

Vec3 lift_to_rest(const ContactList& contacts, double tolerance, WorkBudget& work) {
    HalfSpaces planes(contacts);
    return nearest_free(Vec3(0.0), planes.all(), tolerance, work).point;
}

ConstrainedStep flat_step(const Vec3& pull, const ContactList& contacts, double tolerance, WorkBudget& work) {
    ConstrainedStep step;
    step.motion = pull;
    HalfSpaces planes(contacts);
    const NearestInHalfSpaces nearest = nearest_free(pull, planes.all(), tolerance, work);
    step.motion = nearest.point;
    for (int i = 0; i < nearest.active_count; ++i) {
        if (nearest.multiplier[i] > 0.0) {
            step.pressing[step.pressing_count] = planes.contact[static_cast<std::size_t>(nearest.active[i])];
            step.pressure[step.pressing_count++] = nearest.multiplier[i];
        }
    }
    step.slide = along_surfaces(nearest.point, contacts, step);
    step.drop = nearest.point - step.slide;
    return step;
}

void bend_step(ConstrainedStep& step, const Vec3& pull, const ContactList& contacts,
               std::span<const Curvature> curvatures, const BendLimits& limits, WorkBudget& work) {
    const double tolerance = limits.tolerance;
    if (curvatures.empty() || std::ranges::all_of(curvatures, &Curvature::is_flat)) {
        return;
    }
    std::array<Bend, 2> bends;
    for (int i = 0; i < step.pressing_count; ++i) {
        const Curvature& curvature = curvatures[static_cast<std::size_t>(i)];
        const Vec3& normal = pressing(contacts, step, i).normal;
        bends[static_cast<std::size_t>(i)] = {normal, curvature.u, glm::cross(normal, curvature.u),
                                              step.pressure[i], &curvature};
    }
    const Contact& p = pressing(contacts, step, 0);
    Vec3 base;
    Vec3 along;
    if (step.pressing_count == 1) {
        base = -p.normal * p.gap;
        along = step_on_surface(pull, bends[0], tolerance, limits.trust);
    } else {
        const Contact& q = pressing(contacts, step, 1);
        const Vec3 across = glm::cross(p.normal, q.normal);
        const double squared_sine = glm::dot(across, across);
        if (squared_sine < 1e-18) {
            return;
        }
        const double cosine = glm::dot(p.normal, q.normal);
        base = -(p.normal * (p.gap - cosine * q.gap) + q.normal * (q.gap - cosine * p.gap)) / squared_sine;
        along = step_on_line(pull, bends, across / std::sqrt(squared_sine), base, tolerance, limits.trust);
    }
    // What stands in its way leaves half of it, or a quarter, as long as that is more than the flat step.
    const double least = glm::length(step.slide) / std::max(glm::length(along), 1e-300);
    for (double share = 1.0; share == 1.0 || share > std::max(least, least_bent_share); share *= 0.5) {
        work.spend(1 + contacts.count / 8);
        const Vec3 motion = base + along * share;
        if (std::ranges::all_of(contacts.all(), [&](const Contact& contact) {
                return leads_past(motion, contact, limits.radius, tolerance);
            })) {
            step.motion = motion;
            step.bent = true;
            return;
        }
    }
}

}  // namespace tactus
