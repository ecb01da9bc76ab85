#include "world/scaled_shape.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/touch_shape.hpp"
#include "core/mesh/convex_hull.hpp"

namespace tactus {

namespace {

// How far two factors that should be equal may differ: an engine's single precision leaves about 1e-7 each.
constexpr double even = 1e-4;  // (dimensionless)

ShapeReading failure(std::string error) {
    return {{}, {}, std::move(error)};
}

ShapeReading one(Shape shape, const Pose& pose) {
    return {{PlacedShape{std::move(shape), pose}}, {}, {}};
}

// A shape without triangles is made in no time, so that what is wrong with its size shows at once.
ShapeReading one_solid(Shape shape, const Pose& pose) {
    ShapeReading reading = one(std::move(shape), pose);
    std::string error = make_touch_shape(reading.shapes).error;
    return error.empty() ? reading : failure(std::move(error));
}

// Scales a shape of one kind; the length of each axis after scaling is its factor.
class Scale {
public:
    Scale(const Mat3& scaling, const Pose& pose)
        : scaling_(scaling),
          pose_(pose),
          factors_(glm::length(scaling[0]), glm::length(scaling[1]), glm::length(scaling[2])) {}

    ShapeReading operator()(const BoxShape& box) const {
        return is_square() ? one_solid(BoxShape{box.half_extents * factors_}, pose_) : uneven("box");
    }
    ShapeReading operator()(const SphereShape& sphere) const {
        return is_even() ? one_solid(SphereShape{sphere.radius * factors_.x}, pose_) : uneven("sphere");
    }
    ShapeReading operator()(const CapsuleShape& capsule) const {
        return is_even()
                   ? one_solid(CapsuleShape{capsule.radius * factors_.x, capsule.half_segment * factors_.x},
                               pose_)
                   : uneven("capsule");
    }
    ShapeReading operator()(const CylinderShape& cylinder) const {
        return is_square() && same(factors_.x, factors_.z)
                   ? one_solid(CylinderShape{cylinder.radius * factors_.x, cylinder.half_height * factors_.y},
                               pose_)
                   : uneven("cylinder");
    }
    // A mirrored frame is one that is turned and scaled by less than zero along all axes. As well, it is
    // turned by half a turn more about x, and mirrored along x alone: then up stays up.
    ShapeReading operator()(HeightFieldShape field) const {
        if (!is_square()) {
            return uneven("height map");
        }
        Pose pose = pose_;
        field.scale *= factors_;
        if (glm::determinant(scaling_) < 0.0) {
            field.scale.x = -field.scale.x;
            pose.rotation = pose.rotation * Quat(0.0, 1.0, 0.0, 0.0);
        }
        return one(std::move(field), pose);
    }
    ShapeReading operator()(const PlaneShape& plane) const {
        const Vec3 normal = glm::transpose(glm::inverse(scaling_)) * plane.normal;
        if (!(glm::length(normal) > 0.0)) {
            return failure("its world boundary has no direction: give its plane a normal");
        }
        const Vec3 unit = glm::normalize(normal);
        return one(PlaneShape{unit, glm::dot(unit, scaling_ * (plane.normal * plane.offset))}, pose_);
    }
    ShapeReading operator()(const ConvexHullShape& hull) const {
        return scaled_hull(hull.hull->vertices, scaling_, pose_);
    }
    // Triangles are scaled where their tree is built.
    ShapeReading operator()(const MeshShape& mesh) const {
        const auto source = std::make_shared<TriangleSource>(TriangleSource::Checked{mesh.mesh, {}});
        return {{}, {{source, scaling_, pose_, mesh.smooth_below, mesh.one_sided, {}}}, {}};
    }

private:
    static bool same(double a, double b) { return std::abs(a - b) <= even * std::abs(a); }
    bool is_square() const {
        const auto square = [this](int a, int b) {
            return std::abs(glm::dot(scaling_[a], scaling_[b])) <= even * factors_[a] * factors_[b];
        };
        return square(0, 1) && square(1, 2) && square(2, 0);
    }
    bool is_even() const {
        return is_square() && same(factors_.x, factors_.y) && same(factors_.x, factors_.z);
    }
    static ShapeReading uneven(const char* kind) {
        return failure(
            std::string("its ") + kind +
            " is scaled differently along its axes: scale it evenly, or touch a HapticMesh instead");
    }

    const Mat3& scaling_;
    const Pose& pose_;
    Vec3 factors_;
};

}  // namespace

ShapeReading scaled_shape(const Shape& shape, const Mat3& scaling, const Pose& pose) {
    return std::visit(Scale(scaling, pose), shape);
}

ShapeReading scaled_hull(std::vector<Vec3> points, const Mat3& scaling, const Pose& pose) {
    for (Vec3& point : points) {
        point = scaling * point;
    }
    TriangleMesh hull = convex_hull(points);
    if (hull.triangles.empty()) {
        return failure(
            "its convex shape has no volume: give it at least four points that are not in one plane");
    }
    return one(ConvexHullShape{std::make_shared<TriangleMesh>(std::move(hull))}, pose);
}

}  // namespace tactus
