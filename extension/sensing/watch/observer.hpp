// From depth images to what the sensor's owner is told: the objects, the plane they stand on, and the cloud.
//
// Threads: the sensor's own.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "core/ports/depth_sensing.hpp"
#include "sensing/discovery/cloud_surface.hpp"
#include "sensing/discovery/discovery.hpp"

namespace tactus {

// A sight with all that it points to.
struct Picture {
    Sight sight;
    std::string text;
    std::vector<SightedObject> objects;
    std::vector<TriangleMesh> hulls;  // one for each object, empty where it is of the library
    std::vector<glm::vec3> cloud;
    TriangleMesh surface;

    // Points the sight to what is here.
    void point();
};

using MeshLibrary = std::vector<LibraryMesh>;

class Observer {
public:
    // Learns the meshes, which takes about a tenth of a second for each; what has been seen is forgotten.
    void set_library(const MeshLibrary& library);
    // What has been seen is forgotten; the meshes stay.
    void forget() {
        discovery_.reset();
        surface_ = CloudSurface();
    }

    // All of the picture but its state, text and times of arrival. Empty, or why nothing can be found in the
    // image: all places stay as they were, and are believed less.
    std::string look(const DepthImage& image, const SensorSettings& settings, Picture& picture);

    // Of the last image: what is seen and not told, and why; for the end of a sentence. Empty: nothing.
    std::string remark() const;

private:
    void begin(const SensorSettings& settings);
    void tell(const SensorSettings& settings, Picture& picture);

    std::shared_ptr<const std::vector<LearntMesh>> meshes_;
    std::vector<std::int32_t> indices_;  // of meshes_, in the library: what cannot be recognised is left out
    std::optional<Discovery> discovery_;
    CloudSurface surface_;
    std::optional<double> support_height_;  // that it was begun with
    std::unordered_set<std::uint32_t> told_;
};

}  // namespace tactus
