#include "sensing/source.hpp"

#include <filesystem>

#include "sensing/openni/camera.hpp"
#include "sensing/recording/recorded_frames.hpp"

namespace tactus {

namespace {

namespace fs = std::filesystem;

// All its images are in the file that they come from.
std::string copy_recording(const std::string& from, const std::string& to) {
    std::error_code error;
    if (to.empty() || fs::equivalent(from, to, error)) {
        return "";
    }
    fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    return error ? "its images cannot be recorded into '" + to + "' (" + error.message() +
                       "): name another file, or none"
                 : "";
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
