// Room for datagrams of any size, in blocks of one size: many short ones and a few long ones take what they
// need. All memory is taken in the constructor.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace tactus {

class DatagramStore {
public:
    static constexpr std::size_t block_bytes = 128;

    explicit DatagramStore(std::size_t blocks) : blocks_(blocks) {
        for (std::size_t i = 0; i < blocks; ++i) {
            blocks_[i].next = static_cast<std::uint32_t>(i + 1);
        }
        free_ = blocks;
    }

    bool has_room_for(std::size_t bytes) const { return count_of(bytes) <= free_; }

    // The place of a copy of it. There must be room.
    std::uint32_t put(std::span<const std::byte> datagram) {
        const std::uint32_t place = first_free_;
        std::uint32_t last = place;
        for (std::size_t i = 0, count = count_of(datagram.size()); i < count; ++i) {
            const std::span<const std::byte> part =
                datagram.subspan(i * block_bytes, std::min(block_bytes, datagram.size() - i * block_bytes));
            last = first_free_;
            std::memcpy(blocks_[last].bytes.data(), part.data(), part.size());
            first_free_ = blocks_[last].next;
        }
        free_ -= count_of(datagram.size());
        return place;
    }

    // Copies what is at the place to the front of `into`, and frees it. `into` has the datagram's size, or is
    // empty where it is only freed.
    void take(std::uint32_t place, std::size_t bytes, std::span<std::byte> into) {
        std::uint32_t last = place;
        const std::size_t count = count_of(bytes);
        for (std::size_t i = 0; i < count; ++i) {
            last = i == 0 ? place : blocks_[last].next;
            if (!into.empty()) {
                std::memcpy(into.data() + i * block_bytes, blocks_[last].bytes.data(),
                            std::min(block_bytes, bytes - i * block_bytes));
            }
        }
        blocks_[last].next = first_free_;
        first_free_ = place;
        free_ += count;
    }

private:
    struct Block {
        std::array<std::byte, block_bytes> bytes;
        std::uint32_t next;
    };

    // An empty datagram has a place, too.
    static std::size_t count_of(std::size_t bytes) {
        return std::max<std::size_t>((bytes + block_bytes - 1) / block_bytes, 1);
    }

    std::vector<Block> blocks_;
    std::uint32_t first_free_ = 0;
    std::size_t free_ = 0;
};

}  // namespace tactus
