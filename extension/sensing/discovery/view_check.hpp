// Whether a mesh at a place is what the camera sees: it is drawn there and held against the image.
//
// Every pixel that the drawing or the piece of the image covers costs something, as minus the logarithm of
// how probable it is: an agreeing depth half its squared deviation, a pixel that is seen through, or that
// nothing explains, a fixed sum. What something nearer hides costs nothing. So the costs of different meshes
// over one piece compare.
#pragma once

#include <vector>

#include "sensing/discovery/learnt_mesh.hpp"
#include "sensing/discovery/pose_fit.hpp"
#include "sensing/discovery/segmentation.hpp"

namespace tactus {

// An image with what is known of it.
struct SeenScene {
    const DepthImage* image = nullptr;
    const Segmentation* segmentation = nullptr;
    DepthAccuracy accuracy;
    double scale = 1.0;  // true depth over told depth (dimensionless), > 0
};

struct ViewCheck {
    double cost = 0.0;     // over all pixels (dimensionless)
    int pixels = 0;        // of the piece
    int explained = 0;     // of the piece, by an agreeing depth
    int drawn = 0;         // of the mesh
    int confirmed = 0;     // of the mesh, by an agreeing depth
    int seen_through = 0;  // of the mesh, where the camera sees something behind it
    int hidden = 0;        // of the mesh, behind something nearer
    int outline = 0;       // pairs of neighbours across the outline of what is confirmed
    int goes_on = 0;       // of these, where what is seen goes on beyond it as if there were none
    double misfit = 0.0;   // cost of the mesh's pixels that are not hidden, on average: 1/2 by chance alone
    double apart = 0.0;    // mean of told minus drawn depth over what is confirmed (unit: meters)

    // How much of the piece is this mesh, and how much of this mesh, where it would be seen, is there: 0 … 1.
    double quality() const;
};

// Keeps memory from one call to the next.
class ViewChecker {
public:
    // `piece`: of the segmentation, 1 + index of the cluster; 0: none, what is confirmed alone counts.
    ViewCheck check(const SeenScene& scene, const LearntMesh& mesh, const Pose& mesh_in_camera,
                    std::uint16_t piece);

    // Of the last check, with the same arguments: adds to the normal equations how far told depths are from
    // those that were drawn, pixel by pixel. Which face a pixel sees follows from the pixel, not from its
    // depth: chance does not choose the face, as it does where points are laid onto the nearest one.
    void add_depths(const SeenScene& scene, const LearntMesh& mesh, const Pose& mesh_in_camera,
                    std::uint16_t piece, double reach_deviations, FitSums& sums) const;
    // Of the last check, with the same arguments: adds how far the outline of the
    // drawing is from that of the piece. Only where the piece ends before something farther away: at an edge
    // to something nearer, or where it stands on its support, it ends elsewhere than the mesh does.
    void add_outline(const SeenScene& scene, const Pose& mesh_in_camera, std::uint16_t piece,
                     FitSums& sums) const;

    // Of the last check: the pixels that were drawn, and their depths.
    const DepthBuffer& drawing() const { return drawing_; }
    PixelBox drawn_box() const { return drawn_; }

private:
    void clear(const DepthCamera& camera);
    bool is_rim(int u, int v) const;
    bool is_drawn(int u, int v) const;
    void look_beyond(const SeenScene& scene, int u, int v, ViewCheck& found) const;

    DepthRenderer renderer_;
    DepthBuffer drawing_;
    PixelBox drawn_;
};

}  // namespace tactus
