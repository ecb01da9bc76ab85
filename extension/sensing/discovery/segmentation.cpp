#include "sensing/discovery/segmentation.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tactus {

namespace {

constexpr std::size_t centimeters = 6554;  // of all that 16 bits of millimeters can tell

// Pixels of eight bytes at a time: the index of the next that is not zero, or `end`.
int next_set(const std::uint8_t* row, int at, int end) {
    while (at + 8 <= end) {
        std::uint64_t eight = 0;
        std::memcpy(&eight, row + at, 8);
        if (eight != 0) {
            if constexpr (std::endian::native == std::endian::little) {
                return at + std::countr_zero(eight) / 8;
            }
            break;
        }
        at += 8;
    }
    while (at < end && row[at] == 0) {
        ++at;
    }
    return at;
}

}  // namespace

const Segmentation& Segmenter::segment(const DepthImage& image, const DepthAccuracy& accuracy,
                                       const std::optional<ImagePlane>& plane,
                                       const SegmentationSettings& settings) {
    mark(image, accuracy, plane, settings);
    return find_pieces(image, settings);
}

const Segmentation& Segmenter::find_pieces(const DepthImage& image, const SegmentationSettings& settings) {
    find_runs(image);
    gather(image.camera, settings.least_pixels);
    return result_;
}

void Segmenter::mark(const DepthImage& image, const DepthAccuracy& accuracy,
                     const std::optional<ImagePlane>& plane, const SegmentationSettings& settings) {
    jump_by_cm_.resize(centimeters);
    for (std::size_t i = 0; i < centimeters; ++i) {
        const double deviation = depth_deviation(accuracy, 0.01 * static_cast<double>(i) + 0.005);
        const double jump = 1000.0 * (settings.jump + settings.jump_deviations * deviation);
        jump_by_cm_[i] = static_cast<std::uint16_t>(std::min(jump, 65535.0));
    }
    result_.stands_out.resize(image.depth_mm.size());
    std::uint8_t* const out = result_.stands_out.data();
    if (!plane) {
        std::ranges::transform(image.depth_mm, out, [](std::uint16_t mm) { return std::uint8_t{mm != 0}; });
        return;
    }
    const HeightOverImage height = height_over_image(image.camera, *plane);
    const Vec3 normal = plane->normal();
    const auto a = static_cast<float>(1e-3 * height.a);
    for (int v = 0; v < image.camera.height; ++v) {
        const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(image.camera.width);
        const auto start = static_cast<float>(1e-3 * (height.b * v + height.c));
        // Chance moves a pixel along its ray. It is told for the depth at which the middle of the row meets
        // the plane: what counts is chance at the plane itself.
        const Vec3 ray = ray_through(image.camera, image.camera.center_x, v);
        const double towards = -glm::dot(normal, ray);
        const double depth = towards > 1e-3 ? std::min(plane->distance() / towards, 10.0) : 10.0;
        const double chance =
            settings.height_deviations * depth_deviation(accuracy, depth) * std::max(0.0, towards);
        const auto least = static_cast<float>(std::max(settings.least_height, chance) - height.d);
        const std::uint16_t* const mm = image.depth_mm.data() + row;
        for (int u = 0; u < image.camera.width; ++u) {
            const float over = static_cast<float>(mm[u]) * (a * static_cast<float>(u) + start);
            out[row + static_cast<std::size_t>(u)] = static_cast<std::uint8_t>((over > least) & (mm[u] != 0));
        }
    }
}

bool Segmenter::continues(const DepthImage& image, std::size_t a, std::size_t b) const {
    const int depth = image.depth_mm[a];
    const int difference = depth - image.depth_mm[b];
    return std::abs(difference) <= jump_by_cm_[static_cast<std::size_t>(depth / 10)];
}

void Segmenter::find_runs(const DepthImage& image) {
    runs_.clear();
    std::size_t above = 0;
    for (int v = 0; v < image.camera.height; ++v) {
        const std::size_t first = runs_.size();
        const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(image.camera.width);
        const std::uint8_t* const set = result_.stands_out.data() + row;
        int u = next_set(set, 0, image.camera.width);
        while (u < image.camera.width) {
            const int begin = u++;
            while (
                u < image.camera.width && set[u] != 0 &&
                continues(image, row + static_cast<std::size_t>(u), row + static_cast<std::size_t>(u) - 1)) {
                ++u;
            }
            runs_.push_back({v, begin, u, static_cast<std::uint32_t>(runs_.size())});
            u = next_set(set, u, image.camera.width);
        }
        join_rows(image, above, first, runs_.size());
        above = first;
    }
}

// Runs above … here are those of the row above.
void Segmenter::join_rows(const DepthImage& image, std::size_t above, std::size_t here, std::size_t end) {
    const auto width = static_cast<std::size_t>(image.camera.width);
    std::size_t upper = above;
    for (std::size_t lower = here; lower < end; ++lower) {
        const Run run = runs_[lower];
        while (upper < here && runs_[upper].end <= run.begin) {
            ++upper;
        }
        for (std::size_t other = upper; other < here && runs_[other].begin < run.end; ++other) {
            const std::size_t row = static_cast<std::size_t>(run.row) * width;
            for (int u = std::max(run.begin, runs_[other].begin); u < std::min(run.end, runs_[other].end);
                 ++u) {
                const std::size_t at = row + static_cast<std::size_t>(u);
                if (runs_[other].row + 1 == run.row && continues(image, at, at - width)) {
                    join(static_cast<std::uint32_t>(lower), static_cast<std::uint32_t>(other));
                    break;
                }
            }
        }
    }
}

std::uint32_t Segmenter::root(std::uint32_t run) {
    while (runs_[run].parent != run) {
        runs_[run].parent = runs_[runs_[run].parent].parent;
        run = runs_[run].parent;
    }
    return run;
}

void Segmenter::join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t x = root(a), y = root(b);
    runs_[std::max(x, y)].parent = std::min(x, y);
}

void Segmenter::gather(const DepthCamera& camera, int least_pixels) {
    result_.piece.assign(pixel_count(camera), 0);
    result_.clusters.clear();
    number_.assign(runs_.size(), 0);
    for (std::uint32_t i = 0; i < runs_.size(); ++i) {
        number_[root(i)] += static_cast<std::uint32_t>(runs_[i].end - runs_[i].begin);
    }
    for (std::uint32_t i = 0; i < runs_.size(); ++i) {
        const std::uint32_t of = root(i);
        const Run& run = runs_[i];
        if (of == i) {
            const bool enough =
                number_[i] >= static_cast<std::uint32_t>(least_pixels) && result_.clusters.size() < 0xffff;
            if (enough) {
                result_.clusters.push_back({{}, {run.begin, run.row, run.end, run.row + 1}});
                result_.clusters.back().pixels.reserve(number_[i]);
            }
            number_[i] = enough ? static_cast<std::uint32_t>(result_.clusters.size()) : 0;
        }
        if (number_[of] == 0) {
            continue;
        }
        Cluster& cluster = result_.clusters[number_[of] - 1];
        cluster.box.left = std::min(cluster.box.left, run.begin);
        cluster.box.right = std::max(cluster.box.right, run.end);
        cluster.box.bottom = run.row + 1;
        for (int u = run.begin; u < run.end; ++u) {
            const auto at = static_cast<std::uint32_t>(run.row * camera.width + u);
            cluster.pixels.push_back(at);
            result_.piece[at] = static_cast<std::uint16_t>(number_[of]);
        }
    }
}

}  // namespace tactus
