// Memory for what Jolt allocates while the loop runs: a fixed block with one list of free pieces per size.
//
// Thread rule: a LoopMemory belongs to one PhysicsWorld and is used by whichever single thread is inside that
// world. There is no lock. A piece is found and given back in a few instructions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace tactus {

class LoopMemory {
public:
    explicit LoopMemory(std::size_t capacity);  // (unit: bytes)

    LoopMemory(const LoopMemory&) = delete;
    LoopMemory& operator=(const LoopMemory&) = delete;

    // A block of at least `bytes` at a multiple of piece_alignment, or null when the memory is used up.
    void* take(std::size_t bytes);

    // `block` came from take(bytes).
    void give_back(void* block, std::size_t bytes);

    // How often the memory was used up and the system's had to help: zero, or the loop was late through our
    // fault.
    std::uint64_t overflows() const { return overflows_; }
    void count_overflow() { ++overflows_; }

    std::size_t used() const { return used_; }  // high-water mark (unit: bytes)

    static constexpr std::size_t piece_alignment = 64;

private:
    struct FreePiece {
        FreePiece* next;
    };

    // Pieces are powers of two: 64 bytes to 2^(6 + size_classes - 1).
    static constexpr std::size_t size_classes = 24;
    static std::size_t size_class(std::size_t bytes);

    std::unique_ptr<std::byte[]> storage_;
    std::byte* begin_;
    std::size_t capacity_;
    std::size_t used_ = 0;
    std::array<FreePiece*, size_classes> free_{};
    std::uint64_t overflows_ = 0;
};

// While one of these lives on a thread, everything Jolt allocates there comes from `memory`.
class LoopMemoryScope {
public:
    explicit LoopMemoryScope(LoopMemory& memory);
    ~LoopMemoryScope();

    LoopMemoryScope(const LoopMemoryScope&) = delete;
    LoopMemoryScope& operator=(const LoopMemoryScope&) = delete;

private:
    LoopMemory* outer_;
};

// The functions Jolt is told to allocate with. Outside of a LoopMemoryScope they are the system's.
namespace jolt_allocation {
void* allocate(std::size_t bytes);
void* reallocate(void* block, std::size_t old_bytes, std::size_t bytes);
void release(void* block);
void* allocate_aligned(std::size_t bytes, std::size_t alignment);
}  // namespace jolt_allocation

}  // namespace tactus
