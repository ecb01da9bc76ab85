#include "sensing/image/depth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus {

namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

// A hash of the pixel and the seed, so that no pixel's chance depends on another's: splitmix64.
std::uint64_t hash_of(std::uint64_t seed, std::uint64_t index) {
    std::uint64_t bits = seed * 0xd1342543de82ef95u + index * 0x9e3779b97f4a7c15u + 0x9e3779b97f4a7c15u;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

// Nearly normally distributed, of variance 1 and at most `largest_chance`: the sum of four even chances (each
// of variance 1/12), which needs no function that differs between C libraries.
constexpr double largest_chance = 3.4641016151377544;
double normal(std::uint64_t bits) {
    const auto part = [bits](int shift) { return static_cast<double>((bits >> shift) & 0xffffu); };
    const double sum = part(0) + part(16) + part(32) + part(48);
    return (sum / 65535.0 - 2.0) * (largest_chance / 2.0);
}

double even(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

double sigma(double depth) {
    return 0.0012 + 0.0019 * (depth - 0.4) * (depth - 0.4);
}

class NoisyView {
public:
    NoisyView(const DepthBuffer& exact, const DepthNoise& noise, std::uint64_t seed)
        : exact_(exact), noise_(noise), seed_(seed) {}

    double exact_at(int u, int v) const {
        const bool inside = u >= 0 && v >= 0 && u < exact_.camera.width && v < exact_.camera.height;
        return inside ? exact_.depth[index(u, v)] : nothing;
    }

    // 0 where nothing is seen (unit: millimeters).
    std::uint16_t told_at(int u, int v) const {
        const std::size_t at = index(u, v);
        const double depth = jittered(u, v, hash_of(seed_, 3 * at));
        if (!(depth >= noise_.nearest) || !std::isfinite(depth) || is_too_steep(u, v) ||
            even(hash_of(seed_, 3 * at + 1)) < noise_.hole_share) {
            return 0;
        }
        const double rough = depth + noise_.random * sigma(depth) * normal(hash_of(seed_, 3 * at + 2));
        const double told = stepped(rough) * (1.0 + noise_.error_share) * 1000.0 + 0.5;
        return told >= 1.0 && told < 65536.0 ? static_cast<std::uint16_t>(told) : std::uint16_t{0};
    }

private:
    std::size_t index(int u, int v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(exact_.camera.width) +
               static_cast<std::size_t>(u);
    }

    // What the pixel sees where it looks a little beside its place, and there is an edge.
    double jittered(int u, int v, std::uint64_t bits) const {
        const double own = exact_at(u, v);
        const auto beside = [&](std::uint64_t of) {
            return static_cast<int>(std::lround(std::clamp(noise_.edge_jitter * normal(of), -2.0, 2.0)));
        };
        // The surface goes on beyond the border of the image.
        const double other = exact_at(std::clamp(u + beside(bits), 0, exact_.camera.width - 1),
                                      std::clamp(v + beside(hash_of(bits, 1)), 0, exact_.camera.height - 1));
        return std::abs(other - own) > noise_.jump ? other : own;
    }

    // By the neighbours: a plane whose normal is turned by a from the ray falls by depth * tan(a) / focal a
    // pixel.
    bool is_too_steep(int u, int v) const {
        const double here = exact_at(u, v);
        const double limit = std::tan(noise_.steepest) * here;
        const auto falls = [&](int du, int dv) {
            return std::min(std::abs(exact_at(u + du, v + dv) - here),
                            std::abs(exact_at(u - du, v - dv) - here));
        };
        const double x = falls(1, 0) * exact_.camera.focal_x;
        const double y = falls(0, 1) * exact_.camera.focal_y;
        return std::isfinite(here) && std::isfinite(x) && std::isfinite(y) && x * x + y * y > limit * limit;
    }

    double stepped(double depth) const {
        if (!(noise_.step > 0.0)) {
            return depth;
        }
        return 1.0 / (noise_.step * std::max(1.0, std::round(1.0 / (noise_.step * depth))));
    }

    const DepthBuffer& exact_;
    const DepthNoise& noise_;
    std::uint64_t seed_;
};

// The projector's ray to a point at (u, z) meets the row at u - f b / z of the projector's own image. Seen
// from the right, the farther of two points with the same one is in the shadow; going through a row from the
// right, whatever lies right of what was lit before is dark.
void cast_shadows(const DepthBuffer& exact, double baseline, DepthImage& image) {
    const int width = exact.camera.width;
    const double disparity = exact.camera.focal_x * baseline;
    for (int v = 0; v < exact.camera.height; ++v) {
        const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(width);
        double lit = std::numeric_limits<double>::infinity();
        for (int u = width - 1; u >= 0; --u) {
            const std::size_t at = row + static_cast<std::size_t>(u);
            const double place = u - disparity / exact.depth[at];
            // One pixel of surface that falls away is no shadow.
            if (place > lit + 1.0) {
                image.depth_mm[at] = 0;
            }
            lit = std::min(lit, place);
        }
    }
}

}  // namespace

double largest_error(const DepthNoise& noise, double depth) {
    return largest_chance * noise.random * sigma(depth) + noise.step * depth * depth;
}

DepthImage noisy_image(const DepthBuffer& exact, const DepthNoise& noise, std::uint64_t seed,
                       std::uint64_t time_us) {
    const NoisyView view(exact, noise, seed);
    DepthImage image{exact.camera, std::vector<std::uint16_t>(exact.depth.size()), time_us};
    std::size_t at = 0;
    for (int v = 0; v < exact.camera.height; ++v) {
        for (int u = 0; u < exact.camera.width; ++u) {
            image.depth_mm[at++] = view.told_at(u, v);
        }
    }
    if (noise.baseline > 0.0) {
        cast_shadows(exact, noise.baseline, image);
    }
    return image;
}

}  // namespace tactus
