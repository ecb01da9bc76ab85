#include "sensing/discovery/cloud_surface.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// Where no ray meets the support (unit: meters).
constexpr double farthest = 4.0;

bool is_same_camera(const DepthCamera& a, const DepthCamera& b) {
    return a.width == b.width && a.height == b.height && a.focal_x == b.focal_x && a.focal_y == b.focal_y &&
           a.center_x == b.center_x && a.center_y == b.center_y;
}

}  // namespace

void CloudSurface::begin(const DepthCamera& camera) {
    camera_ = camera;
    columns_ = std::max(2, camera.width / settings_.stride);
    rows_ = std::max(2, camera.height / settings_.stride);
    const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    corners_.assign(count, {});
    mesh_.vertices.assign(count, Vec3(0.0));
    mesh_.triangles.clear();
    for (int row = 0; row + 1 < rows_; ++row) {
        for (int column = 0; column + 1 < columns_; ++column) {
            const auto a = static_cast<std::uint32_t>(row * columns_ + column);
            const std::uint32_t b = a + 1, c = a + static_cast<std::uint32_t>(columns_), d = c + 1;
            // Counter-clockwise from the camera; rows go down.
            mesh_.triangles.push_back({a, c, b});
            mesh_.triangles.push_back({b, c, d});
        }
    }
}

// What stands out goes before what does not: of a thin thing a part of the pixels is enough.
CloudSurface::Look CloudSurface::look(const DepthImage& image, const Discovery& discovery, int u,
                                      int v) const {
    const std::vector<std::uint8_t>& stands_out = discovery.stands_out();
    double sums[2] = {0.0, 0.0};
    int counts[2] = {0, 0};
    double nearest = farthest;
    const int reach = settings_.stride / 2;
    for (int y = std::max(0, v - reach); y < std::min(camera_.height, v + reach); ++y) {
        for (int x = std::max(0, u - reach); x < std::min(camera_.width, u + reach); ++x) {
            const auto at = static_cast<std::size_t>(y * camera_.width + x);
            if (image.depth_mm[at] == 0) {
                continue;
            }
            const double depth = discovery.depth_scale() * 1e-3 * image.depth_mm[at];
            const std::size_t stands = stands_out[at] != 0 ? 1 : 0;
            sums[stands] += depth;
            ++counts[stands];
            nearest = stands != 0 ? std::min(nearest, depth) : nearest;
        }
    }
    constexpr int enough = 4;  // of the pixels, fewer are jitter
    if (counts[1] >= enough) {
        // Of two surfaces one behind the other, the nearer.
        const double mean = sums[1] / counts[1];
        const double jump = discovery.settings().segmentation.jump;
        return {true, true, mean - nearest > jump ? nearest : mean};
    }
    return {counts[0] >= enough, false, counts[0] > 0 ? sums[0] / counts[0] : 0.0};
}

void CloudSurface::take(Corner& corner, const Look& look, const DepthAccuracy& accuracy) const {
    if (!look.sees) {
        return;  // a shadow, a hole: it stays as it was
    }
    const double off = look.depth - corner.depth;
    const bool agrees =
        look.stands == corner.stands &&
        (!look.stands || std::abs(off) < settings_.deviations * depth_deviation(accuracy, look.depth));
    if (corner.images == 0 || (!agrees && ++corner.against >= settings_.images_to_change)) {
        corner = {look.depth, 1, 0, look.stands};
    } else if (agrees) {
        corner.against = 0;
        corner.images = std::min(corner.images + 1, settings_.images_to_average);
        corner.depth += off / corner.images;
    }
}

// On the ray of a corner, in depth.
double CloudSurface::beneath_support(const Discovery& discovery, const Vec3& ray) const {
    const std::optional<ImagePlane>& plane = discovery.plane();
    const double inverse = plane ? glm::dot(plane->m, ray) : 0.0;
    const double depth = inverse > 1.0 / farthest ? discovery.depth_scale() / inverse : farthest;
    return depth + settings_.beneath;
}

void CloudSurface::update(const DepthImage& image, const Discovery& discovery, const Pose& camera_in_world) {
    if (corners_.empty() || !is_same_camera(camera_, image.camera)) {
        begin(image.camera);
    }
    standing_ = 0;
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            const auto at = static_cast<std::size_t>(row * columns_ + column);
            const int u = column * settings_.stride + settings_.stride / 2;
            const int v = row * settings_.stride + settings_.stride / 2;
            Corner& corner = corners_[at];
            take(corner, look(image, discovery, u, v), discovery.settings().accuracy);
            const Vec3 ray = ray_through(camera_, u, v);
            const double depth = corner.stands ? corner.depth : beneath_support(discovery, ray);
            standing_ += corner.stands ? 1 : 0;
            mesh_.vertices[at] = to_parent(camera_in_world, depth * ray);
        }
    }
}

}  // namespace tactus
