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
#include "network/plausibility.hpp"

namespace tactus {

static_assert(std::endian::native == std::endian::little, "the copies below would have to turn the bytes");

// The first two bytes: "TC" before a packet, "TS" before a sealed one (secure_link.hpp).
inline constexpr std::uint16_t packet_magic = 0x4354;
inline constexpr std::uint16_t sealed_magic = 0x5354;

inline constexpr double quaternion_tolerance = 1e-3;  // of the norm from 1: a damaged one is far off
inline constexpr double max_wire_length = 1e9;  // of what is neither a position nor a speed (unit: meters)

// Small numbers of either sign become small ones without: 0, -1, 1, -2, … -> 0, 1, 2, 3, …
constexpr std::uint64_t folded(std::int64_t value) {
    return (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
}
constexpr std::int64_t unfolded(std::uint64_t value) {
    return static_cast<std::int64_t>((value >> 1) ^ (~(value & 1) + 1));
}

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

    // When the packet is sent: times in it are told from there.
    void set_sent_at(Nanoseconds time) { sent_at_ = time; }
    Nanoseconds sent_at() const { return sent_at_; }

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
    Nanoseconds sent_at_ = 0;
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
    // As few bytes as it takes: seven bits in each, the lowest first, the top bit says that more follow.
    void varint(std::uint64_t value) {
        for (; value >= 0x80u; value >>= 7) {
            integer(static_cast<std::uint8_t>(value | 0x80u));
        }
        integer(static_cast<std::uint8_t>(value));
    }
    void folded_varint(std::int64_t value) { varint(folded(value)); }
    void time_near(Nanoseconds value) {
        const Nanoseconds age = value - sent_at();
        require(age >= -plausible::max_age && age <= plausible::max_age);
        folded_varint(age);
    }
    void flag(bool value) { integer(static_cast<std::uint8_t>(value)); }
    template <typename Enum>
    void choice(Enum value, Enum last) {
        require(value <= last);
        integer(static_cast<std::uint8_t>(value));
    }
    void time(Nanoseconds value) {
        require(value >= -plausible::max_time && value <= plausible::max_time);
        integer(value);
    }
    template <std::floating_point Real>
    void real(Real value, Real least, Real most) {
        check_real(value, least, most);
        put(&value, sizeof value);
    }
    void vector(const Vec3& value, double least = -max_wire_length, double most = max_wire_length) {
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
    void varint(std::uint64_t& value) {
        constexpr int bits = 64;
        value = 0;
        for (int shift = 0; good(); shift += 7) {
            std::uint8_t byte = 0;
            integer(byte);
            const std::uint64_t part = byte & 0x7fu;
            // No bit beyond the last one, and no byte that says nothing.
            require(shift < bits && part << shift >> shift == part && (byte != 0 || shift == 0));
            if (!good()) {
                break;
            }
            value |= part << shift;
            if (byte < 0x80u) {
                return;
            }
        }
    }
    void folded_varint(std::int64_t& value) {
        std::uint64_t number = 0;
        varint(number);
        value = unfolded(number);
    }
    void time_near(Nanoseconds& value) {
        std::int64_t age = 0;
        folded_varint(age);
        require(age >= -plausible::max_age && age <= plausible::max_age);
        value = good() ? sent_at() + age : 0;
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
        require(value >= -plausible::max_time && value <= plausible::max_time);
    }
    template <std::floating_point Real>
    void real(Real& value, Real least, Real most) {
        take(&value, sizeof value);
        check_real(value, least, most);
    }
    void vector(Vec3& value, double least = -max_wire_length, double most = max_wire_length) {
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
