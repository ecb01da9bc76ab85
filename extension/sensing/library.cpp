// The door of the library: what core/ports/depth_sensing.hpp promises. No exception leaves.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>

#include "core/ports/depth_sensing.hpp"
#include "platform/shared_library.hpp"
#include "sensing/openni/openni.hpp"
#include "sensing/source.hpp"
#include "sensing/synthetic_camera/scene_memory.hpp"
#include "sensing/watch/sensor.hpp"

namespace tactus {

namespace {

// The synthetic camera's driver lies beside this library and is called like it.
std::string own_driver() {
    const std::filesystem::path library(path_of_this_library(reinterpret_cast<const void*>(&own_driver)));
    std::string name = library.filename().string();
    if (const std::size_t at = name.find("tactus_sensing"); at != std::string::npos) {
        name.replace(at, std::string("tactus_sensing").size(), "tactus_camera");
    }
    return (library.parent_path() / name).string();
}

void copy_text(const std::string& text, std::span<char> into) {
    if (into.empty()) {
        return;
    }
    const std::size_t length = std::min(text.size(), into.size() - 1);
    std::copy_n(text.begin(), length, into.begin());
    into[length] = '\0';
}

class OwnedScene final : public SyntheticScene {
public:
    OwnedScene(const SyntheticCamera& camera, std::span<const MeshView> meshes) {
        try {
            writer_ = std::make_unique<SceneWriter>(camera, meshes);
            uri_ = writer_->uri();
        } catch (const std::exception& thrown) {
            error_ = std::string("the synthetic camera has no scene: ") + thrown.what();
        }
    }

    const char* uri() const noexcept override { return uri_.c_str(); }
    const char* error() const noexcept override { return error_.c_str(); }
    void show(const Pose& camera, std::span<const ShownBody> bodies, std::uint64_t time) noexcept override {
        if (writer_ != nullptr) {
            writer_->show(camera, bodies, time);
        }
    }
    void set_plugged(bool is_plugged) noexcept override {
        if (writer_ != nullptr) {
            writer_->set_plug(is_plugged ? Plug::in : Plug::out);
        }
    }
    void destroy() noexcept override { delete this; }

private:
    std::unique_ptr<SceneWriter> writer_;
    std::string uri_;
    std::string error_;
};

SensorPort* make_sensor() noexcept {
    try {
        return new Sensor([driver = own_driver()](const SourceChoice& choice, std::string& error) {
            return open_source(choice, driver, error);
        });
    } catch (const std::exception&) {
        return nullptr;
    }
}

SyntheticScene* make_scene(const SyntheticCamera& camera, std::span<const MeshView> meshes) noexcept {
    try {
        return new OwnedScene(camera, meshes);
    } catch (const std::exception&) {
        return nullptr;
    }
}

int scan(std::span<FoundCamera> into, std::span<char> error) noexcept {
    try {
        std::string why;
        const OpenNi* const openni = OpenNi::get(own_driver(), why);
        if (openni == nullptr) {
            copy_text(why, error);
            return -1;
        }
        const std::vector<OniDeviceInfo> cameras = openni->cameras();
        for (std::size_t i = 0; i < std::min(cameras.size(), into.size()); ++i) {
            copy_text(cameras[i].uri, into[i].uri);
            copy_text(std::string(cameras[i].vendor) + " " + cameras[i].name, into[i].name);
        }
        return static_cast<int>(cameras.size());
    } catch (const std::exception& thrown) {
        copy_text(thrown.what(), error);
        return -1;
    }
}

constexpr DepthSensing library{depth_sensing_version, make_sensor, make_scene, scan};

}  // namespace

}  // namespace tactus

extern "C" __attribute__((visibility("default"))) const tactus::DepthSensing* tactus_depth_sensing(
    int version) {
    return version == tactus::depth_sensing_version ? &tactus::library : nullptr;
}
