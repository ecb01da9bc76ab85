// The triangles near one sphere that it remembers of each mesh: of the few that it was near to last.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "core/tree/pack_memory.hpp"

namespace tactus {

class TreeMemories {
public:
    // Whose triangles a memory holds.
    struct Owner {
        std::uint32_t part = 0;
        std::uint32_t stamp = 0;    // of the part, when it was asked; another: the memory is void
        std::uint64_t used_at = 0;  // tick
        bool is_crowded = false;    // in this tick more were near than it holds
        const TriangleTree* tree = nullptr;
    };
    struct Entry {
        PackMemory& memory;
        bool& is_crowded;
    };

    void begin_tick() { ++ticks_; }

    // That of a part, which is emptied where it held another tree; or the one that was least recently used.
    Entry of(std::uint32_t part, std::uint32_t stamp, const TriangleTree& tree) {
        auto owner = std::ranges::find_if(
            owners_, [&](const Owner& own) { return own.part == part && own.stamp == stamp; });
        if (owner == owners_.end()) {
            owner = std::ranges::min_element(owners_, {}, &Owner::used_at);
            *owner = {part, stamp};
        }
        PackMemory& memory = memories_[static_cast<std::size_t>(owner - owners_.begin())];
        owner->is_crowded = owner->is_crowded && owner->used_at == ticks_;
        owner->used_at = ticks_;
        if (owner->tree != &tree) {
            owner->tree = &tree;
            memory.clear();
        }
        return {memory, owner->is_crowded};
    }

private:
    static constexpr std::size_t max_memories = 12;

    std::array<Owner, max_memories> owners_{};
    std::unique_ptr<PackMemory[]> memories_ = std::make_unique<PackMemory[]>(max_memories);
    std::uint64_t ticks_ = 0;
};

}  // namespace tactus
