// Recordings of a depth camera (.oni) that were cut, mended or damaged, and the order in which they are
// played.
#include <sstream>
#include <string>

#include "fuzz_target.hpp"
#include "sensing/recording/oni_file.hpp"
#include "sensing/recording/playback.hpp"
#include "shared/oni_writer.hpp"

namespace tactus::fuzz {
namespace {

constexpr std::size_t most_images = 3;

void play_in_time(const OniRecording& recording) {
    std::vector<std::uint64_t> times;
    for (const OniFrame& frame : recording.frames) {
        times.push_back(frame.time_us);
    }
    Playback playback(times, {.repeats = times.size() % 2 == 0, .as_fast_as_read = false});
    for (Nanoseconds now = 0; now < 20'000'000'000; now += 700'000'000) {
        const auto number = playback.next(now);
        must(!number || *number < times.size(), "an image is shown that there is");
    }
}

}  // namespace

void play(std::span<const std::byte> input) {
    std::istringstream file(std::string(reinterpret_cast<const char*>(input.data()), input.size()));
    OniRecording recording;
    if (!read_oni(file, recording).empty()) {
        return;
    }
    must(!recording.frames.empty(), "what is played has images");
    std::vector<std::byte> memory;
    DepthImage image;
    for (std::size_t i = 0; i < recording.frames.size() && i < most_images; ++i) {
        if (read_oni_frame(file, recording, i, memory, image)) {
            must(image.depth_mm.size() == pixel_count(image.camera), "an image has all its pixels");
        }
    }
    play_in_time(recording);
}

std::vector<Bytes> seeds() {
    std::vector<Bytes> all;
    const auto add = [&all](const std::string& file) {
        const auto bytes = std::as_bytes(std::span(file));
        all.emplace_back(bytes.begin(), bytes.end());
    };
    for (const DepthCodec codec : {DepthCodec::none, DepthCodec::differences, DepthCodec::indices}) {
        add(shared::slope_recording(24, 10, 2, codec));
    }
    shared::OniWriter other(0);
    other.add_node(5, 3, "JPEG");
    other.add_camera(16, 8, DepthCodec::indices);
    other.set_crop({2, 1, 12, 6});
    other.add_data(5, 1, {});
    other.add_image(2, shared::slope_image(12, 6, 0));
    other.set_size(14, 7);
    other.add_image(1, shared::slope_image(12, 6, 1));
    other.end();
    add(other.bytes());
    return all;
}

}  // namespace tactus::fuzz
