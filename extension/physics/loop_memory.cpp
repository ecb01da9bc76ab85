#include "physics/loop_memory.hpp"

#include <bit>
#include <cstdlib>
#include <cstring>

#include "platform/thread_slot.hpp"

namespace tactus {

namespace {

// Set by LoopMemoryScope.
LoopMemory* current_memory() {
    return static_cast<LoopMemory*>(thread_slot());
}

// Stands right before every block given to Jolt, so that a block finds its way home from any thread.
struct alignas(16) BlockHeader {
    LoopMemory* owner;      // null: the system's
    std::uint32_t bytes;    // of the whole piece
    std::uint32_t to_base;  // from the piece's first byte to the block
};
static_assert(sizeof(BlockHeader) == 16);

std::byte* align_up(std::byte* address, std::size_t alignment) {
    const auto value = reinterpret_cast<std::uintptr_t>(address);
    return address + ((alignment - value % alignment) % alignment);
}

}  // namespace

LoopMemory::LoopMemory(std::size_t capacity)
    : storage_(new std::byte[capacity + piece_alignment]),
      begin_(align_up(storage_.get(), piece_alignment)),
      capacity_(capacity) {}

std::size_t LoopMemory::size_class(std::size_t bytes) {
    const std::size_t pieces = (bytes + piece_alignment - 1) / piece_alignment;
    return static_cast<std::size_t>(std::bit_width(pieces - (pieces > 0 ? 1u : 0u)));
}

void* LoopMemory::take(std::size_t bytes) {
    const std::size_t index = size_class(bytes);
    if (index >= size_classes)
        return nullptr;
    if (FreePiece* piece = free_[index]) {
        free_[index] = piece->next;
        return piece;
    }
    const std::size_t piece_bytes = piece_alignment << index;
    if (piece_bytes > capacity_ - used_)
        return nullptr;
    std::byte* piece = begin_ + used_;
    used_ += piece_bytes;
    return piece;
}

void LoopMemory::give_back(void* block, std::size_t bytes) {
    const std::size_t index = size_class(bytes);
    free_[index] = new (block) FreePiece{free_[index]};
}

LoopMemoryScope::LoopMemoryScope(LoopMemory& memory) : outer_(current_memory()) {
    set_thread_slot(&memory);
}

LoopMemoryScope::~LoopMemoryScope() {
    set_thread_slot(outer_);
}

namespace jolt_allocation {

void* allocate_aligned(std::size_t bytes, std::size_t alignment) {
    if (alignment < alignof(BlockHeader))
        alignment = alignof(BlockHeader);
    const std::size_t piece_bytes = bytes + sizeof(BlockHeader) + alignment;
    LoopMemory* owner = current_memory();
    void* piece = owner != nullptr ? owner->take(piece_bytes) : nullptr;
    if (piece == nullptr) {
        if (owner != nullptr)
            owner->count_overflow();
        owner = nullptr;
        piece = std::malloc(piece_bytes);
        if (piece == nullptr)
            std::abort();
    }
    auto* base = static_cast<std::byte*>(piece);
    std::byte* block = align_up(base + sizeof(BlockHeader), alignment);
    new (block - sizeof(BlockHeader))
        BlockHeader{owner, static_cast<std::uint32_t>(piece_bytes), static_cast<std::uint32_t>(block - base)};
    return block;
}

void* allocate(std::size_t bytes) {
    return allocate_aligned(bytes, alignof(BlockHeader));
}

void release(void* block) {
    if (block == nullptr)
        return;
    auto* bytes = static_cast<std::byte*>(block);
    const BlockHeader header = *reinterpret_cast<BlockHeader*>(bytes - sizeof(BlockHeader));
    std::byte* base = bytes - header.to_base;
    if (header.owner != nullptr)
        header.owner->give_back(base, header.bytes);
    else
        std::free(base);
}

void* reallocate(void* block, std::size_t old_bytes, std::size_t bytes) {
    void* moved = allocate(bytes);
    if (block != nullptr) {
        std::memcpy(moved, block, old_bytes < bytes ? old_bytes : bytes);
        release(block);
    }
    return moved;
}

}  // namespace jolt_allocation

}  // namespace tactus
