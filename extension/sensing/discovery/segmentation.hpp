// What stands out of the support plane, in connected pieces of the image.
//
// Neighbours in the image are neighbours on a surface unless depth jumps between them: pieces are found by
// runs of pixels along the rows that are joined from row to row, without any search in space.
#pragma once

#include <optional>
#include <vector>

#include "sensing/discovery/support_plane.hpp"
#include "sensing/image/depth_renderer.hpp"

namespace tactus {

struct SegmentationSettings {
    double least_height = 0.004;     // over the plane (unit: meters), > 0
    double height_deviations = 4.0;  // and over the plane's own chance (dimensionless), > 0
    double jump = 0.012;             // of depth between neighbours of one surface (unit: meters), > 0
    double jump_deviations = 5.0;    // and so much more for chance (dimensionless), >= 0
    int least_pixels = 60;           // a piece of fewer is noise, > 0
};

struct Cluster {
    std::vector<std::uint32_t> pixels;  // ascending
    PixelBox box;                       // around them
};

struct Segmentation {
    std::vector<std::uint8_t> stands_out;  // by pixel: 1 above the plane, 0 in or below it or without depth
    std::vector<std::uint16_t> piece;      // by pixel: 1 + index in `clusters`, 0 none
    std::vector<Cluster> clusters;         // the first found first, by rows
};

// Keeps memory from one image to the next.
class Segmenter {
public:
    // What stands out of the plane; without one, everything that has depth.
    void mark(const DepthImage& image, const DepthAccuracy& accuracy, const std::optional<ImagePlane>& plane,
              const SegmentationSettings& settings);
    // Takes a pixel out: what it belongs to is known.
    void take_out(std::size_t pixel) { result_.stands_out[pixel] = 0; }
    // The pieces of what stands out and was not taken out.
    const Segmentation& find_pieces(const DepthImage& image, const SegmentationSettings& settings);
    const Segmentation& segment(const DepthImage& image, const DepthAccuracy& accuracy,
                                const std::optional<ImagePlane>& plane, const SegmentationSettings& settings);
    const Segmentation& found() const { return result_; }

private:
    struct Run {
        std::int32_t row, begin, end;
        std::uint32_t parent;  // index of a run of the same piece
    };

    void find_runs(const DepthImage& image);
    void join_rows(const DepthImage& image, std::size_t above, std::size_t here, std::size_t end);
    void gather(const DepthCamera& camera, int least_pixels);
    std::uint32_t root(std::uint32_t run);
    void join(std::uint32_t a, std::uint32_t b);
    bool continues(const DepthImage& image, std::size_t a, std::size_t b) const;

    Segmentation result_;
    std::vector<Run> runs_;
    std::vector<std::uint32_t> number_;      // by run: size of its piece, then 1 + index of its cluster
    std::vector<std::uint16_t> jump_by_cm_;  // largest jump at a depth (unit: millimeters)
    std::vector<float> least_height_by_cm_;  // (unit: meters)
};

}  // namespace tactus
