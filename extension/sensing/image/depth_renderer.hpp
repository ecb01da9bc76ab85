// Draws meshes as a depth camera without faults would see them: exact depths at the pixels' own rays.
//
// In a plane n . p = c of the camera's frame the ray r(u, v) of a pixel has depth c / (n . r): 1 / depth is
// linear in u and v. So a triangle is three edge functions and one inverse depth, all linear in the image,
// and its depths are exact, not interpolated.
#pragma once

#include <array>
#include <span>

#include "core/math/pose.hpp"
#include "core/mesh/triangle_mesh.hpp"
#include "sensing/image/depth_image.hpp"

namespace tactus {

struct PosedMesh {
    const TriangleMesh* mesh = nullptr;  // sound: see check_mesh
    Pose pose;                           // in the camera's frame
};

// Keeps memory from one call to the next.
class DepthRenderer {
public:
    // Nearer than this nothing is seen: a triangle that reaches behind the camera is cut there.
    static constexpr double nearest = 0.01;  // (unit: meters)

    // Draws over what is there already: the nearest surface wins, from either side. The mesh is number
    // `index` in buffer.seen. Returns the pixels it may have touched.
    PixelBox draw(const PosedMesh& posed, std::uint16_t index, DepthBuffer& buffer);

    // All of them, numbered in their order, into an empty buffer.
    void render(const DepthCamera& camera, std::span<const PosedMesh> meshes, DepthBuffer& buffer);

private:
    std::vector<Vec3> corners_;     // in the camera's frame
    std::vector<PixelPlace> seen_;  // of corners_
};

}  // namespace tactus
