#include "sensing/openni/camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <span>
#include <utility>

#include "sensing/openni/frame_reading.hpp"
#include "sensing/recording/images_file.hpp"

namespace tactus {

namespace {

constexpr const char* make_room = "make room, then open the camera again";

// The nearest width counts first, then whole millimeters, then speed.
bool is_better(const OniVideoMode& one, const OniVideoMode& other, int width) {
    const auto rank = [width](const OniVideoMode& mode) {
        return std::array<int, 3>{std::abs(mode.resolutionX - width),
                                  mode.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_1_MM ? 0 : 1, -mode.fps};
    };
    return rank(one) < rank(other);
}

bool is_same(const OniVideoMode& one, const OniVideoMode& other) {
    return one.pixelFormat == other.pixelFormat && one.resolutionX == other.resolutionX &&
           one.resolutionY == other.resolutionY && one.fps == other.fps;
}

bool is_view(float angle) {
    return angle > 0.01f && angle < 3.1f;
}

}  // namespace

std::string Camera::open(const Choice& choice) {
    close();
    is_gone_ = false;
    remark_.clear();
    std::string error = open_device(choice.uri);
    // Not before info_ is known, which the callback reads.
    OniDeviceCallbacks callbacks{nullptr, on_disconnected, nullptr};
    openni_->register_device_callbacks(&callbacks, this, &callbacks_);
    if (error.empty()) {
        error = open_stream(choice.width);
    }
    if (error.empty() && !choice.record_to.empty()) {
        error = record(choice.record_to, choice.kept_free);
    }
    if (!error.empty()) {
        give_up();
        return error;
    }
    is_started_ = openni_->stream_start(stream_) == ONI_STATUS_OK;
    if (!is_started_) {
        error = name_ + " gives no depth: " + openni_.last_error();
        give_up();
    }
    return error;
}

std::string Camera::open_device(const std::string& uri) {
    const std::vector<OniDeviceInfo> cameras = uri.empty() ? openni_.cameras() : std::vector<OniDeviceInfo>();
    if (uri.empty() && cameras.empty()) {
        return "no depth camera is there: plug one in, or name a recording (.oni)";
    }
    if (openni_->device_open(uri.empty() ? cameras.front().uri : uri.c_str(), &device_) != ONI_STATUS_OK) {
        const std::string why = openni_.last_error();
        return uri.empty() ? "the camera cannot be opened (" + why + "): is another program using it?"
                           : "there is no camera '" + uri + "' (" + why + "): choose one of those found";
    }
    if (openni_->device_get_info(device_, &info_) != ONI_STATUS_OK) {
        return "the camera does not say what it is: unplug it and plug it in again";
    }
    name_ = info_.name[0] != '\0' ? std::string(info_.vendor) + " " + info_.name : std::string(info_.uri);
    return "";
}

std::string Camera::open_stream(int width) {
    if (openni_->device_get_sensor_info(device_, ONI_SENSOR_DEPTH) == nullptr) {
        return name_ + " gives no depth, only other images: choose another one";
    }
    if (openni_->device_create_stream(device_, ONI_SENSOR_DEPTH, &stream_) != ONI_STATUS_OK) {
        return name_ + " gives no depth: " + openni_.last_error();
    }
    if (std::string error = choose_mode(width); !error.empty()) {
        return error;
    }
    // What the camera does not know it does not do; what it does all the same, read_geometry() finds.
    const OniBool is_mirrored = FALSE;
    openni_->stream_set_property(stream_, ONI_STREAM_PROPERTY_MIRRORING, &is_mirrored, sizeof is_mirrored);
    return read_geometry();
}

std::string Camera::choose_mode(int width) {
    const OniSensorInfo* const info = openni_->device_get_sensor_info(device_, ONI_SENSOR_DEPTH);
    const OniVideoMode* best = nullptr;
    for (const OniVideoMode& mode :
         std::span(info->pSupportedVideoModes,
                   static_cast<std::size_t>(std::max(info->numSupportedVideoModes, 0)))) {
        if (tenths_of_millimeter(mode.pixelFormat) != 0 &&
            (best == nullptr || is_better(mode, *best, width))) {
            best = &mode;
        }
    }
    if (best == nullptr) {
        return name_ + " gives its depth in a format that is not of millimeters: choose another camera";
    }
    OniVideoMode current{};
    int size = sizeof current;
    const bool is_known = openni_->stream_get_property(stream_, ONI_STREAM_PROPERTY_VIDEO_MODE, &current,
                                                       &size) == ONI_STATUS_OK;
    if (is_known && is_same(current, *best)) {
        return "";
    }
    OniVideoMode wanted = *best;
    const bool is_set = openni_->stream_set_property(stream_, ONI_STREAM_PROPERTY_VIDEO_MODE, &wanted,
                                                     sizeof wanted) == ONI_STATUS_OK;
    return is_set || (is_known && tenths_of_millimeter(current.pixelFormat) != 0)
               ? ""
               : name_ + " does not take its own video mode: unplug it and plug it in again";
}

std::string Camera::read_geometry() {
    OniVideoMode mode{};
    float horizontal = 0.0f;
    float vertical = 0.0f;
    const auto get = [this](int property, auto& value) {
        int size = sizeof value;
        return openni_->stream_get_property(stream_, property, &value, &size) == ONI_STATUS_OK &&
               size == sizeof value;
    };
    if (!get(ONI_STREAM_PROPERTY_VIDEO_MODE, mode) || !get(ONI_STREAM_PROPERTY_HORIZONTAL_FOV, horizontal) ||
        !get(ONI_STREAM_PROPERTY_VERTICAL_FOV, vertical) || !is_view(horizontal) || !is_view(vertical) ||
        mode.resolutionX <= 0 || mode.resolutionY <= 0) {
        return name_ + " does not tell its size or angle of view: choose another one";
    }
    view_ = camera_of_view(mode.resolutionX, mode.resolutionY, horizontal, vertical);
    OniBool is_mirrored = FALSE;
    is_mirrored_ = get(ONI_STREAM_PROPERTY_MIRRORING, is_mirrored) && is_mirrored != FALSE;
    return "";
}

// What the stream gives from its start on. OpenNI2's recorder may end the program where it cannot write: the
// file is made before.
std::string Camera::record(const std::string& wanted, std::uintmax_t reserve) {
    recorded_ = wanted;
    if (std::string error = make_images_file(recorded_); !error.empty()) {
        return error;
    }
    reserve_ = reserve;
    if (has_less_free(recorded_, reserve_)) {
        std::remove(recorded_.c_str());
        remark_ = "; '" + recorded_ + "' is not recorded, as its disk is nearly full: " + make_room;
        return "";
    }
    if (openni_->create_recorder(recorded_.c_str(), &recorder_) != ONI_STATUS_OK) {
        recorder_ = nullptr;
        std::remove(recorded_.c_str());
        return images_file_error(recorded_, openni_.last_error());
    }
    const bool runs = openni_->recorder_attach_stream(recorder_, stream_, FALSE) == ONI_STATUS_OK &&
                      openni_->recorder_start(recorder_) == ONI_STATUS_OK;
    return runs ? "" : images_file_error(recorded_, openni_.last_error());
}

void Camera::stop_recording() {
    if (recorder_ != nullptr) {
        openni_->recorder_stop(recorder_);
        openni_->recorder_destroy(&recorder_);
        recorder_ = nullptr;
    }
}

// The next try makes its own file.
void Camera::give_up() {
    const bool has_file = recorder_ != nullptr;
    close();
    if (has_file) {
        std::remove(recorded_.c_str());
    }
}

void Camera::keep_disk_free() {
    if (recorder_ != nullptr && has_less_free(recorded_, reserve_)) {
        stop_recording();
        remark_ = "; '" + recorded_ + "' ends here, as its disk is nearly full: " + make_room;
    }
}

void Camera::close() {
    stop_recording();
    if (stream_ != nullptr) {
        if (std::exchange(is_started_, false)) {
            openni_->stream_stop(stream_);
        }
        openni_->stream_destroy(stream_);
        stream_ = nullptr;
    }
    if (device_ != nullptr) {
        openni_->device_close(device_);
        device_ = nullptr;
    }
    if (callbacks_ != nullptr) {
        openni_->unregister_device_callbacks(callbacks_);
        callbacks_ = nullptr;
    }
}

void Camera::on_disconnected(const OniDeviceInfo* info, void* self) {
    auto* const camera = static_cast<Camera*>(self);
    if (std::strncmp(info->uri, camera->info_.uri, sizeof info->uri) == 0) {
        camera->is_gone_ = true;
    }
}

FrameSource::Reading Camera::read(DepthImage& image, int wait_ms) {
    if (stream_ == nullptr || is_gone_) {
        return Reading::lost;
    }
    int index = 0;
    if (openni_->wait_for_any_stream(&stream_, 1, &index, wait_ms) != ONI_STATUS_OK) {
        return without_frame();
    }
    OniFrame* frame = nullptr;
    if (openni_->stream_read_frame(stream_, &frame) != ONI_STATUS_OK || frame == nullptr) {
        return without_frame();
    }
    keep_disk_free();
    const Reading reading = take(*frame, image);
    openni_->frame_release(frame);
    return reading;
}

// Another program may have set another video mode.
FrameSource::Reading Camera::take(const OniFrame& frame, DepthImage& image) {
    std::string wrong;
    if (!has_size_of(frame, view_)) {
        wrong = read_geometry();
    }
    if (wrong.empty()) {
        wrong = take_frame(frame, view_, is_mirrored_, image);
    }
    trouble_ = wrong.empty() ? "" : name_ + ": " + wrong + "; unplug it and plug it in again";
    return wrong.empty() ? Reading::frame : Reading::damaged;
}

}  // namespace tactus
