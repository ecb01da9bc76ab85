#include "shared/oni_writer.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <utility>

namespace tactus::shared {

namespace {

template <class Value>
std::span<const std::byte> bytes_of(const Value& value) {
    return std::as_bytes(std::span(&value, 1));
}

std::string text_field(std::string_view text) {
    const auto length = static_cast<std::uint32_t>(text.size() + 1);
    std::string field(reinterpret_cast<const char*>(&length), sizeof length);
    field += text;
    field += '\0';
    return field;
}

std::string number_field(const auto& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string_view name_of(DepthCodec codec) {
    return codec == DepthCodec::none ? "NONE" : codec == DepthCodec::differences ? "16zP" : "16zT";
}

// Half a byte for each small difference; see sensing/recording/depth_codec.hpp.
class DifferenceWriter {
public:
    explicit DifferenceWriter(std::vector<std::byte>& into) : into_(into) {}

    void begin(std::uint16_t value) {
        put(value & 0xffu);
        put(value >> 8u);
        last_ = value;
    }
    void add(std::uint16_t value) {
        const int difference = last_ - value;
        last_ = value;
        if (std::abs(difference) <= 6) {
            add_half(static_cast<unsigned>(difference + 6));
            return;
        }
        put_repeats();
        put(has_first_ ? first_ << 4u | 15u : 0xffu);
        has_first_ = false;
        if (std::abs(difference) <= 63) {
            put(static_cast<unsigned>(difference + 192));
        } else {
            put(value >> 8u);
            put(value & 0xffu);
        }
    }
    void end() {
        put_repeats();
        if (has_first_) {
            put(first_ << 4u | 13u);
        }
    }

private:
    void put(unsigned byte) { into_.push_back(static_cast<std::byte>(byte)); }
    void put_repeats() {
        if (repeats_ > 0) {
            put(0xe0u + repeats_);
        }
        repeats_ = 0;
    }
    void add_half(unsigned half) {
        if (!std::exchange(has_first_, !has_first_)) {
            first_ = half;
            return;
        }
        const unsigned byte = first_ << 4u | half;
        if (byte == 0x66) {
            if (++repeats_ == 15) {
                put_repeats();
            }
            return;
        }
        put_repeats();
        put(byte);
    }

    std::vector<std::byte>& into_;
    std::uint16_t last_ = 0;
    bool has_first_ = false;
    unsigned first_ = 0;
    unsigned repeats_ = 0;
};

}  // namespace

std::vector<std::byte> encode_depth(DepthCodec codec, std::span<const std::uint16_t> pixels) {
    std::vector<std::byte> bytes;
    if (codec == DepthCodec::none) {
        const auto raw = std::as_bytes(pixels);
        return {raw.begin(), raw.end()};
    }
    std::vector<std::uint16_t> values(pixels.begin(), pixels.end());
    if (codec == DepthCodec::indices) {
        const std::set<std::uint16_t> ordered(values.begin(), values.end());
        const std::vector<std::uint16_t> table(ordered.begin(), ordered.end());
        for (std::uint16_t& value : values) {
            value = static_cast<std::uint16_t>(std::ranges::lower_bound(table, value) - table.begin());
        }
        const auto count = static_cast<std::uint16_t>(table.size());
        const auto head = bytes_of(count), entries = std::as_bytes(std::span(table));
        bytes.insert(bytes.end(), head.begin(), head.end());
        bytes.insert(bytes.end(), entries.begin(), entries.end());
    }
    DifferenceWriter writer(bytes);
    for (std::size_t i = 0; i < values.size(); ++i) {
        i == 0 ? writer.begin(values[i]) : writer.add(values[i]);
    }
    writer.end();
    return bytes;
}

OniWriter::OniWriter(std::uint16_t maintenance) : has_small_positions_(maintenance < 1) {
    put("NI10", 4);
    const std::array<std::uint8_t, 2> major_minor{1, 0};
    const std::uint32_t build = 0, largest_node = depth_node;
    const std::uint64_t largest_time = 0;
    put(major_minor.data(), 2);
    put(&maintenance, sizeof maintenance);
    put(&build, sizeof build);
    put(&largest_time, sizeof largest_time);
    put(&largest_node, sizeof largest_node);
}

void OniWriter::add_record(std::uint32_t type, std::uint32_t node, std::string_view fields,
                           std::span<const std::byte> payload) {
    const std::uint64_t position = 0;
    const std::size_t position_bytes = has_small_positions_ ? 4 : 8;
    const std::array<std::uint32_t, 5> head{0x0052494e, type, node,
                                            static_cast<std::uint32_t>(20 + position_bytes + fields.size()),
                                            static_cast<std::uint32_t>(payload.size())};
    put(head.data(), sizeof head);
    put(&position, position_bytes);
    put(fields.data(), fields.size());
    put(payload.data(), payload.size());
}

void OniWriter::add_node(std::uint32_t node, std::uint32_t kind, std::string_view codec) {
    add_record(0x0d, node,
               text_field("Depth" + std::to_string(node)) + number_field(kind) + std::string(codec) +
                   std::string(28, '\0'));
}

void OniWriter::set_property(std::uint32_t type, std::uint32_t node, std::string_view name,
                             std::span<const std::byte> value) {
    add_record(type, node,
               text_field(name) + number_field(static_cast<std::uint32_t>(value.size())) +
                   std::string(reinterpret_cast<const char*>(value.data()), value.size()));
}

void OniWriter::set_whole_number(std::uint32_t node, std::string_view name, std::uint64_t value) {
    set_property(0x03, node, name, bytes_of(value));
}

void OniWriter::set_general(std::uint32_t node, std::string_view name, std::span<const std::byte> value) {
    set_property(0x06, node, name, value);
}

void OniWriter::add_data(std::uint32_t node, std::uint64_t time_us, std::span<const std::byte> payload) {
    add_record(0x0a, node, number_field(time_us) + number_field(std::uint32_t{1}), payload);
}

void OniWriter::end() {
    add_record(0x0b, 0, "");
}

void OniWriter::add_camera(std::uint32_t width, std::uint32_t height, DepthCodec codec) {
    codec_ = codec;
    add_node(depth_node, 2, name_of(codec));
    set_size(width, height);
    const std::array<double, 2> angles{1.0, 0.8};
    set_general(depth_node, "xnFOV", std::as_bytes(std::span(angles)));
    set_whole_number(depth_node, "oniPixelFormat", 100);
    set_whole_number(depth_node, "xnMirror", 0);
}

void OniWriter::set_size(std::uint32_t width, std::uint32_t height) {
    const std::array<std::uint32_t, 3> mode{width, height, 30};
    set_general(depth_node, "xnMapOutputMode", std::as_bytes(std::span(mode)));
}

void OniWriter::set_crop(const std::array<std::uint16_t, 4>& left_top_width_height) {
    std::array<std::uint16_t, 6> crop{1, 0};
    std::ranges::copy(left_top_width_height, crop.begin() + 2);
    set_general(depth_node, "xnCropping", std::as_bytes(std::span(crop)));
}

void OniWriter::add_image(std::uint64_t time_us, std::span<const std::uint16_t> pixels) {
    add_data(depth_node, time_us, encode_depth(codec_, pixels));
}

std::vector<std::uint16_t> slope_image(std::uint32_t width, std::uint32_t height, int number) {
    std::vector<std::uint16_t> pixels;
    for (std::uint32_t v = 0; v < height; ++v) {
        for (std::uint32_t u = 0; u < width; ++u) {
            // Flat, sloped and jumping by turns, and somewhere without depth.
            const std::uint32_t slope =
                800 + static_cast<std::uint32_t>(number) + (v > height / 2 ? 3 * u : 0);
            const std::uint32_t depth = u > width / 2 ? slope + 500 : slope;
            pixels.push_back(static_cast<std::uint16_t>((u + v) % 11 == 10 ? 0 : depth));
        }
    }
    return pixels;
}

std::string slope_recording(std::uint32_t width, std::uint32_t height, int count, DepthCodec codec) {
    OniWriter writer;
    writer.add_camera(width, height, codec);
    for (int i = 0; i < count; ++i) {
        writer.add_image(33'000u * static_cast<std::uint64_t>(i + 1), slope_image(width, height, i));
    }
    writer.end();
    return writer.bytes();
}

}  // namespace tactus::shared
