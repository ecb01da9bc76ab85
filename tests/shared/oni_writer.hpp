// Recordings of depth images as OpenNI2's recorder writes them (.oni), to be read, and to be damaged.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sensing/recording/depth_codec.hpp"

namespace tactus::shared {

std::vector<std::byte> encode_depth(DepthCodec codec, std::span<const std::uint16_t> pixels);

// Record by record, in the order of the calls.
class OniWriter {
public:
    static constexpr std::uint32_t depth_node = 1;

    // `maintenance`: of the version 1.0.x; below 1 positions have half the bytes.
    explicit OniWriter(std::uint16_t maintenance = 1);

    void add_node(std::uint32_t node, std::uint32_t kind, std::string_view codec);
    void set_whole_number(std::uint32_t node, std::string_view name, std::uint64_t value);
    void set_general(std::uint32_t node, std::string_view name, std::span<const std::byte> value);
    void add_data(std::uint32_t node, std::uint64_t time_us, std::span<const std::byte> payload);
    void end();

    // A depth camera of that size, and what changes of it.
    void add_camera(std::uint32_t width, std::uint32_t height, DepthCodec codec);
    void set_size(std::uint32_t width, std::uint32_t height);
    void set_crop(const std::array<std::uint16_t, 4>& left_top_width_height);
    void add_image(std::uint64_t time_us, std::span<const std::uint16_t> pixels);

    const std::string& bytes() const { return bytes_; }

private:
    void put(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
    void add_record(std::uint32_t type, std::uint32_t node, std::string_view fields,
                    std::span<const std::byte> payload = {});
    void set_property(std::uint32_t type, std::uint32_t node, std::string_view name,
                      std::span<const std::byte> value);

    std::string bytes_;
    bool has_small_positions_;
    DepthCodec codec_ = DepthCodec::none;
};

// `count` images of a slope that moves, 33 ms apart.
std::string slope_recording(std::uint32_t width, std::uint32_t height, int count, DepthCodec codec);
std::vector<std::uint16_t> slope_image(std::uint32_t width, std::uint32_t height, int number);

}  // namespace tactus::shared
