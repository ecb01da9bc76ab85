// OpenNI2, loaded when a camera is wanted, from a folder made for the purpose: OpenNI2 looks for its drivers
// beside the path that it was loaded from, so there it finds the system's drivers and ours.
//
// Once started it stays: ending it takes OpenNI2 half a second, needs that folder anew the next time, and may
// wait for ever for a driver that is just telling of a camera (it holds its lock over both). Without a camera
// that is open it only waits for plugs.
//
// Threads: any.
#pragma once

#include <OniCAPI.h>

#include <string>
#include <vector>

namespace tactus {

// OpenNI2's functions, by their names less "oni".
struct OpenNiFunctions {
    decltype(&oniInitialize) initialize = nullptr;
    decltype(&oniGetExtendedError) get_extended_error = nullptr;
    decltype(&oniGetDeviceList) get_device_list = nullptr;
    decltype(&oniReleaseDeviceList) release_device_list = nullptr;
    decltype(&oniRegisterDeviceCallbacks) register_device_callbacks = nullptr;
    decltype(&oniUnregisterDeviceCallbacks) unregister_device_callbacks = nullptr;
    decltype(&oniDeviceOpen) device_open = nullptr;
    decltype(&oniDeviceClose) device_close = nullptr;
    decltype(&oniDeviceGetInfo) device_get_info = nullptr;
    decltype(&oniDeviceGetSensorInfo) device_get_sensor_info = nullptr;
    decltype(&oniDeviceIsPropertySupported) device_is_property_supported = nullptr;
    decltype(&oniDeviceSetProperty) device_set_property = nullptr;
    decltype(&oniDeviceCreateStream) device_create_stream = nullptr;
    decltype(&oniStreamDestroy) stream_destroy = nullptr;
    decltype(&oniStreamStart) stream_start = nullptr;
    decltype(&oniStreamStop) stream_stop = nullptr;
    decltype(&oniStreamSetProperty) stream_set_property = nullptr;
    decltype(&oniStreamGetProperty) stream_get_property = nullptr;
    decltype(&oniStreamReadFrame) stream_read_frame = nullptr;
    decltype(&oniWaitForAnyStream) wait_for_any_stream = nullptr;
    decltype(&oniFrameRelease) frame_release = nullptr;
    decltype(&oniCreateRecorder) create_recorder = nullptr;
    decltype(&oniRecorderAttachStream) recorder_attach_stream = nullptr;
    decltype(&oniRecorderStart) recorder_start = nullptr;
    decltype(&oniRecorderStop) recorder_stop = nullptr;
    decltype(&oniRecorderDestroy) recorder_destroy = nullptr;
};

class OpenNi {
public:
    // Started. Null: `error` says why not and what to do; the next call tries again. `own_driver`: a file
    // that is a driver, too; empty: none.
    static const OpenNi* get(const std::string& own_driver, std::string& error);

    const OpenNiFunctions* operator->() const { return &functions_; }
    std::string last_error() const;
    // Those that are plugged in. A scene that was opened by its name stays among OpenNI2's devices; opening
    // one that is gone ends the program.
    std::vector<OniDeviceInfo> cameras() const;

private:
    explicit OpenNi(const OpenNiFunctions& functions) : functions_(functions) {}

    OpenNiFunctions functions_;
};

}  // namespace tactus
