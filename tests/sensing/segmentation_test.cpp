#include "sensing/discovery/segmentation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "shared/depth_scenes.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus::segmentation_test {
namespace {

using shared::DepthScene;

// A frame of four pixels to a letter: what stands out is written as depths, '.' is in the plane or nothing.
DepthImage drawn(const std::vector<std::string>& rows) {
    DepthImage image;
    image.camera = camera_of_view(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), 1.0, 0.8);
    for (const std::string& row : rows) {
        for (const char c : row) {
            image.depth_mm.push_back(c == '.' ? std::uint16_t{0}
                                              : static_cast<std::uint16_t>(500 + 100 * (c - '0')));
        }
    }
    return image;
}

std::vector<std::size_t> sizes_in(const std::vector<std::string>& rows, int least = 1) {
    SegmentationSettings settings;
    settings.least_pixels = least;
    Segmenter segmenter;
    std::vector<std::size_t> sizes;
    for (const Cluster& cluster : segmenter.segment(drawn(rows), {}, std::nullopt, settings).clusters) {
        sizes.push_back(cluster.pixels.size());
    }
    return sizes;
}

using Sizes = std::vector<std::size_t>;

TEST(Segmentation, NeighboursInTheImageAreOnePiece) {
    EXPECT_EQ(sizes_in({"111..1", "1.1..1", "111..1"}), (Sizes{8, 3}));
}

TEST(Segmentation, PiecesThatMeetBelowAreJoined) {
    EXPECT_EQ(sizes_in({"1.1.1", "1.1.1", "11111"}), (Sizes{11}));
    EXPECT_EQ(sizes_in({"11111", "1...1", "1.1.1", "1.111"}), (Sizes{14}));
}

TEST(Segmentation, CornersDoNotTouch) {
    EXPECT_EQ(sizes_in({"11..", "..11"}), (Sizes{2, 2}));
}

TEST(Segmentation, AJumpOfDepthParts) {
    EXPECT_EQ(sizes_in({"1122", "1122"}), (Sizes{4, 4}));
    EXPECT_EQ(sizes_in({"1111", "2222"}), (Sizes{4, 4}));
}

TEST(Segmentation, SmallPiecesAreLeftOut) {
    EXPECT_EQ(sizes_in({"11..1", "11..."}, 4), (Sizes{4}));
    EXPECT_EQ(sizes_in({"....."}), (Sizes{}));
}

TEST(Segmentation, TheLabelsAreThoseOfAFloodFill) {
    shared::RandomValues random(4);
    for (int turn = 0; turn < 20; ++turn) {
        std::vector<std::string> rows(24, std::string(31, '.'));
        for (std::string& row : rows) {
            for (char& c : row) {
                c = random.unit() < 0.6 ? (random.unit() < 0.9 ? '1' : '2') : '.';
            }
        }
        const DepthImage image = drawn(rows);
        SegmentationSettings settings;
        settings.least_pixels = 1;
        Segmenter segmenter;
        const Segmentation& found = segmenter.segment(image, {}, std::nullopt, settings);
        for (int v = 0; v < 24; ++v) {
            for (int u = 0; u < 31; ++u) {
                const auto at = static_cast<std::size_t>(v * 31 + u);
                ASSERT_EQ(found.piece[at] != 0, image.depth_mm[at] != 0);
                if (u > 0 && image.depth_mm[at] != 0 && image.depth_mm[at] == image.depth_mm[at - 1]) {
                    ASSERT_EQ(found.piece[at], found.piece[at - 1]);
                }
                if (v > 0 && image.depth_mm[at] != 0 && image.depth_mm[at] == image.depth_mm[at - 31]) {
                    ASSERT_EQ(found.piece[at], found.piece[at - 31]);
                }
            }
        }
        for (std::size_t i = 0; i < found.clusters.size(); ++i) {
            const Cluster& cluster = found.clusters[i];
            ASSERT_TRUE(std::ranges::is_sorted(cluster.pixels));
            for (const std::uint32_t at : cluster.pixels) {
                ASSERT_EQ(found.piece[at], i + 1);
                const int u = static_cast<int>(at % 31), v = static_cast<int>(at / 31);
                ASSERT_TRUE(u >= cluster.box.left && u < cluster.box.right && v >= cluster.box.top &&
                            v < cluster.box.bottom);
            }
        }
    }
}

// A box on a table: all of its pixels but the strip along the table, and next to nothing of the table.
TEST(Segmentation, WhatStandsOnThePlaneIsMarked) {
    const std::vector<LibraryMesh> library{{"box", shared::box(Vec3(0.05)), 0.0}};
    const Pose camera = shared::camera_above_table(0.85, 0.8);
    DepthBuffer exact;
    shared::draw_scene(
        library, DepthScene{kinect_camera(320, 240), camera, {{0, {{0.0, 0.05, 0.0}, {1, 0, 0, 0}}}}}, exact);
    DepthNoise noise;
    noise.error_share = 0.0;
    const DepthImage image = noisy_image(exact, noise, 3, 0);
    PlaneSearch search;
    search.up = direction_to_local(camera, {0.0, 1.0, 0.0});
    const auto planes = find_planes(image, {}, search, 1);
    ASSERT_EQ(planes.size(), 1u);
    Segmenter segmenter;
    const Segmentation& found = segmenter.segment(image, {}, planes.front().plane, {});
    ASSERT_EQ(found.clusters.size(), 1u);
    const auto of_box = static_cast<double>(std::ranges::count(exact.seen, std::uint16_t{0}));
    double hits = 0.0;
    for (const std::uint32_t at : found.clusters[0].pixels) {
        hits += exact.seen[at] == 0;
    }
    EXPECT_GT(hits, 0.9 * of_box);
    EXPECT_GT(hits, 0.98 * static_cast<double>(found.clusters[0].pixels.size()));
    const auto marked = std::ranges::count(found.stands_out, std::uint8_t{1});
    EXPECT_LT(static_cast<double>(marked), hits + 0.002 * static_cast<double>(exact.depth.size()));
}

TEST(Segmentation, WhatIsTakenOutIsInNoPiece) {
    const DepthImage image = drawn({"111", "111", "111"});
    SegmentationSettings settings;
    settings.least_pixels = 1;
    Segmenter segmenter;
    segmenter.mark(image, {}, std::nullopt, settings);
    for (const std::size_t middle : {1u, 4u, 7u}) {
        segmenter.take_out(middle);
    }
    EXPECT_EQ(segmenter.find_pieces(image, settings).clusters.size(), 2u);
}

}  // namespace
}  // namespace tactus::segmentation_test
