// From a Falcon's counts to a hand, and from a force to counts: its kinematics, motors and limits. Plain
// values.
#pragma once

#include "core/kinematics/delta.hpp"
#include "core/ports/device.hpp"
#include "devices/falcon/falcon_packet.hpp"

namespace tactus {

struct FalconData {
    DeltaGeometry geometry = falcon_geometry;
    double counts_a_turn = 1280.0;           // of a motor
    Vec3 zero_angles{40.0 * delta_degrees};  // of the legs where the encoders say 0 (unit: radians)
    double torque_a_count = 1.9835e-5;       // of a motor (unit: newton meters)
    int max_counts = 4096;
};

// Where the encoders say the legs are (unit: radians).
Vec3 falcon_angles(const FalconData& data, const std::array<std::int16_t, 3>& encoders);

class FalconArm {
public:
    explicit FalconArm(const FalconData& data = {});

    // The hand at this reading, `seconds` after the one before. In the device's frame: x right, y up, z
    // towards the user, 0 amid the workspace. False where the encoders show no place; the hand is then where
    // it was.
    bool read(const FalconReport& report, double seconds, DeviceSample& sample);

    // Counts that push the hand with this force where it was read last. Too much of it is shortened, never
    // turned; towards singular places it fades. What rounding leaves out comes with the next ones.
    std::array<std::int16_t, 3> counts(const Vec3& force);

    void reset();

private:
    FalconData data_;
    Vec3 place_;  // of the platform, in the arm's own frame (unit: meters)
    Vec3 angles_{0.0};
    Vec3 rates_{0.0};    // of the angles, smoothed (unit: radians per second)
    Vec3 rounded_{0.0};  // (unit: counts)
    bool begun_ = false;
};

DeviceCapabilities falcon_capabilities();

}  // namespace tactus
