#include "sensing/discovery/learnt_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/mesh/mesh_check.hpp"
#include "core/tree/triangle_tree.hpp"
#include "sensing/image/depth_renderer.hpp"

namespace tactus {

namespace {

// Views are drawn so small, from so far away that the rays are all but parallel.
constexpr int view_size = 24;           // (unit: pixels)
constexpr double view_distance = 40.0;  // (unit: radii)
constexpr double view_width = 2.2;      // (unit: radii)

// A mesh below this size is a few pixels.
constexpr double smallest_radius = 0.008;   // (unit: meters)
constexpr double max_cells = 20'000'000.0;  // 16 bytes each

struct Ball {
    Vec3 center{0.0};
    double radius = 0.0;
};

Ball ball_around(const TriangleMesh& mesh) {
    const CornerExtent extent = corner_extent(mesh, run_serially);
    Ball ball{0.5 * (extent.low + extent.high), 0.0};
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            ball.radius = std::max(ball.radius, glm::length(mesh.vertices[corner] - ball.center));
        }
    }
    return ball;
}

class ViewPainter {
public:
    ViewPainter(const TriangleMesh& mesh, const Ball& ball) : mesh_(mesh), ball_(ball) {
        const double focal = view_size / view_width * view_distance;
        camera_ = {view_size, view_size, focal, focal, 0.5 * view_size, 0.5 * view_size};
    }

    // Depths about their mean, infinite where nothing is seen; none where nothing at all is.
    std::vector<float> paint(const Quat& rotation, Vec3& seen) {
        const Vec3 place = Vec3(0.0, 0.0, -view_distance * ball_.radius) - rotation * ball_.center;
        const PosedMesh posed{&mesh_, {place, rotation}};
        renderer_.render(camera_, {&posed, 1}, buffer_);
        Vec3 sum(0.0);
        double count = 0.0;
        for (int i = 0; i < view_size * view_size; ++i) {
            const double depth = buffer_.depth[static_cast<std::size_t>(i)];
            if (std::isfinite(depth)) {
                sum += depth * ray_through(camera_, i % view_size, i / view_size);
                count += 1.0;
            }
        }
        if (count == 0.0) {
            return {};
        }
        const Vec3 mean = sum / count;
        seen = mean - place;
        for (float& depth : buffer_.depth) {
            depth += static_cast<float>(mean.z);
        }
        return buffer_.depth;
    }

private:
    const TriangleMesh& mesh_;
    const Ball& ball_;
    DepthCamera camera_;
    DepthRenderer renderer_;
    DepthBuffer buffer_;
};

std::vector<Vec3> normals_of(const TriangleMesh& mesh) {
    std::vector<Vec3> normals;
    normals.reserve(mesh.triangles.size());
    for (const auto& [i, j, k] : mesh.triangles) {
        const Vec3& a = mesh.vertices[i];
        const Vec3 across = glm::cross(mesh.vertices[j] - a, mesh.vertices[k] - a);
        const double length = glm::length(across);
        normals.push_back(length > 0.0 ? across / length : Vec3(0.0));
    }
    return normals;
}

// How far the surfaces of two views are apart, on average; `far` where only one of them has any.
double difference(const std::vector<float>& a, const std::vector<float>& b, float far) {
    float sum = 0.0f;
    float count = 0.0f;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool in_a = a[i] < 1e9f, in_b = b[i] < 1e9f;
        const float apart = in_a && in_b ? std::min(std::abs(a[i] - b[i]), far) : far;
        sum += in_a || in_b ? apart : 0.0f;
        count += in_a || in_b ? 1.0f : 0.0f;
    }
    return sum / std::max(1.0f, count);
}

std::vector<MeshAspect> aspects_of(const TriangleMesh& mesh, const Ball& ball,
                                   const LearningSettings& settings) {
    ViewPainter painter(mesh, ball);
    std::vector<MeshAspect> aspects;
    std::vector<std::vector<float>> painted;
    const auto far = static_cast<float>(6.0 * settings.alike);
    for (const Quat& rotation : even_rotations(settings.rotations)) {
        MeshAspect aspect{rotation, Vec3(0.0)};
        const std::vector<float> depths = painter.paint(rotation, aspect.seen);
        const bool known = std::ranges::any_of(
            painted, [&](const auto& other) { return difference(depths, other, far) < settings.alike; });
        if (!depths.empty() && !known) {
            aspects.push_back(aspect);
            painted.push_back(depths);
        }
    }
    return aspects;
}

}  // namespace

// Points of a spiral on the 3-sphere: sqrt(2) and psi, with psi^4 = psi + 4, are the two numbers that spread
// them best.
std::vector<Quat> even_rotations(int count) {
    constexpr double phi = std::numbers::sqrt2;
    constexpr double psi = 1.533751168755204288118041;
    std::vector<Quat> rotations;
    rotations.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const double s = i + 0.5;
        const double t = s / count;
        const double alpha = 2.0 * std::numbers::pi * s / phi;
        const double beta = 2.0 * std::numbers::pi * s / psi;
        const double inner = std::sqrt(t), outer = std::sqrt(1.0 - t);
        rotations.push_back(glm::normalize(Quat(outer * std::cos(beta), inner * std::sin(alpha),
                                                inner * std::cos(alpha), outer * std::sin(beta))));
    }
    return rotations;
}

LearntMesh learn_mesh(const LibraryMesh& mesh, const LearningSettings& settings, const ParallelRunner& run) {
    const Ball ball = ball_around(mesh.mesh);
    return {mesh.name,
            mesh.mesh,
            normals_of(mesh.mesh),
            mesh.mass,
            ball.center,
            ball.radius,
            MeshField::build(mesh.mesh, settings.cell, settings.margin, run),
            aspects_of(mesh.mesh, ball, settings)};
}

std::string check_library_mesh(const LibraryMesh& mesh, const LearningSettings& settings) {
    const std::string fault = check_mesh(mesh.mesh);
    if (!fault.empty()) {
        return "mesh \"" + mesh.name + "\": " + fault;
    }
    if (!(mesh.mass >= 0.0) || !std::isfinite(mesh.mass)) {
        return "mesh \"" + mesh.name + "\": its mass is no mass; 0 means that it is not known";
    }
    const Ball ball = ball_around(mesh.mesh);
    if (ball.radius < smallest_radius) {
        return "mesh \"" + mesh.name + "\" is too small for a camera to tell: is it in meters?";
    }
    const double side = (2.0 * ball.radius + 2.0 * settings.margin) / settings.cell;
    if (side * side * side > max_cells) {
        return "mesh \"" + mesh.name + "\" is too large to be recognized: is it in meters?";
    }
    return "";
}

}  // namespace tactus
