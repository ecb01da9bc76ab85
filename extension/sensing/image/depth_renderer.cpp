#include "sensing/image/depth_renderer.hpp"

#include <algorithm>
#include <cmath>

namespace tactus {

namespace {

// A function a u + b v + c over the image.
struct Linear {
    double a = 0.0, b = 0.0, c = 0.0;

    double at(double u, double v) const { return a * u + b * v + c; }
};

// Positive on the inner side of the edge from p to q, for corners that run clockwise in the image as it is
// stored (v down).
Linear edge_function(const PixelPlace& p, const PixelPlace& q) {
    const double a = p.v - q.v;
    const double b = q.u - p.u;
    return {a, b, -(a * p.u + b * p.v)};
}

// Of the plane through three points of the camera's frame: n . r(u, v) / c.
Linear inverse_depth(const DepthCamera& camera, const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 normal = glm::cross(q - p, r - p);
    const double offset = glm::dot(normal, p);
    const double a = normal.x / (camera.focal_x * offset);
    const double b = -normal.y / (camera.focal_y * offset);
    return {a, b, -normal.z / offset - a * camera.center_x - b * camera.center_y};
}

struct Corner {
    Vec3 point;
    PixelPlace place;
};

// What is written beside the depth.
struct Name {
    std::uint16_t mesh;
    std::uint32_t face;
};

// The first whole number not below, and not above, clamped to 0 … limit also where it is far away.
int first_pixel(double from, int limit) {
    return static_cast<int>(std::ceil(std::clamp(from, 0.0, static_cast<double>(limit))));
}
int end_pixel(double to, int limit) {
    return static_cast<int>(std::floor(std::clamp(to, -1.0, static_cast<double>(limit) - 1.0))) + 1;
}

PixelBox box_around(const DepthCamera& camera, const PixelPlace& a, const PixelPlace& b,
                    const PixelPlace& c) {
    return {first_pixel(std::min({a.u, b.u, c.u}), camera.width),
            first_pixel(std::min({a.v, b.v, c.v}), camera.height),
            end_pixel(std::max({a.u, b.u, c.u}), camera.width),
            end_pixel(std::max({a.v, b.v, c.v}), camera.height)};
}

void widen(PixelBox& box, const PixelBox& by) {
    if (by.is_empty()) {
        return;
    }
    box = box.is_empty() ? by
                         : PixelBox{std::min(box.left, by.left), std::min(box.top, by.top),
                                    std::max(box.right, by.right), std::max(box.bottom, by.bottom)};
}

// Rounding may put the common edge of two triangles at two places: both reach over it by this much, and a
// pixel there belongs to both, at the same depth (unit: pixels).
constexpr double overlap = 1e-9;

// The part of a row where all three edge functions are not negative.
void inner_span(const std::array<Linear, 3>& edges, double v, int& left, int& right) {
    for (const Linear& edge : edges) {
        const double start = edge.b * v + edge.c;
        if (edge.a > 0.0) {
            left = std::max(left, first_pixel(-start / edge.a - overlap, right));
        } else if (edge.a < 0.0) {
            right = std::min(right, end_pixel(-start / edge.a + overlap, right));
        } else if (start < 0.0) {
            right = left;
        }
    }
}

// One triangle, all of it in front of the camera.
void draw_triangle(const Corner& a, const Corner& b, const Corner& c, Name name, DepthBuffer& buffer,
                   PixelBox& touched) {
    const PixelBox box = box_around(buffer.camera, a.place, b.place, c.place);
    if (box.is_empty()) {
        return;
    }
    const Linear inverse = inverse_depth(buffer.camera, a.point, b.point, c.point);
    if (!std::isfinite(inverse.a + inverse.b + inverse.c)) {
        return;  // without area, or seen exactly from the side
    }
    std::array<Linear, 3> edges{edge_function(a.place, b.place), edge_function(b.place, c.place),
                                edge_function(c.place, a.place)};
    if (edges[0].at(c.place.u, c.place.v) < 0.0) {
        for (Linear& edge : edges) {
            edge = {-edge.a, -edge.b, -edge.c};
        }
    }
    widen(touched, box);
    for (int v = box.top; v < box.bottom; ++v) {
        int left = box.left;
        int right = box.right;
        inner_span(edges, v, left, right);
        const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(buffer.camera.width);
        for (int u = left; u < right; ++u) {
            const auto depth = static_cast<float>(1.0 / inverse.at(u, v));
            const std::size_t at = row + static_cast<std::size_t>(u);
            // Rounding can put the inverse depth of a steep sliver beyond the horizon.
            if (depth > 0.0f && depth < buffer.depth[at]) {
                buffer.depth[at] = depth;
                buffer.seen[at] = name.mesh;
                buffer.face[at] = name.face;
            }
        }
    }
}

Corner cut_at_nearest(const DepthCamera& camera, const Vec3& inside, const Vec3& outside) {
    const double t = (inside.z + DepthRenderer::nearest) / (inside.z - outside.z);
    Vec3 point = inside + t * (outside - inside);
    point.z = -DepthRenderer::nearest;
    return {point, seen_at(camera, point)};
}

// What is left of a triangle in front of the plane z = -nearest: a fan of at most two.
void draw_cut_triangle(const std::array<Corner, 3>& corners, Name name, DepthBuffer& buffer,
                       PixelBox& touched) {
    std::array<Corner, 4> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Corner& here = corners[i];
        const Corner& next = corners[(i + 1) % 3];
        const bool here_inside = here.place.depth >= DepthRenderer::nearest;
        const bool next_inside = next.place.depth >= DepthRenderer::nearest;
        if (here_inside) {
            kept[count++] = here;
        }
        if (here_inside != next_inside) {
            kept[count++] = cut_at_nearest(buffer.camera, here_inside ? here.point : next.point,
                                           here_inside ? next.point : here.point);
        }
    }
    for (std::size_t i = 2; i < count; ++i) {
        draw_triangle(kept[0], kept[i - 1], kept[i], name, buffer, touched);
    }
}

}  // namespace

PixelBox DepthRenderer::draw(const PosedMesh& posed, std::uint16_t index, DepthBuffer& buffer) {
    const TriangleMesh& mesh = *posed.mesh;
    const Mat3 turn = glm::mat3_cast(posed.pose.rotation);
    corners_.resize(mesh.vertices.size());
    seen_.resize(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        corners_[i] = turn * mesh.vertices[i] + posed.pose.position;
        seen_[i] = seen_at(buffer.camera, corners_[i]);
    }
    PixelBox touched;
    for (std::uint32_t face = 0; face < mesh.triangles.size(); ++face) {
        const auto& [i, j, k] = mesh.triangles[face];
        const std::array<Corner, 3> corners{Corner{corners_[i], seen_[i]}, Corner{corners_[j], seen_[j]},
                                            Corner{corners_[k], seen_[k]}};
        const double nearest_corner = std::min({seen_[i].depth, seen_[j].depth, seen_[k].depth});
        if (nearest_corner >= nearest) {
            draw_triangle(corners[0], corners[1], corners[2], {index, face}, buffer, touched);
        } else {
            draw_cut_triangle(corners, {index, face}, buffer, touched);
        }
    }
    return touched;
}

void DepthRenderer::render(const DepthCamera& camera, std::span<const PosedMesh> meshes,
                           DepthBuffer& buffer) {
    buffer.clear(camera);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        draw(meshes[i], static_cast<std::uint16_t>(i), buffer);
    }
}

}  // namespace tactus
