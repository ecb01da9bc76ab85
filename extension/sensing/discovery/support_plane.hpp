// The plane that things stand on: found once, then followed.
//
// A plane m . p = 1 of the camera's frame has 1 / depth = m . ray(u, v), linear over the image. A
// structured-light camera measures 1 / depth in even steps with even chance, so a least-squares fit of the
// inverse depth is a linear one, without bias. The height of a pixel over the plane is linear, too:
// height = (1 - depth m . ray) / |m|.
#pragma once

#include <optional>
#include <vector>

#include "sensing/discovery/depth_accuracy.hpp"
#include "sensing/image/depth_image.hpp"

namespace tactus {

// In the camera's frame, as an unnormalised inverse: m.
struct ImagePlane {
    Vec3 m{0.0, -1.0, 0.0};  // (unit: 1/meter), not zero

    double distance() const;  // of the camera from it (unit: meters)
    Vec3 normal() const;      // unit, towards the camera's side
};

// height = depth * (a u + b v + c) + d
struct HeightOverImage {
    double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
};
HeightOverImage height_over_image(const DepthCamera& camera, const ImagePlane& plane);

struct PlaneFit {
    ImagePlane plane;
    double residual = 0.0;  // root mean square of the heights of what lies in it (unit: meters)
    double share = 0.0;     // of the pixels with depth that lie in it (dimensionless)
};

struct PlaneSearch {
    Vec3 up{0.0, 1.0, 0.0};     // of the world, in the camera's frame, unit
    double max_tilt = 0.6;      // of the plane's normal from it (unit: radians), > 0
    double least_share = 0.04;  // of the pixels: less is no support (dimensionless)
    int tries = 150;            // planes through three pixels, and as many through three that are close
};

// Planes that are level enough, each with the most pixels of those that lie in none before it; none where the
// image has no such plane. The same image gives the same planes.
std::vector<PlaneFit> find_planes(const DepthImage& image, const DepthAccuracy& accuracy,
                                  const PlaneSearch& search, std::size_t most);

// A plane that is known, but for the share by which all depths may be off together: none where too little of
// it is seen. `known`: for depths as they are.
std::optional<PlaneFit> find_known_plane(const DepthImage& image, const DepthAccuracy& accuracy,
                                         const ImagePlane& known);

// The plane near `last` that fits best; none where too little of it is seen to tell.
std::optional<PlaneFit> follow_plane(const DepthImage& image, const DepthAccuracy& accuracy,
                                     const ImagePlane& last, double least_share);

}  // namespace tactus
