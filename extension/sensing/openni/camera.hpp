// One OpenNI2 camera, or a recording of one: frames in, depth images out.
//
// Threads: one, but for what OpenNI2's own threads report, which is one flag.
#pragma once

#include <atomic>
#include <string>
#include <string_view>

#include "sensing/image/depth_image.hpp"
#include "sensing/openni/openni.hpp"
#include "sensing/synthetic_camera/scene_memory.hpp"

namespace tactus {

class Camera {
public:
    struct Choice {
        std::string uri;      // a camera's, or the path of an .oni file; empty: the first camera there is
        int width = 320;      // of the image, as nearly as the camera has it (unit: pixels)
        bool repeats = true;  // a recording, when it is at its end
        bool as_fast_as_read = false;  // a recording: drops no frame, waits for none
        std::string record_to{};       // a file (.oni) that its images are written to; empty: none
    };

    enum class Reading {
        frame,
        nothing,  // in the time that was given
        damaged,  // a frame came that is none; the next one may be whole
        ended,    // the recording is at its end
        lost,     // the camera is gone: open it again
    };

    explicit Camera(const OpenNi& openni) : openni_(openni) {}
    ~Camera() { close(); }
    Camera(const Camera&) = delete;
    Camera& operator=(const Camera&) = delete;

    // Empty, or why not and what to do.
    std::string open(const Choice& choice);
    void close();

    // Waits for a frame so long. `image` keeps its memory from one frame to the next.
    Reading read(DepthImage& image, int wait_ms);

    const std::string& name() const { return name_; }
    bool is_recording() const { return frame_count_ > 0; }
    // Its images are stamped with the time at which they were taken, on this machine's monotonic clock.
    bool has_our_clock() const { return std::string_view(info_.uri).starts_with(synthetic_scheme); }

private:
    std::string open_device(const std::string& uri);
    std::string open_stream(int width);
    std::string record(const std::string& path);
    std::string choose_mode(int width);
    std::string read_geometry();
    void play_recording(const Choice& choice);
    void stop();
    bool take(const OniFrame& frame, DepthImage& image) const;
    Reading without_frame();

    static void ONI_CALLBACK_TYPE on_disconnected(const OniDeviceInfo* info, void* self);

    const OpenNi& openni_;
    OniDeviceHandle device_ = nullptr;
    OniStreamHandle stream_ = nullptr;
    OniRecorderHandle recorder_ = nullptr;
    OniCallbackHandle callbacks_ = nullptr;
    OniDeviceInfo info_{};
    std::string name_;
    DepthCamera view_;
    bool is_file_ = false;     // what is open, a recording
    bool is_started_ = false;  // the stream
    bool is_mirrored_ = false;
    int frame_count_ = 0;  // of a recording; 0: a camera
    int last_frame_ = 0;
    bool repeats_ = true;
    std::atomic<bool> is_gone_{false};
};

}  // namespace tactus
