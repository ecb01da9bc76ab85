#include "sensing/image/depth_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus {

namespace {

// Larger images than any depth camera's are a mistake in the size.
constexpr int largest_side = 4096;

// Of the pixels: less depth than this is a covered lens.
constexpr double least_seen_share = 0.01;

bool is_sound(const DepthCamera& camera) {
    const bool sized = camera.width > 0 && camera.height > 0 && camera.width <= largest_side &&
                       camera.height <= largest_side;
    const bool focused = camera.focal_x > 0.0 && camera.focal_y > 0.0 && std::isfinite(camera.focal_x) &&
                         std::isfinite(camera.focal_y);
    return sized && focused && std::isfinite(camera.center_x) && std::isfinite(camera.center_y);
}

}  // namespace

DepthCamera camera_of_view(int width, int height, double horizontal, double vertical) {
    const double half_width = 0.5 * width;
    const double half_height = 0.5 * height;
    return {width,
            height,
            half_width / std::tan(0.5 * horizontal),
            half_height / std::tan(0.5 * vertical),
            half_width,
            half_height};
}

DepthCamera kinect_camera(int width, int height) {
    // As the PS1080 driver of OpenNI2 reports them.
    return camera_of_view(width, height, 1.0144686707507438, 0.78980943449644714);
}

PixelBox seen_part(const DepthImage& image) {
    const int width = image.camera.width, height = image.camera.height;
    const auto is_empty = [&](int u, int v, int du, int dv, int count) {
        for (int i = 0; i < count; ++i) {
            if (image.depth_mm[static_cast<std::size_t>((v + i * dv) * width + u + i * du)] != 0) {
                return false;
            }
        }
        return true;
    };
    PixelBox part{0, 0, width, height};
    while (part.left < width / 25 && is_empty(part.left, 0, 0, 1, height)) {
        ++part.left;
    }
    while (width - part.right < width / 25 && is_empty(part.right - 1, 0, 0, 1, height)) {
        --part.right;
    }
    while (part.top < height / 25 && is_empty(0, part.top, 1, 0, width)) {
        ++part.top;
    }
    while (height - part.bottom < height / 25 && is_empty(0, part.bottom - 1, 1, 0, width)) {
        --part.bottom;
    }
    return part;
}

void DepthBuffer::clear(const DepthCamera& of) {
    camera = of;
    depth.assign(pixel_count(of), std::numeric_limits<float>::infinity());
    seen.assign(pixel_count(of), no_mesh);
    face.assign(pixel_count(of), 0);
}

DepthImage to_image(const DepthBuffer& buffer, std::uint64_t time_us) {
    DepthImage image{buffer.camera, std::vector<std::uint16_t>(buffer.depth.size()), time_us};
    for (std::size_t i = 0; i < buffer.depth.size(); ++i) {
        const float mm = 1000.0f * buffer.depth[i] + 0.5f;
        image.depth_mm[i] = mm < 65536.0f ? static_cast<std::uint16_t>(mm) : std::uint16_t{0};
    }
    return image;
}

std::string check_image(const DepthImage& image) {
    if (!is_sound(image.camera)) {
        return "the camera's size or angle of view makes no sense: choose another video mode";
    }
    if (image.depth_mm.size() != pixel_count(image.camera)) {
        return "the image has " + std::to_string(image.depth_mm.size()) + " pixels where " +
               std::to_string(pixel_count(image.camera)) + " were announced: choose another video mode";
    }
    std::size_t seen = 0;
    std::uint16_t first = 0;
    bool differs = false;
    for (const std::uint16_t depth : image.depth_mm) {
        seen += depth != 0;
        first = first == 0 ? depth : first;
        differs = differs || (depth != 0 && depth != first);
    }
    if (static_cast<double>(seen) < least_seen_share * static_cast<double>(image.depth_mm.size())) {
        return "the image holds no depth: is the lens covered, or everything too near or too far?";
    }
    return differs ? "" : "every pixel has the same depth: unplug the camera and plug it in again";
}

}  // namespace tactus
