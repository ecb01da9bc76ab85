// The depth stream of a synthetic camera: a thread that looks at a scene and draws what a depth camera would
// see of it.
#pragma once

#include <OniCAPI.h>

#define XN_NEW(type, arg) new type(arg)
#define XN_DELETE(object) delete object
#include <Driver/OniDriverAPI.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "sensing/image/depth_noise.hpp"
#include "sensing/image/depth_renderer.hpp"
#include "sensing/synthetic_camera/scene_memory.hpp"

namespace tactus {

class SyntheticStream : public oni::driver::StreamBase {
public:
    explicit SyntheticStream(const SceneReader& scene);
    ~SyntheticStream() override { stop(); }

    OniStatus start() override;
    void stop() override;
    OniStatus getProperty(int property, void* data, int* size) override;
    OniStatus setProperty(int property, const void* data, int size) override;
    OniBool isPropertySupported(int property) override;

    static OniVideoMode mode_of(const SyntheticCamera& camera);

private:
    void run();
    void look(const SceneState& state);
    void draw(const SceneState& state);
    void send(const DepthImage& image);

    const SceneReader& scene_;
    DepthCamera view_;
    DepthNoise noise_;
    OniCropping cropping_{};
    OniBool is_mirrored_ = FALSE;

    std::thread thread_;
    std::atomic<bool> ends_{false};

    // The thread's own.
    DepthRenderer renderer_;
    DepthBuffer exact_;
    std::vector<PosedMesh> posed_;
    int frame_ = 0;
};

}  // namespace tactus
