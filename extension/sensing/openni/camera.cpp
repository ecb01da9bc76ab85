#include "sensing/openni/camera.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <span>
#include <thread>
#include <utility>

#include "sensing/openni/recording_check.hpp"

namespace tactus {

namespace {

// Depth of a pixel in tenths of a millimeter; 0: not a format that is depth.
int tenths_of_millimeter(OniPixelFormat format) {
    return format == ONI_PIXEL_FORMAT_DEPTH_1_MM ? 10 : format == ONI_PIXEL_FORMAT_DEPTH_100_UM ? 1 : 0;
}

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

bool is_recording_path(const std::string& uri) {
    return uri.ends_with(".oni") || uri.ends_with(".ONI");
}

// OpenNI2's player of recordings looks through its streams without a lock: all the time while it plays, and
// once its file is at its end without anything else to do; while none is started, for some nanoseconds every
// 10 ms. A stream that is destroyed meanwhile ends the program. So long after it was stopped the player has
// seen that it is, and rests.
constexpr std::chrono::milliseconds until_player_rests(30);

bool is_view(float angle) {
    return angle > 0.01f && angle < 3.1f;
}

}  // namespace

std::string Camera::open(const Choice& choice) {
    close();
    is_gone_ = false;
    last_frame_ = 0;
    repeats_ = choice.repeats;
    is_file_ = is_recording_path(choice.uri);
    std::string error = open_device(choice.uri);
    // Not before info_ is known, which the callback reads.
    OniDeviceCallbacks callbacks{nullptr, on_disconnected, nullptr};
    openni_->register_device_callbacks(&callbacks, this, &callbacks_);
    if (error.empty()) {
        error = open_stream(choice.width);
    }
    if (error.empty() && !choice.record_to.empty()) {
        error = record(choice.record_to);
    }
    if (!error.empty()) {
        close();
        return error;
    }
    play_recording(choice);
    is_started_ = openni_->stream_start(stream_) == ONI_STATUS_OK;
    if (!is_started_) {
        error = name_ + " gives no depth: " + openni_.last_error();
        close();
    }
    return error;
}

std::string Camera::open_device(const std::string& uri) {
    if (is_recording_path(uri)) {
        if (const std::string wrong = check_recording(uri); !wrong.empty()) {
            return "the recording '" + uri + "' cannot be played: " + wrong + "; name another one";
        }
    }
    const std::vector<OniDeviceInfo> cameras = uri.empty() ? openni_.cameras() : std::vector<OniDeviceInfo>();
    if (uri.empty() && cameras.empty()) {
        return "no depth camera is there: plug one in, or name a recording (.oni)";
    }
    if (openni_->device_open(uri.empty() ? cameras.front().uri : uri.c_str(), &device_) != ONI_STATUS_OK) {
        const std::string why = openni_.last_error();
        return is_recording_path(uri)
                   ? "the recording '" + uri + "' cannot be played (" + why + "): name another one"
               : uri.empty() ? "the camera cannot be opened (" + why + "): is another program using it?"
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
    // A recording is as it is.
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
    int count = 0;
    const bool is_file = openni_->device_is_property_supported(device_, ONI_DEVICE_PROPERTY_PLAYBACK_SPEED);
    frame_count_ = is_file && get(ONI_STREAM_PROPERTY_NUMBER_OF_FRAMES, count) ? std::max(count, 0) : 0;
    return is_file && frame_count_ == 0 ? "the recording '" + std::string(info_.uri) +
                                              "' holds no depth images, it may be damaged: name another one"
                                        : "";
}

// What the stream gives from its start on. OpenNI2's recorder may end the program where it cannot write: the
// file is tried before.
std::string Camera::record(const std::string& path) {
    const auto refused = [&](const std::string& why) {
        return "its images cannot be recorded into '" + path + "' (" + why + "): name another file, or none";
    };
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) {
        return refused(std::strerror(errno));
    }
    std::fclose(file);
    if (openni_->create_recorder(path.c_str(), &recorder_) != ONI_STATUS_OK) {
        recorder_ = nullptr;
        return refused(openni_.last_error());
    }
    const bool runs = openni_->recorder_attach_stream(recorder_, stream_, FALSE) == ONI_STATUS_OK &&
                      openni_->recorder_start(recorder_) == ONI_STATUS_OK;
    return runs ? "" : refused(openni_.last_error());
}

void Camera::play_recording(const Choice& choice) {
    if (!is_recording()) {
        return;
    }
    const OniBool repeats = choice.repeats ? TRUE : FALSE;
    const float speed = choice.as_fast_as_read ? -1.0f : 1.0f;
    openni_->device_set_property(device_, ONI_DEVICE_PROPERTY_PLAYBACK_REPEAT_ENABLED, &repeats,
                                 sizeof repeats);
    openni_->device_set_property(device_, ONI_DEVICE_PROPERTY_PLAYBACK_SPEED, &speed, sizeof speed);
}

void Camera::close() {
    if (recorder_ != nullptr) {
        openni_->recorder_stop(recorder_);
        openni_->recorder_destroy(&recorder_);
        recorder_ = nullptr;
    }
    if (stream_ != nullptr) {
        stop();
        if (is_file_) {
            std::this_thread::sleep_for(until_player_rests);
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

void Camera::stop() {
    if (std::exchange(is_started_, false)) {
        openni_->stream_stop(stream_);
    }
}

void Camera::on_disconnected(const OniDeviceInfo* info, void* self) {
    auto* const camera = static_cast<Camera*>(self);
    if (std::strncmp(info->uri, camera->info_.uri, sizeof info->uri) == 0) {
        camera->is_gone_ = true;
    }
}

Camera::Reading Camera::without_frame() {
    if (is_gone_) {
        return Reading::lost;
    }
    // OpenNI2 says nothing when a file is at its end.
    return is_recording() && !repeats_ && last_frame_ >= frame_count_ ? Reading::ended : Reading::nothing;
}

Camera::Reading Camera::read(DepthImage& image, int wait_ms) {
    if (stream_ == nullptr || is_gone_) {
        return Reading::lost;
    }
    if (without_frame() == Reading::ended) {
        stop();  // or its player takes all of a processor
        return Reading::ended;
    }
    int index = 0;
    if (openni_->wait_for_any_stream(&stream_, 1, &index, wait_ms) != ONI_STATUS_OK) {
        return without_frame();
    }
    OniFrame* frame = nullptr;
    if (openni_->stream_read_frame(stream_, &frame) != ONI_STATUS_OK || frame == nullptr) {
        return without_frame();
    }
    last_frame_ = frame->frameIndex;
    const bool is_whole = take(*frame, image);
    openni_->frame_release(frame);
    return is_whole ? Reading::frame : Reading::damaged;
}

// A frame may be cropped: what it leaves out has no depth.
bool Camera::take(const OniFrame& frame, DepthImage& image) const {
    const int tenths = tenths_of_millimeter(frame.videoMode.pixelFormat);
    const int left = frame.croppingEnabled ? frame.cropOriginX : 0;
    const int top = frame.croppingEnabled ? frame.cropOriginY : 0;
    const bool is_inside = frame.width > 0 && frame.height > 0 && left >= 0 && top >= 0 &&
                           frame.width <= view_.width - left && frame.height <= view_.height - top;
    const auto row_bytes = static_cast<std::size_t>(frame.width) * sizeof(OniDepthPixel);
    if (tenths == 0 || !is_inside || frame.data == nullptr || frame.stride < 0 ||
        static_cast<std::size_t>(frame.stride) < row_bytes || frame.dataSize < 0 ||
        static_cast<std::size_t>(frame.dataSize) <
            static_cast<std::size_t>(frame.height - 1) * static_cast<std::size_t>(frame.stride) + row_bytes) {
        return false;
    }
    image.camera = view_;
    image.time_us = frame.timestamp;
    image.depth_mm.assign(pixel_count(view_), 0);
    for (int v = 0; v < frame.height; ++v) {
        const std::byte* const bytes = static_cast<const std::byte*>(frame.data) +
                                       static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.stride);
        std::uint16_t* const row =
            image.depth_mm.data() + static_cast<std::size_t>(v + top) * static_cast<std::size_t>(view_.width);
        for (int u = 0; u < frame.width; ++u) {
            OniDepthPixel told = 0;
            std::memcpy(&told, bytes + static_cast<std::size_t>(u) * sizeof told, sizeof told);
            const int at = is_mirrored_ ? view_.width - 1 - (u + left) : u + left;
            row[at] = tenths == 10 ? told : static_cast<std::uint16_t>((told + 5) / 10);
        }
    }
    return true;
}

}  // namespace tactus
