// A drawn mesh whose corners follow bones and blend shapes, as it is drawn: with the shapes' ways added to
// the corners at rest, and then where the bones take them.
//
// Corners at one place of the mesh at rest are one, whatever bones they follow: seams of texture and shading
// stay closed, and the triangles are the same in every pose, so that a tree over them is refitted.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "world/scene_frame.hpp"
#include "world/triangle_source.hpp"

namespace tactus {

struct SkinnedMesh {
    TriangleMesh rest;
    // By vertex, so many each; none: nothing follows a bone. Weights are at least 0.
    std::size_t influences = 0;
    std::vector<std::uint16_t> bones;
    std::vector<float> weights;
    // By blend shape: the way of each vertex at the weight 1 (unit: meters).
    std::vector<std::vector<Vec3>> shapes;
};

struct SkinPose {
    std::vector<SceneFrame> bones;  // from the mesh at rest to where the bone takes it
    std::vector<double> shapes;     // weights
    SceneFrame place;               // of the whole mesh
    bool operator==(const SkinPose&) const = default;
};

// Of surfaces that are put together as they are drawn: clockwise triangles, corners split along seams.
class SkinCollector {
public:
    struct Surface {
        std::vector<Vec3> corners;
        std::vector<std::int32_t> indices;  // none: each corner in turn
        std::vector<std::int32_t> bones;    // so many for each corner; none: it follows no bone
        std::vector<float> weights;
        std::vector<std::vector<Vec3>> shapes;  // ways of the corners, by blend shape
    };
    void add(Surface surface) { surfaces_.push_back(std::move(surface)); }
    SkinnedMesh take();

private:
    std::vector<Surface> surfaces_;
};

// A vertex whose weights are all 0 stays where its shapes have it; weights need not add up to 1.
TriangleMesh posed(const SkinnedMesh& mesh, const SkinPose& pose);

// The triangles in that pose, for whoever asks: on their thread.
std::shared_ptr<TriangleSource> source_of(std::shared_ptr<const SkinnedMesh> mesh, SkinPose pose);

}  // namespace tactus
