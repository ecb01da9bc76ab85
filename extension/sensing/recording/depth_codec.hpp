// The codecs of depth images in recordings by OpenNI2.
//
//   16z   the first value in two bytes, then differences last - next: two in a byte, as half bytes d + 6 for
//         |d| <= 6. A low half 13 is none. 0xE0 + n: 2 n times the last value. 0xFF, or a low half 15, in
//         place of a difference: the next byte is d + 192 for |d| < 64, or else it and the one after it are
//         the value itself, the high byte first, below 0x8000.
//   16zT  the number of values and the values that occur, two bytes each, then 16z of their indices.
//
// Numbers are little-endian but for the value itself. The bytes may be anything: reads and writes are
// bounded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus {

enum class DepthCodec : std::uint8_t { none, differences, indices };

// Returns how many of the pixels were written, from the first on; the rest keep what they hold. 0 where the
// bytes cannot be of so many pixels.
std::size_t decode_depth(DepthCodec codec, std::span<const std::byte> bytes, std::span<std::uint16_t> pixels);

// Bytes of an image of so many pixels, at most.
std::size_t most_encoded_bytes(std::size_t pixels);

}  // namespace tactus
