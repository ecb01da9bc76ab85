// Numbers to bytes and back: little-endian, packed without gaps, every step checked.
//
// A writer and a reader have the same functions, so that one list of fields serves both and neither can
// forget what the other has. The first thing that is wrong stops both: what follows is neither written nor
// read.
#pragma once

#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/math/pose.hpp"
#include "network/messages.hpp"

namespace tactus {

static_assert(std::endian::native == std::endian::little, "the copies below would have to turn the bytes");

// The first two bytes: "TC" before a packet, "TS" before a sealed one (secure_link.hpp).
inline constexpr std::uint16_t packet_magic = 0x4354;
inline constexpr std::uint16_t sealed_magic = 0x5354;

// What any honest sender stays within. Times: so that no sum of four overflows. Quaternions: single precision
// leaves 1e-7, a damaged one is far off.
inline constexpr Nanoseconds most_wire_time = Nanoseconds{1} << 60;  // either sign; 36 years
inline constexpr double most_wire_length = 1e9;                      // of any component of any vector
inline constexpr double quaternion_tolerance = 1e-3;                 // of the norm from 1

class WireStream {
public:
    Refusal refusal() const { return refusal_; }
    bool good() const { return refusal_ == Refusal::none; }

    void refuse(Refusal refusal) {
        if (good()) {
            refusal_ = refusal;
        }
    }
    void require(bool condition) {
        if (!condition) {
            refuse(Refusal::out_of_range);
        }
    }

protected:
    template <std::floating_point Real>
    void check_real(Real value, Real least, Real most) {
        if (!std::isfinite(value)) {
            refuse(Refusal::not_finite);
        } else {
            require(value >= least && value <= most);
        }
    }

    void check_rotation(const Quat& q) {
        require(std::abs(glm::dot(q, q) - 1.0) < 2.0 * quaternion_tolerance);
    }

private:
    Refusal refusal_ = Refusal::none;
};

class WireWriter : public WireStream {
public:
    static constexpr bool reads = false;

    explicit WireWriter(std::span<std::byte> into) : data_(into.data()), limit_(into.size()) {}

    // Counts the bytes that would be written, at most `limit`.
    static WireWriter measuring(std::size_t limit) { return WireWriter(nullptr, limit); }

    std::size_t written() const { return at_; }

    template <std::integral Integer>
    void integer(Integer value) {
        put(&value, sizeof value);
    }
    void flag(bool value) { integer(static_cast<std::uint8_t>(value)); }
    template <typename Enum>
    void choice(Enum value, Enum last) {
        require(value <= last);
        integer(static_cast<std::uint8_t>(value));
    }
    void time(Nanoseconds value) {
        require(value >= -most_wire_time && value <= most_wire_time);
        integer(value);
    }
    template <std::floating_point Real>
    void real(Real value, Real least, Real most) {
        check_real(value, least, most);
        put(&value, sizeof value);
    }
    void vector(const Vec3& value, double least = -most_wire_length, double most = most_wire_length) {
        real(value.x, least, most);
        real(value.y, least, most);
        real(value.z, least, most);
    }
    void rotation(const Quat& value) {
        for (const double part : {value.x, value.y, value.z, value.w}) {
            real(part, -2.0, 2.0);
        }
        check_rotation(value);
    }
    void pose(const Pose& value) {
        vector(value.position);
        rotation(value.rotation);
    }
    void bytes(std::span<const std::byte> value) { put(value.data(), value.size()); }

private:
    WireWriter(std::byte* data, std::size_t limit) : data_(data), limit_(limit) {}

    void put(const void* from, std::size_t size) {
        if (size > limit_ - at_) {
            refuse(Refusal::oversized);
        }
        if (!good()) {
            return;
        }
        if (data_ != nullptr && size != 0) {
            std::memcpy(data_ + at_, from, size);
        }
        at_ += size;
    }

    std::byte* data_;
    std::size_t limit_;
    std::size_t at_ = 0;
};

class WireReader : public WireStream {
public:
    static constexpr bool reads = true;

    explicit WireReader(std::span<const std::byte> from) : from_(from) {}

    std::size_t remaining() const { return from_.size() - at_; }

    template <std::integral Integer>
    void integer(Integer& value) {
        take(&value, sizeof value);
    }
    void flag(bool& value) {
        std::uint8_t byte = 0;
        integer(byte);
        require(byte <= 1);
        value = byte == 1;
    }
    template <typename Enum>
    void choice(Enum& value, Enum last) {
        std::uint8_t byte = 0;
        integer(byte);
        require(byte <= static_cast<std::uint8_t>(last));
        value = good() ? static_cast<Enum>(byte) : Enum{};
    }
    void time(Nanoseconds& value) {
        integer(value);
        require(value >= -most_wire_time && value <= most_wire_time);
    }
    template <std::floating_point Real>
    void real(Real& value, Real least, Real most) {
        take(&value, sizeof value);
        check_real(value, least, most);
    }
    void vector(Vec3& value, double least = -most_wire_length, double most = most_wire_length) {
        real(value.x, least, most);
        real(value.y, least, most);
        real(value.z, least, most);
    }
    void rotation(Quat& value) {
        for (double* part : {&value.x, &value.y, &value.z, &value.w}) {
            real(*part, -2.0, 2.0);
        }
        check_rotation(value);
    }
    void pose(Pose& value) {
        vector(value.position);
        rotation(value.rotation);
    }

    // The next bytes in place; empty where there are fewer.
    std::span<const std::byte> bytes(std::size_t count) {
        if (count > remaining()) {
            refuse(Refusal::truncated);
        }
        if (!good()) {
            return {};
        }
        at_ += count;
        return from_.subspan(at_ - count, count);
    }

private:
    void take(void* into, std::size_t size) {
        const std::span<const std::byte> found = bytes(size);
        if (found.size() == size) {
            std::memcpy(into, found.data(), size);
        }
    }

    std::span<const std::byte> from_;
    std::size_t at_ = 0;
};

}  // namespace tactus
