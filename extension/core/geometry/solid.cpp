#include "core/geometry/solid.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/math/perpendicular.hpp"

namespace tactus {

namespace {

constexpr double tiny = 1e-150;  // lengths below it have no direction

// Around a single point (a corner, the end of a capsule) the distance bends equally in every direction.
SolidDistance from_point(const Vec3& offset, double inflation) {
    const double length = glm::length(offset);
    SolidDistance result;
    result.distance = length - inflation;
    if (length > tiny) {
        result.normal = offset / length;
        result.bend_u = result.bend_v = 1.0 / length;
    }
    result.u = any_perpendicular(result.normal);
    return result;
}

// Around a line along `axis` (an edge, the side of a capsule) it bends across the line only.
SolidDistance from_line(const Vec3& offset, const Vec3& axis, double inflation) {
    SolidDistance result = from_point(offset, inflation);
    result.u = glm::cross(result.normal, axis);
    const double length = glm::length(result.u);
    result.u = length > 0.5 ? result.u / length : any_perpendicular(result.normal);
    result.bend_v = 0.0;
    return result;
}

SolidDistance from_plane(double distance, const Vec3& normal) {
    SolidDistance result;
    result.distance = distance;
    result.normal = normal;
    result.u = any_perpendicular(normal);
    return result;
}

void add_end(SolidDistance& at, const Vec3& direction, double room) {
    at.ends[static_cast<std::size_t>(at.end_count++)] = {direction, room};
}

SolidDistance distance_to(const SphereShape& sphere, const Vec3& p) {
    return from_point(p, sphere.radius);
}

SolidDistance distance_to(const CapsuleShape& capsule, const Vec3& p) {
    if (std::abs(p.y) <= capsule.half_segment) {
        return from_line({p.x, 0.0, p.z}, {0.0, 1.0, 0.0}, capsule.radius);
    }
    return from_point(p - Vec3(0.0, std::copysign(capsule.half_segment, p.y), 0.0), capsule.radius);
}

SolidDistance distance_to(const PlaneShape& plane, const Vec3& p) {
    return from_plane(glm::dot(plane.normal, p) - plane.offset, plane.normal);
}

SolidDistance distance_to(const BoxShape& box, const Vec3& p) {
    const Vec3 offset = p - glm::clamp(p, -box.half_extents, box.half_extents);
    int outside = 0;
    int inside_axis = 0;
    int outside_axis = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const bool out = offset[axis] != 0.0;
        outside += out;
        (out ? outside_axis : inside_axis) = axis;
    }
    Vec3 direction(0.0);
    if (outside >= 2) {
        direction[inside_axis] = 1.0;
        SolidDistance result = outside == 3 ? from_point(offset, 0.0) : from_line(offset, direction, 0.0);
        for (int axis = 0; axis < 3; ++axis) {
            if (offset[axis] != 0.0) {
                Vec3 inward(0.0);
                inward[axis] = -std::copysign(1.0, offset[axis]);
                add_end(result, inward, std::abs(offset[axis]));
            }
        }
        return result;
    }
    if (outside == 1) {
        direction[outside_axis] = std::copysign(1.0, offset[outside_axis]);
        return from_plane(std::abs(offset[outside_axis]), direction);
    }
    int nearest = 0;
    for (int axis = 1; axis < 3; ++axis) {
        if (box.half_extents[axis] - std::abs(p[axis]) < box.half_extents[nearest] - std::abs(p[nearest])) {
            nearest = axis;
        }
    }
    direction[nearest] = std::copysign(1.0, p[nearest]);
    return from_plane(std::abs(p[nearest]) - box.half_extents[nearest], direction);
}

SolidDistance distance_to(const CylinderShape& cylinder, const Vec3& p) {
    const double radial = std::hypot(p.x, p.z);
    const Vec3 outward = radial > tiny ? Vec3(p.x / radial, 0.0, p.z / radial) : Vec3(1.0, 0.0, 0.0);
    const Vec3 around(-outward.z, 0.0, outward.x);
    const Vec3 up(0.0, std::copysign(1.0, p.y), 0.0);
    const double beyond_side = radial - cylinder.radius;
    const double beyond_cap = std::abs(p.y) - cylinder.half_height;
    SolidDistance result;
    result.u = around;
    if (beyond_side > 0.0 && beyond_cap > 0.0) {  // the rim: a circle of the cylinder's radius
        result.distance = std::hypot(beyond_side, beyond_cap);
        result.normal = (outward * beyond_side + up * beyond_cap) / result.distance;
        result.bend_u = beyond_side / (result.distance * radial);
        result.bend_v = 1.0 / result.distance;
        add_end(result, -outward, beyond_side);
        add_end(result, -up, beyond_cap);
    } else if (beyond_side > beyond_cap) {
        result.distance = beyond_side;
        result.normal = outward;
        result.bend_u = radial > tiny ? 1.0 / radial : 0.0;
    } else {
        result.distance = beyond_cap;
        result.normal = up;
    }
    return result;
}

}  // namespace

SolidDistance distance_to_solid(const Solid& solid, const Vec3& point) {
    return std::visit([&](const auto& shape) { return distance_to(shape, point); }, solid);
}

Hit sweep_to_solid(const Solid& solid, const SphereWay& way, double limit, WorkBudget& work) {
    constexpr int max_iterations = 48;
    Hit hit;
    hit.found = true;
    hit.t = 0.0;
    for (int i = 0; i < max_iterations; ++i) {
        work.spend(cost::solid_look);
        const SolidDistance at = distance_to_solid(solid, way.start + way.motion * hit.t);
        const double rate = glm::dot(at.normal, way.motion);
        const double gap = at.distance - way.distance;
        if (rate < 0.0 && gap <= way.slack) {
            return hit;
        }
        hit.t = rate < 0.0 ? hit.t - gap / rate : limit;
        if (rate >= 0.0 || !(hit.t <= limit)) {
            hit.t = limit;
            hit.found = false;
            return hit;
        }
    }
    return hit;
}

double bounding_radius(const Solid& solid) {
    struct Radius {
        double operator()(const SphereShape& s) const { return s.radius; }
        double operator()(const BoxShape& b) const { return glm::length(b.half_extents); }
        double operator()(const CapsuleShape& c) const { return c.half_segment + c.radius; }
        double operator()(const CylinderShape& c) const { return std::hypot(c.radius, c.half_height); }
        double operator()(const PlaneShape&) const { return std::numeric_limits<double>::infinity(); }
    };
    return std::visit(Radius{}, solid);
}

}  // namespace tactus
