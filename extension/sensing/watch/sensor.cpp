#include "sensing/watch/sensor.hpp"

#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "platform/clock.hpp"
#include "platform/this_thread.hpp"

namespace tactus {

namespace {

constexpr int frame_wait_ms = 100;
constexpr int retry_ms = 1000;

// Longer than any camera leaves between two frames (unit: nanoseconds).
constexpr Nanoseconds silence = 1'000'000'000;

// Without a new frame what was seen is believed half as much after so long (unit: seconds).
constexpr double half_life = 2.0;

}  // namespace

Sensor::Sensor(OpenSource open_source) : open_source_(std::move(open_source)), thread_([this] { run(); }) {}

Sensor::~Sensor() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    wakes_.notify_one();
    thread_.join();
}

template <class Change>
void Sensor::want(const Change& change) noexcept {
    try {
        const std::lock_guard lock(mutex_);
        change();
    } catch (const std::exception&) {
        return;  // no memory: all stays as it was
    }
    wakes_.notify_one();
}

void Sensor::open(const CameraChoice& choice) noexcept {
    want([&] {
        wanted_.camera =
            SourceChoice{choice.uri, choice.width, choice.repeats, choice.as_fast_as_read, choice.record_to};
        ++wanted_.camera_change;
    });
}

void Sensor::close() noexcept {
    want([&] {
        wanted_.camera.reset();
        ++wanted_.camera_change;
    });
}

void Sensor::set_library(std::span<const KnownMesh> meshes) noexcept {
    want([&] {
        auto library = std::make_shared<MeshLibrary>();
        for (const KnownMesh& known : meshes) {
            library->push_back({known.name,
                                {{known.mesh.vertices.begin(), known.mesh.vertices.end()},
                                 {known.mesh.triangles.begin(), known.mesh.triangles.end()}},
                                known.mass});
        }
        wanted_.library = std::move(library);
        ++wanted_.library_change;
    });
}

void Sensor::set_settings(const SensorSettings& settings) noexcept {
    want([&] { wanted_.settings = settings; });
}

bool Sensor::take() noexcept {
    const std::lock_guard lock(mutex_);
    const bool is_new = has_new_frame_;
    if (has_new_) {
        std::swap(front_, middle_);
        front_.point();
        has_new_ = has_new_frame_ = false;
    }
    return is_new;
}

void Sensor::run() {
    name_this_thread("tactus_sensor");
    work_in_background();
    for (;;) {
        {
            const std::lock_guard lock(mutex_);
            if (ends_) {
                break;
            }
        }
        try {
            look_once();
        } catch (const std::exception& thrown) {
            camera_.reset();
            say(SensorState::opening, std::string("the sensor has failed and begins anew: ") + thrown.what());
            wait(retry_ms);
        }
    }
    camera_.reset();
}

void Sensor::look_once() {
    Wanted wanted;
    {
        const std::lock_guard lock(mutex_);
        wanted = wanted_;
    }
    follow(wanted);
    if (!now_.camera) {
        wait(retry_ms);
    } else if (camera_ == nullptr && !try_to_open()) {
        fade();
        wait(retry_ms);
    } else {
        read_frame();
    }
}

void Sensor::follow(const Wanted& wanted) {
    const bool is_other_library = wanted.library_change != now_.library_change;
    const bool is_other_camera = wanted.camera_change != now_.camera_change;
    now_ = wanted;
    if (is_other_library) {
        say(seen_.sight.state, "learning the meshes of the library");
        observer_.set_library(*now_.library);
    }
    if (is_other_camera) {
        camera_.reset();
        seen_ = {};
        last_frame_ = 0;
        observer_.forget();
        say(now_.camera ? SensorState::opening : SensorState::closed,
            now_.camera ? "opening the camera" : "closed");
    }
}

bool Sensor::try_to_open() {
    std::string error;
    std::unique_ptr<FrameSource> camera = open_source_(*now_.camera, error);
    if (camera == nullptr) {
        say(SensorState::opening, error);
        return false;
    }
    say(SensorState::waiting, camera->name() + " is open, waiting for its first frame");
    camera_ = std::move(camera);
    clock_.forget();
    last_frame_ = monotonic_now();
    return true;
}

