// One OpenNI2 camera: frames in, depth images out.
//
// Threads: one, but for what OpenNI2's own threads report, which is one flag.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "sensing/image/frame_source.hpp"
#include "sensing/openni/openni.hpp"
#include "sensing/recording/images_file.hpp"
#include "sensing/synthetic_camera/scene_memory.hpp"

namespace tactus {

class Camera final : public FrameSource {
public:
    struct Choice {
        std::string uri;  // empty: the first camera there is
        int width = 320;  // of the image, as nearly as the camera has it (unit: pixels)
        // A file (.oni) that its images are written to, or the next of this name that is not there yet;
        // empty: none.
        std::string record_to{};
        std::uintmax_t kept_free = tactus::kept_free;  // on that file's disk, else it ends (unit: bytes)
    };

    explicit Camera(const OpenNi& openni) : openni_(openni) {}
    ~Camera() override { close(); }
    Camera(const Camera&) = delete;
    Camera& operator=(const Camera&) = delete;

    // Empty, or why not and what to do.
    std::string open(const Choice& choice);
    void close();

    Reading read(DepthImage& image, int wait_ms) override;
    const std::string& name() const override { return name_; }
    const std::string& trouble() const override { return trouble_; }
    std::string remark() const override { return remark_; }
    bool has_our_clock() const override { return std::string_view(info_.uri).starts_with(synthetic_scheme); }

private:
    std::string open_device(const std::string& uri);
    std::string open_stream(int width);
    std::string record(const std::string& wanted, std::uintmax_t reserve);
    void stop_recording();
    void give_up();
    void keep_disk_free();
    std::string choose_mode(int width);
    std::string read_geometry();
    Reading take(const OniFrame& frame, DepthImage& image);
    Reading without_frame() const { return is_gone_ ? Reading::lost : Reading::nothing; }

    static void ONI_CALLBACK_TYPE on_disconnected(const OniDeviceInfo* info, void* self);

    const OpenNi& openni_;
    OniDeviceHandle device_ = nullptr;
    OniStreamHandle stream_ = nullptr;
    OniRecorderHandle recorder_ = nullptr;
    OniCallbackHandle callbacks_ = nullptr;
    OniDeviceInfo info_{};
    std::string name_, trouble_, remark_;
    std::string recorded_;        // the file that its images are written to
    std::uintmax_t reserve_ = 0;  // what stays free on its disk (unit: bytes)
    DepthCamera view_;
    bool is_started_ = false;  // the stream
    bool is_mirrored_ = false;
    std::atomic<bool> is_gone_{false};
};

}  // namespace tactus
