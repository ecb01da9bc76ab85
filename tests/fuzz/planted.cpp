// A target with two defects in it, so that a test can tell whether a driver tells of one.
#include <string_view>

#include "fuzz_target.hpp"

namespace tactus::fuzz {

void play(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    must(!text.starts_with("touch"), "the planted defect");
    for (volatile bool forever = text.starts_with("wait for ever"); forever;) {
    }
}

// A byte away from the first, and far from the second.
std::vector<Bytes> seeds() {
    std::vector<Bytes> all;
    for (const std::string_view text : {"tough", "couch"}) {
        const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
        all.emplace_back(begin, begin + text.size());
    }
    return all;
}

}  // namespace tactus::fuzz
