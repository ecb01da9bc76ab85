// The packets of tests/shared/wire_vectors.txt, which tests/tools/wire_decoder.py reads as well.
#pragma once

#include <cstddef>
#include <fstream>
#include <map>
#include <span>
#include <string>

namespace tactus::samples {

inline std::string hex(std::span<const std::byte> bytes) {
    constexpr const char* digits = "0123456789abcdef";
    std::string text;
    for (const std::byte byte : bytes) {
        text += {digits[std::to_integer<int>(byte) >> 4], digits[std::to_integer<int>(byte) & 15]};
    }
    return text;
}

// By name, in hexadecimal digits.
inline std::map<std::string, std::string> published_vectors() {
    std::map<std::string, std::string> vectors;
    std::ifstream file("tests/shared/wire_vectors.txt");
    for (std::string name, bytes; file >> name >> bytes;) {
        vectors[name] = bytes;
    }
    return vectors;
}

}  // namespace tactus::samples
