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

namespace {

// Three pixels, anywhere or all of them within a window: those of a small table among all others are seldom
// three of one plane.
class Triples {
public:
    explicit Triples(const std::vector<PlanePixel>& pixels) : pixels_(pixels) {}

    std::optional<ImagePlane> any() {
        const std::size_t a = anyone(), b = anyone(), c = anyone();
        return through(pixels_[a], pixels_[b], pixels_[c]);
    }
    std::optional<ImagePlane> close() {
        const std::size_t a = anyone(), b = near(a), c = near(a);
        return through(pixels_[a], pixels_[b], pixels_[c]);
    }

private:
    // Pixels are in the order of their rows.
    static constexpr int looks = 40;
    static constexpr double window = 0.15;  // of rays at depth 1 (dimensionless)

    std::size_t anyone() { return random_() % pixels_.size(); }
    std::size_t near(std::size_t to) {
        const Vec3 ray = pixels_[to].ray;
        for (int i = 0; i < looks; ++i) {
            const std::size_t other = anyone();
            const Vec3 apart = pixels_[other].ray - ray;
            if (std::abs(apart.x) < window && std::abs(apart.y) < window) {
                return other;
            }
        }
        return anyone();
    }

    const std::vector<PlanePixel>& pixels_;
    std::mt19937_64 random_{1};
};

std::optional<ImagePlane> most_seen_plane(const std::vector<PlanePixel>& pixels, const PlaneSearch& search) {
    Triples triples(pixels);
    const double least_cosine = std::cos(search.max_tilt);
    std::optional<ImagePlane> best;
    std::size_t most = 0;
    for (int i = 0; i < 2 * search.tries; ++i) {
        const std::optional<ImagePlane> plane = i < search.tries ? triples.any() : triples.close();
        if (!plane || !(glm::dot(plane->normal(), search.up) > least_cosine)) {
            continue;
        }
        const std::size_t count = count_in(*plane, pixels);
        if (count > most) {
            most = count;
            best = plane;
        }
    }
    return best;
}

// What is so near to a plane is not another one (unit: meters).
constexpr double same_level = 0.02;

void take_out_level(const ImagePlane& plane, std::vector<PlanePixel>& pixels) {
    const double length = glm::length(plane.m);
    std::erase_if(pixels, [&](const PlanePixel& pixel) {
        const double height = (1.0 - pixel.depth * glm::dot(plane.m, pixel.ray)) / length;
        return std::abs(height) < same_level || lies_in(plane, pixel, 3.0 * deviations);
    });
}

// Depths that are all off by a share: so far, in steps that are less than chance (dimensionless).
constexpr double most_error = 0.05, error_step = 0.0025;
constexpr double least_share_of_known = 0.015;

}  // namespace

std::vector<PlaneFit> find_planes(const DepthImage& image, const DepthAccuracy& accuracy,
                                  const PlaneSearch& search, std::size_t most) {
    const std::vector<PlanePixel> all = sample(image, accuracy);
    std::vector<PlanePixel> left = all;
    std::vector<PlaneFit> found;
    while (found.size() < most && left.size() >= 3) {
        const std::optional<ImagePlane> plane = most_seen_plane(left, search);
        std::optional<PlaneFit> fit = plane ? fit_near(*plane, left, 0.0) : std::nullopt;
        if (!fit) {
            break;
        }
        fit->share *= static_cast<double>(left.size()) / static_cast<double>(all.size());
        const bool is_level = glm::dot(fit->plane.normal(), search.up) > std::cos(search.max_tilt);
        if (!(fit->share >= search.least_share) || !is_level) {
            break;
        }
        found.push_back(*fit);
        take_out_level(fit->plane, left);
    }
    return found;
}

std::optional<PlaneFit> find_known_plane(const DepthImage& image, const DepthAccuracy& accuracy,
                                         const ImagePlane& known) {
    const std::vector<PlanePixel> pixels = sample(image, accuracy);
    ImagePlane best = known;
    std::size_t most = 0;
    for (double error = -most_error; error <= most_error; error += error_step) {
        const ImagePlane plane{known.m / (1.0 + error)};
        const std::size_t count = count_in(plane, pixels);
        if (count > most) {
            most = count;
            best = plane;
        }
    }
    // A camera's place is known to a degree or two: each fit takes more of a plane that leans.
    std::optional<PlaneFit> fit = fit_near(best, pixels, least_share_of_known);
    for (int i = 0; i < 3 && fit; ++i) {
        fit = fit_near(fit->plane, pixels, least_share_of_known);
    }
    return fit;
}

std::optional<PlaneFit> follow_plane(const DepthImage& image, const DepthAccuracy& accuracy,
                                     const ImagePlane& last, double least_share) {
    return fit_near(last, sample(image, accuracy), least_share);
}

}  // namespace tactus
