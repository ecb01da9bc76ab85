// What stands on the support and nobody has recognised yet, as one surface that can be touched.
//
// A grid over the image whose corners lie on their rays, at the depth that is seen there. Its triangles stay
// the same for ever: from image to image only corners move, so that who touches it is swept along. Where the
// support is seen, or an object that is known, it lies beneath the support; from the rim of what stands out
// it goes down there along the rays: nothing behind that can be seen, and so nothing there is open.
//
// A depth that agrees with the last ones is averaged with them. One that does not is believed when it has
// come a few times in succession: a pixel at an edge sees now this, now that.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "sensing/discovery/discovery.hpp"

namespace tactus {

struct CloudSurfaceSettings {
    int stride = 4;              // pixels between two corners, > 0
    double beneath = 0.02;       // the support, where nothing is to be touched (unit: meters), > 0
    double deviations = 4.0;     // of a depth: one that is off by more does not agree, > 0
    int images_to_change = 3;    // that do not agree, until they are believed, > 0
    int images_to_average = 30;  // at most, > 0
};

class CloudSurface {
public:
    explicit CloudSurface(const CloudSurfaceSettings& settings = {}) : settings_(settings) {}

    // After discovery.update() with the same image and place of the camera.
    void update(const DepthImage& image, const Discovery& discovery, const Pose& camera_in_world);
    // In the world. Empty before the first image.
    const TriangleMesh& mesh() const { return mesh_; }
    // Corners above the support now.
    std::size_t standing() const { return standing_; }

private:
    struct Corner {
        double depth = 0.0;  // true, along −z (unit: meters); 0: nothing has been seen there yet
        int images = 0;      // that it is the mean of
        int against = 0;     // in succession
        bool stands = false;
    };
    // What an image shows of a corner: the mean of the pixels around it that see the same.
    struct Look {
        bool sees = false, stands = false;
        double depth = 0.0;
    };

    void begin(const DepthCamera& camera);
    Look look(const DepthImage& image, const Discovery& discovery, int u, int v) const;
    void take(Corner& corner, const Look& look, const DepthAccuracy& accuracy) const;
    double beneath_support(const Discovery& discovery, const Vec3& ray) const;

    CloudSurfaceSettings settings_;
    DepthCamera camera_;
    int columns_ = 0, rows_ = 0;
    std::vector<Corner> corners_;
    TriangleMesh mesh_;
    std::size_t standing_ = 0;
};

}  // namespace tactus
