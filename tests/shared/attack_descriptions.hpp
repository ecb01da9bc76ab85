// Descriptions that arrive whole, with the hash of what they say, and say what no honest side would: bodies
// of all shapes and sizes where the hand is, meshes that close nothing, joints of anything with motors of any
// strength, and all of that with some bits turned.
#pragma once

#include <cstddef>
#include <vector>

#include "network/messages.hpp"
#include "shared/dice.hpp"

namespace tactus::shared {

class FalseDescriptions {
public:
    // Bodies and joints are on no layer of `spared`, and notice none of it: what a body may push is the
    // right of whoever describes it.
    FalseDescriptions(Dice& dice, bool joints, std::uint32_t spared)
        : dice_(dice), joints_(joints), spared_(spared) {}

    // The next piece; valid until the next call.
    DiscoveryFragment next();

private:
    void begin();
    std::vector<std::byte> some_body();
    std::vector<std::byte> some_joint();
    Shape some_shape();
    TriangleMesh some_mesh();
    void turn_bits(std::vector<std::byte>& bytes);
    bool is_spared(const std::vector<std::byte>& bytes) const;
    Vec3 near_hand();

    Dice& dice_;
    bool joints_;
    std::uint32_t spared_;
    std::vector<std::byte> bytes_;
    DiscoveryFragment piece_;
    std::uint32_t offset_ = 0;
    std::uint32_t revision_ = 1'000'000;  // higher than any that an honest side has given
};

}  // namespace tactus::shared
