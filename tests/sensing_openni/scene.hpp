// A table with things on it that nobody can mistake for their mirror image, and a synthetic camera that looks
// at it through the real OpenNI2.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "sensing/image/depth_renderer.hpp"
#include "sensing/openni/camera.hpp"
#include "sensing/synthetic_camera/scene_memory.hpp"
#include "shared/meshes.hpp"
#include "support/process.hpp"

namespace tactus::testing {

inline std::string driver_path() {
    return (program_path().parent_path() / "camera/libtactus_camera.so").string();
}

inline const OpenNi& openni() {
    std::string error;
    const OpenNi* const found = OpenNi::get(driver_path(), error);
    if (found == nullptr) {
        throw std::runtime_error(error);
    }
    return *found;
}

inline MeshView view_of(const TriangleMesh& mesh) {
    return {mesh.vertices, mesh.triangles};
}

// Frames come when they are asked for, and show exact depths, unless said otherwise.
inline SyntheticCamera exact_camera() {
    SyntheticCamera camera;
    camera.rate = 0.0;
    camera.depth_error = 0.0;
    camera.noise = 0.0;
    return camera;
}

class Scene {
public:
    explicit Scene(const SyntheticCamera& settings = exact_camera())
        : settings_(settings), writer_(settings, views_of(meshes_)) {}

    std::string uri() const { return writer_.uri(); }
    SceneWriter& writer() { return writer_; }

    void show(std::uint64_t time = 0) { writer_.show(camera_, bodies_, time); }
    const Pose& camera() const { return camera_; }
    const Pose& box() const { return bodies_[1].pose; }
    // The big box, along x.
    void move(double along) { bodies_[1].pose.position.x = -0.1 + along; }

    // What an exact camera sees of it.
    DepthImage image(std::uint64_t time = 0) const {
        const DepthCamera view =
            camera_of_view(settings_.width, settings_.height, settings_.field_of_view, vertical_view());
        std::vector<PosedMesh> posed;
        for (const ShownBody& body : bodies_) {
            posed.push_back({&meshes_[body.mesh], compose(inverse(camera_), body.pose)});
        }
        DepthRenderer renderer;
        DepthBuffer buffer;
        renderer.render(view, posed, buffer);
        return to_image(buffer, time);
    }

private:
    static std::vector<MeshView> views_of(const std::vector<TriangleMesh>& meshes) {
        std::vector<MeshView> views;
        for (const TriangleMesh& mesh : meshes) {
            views.push_back(view_of(mesh));
        }
        return views;
    }
    double vertical_view() const {
        return 2.0 * std::atan(std::tan(0.5 * settings_.field_of_view) * settings_.height / settings_.width);
    }

    SyntheticCamera settings_;
    std::vector<TriangleMesh> meshes_{shared::box({0.5, 0.01, 0.4}), shared::box({0.05, 0.04, 0.03}),
                                      shared::icosphere(2, 0.03)};
    // 0.85 m from the table, steeply from above.
    Pose camera_{{0.0, 0.7, 0.48}, glm::angleAxis(-0.97, Vec3(1.0, 0.0, 0.0))};
    std::vector<ShownBody> bodies_{{0, {{0.0, -0.01, 0.0}}},
                                   {1, {{-0.1, 0.04, 0.02}, glm::angleAxis(0.4, Vec3(0.0, 1.0, 0.0))}},
                                   {2, {{0.12, 0.03, -0.05}}}};
    SceneWriter writer_;
};

// A frame that shows this scene, which is shown for it; fails where none comes.
inline DepthImage frame_of(Camera& camera, Scene& scene, std::uint64_t time) {
    scene.show(time);
    DepthImage image;
    for (int i = 0; i < 50; ++i) {
        if (camera.read(image, 100) == Camera::Reading::frame && image.time_us == time) {
            return image;
        }
    }
    ADD_FAILURE() << "no frame of " << time << " µs has come";
    return image;
}

}  // namespace tactus::testing
