// The images of a recording, at the pace at which they were taken.
//
// Threads: one.
#pragma once

#include <fstream>
#include <optional>

#include "sensing/image/frame_source.hpp"
#include "sensing/recording/oni_file.hpp"
#include "sensing/recording/playback.hpp"

namespace tactus {

// Whether it is the name of a recording, and not that of a camera.
bool is_recording_path(const std::string& uri);

class RecordedFrames final : public FrameSource {
public:
    // Once. Empty, or why not and what to do.
    std::string open(const std::string& path, const Playback::Choice& choice);

    Reading read(DepthImage& image, int wait_ms) override;
    const std::string& name() const override { return name_; }
    const std::string& trouble() const override { return trouble_; }
    std::size_t frame_count() const { return recording_.frames.size(); }

private:
    std::string name_, trouble_;
    std::ifstream file_;
    OniRecording recording_;
    std::optional<Playback> playback_;
    std::vector<std::byte> memory_;
};

}  // namespace tactus
