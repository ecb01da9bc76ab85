// One sensor: a thread that opens its camera, again and again while it is not there, looks at what comes, and
// keeps what it has seen for its owner.
//
// Threads: the owner's calls and the sensor's own thread meet in `mutex_`, which nobody holds for longer than
// it takes to copy a few words or to swap two pictures.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/ports/depth_sensing.hpp"
#include "platform/beside_loop.hpp"
#include "sensing/image/camera_clock.hpp"
#include "sensing/image/depth_image.hpp"
#include "sensing/image/frame_source.hpp"
#include "sensing/watch/lasting_thread.hpp"
#include "sensing/watch/observer.hpp"

namespace tactus {

// A CameraChoice that owns its texts.
struct SourceChoice {
    std::string uri;
    int width = 320;
    bool repeats = true;
    bool as_fast_as_read = false;
    std::string record_to;
};

// Null: `error` says why not and what to do. Called on the sensor's thread.
using OpenSource =
    std::function<std::unique_ptr<FrameSource>(const SourceChoice& choice, std::string& error)>;

class Sensor final : public SensorPort {
public:
    // Throws std::system_error where there is no thread for it.
    explicit Sensor(OpenSource open_source);
    ~Sensor();

    void open(const CameraChoice& choice) noexcept override;
    void close() noexcept override;
    void set_library(std::span<const KnownMesh> meshes) noexcept override;
    void set_settings(const SensorSettings& settings) noexcept override;
    bool take() noexcept override;
    const Sight& sight() const noexcept override { return front_.sight; }
    void destroy() noexcept override { delete this; }

private:
    // What the owner wants, as the thread finds it.
    struct Wanted {
        std::optional<SourceChoice> camera;  // none: closed
        std::uint64_t camera_change = 0;
        std::shared_ptr<const MeshLibrary> library = std::make_shared<MeshLibrary>();
        std::uint64_t library_change = 0;
        SensorSettings settings;
    };

    template <class Change>
    void want(const Change& change) noexcept;

    void run();
    void look_once();
    void follow(const Wanted& wanted);
    bool try_to_open();
    void read_frame();
    void miss_damaged();
    void see(const DepthImage& image, Nanoseconds arrived);
    void say(SensorState state, const std::string& text);
    void fade();
    void publish(bool is_new_frame);
    void wait(int milliseconds);

    const OpenSource open_source_;

    std::mutex mutex_;
    std::condition_variable wakes_;
    Wanted wanted_;
    bool ends_ = false;
    Picture middle_;
    bool has_new_ = false;        // middle_ is later than front_
    bool has_new_frame_ = false;  // by another frame

    Picture front_;  // the owner's

    // The thread's own.
    Wanted now_;
    std::unique_ptr<FrameSource> camera_;
    Observer observer_;
    BesideLoop beside_loop_;
    CameraClock clock_;
    DepthImage image_;
    Picture seen_, spare_;
    Nanoseconds last_frame_ = 0, last_fade_ = 0;
    int damaged_ = 0;  // images in succession

    LastingThread thread_;
};

}  // namespace tactus