void Sensor::read_frame() {
    switch (camera_->read(image_, frame_wait_ms)) {
        case FrameSource::Reading::frame:
            damaged_ = 0;
            see(image_, monotonic_now());
            return;
        case FrameSource::Reading::damaged:
            miss_damaged();
            break;
        case FrameSource::Reading::ended:
            if (seen_.sight.state != SensorState::ended) {
                say(SensorState::ended, "the recording is at its end: open it again, or let it repeat");
            }
            wait(frame_wait_ms);
            break;
        case FrameSource::Reading::lost:
            say(SensorState::opening, camera_->name() + " is gone: plug it in again");
            camera_.reset();
            wait(frame_wait_ms);
            break;
        case FrameSource::Reading::nothing:
            if (monotonic_now() - last_frame_ > silence && seen_.sight.state != SensorState::waiting) {
                say(SensorState::waiting,
                    camera_->name() + " sends no frames: unplug it and plug it in again");
            }
            break;
    }
    fade();
}

// A single one is forgotten over the next, however late this thread is.
void Sensor::miss_damaged() {
    ++seen_.sight.dropped;
    ++damaged_;
    const bool is_silent = damaged_ > 1 && monotonic_now() - last_frame_ > silence;
    if (seen_.sight.state != SensorState::seeing || is_silent) {
        say(SensorState::waiting, camera_->trouble());
    }
}

void Sensor::see(const DepthImage& image, Nanoseconds arrived) {
    const bool is_too_soon = !now_.camera->as_fast_as_read && now_.settings.max_rate > 0.0 &&
                             to_seconds(arrived - last_frame_) < 0.9 / now_.settings.max_rate &&
                             seen_.sight.frames > 0;
    if (is_too_soon) {
        return;
    }
    last_frame_ = last_fade_ = arrived;
    const Nanoseconds taken_at =
        camera_->has_our_clock() ? time_of_stamp(image.time_us) : clock_.taken_at(image.time_us, arrived);
    const Nanoseconds seen_at = taken_at - from_seconds(now_.settings.camera_delay);
    beside_loop_.begin_burst();
    const std::string wrong = observer_.look(image, now_.settings, seen_);
    beside_loop_.end_burst();
    if (!wrong.empty()) {
        ++seen_.sight.dropped;
        say(SensorState::waiting, wrong);
        publish(false);
        return;
    }
    seen_.sight.state = SensorState::seeing;
    seen_.text = "seeing through " + camera_->name() + camera_->remark() + observer_.remark();
    ++seen_.sight.frames;
    seen_.sight.camera_time = image.time_us;
    seen_.sight.seen_at = seen_at;
    seen_.sight.times.frame = to_seconds(monotonic_now() - arrived);
    publish(true);
}

// The last good model stays; how far it is believed falls.
void Sensor::fade() {
    const Nanoseconds now = monotonic_now();
    if (seen_.objects.empty() || last_fade_ == 0 || now - last_frame_ < silence) {
        last_fade_ = now;
        return;
    }
    const double less = std::exp2(-to_seconds(now - std::exchange(last_fade_, now)) / half_life);
    for (SightedObject& object : seen_.objects) {
        object.confidence *= less;
        object.linear_velocity = object.angular_velocity = Vec3(0.0);
    }
    publish(false);
}

void Sensor::say(SensorState state, const std::string& text) {
    if (seen_.sight.state == state && seen_.text == text) {
        return;
    }
    seen_.sight.state = state;
    seen_.text = text;
    publish(false);
}

// Clouds are copied before anybody has to wait for it.
void Sensor::publish(bool is_new_frame) {
    spare_ = seen_;
    const std::lock_guard lock(mutex_);
    std::swap(middle_, spare_);
    has_new_ = true;
    has_new_frame_ = has_new_frame_ || is_new_frame;
}

void Sensor::wait(int milliseconds) {
    std::unique_lock lock(mutex_);
    wakes_.wait_for(lock, std::chrono::milliseconds(milliseconds), [this] {
        return ends_ || wanted_.camera_change != now_.camera_change ||
               wanted_.library_change != now_.library_change;
    });
}

}  // namespace tactus
