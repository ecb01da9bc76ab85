#include "sensing/synthetic_camera/synthetic_stream.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "platform/clock.hpp"

namespace tactus {

namespace {

using Clock = std::chrono::steady_clock;

// How soon a frame follows a show() that asked for it.
constexpr std::chrono::microseconds glance(500);

// Of what OpenNI2 and its recorder ask of every depth stream.
constexpr int max_depth_mm = 10000;

template <class Value>
OniStatus give(const Value& value, void* data, int* size) {
    if (*size < static_cast<int>(sizeof value)) {
        return ONI_STATUS_BAD_PARAMETER;
    }
    std::memcpy(data, &value, sizeof value);
    *size = sizeof value;
    return ONI_STATUS_OK;
}

// Square pixels.
double vertical_view(const SyntheticCamera& camera) {
    return 2.0 * std::atan(std::tan(0.5 * camera.field_of_view) * camera.height / camera.width);
}

DepthNoise noise_of(const SyntheticCamera& camera) {
    DepthNoise noise;
    noise.error_share = camera.depth_error;
    noise.random *= camera.noise;
    noise.edge_jitter *= camera.noise;
    noise.hole_share = std::min(1.0, noise.hole_share * camera.noise);
    return noise;
}

}  // namespace

SyntheticStream::SyntheticStream(const SceneReader& scene)
    : scene_(scene),
      view_(camera_of_view(scene.camera().width, scene.camera().height, scene.camera().field_of_view,
                           vertical_view(scene.camera()))),
      noise_(noise_of(scene.camera())) {
    cropping_ = {FALSE, 0, 0, view_.width, view_.height};
}

OniVideoMode SyntheticStream::mode_of(const SyntheticCamera& camera) {
    const int rate = camera.rate > 0.0 ? std::max(1, static_cast<int>(std::lround(camera.rate))) : 30;
    return {ONI_PIXEL_FORMAT_DEPTH_1_MM, camera.width, camera.height, rate};
}

OniStatus SyntheticStream::start() {
    stop();
    ends_ = false;
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::exception&) {
        return ONI_STATUS_ERROR;
    }
    return ONI_STATUS_OK;
}

void SyntheticStream::stop() {
    ends_ = true;
    if (thread_.joinable()) {
        thread_.join();
    }
}

OniStatus SyntheticStream::getProperty(int property, void* data, int* size) {
    switch (property) {
        case ONI_STREAM_PROPERTY_VIDEO_MODE:
            return give(mode_of(scene_.camera()), data, size);
        case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
            return give(static_cast<float>(scene_.camera().field_of_view), data, size);
        case ONI_STREAM_PROPERTY_VERTICAL_FOV:
            return give(static_cast<float>(vertical_view(scene_.camera())), data, size);
        case ONI_STREAM_PROPERTY_MAX_VALUE:
            return give(max_depth_mm, data, size);
        case ONI_STREAM_PROPERTY_MIN_VALUE:
            return give(0, data, size);
        case ONI_STREAM_PROPERTY_STRIDE:
            return give(view_.width * static_cast<int>(sizeof(OniDepthPixel)), data, size);
        case ONI_STREAM_PROPERTY_MIRRORING:
            return give(is_mirrored_, data, size);
        case ONI_STREAM_PROPERTY_CROPPING:
            return give(cropping_, data, size);
        default:
            return ONI_STATUS_NOT_SUPPORTED;
    }
}

// It sees what it sees: only its own mode, unmirrored and whole, may be asked for.
OniStatus SyntheticStream::setProperty(int property, const void* data, int size) {
    const auto is = [&](const auto& value) {
        return size == static_cast<int>(sizeof value) && std::memcmp(data, &value, sizeof value) == 0;
    };
    const bool is_so = property == ONI_STREAM_PROPERTY_VIDEO_MODE  ? is(mode_of(scene_.camera()))
                       : property == ONI_STREAM_PROPERTY_MIRRORING ? is(is_mirrored_)
                       : property == ONI_STREAM_PROPERTY_CROPPING  ? is(cropping_)
                                                                   : false;
    return is_so ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
}

OniBool SyntheticStream::isPropertySupported(int property) {
    return property >= ONI_STREAM_PROPERTY_CROPPING && property <= ONI_STREAM_PROPERTY_MIRRORING ? TRUE
                                                                                                 : FALSE;
}

void SyntheticStream::run() {
    const double rate = scene_.camera().rate;
    const auto period = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(rate > 0.0 ? 1.0 / rate : 1.0));
    Clock::time_point next = Clock::now();
    SceneState state;
    std::uint32_t drawn = 0;
    while (!ends_) {
        if (rate > 0.0) {
            std::this_thread::sleep_until(next);
            // A frame that is late drops those it was late for.
            next = std::max(next + period, Clock::now());
        } else {
            std::this_thread::sleep_for(glance);
        }
        if (!scene_.read(state) || state.plug != Plug::in || state.shown == 0 ||
            (rate == 0.0 && state.shown == drawn)) {
            continue;
        }
        if (state.shown == std::exchange(drawn, state.shown)) {
            // Nobody has shown anything else since: so it stands now, too.
            state.time = static_cast<std::uint64_t>(monotonic_now() / 1000);
        }
        draw(state);
    }
}

// What another renderer has drawn, or what is drawn here.
void SyntheticStream::look(const SceneState& state) {
    if (!state.image.empty()) {
        exact_.camera = view_;
        exact_.depth.assign(state.image.begin(), state.image.end());
        std::ranges::replace_if(
            exact_.depth, [](float depth) { return !(depth > 0.0f); },
            std::numeric_limits<float>::infinity());
        return;
    }
    const Pose to_camera = inverse(state.camera);
    posed_.clear();
    for (const ShownBody& body : state.bodies) {
        posed_.push_back({&scene_.meshes()[body.mesh], compose(to_camera, body.pose)});
    }
    renderer_.render(view_, posed_, exact_);
}

void SyntheticStream::draw(const SceneState& state) {
    look(state);
    ++frame_;
    if (scene_.camera().noise == 0.0) {
        for (float& depth : exact_.depth) {
            depth *= static_cast<float>(1.0 + noise_.error_share);
        }
        send(to_image(exact_, state.time));
        return;
    }
    // Each frame has chances of its own, the same in every run.
    send(noisy_image(exact_, noise_, scene_.camera().seed + static_cast<std::uint64_t>(frame_), state.time));
}

void SyntheticStream::send(const DepthImage& image) {
    OniFrame* const frame = getServices().acquireFrame();
    if (frame == nullptr) {
        return;
    }
    const std::size_t bytes = image.depth_mm.size() * sizeof(OniDepthPixel);
    if (frame->data != nullptr && frame->dataSize >= static_cast<int>(bytes)) {
        std::memcpy(frame->data, image.depth_mm.data(), bytes);
        frame->dataSize = static_cast<int>(bytes);
        frame->sensorType = ONI_SENSOR_DEPTH;
        frame->timestamp = image.time_us;
        frame->frameIndex = frame_;
        frame->width = view_.width;
        frame->height = view_.height;
        frame->videoMode = mode_of(scene_.camera());
        frame->croppingEnabled = FALSE;
        frame->cropOriginX = 0;
        frame->cropOriginY = 0;
        frame->stride = view_.width * static_cast<int>(sizeof(OniDepthPixel));
        raiseNewFrame(frame);
    }
    getServices().releaseFrame(frame);
}

}  // namespace tactus
