#include "sensing/recording/depth_codec.hpp"

#include <algorithm>
#include <optional>

namespace tactus {

namespace {

class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::size_t left() const { return bytes_.size(); }
    // 0 where none is left.
    unsigned next() {
        if (bytes_.empty()) {
            return 0;
        }
        const auto value = std::to_integer<unsigned>(bytes_.front());
        bytes_ = bytes_.subspan(1);
        return value;
    }
    std::uint16_t next_two() {
        const unsigned low = next();
        return static_cast<std::uint16_t>(low | next() << 8u);
    }

private:
    std::span<const std::byte> bytes_;
};

constexpr unsigned no_second = 13, wide = 15, first_repeat = 0xe0, wide_alone = 0xff;

// Writes pixels one after the other; false: there is no more room, or no such value in the table.
class PixelWriter {
public:
    PixelWriter(std::optional<std::span<const std::byte>> table, std::span<std::uint16_t> pixels)
        : table_(table), pixels_(pixels) {}

    bool write(std::uint16_t value) {
        if (written_ == pixels_.size() || (table_ && 2 * std::size_t{value} >= table_->size())) {
            return false;
        }
        pixels_[written_++] = table_ ? ByteReader(table_->subspan(2 * std::size_t{value})).next_two() : value;
        return true;
    }
    std::size_t written() const { return written_; }

private:
    std::optional<std::span<const std::byte>> table_;
    std::span<std::uint16_t> pixels_;
    std::size_t written_ = 0;
};

std::uint16_t less(std::uint16_t value, int difference) {
    return static_cast<std::uint16_t>(value - difference);
}

std::uint16_t wide_value(ByteReader& bytes, std::uint16_t last) {
    const unsigned first = bytes.next();
    return (first & 0x80u) != 0 ? less(last, static_cast<int>(first) - 192)
                                : static_cast<std::uint16_t>(first << 8u | bytes.next());
}

bool decode_differences(ByteReader bytes, PixelWriter& out) {
    std::uint16_t last = bytes.next_two();
    if (!out.write(last)) {
        return false;
    }
    while (bytes.left() > 0) {
        const unsigned byte = bytes.next();
        if (byte == wide_alone) {
            last = wide_value(bytes, last);
            if (!out.write(last)) {
                return false;
            }
        } else if (byte >= first_repeat) {
            for (unsigned i = 0; i < 2 * (byte - first_repeat); ++i) {
                if (!out.write(last)) {
                    return false;
                }
            }
        } else {
            last = less(last, static_cast<int>(byte >> 4u) - 6);
            if (!out.write(last)) {
                return false;
            }
            const unsigned second = byte & 0x0fu;
            if (second == no_second) {
                continue;
            }
            last = second == wide ? wide_value(bytes, last) : less(last, static_cast<int>(second) - 6);
            if (!out.write(last)) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

std::size_t decode_depth(DepthCodec codec, std::span<const std::byte> bytes,
                         std::span<std::uint16_t> pixels) {
    ByteReader reader(bytes);
    if (codec == DepthCodec::none) {
        if (bytes.size() < 2 * pixels.size()) {
            return 0;
        }
        std::ranges::generate(pixels, [&reader] { return reader.next_two(); });
        return pixels.size();
    }
    std::optional<std::span<const std::byte>> table;
    if (codec == DepthCodec::indices) {
        const std::size_t table_bytes = 2 * std::size_t{reader.next_two()};
        if (bytes.size() < 2 + table_bytes) {
            return 0;
        }
        table = bytes.subspan(2, table_bytes);
        reader = ByteReader(bytes.subspan(2 + table_bytes));
    }
    if (reader.left() < 2) {
        return 0;
    }
    PixelWriter out(table, pixels);
    return decode_differences(reader, out) ? out.written() : 0;
}

// Three bytes for every pixel, and every value once.
std::size_t most_encoded_bytes(std::size_t pixels) {
    return 3 * pixels + 2 * 0x10000 + 4;
}

}  // namespace tactus
