#include "sensing/observer.hpp"

namespace tactus {

namespace {

void deproject(const DepthImage& image, std::vector<glm::vec3>& cloud) {
    cloud.clear();
    std::size_t at = 0;
    for (int v = 0; v < image.camera.height; ++v) {
        for (int u = 0; u < image.camera.width; ++u) {
            if (const std::uint16_t depth = image.depth_mm[at++]; depth != 0) {
                cloud.emplace_back(ray_through(image.camera, u, v) * (0.001 * depth));
            }
        }
    }
}

}  // namespace

void Picture::point() {
    for (std::size_t i = 0; i < objects.size() && i < hulls.size(); ++i) {
        objects[i].hull = {hulls[i].vertices, hulls[i].triangles};
    }
    sight.objects = objects;
    sight.cloud = cloud;
    sight.text = text.c_str();
}

void Observer::set_library(std::shared_ptr<const MeshLibrary> library) {
    library_ = std::move(library);
}

void Observer::look(const DepthImage& image, const SensorSettings& settings, Picture& picture) {
    picture.sight.camera = settings.camera;
    deproject(image, picture.cloud);
}

}  // namespace tactus
