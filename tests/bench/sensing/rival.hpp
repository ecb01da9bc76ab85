// Another way from depth images to objects, held beside ours in the same run.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/math/pose.hpp"
#include "core/mesh/triangle_mesh.hpp"

namespace tactus::shared {

struct RivalMatch {
    bool found = false;
    std::size_t mesh = 0;  // index in its library
    Pose pose;             // of the mesh in the camera's frame
};

// Points are in the camera's frame (unit: meters).
class SensingRival {
public:
    virtual ~SensingRival() = default;

    // What stands out of the largest plane, in pieces.
    virtual std::vector<std::vector<Vec3>> pieces(std::span<const Vec3> points) = 0;
    // Which mesh of the library a piece is, and where.
    virtual RivalMatch recognise(std::span<const Vec3> piece) = 0;
    // The mesh was at `from`, and these are the points around it: where it is now.
    virtual Pose follow(std::size_t mesh, std::span<const Vec3> points, const Pose& from) = 0;
};

// By the Point Cloud Library; null where the machine does not have it.
std::unique_ptr<SensingRival> make_pcl_rival(const std::vector<TriangleMesh>& library);

}  // namespace tactus::shared
