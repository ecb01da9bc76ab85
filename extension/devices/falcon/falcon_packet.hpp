// The sixteen bytes that a Novint Falcon and its host exchange a thousand times a second.
//
//     '<'  torques or encoders: three int16 of four nibbles each, lowest first, every nibble + 'A'
//          one byte of flags + 'A'   one byte of nothing, 'A'   '>'
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus {

inline constexpr std::size_t falcon_packet_size = 16;
using FalconPacket = std::array<std::uint8_t, falcon_packet_size>;

enum FalconLed : std::uint8_t { falcon_led_green = 1, falcon_led_blue = 2, falcon_led_red = 4 };

struct FalconCommand {
    std::array<std::int16_t, 3> torques{};  // (unit: counts), -4096 … 4096
    bool homing = false;                    // it looks for its legs' reference marks
    std::uint8_t leds = 0;                  // FalconLed
    friend bool operator==(const FalconCommand&, const FalconCommand&) = default;
};

struct FalconReport {
    std::array<std::int16_t, 3> encoders{};  // (unit: counts)
    std::uint8_t buttons = 0;                // bits: plus, forward, centre, minus
    std::uint8_t homed = 0;                  // bits: legs that have seen their mark; 7: all
    friend bool operator==(const FalconReport&, const FalconReport&) = default;
};

FalconPacket falcon_encode(const FalconCommand& command);
// As the device does it, for who plays one.
FalconPacket falcon_encode(const FalconReport& report);

// Bytes as they come, in pieces of any size, with or without gaps: whole packets out. What is no packet is
// left out, never believed.
template <typename Message>
class FalconStream {
public:
    void take(std::span<const std::uint8_t> bytes);
    // The oldest whole message that has not been given out; false where there is none.
    bool next(Message& message);
    std::uint64_t dropped() const { return dropped_; }  // bytes that belonged to no packet
    void reset() { size_ = 0; }

private:
    std::array<std::uint8_t, 512> bytes_{};
    std::size_t size_ = 0;
    std::uint64_t dropped_ = 0;
};

extern template class FalconStream<FalconReport>;
extern template class FalconStream<FalconCommand>;

}  // namespace tactus
