#include "sensing/discovery/support_plane.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "core/math/small_matrix.hpp"

namespace tactus {

namespace {

// Every so many pixels across and down one is looked at: thousands are left, and the plane is sure to some
// hundredths of a millimeter.
constexpr int stride = 4;

// What lies within so many standard deviations belongs to the plane.
constexpr double deviations = 3.0;

struct PlanePixel {
    Vec3 ray;
    double depth;      // (unit: meters)
    double deviation;  // of its inverse depth (unit: 1/meter)
};

std::vector<PlanePixel> sample(const DepthImage& image, const DepthAccuracy& accuracy) {
    std::vector<PlanePixel> pixels;
    pixels.reserve(image.depth_mm.size() / (stride * stride) + 1);
    for (int v = stride / 2; v < image.camera.height; v += stride) {
        for (int u = stride / 2; u < image.camera.width; u += stride) {
            const int mm = image.depth_mm[static_cast<std::size_t>(v * image.camera.width + u)];
            if (mm != 0) {
                const double depth = 1e-3 * mm;
                pixels.push_back({ray_through(image.camera, u, v), depth,
                                  depth_deviation(accuracy, depth) / (depth * depth)});
            }
        }
    }
    return pixels;
}

bool lies_in(const ImagePlane& plane, const PlanePixel& pixel, double reach) {
    return std::abs(1.0 / pixel.depth - glm::dot(plane.m, pixel.ray)) < reach * pixel.deviation;
}

std::size_t count_in(const ImagePlane& plane, const std::vector<PlanePixel>& pixels) {
    return static_cast<std::size_t>(std::ranges::count_if(
        pixels, [&](const PlanePixel& pixel) { return lies_in(plane, pixel, deviations); }));
}

// m of the three equations m . (depth ray) = 1; none for three pixels in a line.
std::optional<ImagePlane> through(const PlanePixel& a, const PlanePixel& b, const PlanePixel& c) {
    const Vec3 p = a.depth * a.ray;
    const Vec3 normal = glm::cross(b.depth * b.ray - p, c.depth * c.ray - p);
    const double offset = glm::dot(normal, p);
    if (!(std::abs(offset) > 1e-9)) {
        return std::nullopt;
    }
    return ImagePlane{normal / offset};
}

// Least squares over those of the pixels that lie near the plane; none where they do not tell it.
std::optional<ImagePlane> refit(const ImagePlane& plane, const std::vector<PlanePixel>& pixels,
                                double reach) {
    SmallMatrix<3> squares{};
    SmallVector<3> sums{};
    for (const PlanePixel& pixel : pixels) {
        if (!lies_in(plane, pixel, reach)) {
            continue;
        }
        const double weight = 1.0 / (pixel.deviation * pixel.deviation);
        const SmallVector<3> ray{pixel.ray.x, pixel.ray.y, pixel.ray.z};
        for (std::size_t i = 0; i < 3; ++i) {
            sums[i] += weight * ray[i] / pixel.depth;
            for (std::size_t j = 0; j <= i; ++j) {
                squares[i][j] += weight * ray[i] * ray[j];
            }
        }
    }
    SmallMatrix<3> factor{};
    if (!cholesky(squares, factor, 1e-6)) {
        return std::nullopt;
    }
    const SmallVector<3> m = solve_cholesky(factor, sums);
    return ImagePlane{{m[0], m[1], m[2]}};
}

std::optional<PlaneFit> fit_near(ImagePlane plane, const std::vector<PlanePixel>& pixels,
                                 double least_share) {
    // First from a little farther away: what was found, or followed, may be off by more than chance.
    for (const double reach : {3.0 * deviations, deviations, deviations}) {
        const std::optional<ImagePlane> better = refit(plane, pixels, reach);
        if (!better) {
            return std::nullopt;
        }
        plane = *better;
    }
    PlaneFit fit{plane, 0.0, 0.0};
    const double length = glm::length(plane.m);
    std::size_t count = 0;
    for (const PlanePixel& pixel : pixels) {
        if (lies_in(plane, pixel, deviations)) {
            const double height = (1.0 - pixel.depth * glm::dot(plane.m, pixel.ray)) / length;
            fit.residual += height * height;
            ++count;
        }
    }
    fit.share = static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, pixels.size()));
    if (!(fit.share >= least_share) || !std::isfinite(length)) {
        return std::nullopt;
    }
    fit.residual = std::sqrt(fit.residual / static_cast<double>(count));
    return fit;
}

}  // namespace

double ImagePlane::distance() const {
    return 1.0 / glm::length(m);
}

Vec3 ImagePlane::normal() const {
    return -m / glm::length(m);
}

HeightOverImage height_over_image(const DepthCamera& camera, const ImagePlane& plane) {
    const Vec3 n = plane.normal();
    const double a = n.x / camera.focal_x;
    const double b = -n.y / camera.focal_y;
    return {a, b, -n.z - a * camera.center_x - b * camera.center_y, plane.distance()};
}

std::optional<PlaneFit> find_plane(const DepthImage& image, const DepthAccuracy& accuracy,
                                   const PlaneSearch& search) {
    const std::vector<PlanePixel> pixels = sample(image, accuracy);
    if (pixels.size() < 3) {
        return std::nullopt;
    }
    std::mt19937_64 random(1);
    const auto any = [&]() -> const PlanePixel& { return pixels[random() % pixels.size()]; };
    const double least_cosine = std::cos(search.max_tilt);
    std::optional<ImagePlane> best;
    std::size_t most = 0;
    for (int i = 0; i < search.tries; ++i) {
        const PlanePixel &a = any(), &b = any(), &c = any();
        const std::optional<ImagePlane> plane = through(a, b, c);
        if (!plane || !(glm::dot(plane->normal(), search.up) > least_cosine)) {
            continue;
        }
        const std::size_t count = count_in(*plane, pixels);
        if (count > most) {
            most = count;
            best = plane;
        }
    }
    return best ? fit_near(*best, pixels, search.least_share) : std::nullopt;
}

std::optional<PlaneFit> follow_plane(const DepthImage& image, const DepthAccuracy& accuracy,
                                     const ImagePlane& last, double least_share) {
    return fit_near(last, sample(image, accuracy), least_share);
}

}  // namespace tactus
