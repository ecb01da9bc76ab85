// From depth images to what the sensor's owner is told: the objects, the plane they stand on, and the cloud.
//
// Threads: the sensor's own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/geometry/triangle_mesh.hpp"
#include "core/ports/depth_sensing.hpp"
#include "sensing/image/depth_image.hpp"

namespace tactus {

// A sight with all that it points to.
struct Picture {
    Sight sight;
    std::string text;
    std::vector<SightedObject> objects;
    std::vector<TriangleMesh> hulls;  // one for each object, empty where it is of the library
    std::vector<glm::vec3> cloud;

    // Points the sight to what is here.
    void point();
};

struct LibraryMesh {
    TriangleMesh mesh;
    double mass = 0.0;  // (unit: kilograms)
};
using MeshLibrary = std::vector<LibraryMesh>;

class Observer {
public:
    // What has been seen is forgotten.
    void set_library(std::shared_ptr<const MeshLibrary> library);

    // All of the picture but its state, text and times of arrival.
    void look(const DepthImage& image, const SensorSettings& settings, Picture& picture);

private:
    std::shared_ptr<const MeshLibrary> library_;
};

}  // namespace tactus
