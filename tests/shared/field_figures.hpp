// A sphere as a field of samples, touched, beside the sphere in closed form.
#pragma once

#include <cstdint>
#include <vector>

namespace tactus::shared {

struct FieldFigures {
    int ticks = 0;
    int contact_ticks = 0;
    int unfinished = 0;
    // Of the proxy's place, the largest over all finished ticks in contact (unit: distances between samples).
    double error_voxels = 0.0;
    // The part of it across the surface.
    double height_error_voxels = 0.0;
    double build_milliseconds = 0.0;  // triangles and tree
    double triangles = 0.0;
    std::vector<double> microseconds;       // of each tick in contact, its force included
    std::vector<double> free_microseconds;  // of the others
};

// A sphere of radius 1 in `samples` samples along each axis, under the way of around_sphere().
FieldFigures play_field_sphere(std::uint32_t samples, double proxy_radius, int ticks);

}  // namespace tactus::shared
