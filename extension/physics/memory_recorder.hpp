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

class MemoryWriter final : public JPH::StateRecorder {
public:
    explicit MemoryWriter(std::span<std::byte> memory) : memory_(memory) {}

    void WriteBytes(const void* data, std::size_t bytes) override {
        if (bytes > memory_.size() - used_) {
            failed_ = true;
            return;
        }
        std::memcpy(memory_.data() + used_, data, bytes);
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
        std::memcpy(data, memory_.data() + used_, bytes);
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
