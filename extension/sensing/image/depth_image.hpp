// What a depth camera delivers, and where in space its pixels are.
//
// The camera's frame is Godot's: right-handed, x to the right of the image, y up, looking along -z. Images
// have their first row at the top. Depth is measured along the optical axis, not along the ray.
//
// OpenNI2 puts pixel (u, v) at u/width - 1/2 of the field of view, without half a pixel, and its world is
// left-handed (z grows away from the camera). Taken as it is, a mesh would be fitted to its mirror image;
// here z is turned round, once, in `ray_through`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

// A pinhole. Pixel coordinates are those of the samples themselves: (0, 0) is the first one's ray.
struct DepthCamera {
    int width = 0, height = 0;              // (unit: pixels), > 0
    double focal_x = 0.0, focal_y = 0.0;    // (unit: pixels), > 0
    double center_x = 0.0, center_y = 0.0;  // where the optical axis meets the image (unit: pixels)

    bool operator==(const DepthCamera&) const = default;
};

// With the whole angles of view that OpenNI2 tells (unit: radians), both in (0, pi).
DepthCamera camera_of_view(int width, int height, double horizontal, double vertical);

// A Kinect of the first kind.
DepthCamera kinect_camera(int width, int height);

inline std::size_t pixel_count(const DepthCamera& camera) {
    return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
}

// Where the ray of a pixel is at depth 1: a point at depth d is d times as far (dimensionless).
inline Vec3 ray_through(const DepthCamera& camera, double u, double v) {
    return {(u - camera.center_x) / camera.focal_x, (camera.center_y - v) / camera.focal_y, -1.0};
}

struct PixelPlace {
    double u = 0.0, v = 0.0;  // (unit: pixels)
    double depth = 0.0;       // negative or zero: behind the camera, and u and v mean nothing (unit: meters)
};

// Where a point of the camera's frame is seen.
inline PixelPlace seen_at(const DepthCamera& camera, const Vec3& point) {
    const double depth = -point.z;
    return {camera.center_x + camera.focal_x * point.x / depth,
            camera.center_y - camera.focal_y * point.y / depth, depth};
}

struct DepthImage {
    DepthCamera camera;
    std::vector<std::uint16_t> depth_mm;  // row by row; 0: no depth (unit: millimeters)
    std::uint64_t time_us = 0;            // of the camera's clock (unit: microseconds)
};

// Rectangle of pixels, without its last column and row.
struct PixelBox {
    int left = 0, top = 0, right = 0, bottom = 0;

    bool is_empty() const { return right <= left || bottom <= top; }
    bool operator==(const PixelBox&) const = default;
};

// What the camera sees: the image without the strips along its edges in which no pixel has depth, as where
// the projector's light does not reach. No strip is broader than a twenty-fifth of the image.
PixelBox seen_part(const DepthImage& image);

// Depths as they are computed: meters, infinite where nothing is.
struct DepthBuffer {
    DepthCamera camera;
    std::vector<float> depth;         // (unit: meters)
    std::vector<std::uint16_t> seen;  // index of the mesh that is seen there; no_mesh: none
    std::vector<std::uint32_t> face;  // and of its triangle

    static constexpr std::uint16_t no_mesh = 0xffff;

    // Empty, of that camera's size.
    void clear(const DepthCamera& of);
};

// Rounded to whole millimeters; what is farther than 65 m, or nowhere, has no depth.
DepthImage to_image(const DepthBuffer& buffer, std::uint64_t time_us);

// Empty where something can be found in the image; else what is wrong with it and what to do: a camera
// without a sensible size or focal length, too few or too many pixels, no depth at all, the same depth
// everywhere.
std::string check_image(const DepthImage& image);

}  // namespace tactus
