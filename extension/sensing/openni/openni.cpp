#include "sensing/openni/openni.hpp"

#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string_view>

#include "platform/shared_library.hpp"
#include "sensing/openni/staging.hpp"
#include "sensing/synthetic_camera/scene_memory.hpp"

namespace tactus {

namespace fs = std::filesystem;

namespace {

template <typename Function>
bool find(const std::string& library, const char* name, Function& function) {
    std::string error;
    function = reinterpret_cast<Function>(function_of_library(library, name, error));
    return function != nullptr;
}

bool find_all(const std::string& library, OpenNiFunctions& oni) {
    return find(library, "oniInitialize", oni.initialize) &&
           find(library, "oniGetExtendedError", oni.get_extended_error) &&
           find(library, "oniGetDeviceList", oni.get_device_list) &&
           find(library, "oniReleaseDeviceList", oni.release_device_list) &&
           find(library, "oniRegisterDeviceCallbacks", oni.register_device_callbacks) &&
           find(library, "oniUnregisterDeviceCallbacks", oni.unregister_device_callbacks) &&
           find(library, "oniDeviceOpen", oni.device_open) &&
           find(library, "oniDeviceClose", oni.device_close) &&
           find(library, "oniDeviceGetInfo", oni.device_get_info) &&
           find(library, "oniDeviceGetSensorInfo", oni.device_get_sensor_info) &&
           find(library, "oniDeviceIsPropertySupported", oni.device_is_property_supported) &&
           find(library, "oniDeviceSetProperty", oni.device_set_property) &&
           find(library, "oniDeviceCreateStream", oni.device_create_stream) &&
           find(library, "oniStreamDestroy", oni.stream_destroy) &&
           find(library, "oniStreamStart", oni.stream_start) &&
           find(library, "oniStreamStop", oni.stream_stop) &&
           find(library, "oniStreamSetProperty", oni.stream_set_property) &&
           find(library, "oniStreamGetProperty", oni.stream_get_property) &&
           find(library, "oniStreamReadFrame", oni.stream_read_frame) &&
           find(library, "oniWaitForAnyStream", oni.wait_for_any_stream) &&
           find(library, "oniFrameRelease", oni.frame_release) &&
           find(library, "oniCreateRecorder", oni.create_recorder) &&
           find(library, "oniRecorderAttachStream", oni.recorder_attach_stream) &&
           find(library, "oniRecorderStart", oni.recorder_start) &&
           find(library, "oniRecorderStop", oni.recorder_stop) &&
           find(library, "oniRecorderDestroy", oni.recorder_destroy);
}

// Initialised, or why not. While it looks for its drivers, OpenNI2 makes their folder the program's own.
std::string start(const std::string& own_driver, OpenNiFunctions& oni) {
    const fs::path installed = find_openni();
    if (installed.empty()) {
        return "OpenNI2 is not installed: install it (Debian: apt-get install libopenni2-0)";
    }
    const Stage stage(installed, own_driver);
    std::string error;
    if (function_of_library(stage.library(), "oniInitialize", error) == nullptr) {
        return "OpenNI2 could not be loaded: " + error;
    }
    if (!find_all(stage.library(), oni)) {
        return "the OpenNI2 on this system is too old: version 2.2 or later is needed";
    }
    return oni.initialize(ONI_API_VERSION) == ONI_STATUS_OK
               ? ""
               : std::string("OpenNI2 does not start: ") + oni.get_extended_error();
}

}  // namespace

const OpenNi* OpenNi::get(const std::string& own_driver, std::string& error) {
    static std::mutex mutex;
    static std::unique_ptr<const OpenNi> started;
    const std::lock_guard lock(mutex);
    if (started != nullptr) {
        return started.get();
    }
    OpenNiFunctions functions;
    try {
        error = start(own_driver, functions);
    } catch (const std::exception& thrown) {
        error = std::string("OpenNI2 does not start: ") + thrown.what();
    }
    if (error.empty()) {
        started.reset(new OpenNi(functions));
    }
    return started.get();
}

std::string OpenNi::last_error() const {
    const char* const text = functions_.get_extended_error();
    std::string trimmed = text != nullptr ? text : "";
    while (!trimmed.empty() && (trimmed.back() == '\n' || trimmed.back() == ' ' || trimmed.back() == '\t')) {
        trimmed.pop_back();
    }
    return trimmed.empty() ? "no reason given" : trimmed;
}

std::vector<OniDeviceInfo> OpenNi::cameras() const {
    OniDeviceInfo* list = nullptr;
    int count = 0;
    std::vector<OniDeviceInfo> found;
    if (functions_.get_device_list(&list, &count) == ONI_STATUS_OK) {
        found.assign(list, list + count);
        functions_.release_device_list(list);
    }
    std::erase_if(found, [](const OniDeviceInfo& device) {
        return std::string_view(device.uri).starts_with(synthetic_scheme);
    });
    return found;
}

}  // namespace tactus
