// An ordinary driver of OpenNI2 for cameras that do not exist: each looks at a scene in a file that its URI
// names (scene_memory.hpp). OpenNI2 finds it as lib*.so.0 among its drivers.
//
// Threads: OpenNI2 calls from any thread, one at a time for each device; the watch over the plugs is a thread
// of its own.
#include <chrono>
#include <cstring>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <utility>

#include "sensing/synthetic_camera/synthetic_stream.hpp"

namespace tactus {

namespace {

constexpr std::chrono::milliseconds plug_watch(20);

OniDeviceInfo info_of(const std::string& uri) {
    OniDeviceInfo info{};
    std::strncpy(info.uri, uri.c_str(), sizeof info.uri - 1);
    std::strncpy(info.vendor, "Tactus", sizeof info.vendor - 1);
    std::strncpy(info.name, "synthetic camera", sizeof info.name - 1);
    return info;
}

class SyntheticDevice : public oni::driver::DeviceBase {
public:
    explicit SyntheticDevice(std::shared_ptr<const SceneReader> scene)
        : scene_(std::move(scene)), mode_(SyntheticStream::mode_of(scene_->camera())) {}

    OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
        *sensors = &depth_;
        *count = 1;
        return ONI_STATUS_OK;
    }
    oni::driver::StreamBase* createStream(OniSensorType type) override {
        return type == ONI_SENSOR_DEPTH ? new (std::nothrow) SyntheticStream(*scene_) : nullptr;
    }
    void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }

private:
    std::shared_ptr<const SceneReader> scene_;
    OniVideoMode mode_;
    OniSensorInfo depth_{ONI_SENSOR_DEPTH, 1, &mode_};
};

}  // namespace

class SyntheticDriver : public oni::driver::DriverBase {
public:
    explicit SyntheticDriver(OniDriverServices* services) : DriverBase(services) {}

    OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                         oni::driver::DeviceDisconnectedCallback disconnected,
                         oni::driver::DeviceStateChangedCallback state_changed, void* cookie) override {
        const OniStatus status = DriverBase::initialize(connected, disconnected, state_changed, cookie);
        ends_ = false;
        watch_ = std::thread([this] { watch_plugs(); });
        return status;
    }

    // OpenNI2 asks of names that it does not know.
    OniStatus tryDevice(const char* uri) override {
        std::shared_ptr<const SceneReader> scene = opened(uri);
        SceneState state;
        if (scene == nullptr || !scene->read(state) || state.plug != Plug::in) {
            return ONI_STATUS_ERROR;
        }
        {
            const std::lock_guard lock(mutex_);
            scenes_[uri] = {scene, true};
        }
        const OniDeviceInfo info = info_of(uri);
        deviceConnected(&info);
        return ONI_STATUS_OK;
    }

    oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
        const std::lock_guard lock(mutex_);
        const auto found = scenes_.find(uri);
        return found != scenes_.end() ? new (std::nothrow) SyntheticDevice(found->second.scene) : nullptr;
    }
    void deviceClose(oni::driver::DeviceBase* device) override { delete device; }

    void shutdown() override {
        ends_ = true;
        if (watch_.joinable()) {
            watch_.join();
        }
        scenes_.clear();
    }

private:
    std::shared_ptr<const SceneReader> opened(const char* uri) {
        try {
            return std::make_shared<const SceneReader>(uri);
        } catch (const std::exception& thrown) {
            if (std::string(uri).starts_with(synthetic_scheme)) {
                getServices().errorLoggerAppend("%s", thrown.what());
            }
            return nullptr;
        }
    }

    // OpenNI2 never asks again for a name that it has known: whoever comes back says so.
    void watch_plugs() {
        while (!ends_) {
            std::this_thread::sleep_for(plug_watch);
            for (const auto& [uri, is_in] : take_changes()) {
                const OniDeviceInfo info = info_of(uri);
                is_in ? deviceConnected(&info) : deviceDisconnected(&info);
            }
        }
    }
    // Which have been put in (true) or pulled out since the last time.
    std::vector<std::pair<std::string, bool>> take_changes() {
        const std::lock_guard lock(mutex_);
        std::vector<std::pair<std::string, bool>> changes;
        for (auto named = scenes_.begin(); named != scenes_.end();) {
            auto& [uri, known] = *named;
            SceneState state;
            const bool is_read = known.scene->read(state);
            const bool is_in = is_read ? state.plug == Plug::in : known.is_in;
            if (std::exchange(known.is_in, is_in) != is_in) {
                changes.emplace_back(uri, is_in);
            }
            named = is_read && state.plug == Plug::gone ? scenes_.erase(named) : std::next(named);
        }
        return changes;
    }

    struct Known {
        std::shared_ptr<const SceneReader> scene;
        bool is_in = false;
    };

    std::mutex mutex_;  // of scenes_
    std::map<std::string, Known> scenes_;
    std::atomic<bool> ends_{false};
    std::thread watch_;
};

}  // namespace tactus

ONI_EXPORT_DRIVER(tactus::SyntheticDriver)
