#include "sensing/openni/frame_reading.hpp"

#include <cstring>

namespace tactus {

namespace {

std::string size_of(int width, int height) {
    return std::to_string(width) + " × " + std::to_string(height);
}

// Of all that the camera sees, as the frame has it.
struct WholeSize {
    int width = 0, height = 0;
};

WholeSize whole_size(const OniFrame& frame) {
    return frame.croppingEnabled ? WholeSize{frame.videoMode.resolutionX, frame.videoMode.resolutionY}
                                 : WholeSize{frame.width, frame.height};
}

bool holds_its_rows(const OniFrame& frame) {
    const auto row_bytes = static_cast<std::size_t>(frame.width) * sizeof(OniDepthPixel);
    return frame.data != nullptr && frame.stride >= 0 &&
           static_cast<std::size_t>(frame.stride) >= row_bytes && frame.dataSize >= 0 &&
           static_cast<std::size_t>(frame.dataSize) >=
               static_cast<std::size_t>(frame.height - 1) * static_cast<std::size_t>(frame.stride) +
                   row_bytes;
}

}  // namespace

int tenths_of_millimeter(OniPixelFormat format) {
    return format == ONI_PIXEL_FORMAT_DEPTH_1_MM ? 10 : format == ONI_PIXEL_FORMAT_DEPTH_100_UM ? 1 : 0;
}

bool has_size_of(const OniFrame& frame, const DepthCamera& view) {
    const WholeSize whole = whole_size(frame);
    return whole.width == view.width && whole.height == view.height;
}

std::string take_frame(const OniFrame& frame, const DepthCamera& view, bool is_mirrored, DepthImage& image) {
    const int tenths = tenths_of_millimeter(frame.videoMode.pixelFormat);
    if (tenths == 0) {
        return "its images hold no depths in millimeters";
    }
    const WholeSize whole = whole_size(frame);
    if (!has_size_of(frame, view)) {
        return "its images are of " + size_of(whole.width, whole.height) + " pixels where " +
               size_of(view.width, view.height) + " were announced";
    }
    const int left = frame.croppingEnabled ? frame.cropOriginX : 0;
    const int top = frame.croppingEnabled ? frame.cropOriginY : 0;
    const bool is_inside = frame.width > 0 && frame.height > 0 && left >= 0 && top >= 0 &&
                           frame.width <= view.width - left && frame.height <= view.height - top;
    if (!is_inside || !holds_its_rows(frame)) {
        return "its images are not whole";
    }
    image.camera = view;
    image.time_us = frame.timestamp;
    image.depth_mm.assign(pixel_count(view), 0);
    for (int v = 0; v < frame.height; ++v) {
        const std::byte* const bytes = static_cast<const std::byte*>(frame.data) +
                                       static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.stride);
        std::uint16_t* const row =
            image.depth_mm.data() + static_cast<std::size_t>(v + top) * static_cast<std::size_t>(view.width);
        for (int u = 0; u < frame.width; ++u) {
            OniDepthPixel told = 0;
            std::memcpy(&told, bytes + static_cast<std::size_t>(u) * sizeof told, sizeof told);
            const int at = is_mirrored ? view.width - 1 - (u + left) : u + left;
            row[at] = tenths == 10 ? told : static_cast<std::uint16_t>((told + 5) / 10);
        }
    }
    return "";
}

}  // namespace tactus
