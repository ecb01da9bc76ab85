#include "sensing/source.hpp"

#include <filesystem>

#include "sensing/openni/camera.hpp"
#include "sensing/recording/images_file.hpp"
#include "sensing/recording/recorded_frames.hpp"

namespace tactus {

namespace {

namespace fs = std::filesystem;

// All its images are in the file that they come from.
std::string copy_recording(const std::string& from, std::string to) {
    std::error_code error;
    if (to.empty() || fs::equivalent(from, to, error)) {
        return "";
    }
    if (std::string refusal = make_images_file(to); !refusal.empty()) {
        return refusal;
    }
    fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    if (!error) {
        return "";
    }
    std::error_code ignored;
    fs::remove(to, ignored);
    return images_file_error(to, error.message());
}

std::unique_ptr<FrameSource> open_recording(const SourceChoice& choice, std::string& error) {
    auto recording = std::make_unique<RecordedFrames>();
    error = recording->open(choice.uri, {choice.repeats, choice.as_fast_as_read});
    if (error.empty()) {
        error = copy_recording(choice.uri, choice.record_to);
    }
    return error.empty() ? std::move(recording) : nullptr;
}

}  // namespace

std::unique_ptr<FrameSource> open_source(const SourceChoice& choice, const std::string& own_driver,
                                         std::string& error) {
    if (is_recording_path(choice.uri)) {
        return open_recording(choice, error);
    }
    const OpenNi* const openni = OpenNi::get(own_driver, error);
    if (openni == nullptr) {
        return nullptr;
    }
    auto camera = std::make_unique<Camera>(*openni);
    error = camera->open({choice.uri, choice.width, choice.record_to});
    return error.empty() ? std::move(camera) : nullptr;
}

}  // namespace tactus
