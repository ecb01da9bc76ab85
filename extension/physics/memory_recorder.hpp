// Jolt's state as bytes in memory that somebody else owns.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>

#include "physics/jolt.hpp"

#include <Jolt/Physics/StateRecorder.h>

namespace tactus {

// Jolt's whole state of one body; 197 bytes in 5.6.0 with double precision.
constexpr std::size_t max_bytes_of_a_body = 232;

// Jolt hands over a number or a vector at a time: a call of the C library would take longer than the copy.
inline void copy_few_bytes(void* to, const void* from, std::size_t bytes) {
    auto* target = static_cast<std::byte*>(to);
    auto* source = static_cast<const std::byte*>(from);
    const auto copy = [&]<std::size_t size> {
        std::memcpy(target, source, size);
        target += size;
        source += size;
    };
    for (; bytes >= 16; bytes -= 16)
        copy.operator()<16>();
    if (bytes & 8)
        copy.operator()<8>();
    if (bytes & 4)
        copy.operator()<4>();
    if (bytes & 2)
        copy.operator()<2>();
    if (bytes & 1)
        copy.operator()<1>();
}

class MemoryWriter final : public JPH::StateRecorder {
public:
    explicit MemoryWriter(std::span<std::byte> memory) : memory_(memory) {}

    void WriteBytes(const void* data, std::size_t bytes) override {
        if (bytes > memory_.size() - used_) {
            failed_ = true;
            return;
        }
        copy_few_bytes(memory_.data() + used_, data, bytes);
        used_ += bytes;
    }
    void ReadBytes(void*, std::size_t) override { failed_ = true; }
    bool IsEOF() const override { return false; }
    bool IsFailed() const override { return failed_; }

    std::size_t used() const { return used_; }  // (unit: bytes)

private:
    std::span<std::byte> memory_;
    std::size_t used_ = 0;
    bool failed_ = false;
};

class MemoryReader final : public JPH::StateRecorder {
public:
    explicit MemoryReader(std::span<const std::byte> memory) : memory_(memory) {}

    // What is missing reads as zero, and the whole as failed.
    void ReadBytes(void* data, std::size_t bytes) override {
        if (bytes > memory_.size() - used_) {
            failed_ = true;
            std::memset(data, 0, bytes);
            return;
        }
        copy_few_bytes(data, memory_.data() + used_, bytes);
        used_ += bytes;
    }
    void WriteBytes(const void*, std::size_t) override { failed_ = true; }
    bool IsEOF() const override { return used_ == memory_.size(); }
    bool IsFailed() const override { return failed_; }

private:
    std::span<const std::byte> memory_;
    std::size_t used_ = 0;
    bool failed_ = false;
};

}  // namespace tactus
