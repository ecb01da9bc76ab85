#include "devices/falcon/falcon_arm.hpp"

#include <algorithm>
#include <cmath>

#include "core/safety/stiffness_limit.hpp"

namespace tactus {

namespace {

// An encoder's step a millisecond is 38 mm/s at the hand: rates are smoothed over this (unit: seconds).
constexpr double rate_time = 0.004;

}  // namespace

Vec3 falcon_angles(const FalconData& data, const std::array<std::int16_t, 3>& encoders) {
    const double count = 360.0 * delta_degrees / (data.counts_a_turn * data.geometry.gear);
    return data.zero_angles + count * Vec3(encoders[0], encoders[1], encoders[2]);
}

FalconArm::FalconArm(const FalconData& data) : data_(data), place_(delta_centre(data.geometry)) {}

void FalconArm::reset() {
    *this = FalconArm(data_);
}

bool FalconArm::read(const FalconReport& report, double seconds, DeviceSample& sample) {
    sample.buttons = report.buttons;
    const Vec3 angles = falcon_angles(data_, report.encoders);
    DeltaPlace found = delta_place(data_.geometry, angles, place_);
    if (!found.found) {
        found = delta_place(data_.geometry, angles, delta_centre(data_.geometry));
    }
    const DeltaPose pose = delta_pose(data_.geometry, found.place);
    if (!found.found || pose.state == DeltaState::out_of_reach) {
        sample.velocity = Vec3(0.0);
        begun_ = false;
        return false;
    }
    place_ = found.place;
    const double share = seconds / (seconds + rate_time);
    rates_ = begun_ ? rates_ + share * ((angles - angles_) / seconds - rates_) : Vec3(0.0);
    angles_ = angles;
    begun_ = true;
    sample.position = place_ - delta_centre(data_.geometry);
    sample.velocity = pose.clearance > 0.0 ? delta_velocity(pose, rates_) : Vec3(0.0);
    return true;
}

std::array<std::int16_t, 3> FalconArm::counts(const Vec3& force) {
    const DeltaPose pose = delta_pose(data_.geometry, place_);
    if (force == Vec3(0.0) || !(pose.clearance > 0.0)) {
        rounded_ = Vec3(0.0);
        return {};
    }
    const Vec3 torques = delta_torques(pose, force * pose.clearance);
    Vec3 wanted = torques / (data_.geometry.gear * data_.torque_a_count);
    const double most = data_.max_counts;
    const double largest = std::max({std::abs(wanted.x), std::abs(wanted.y), std::abs(wanted.z)});
    if (largest > most) {
        wanted *= most / largest;
    }
    std::array<std::int16_t, 3> counts{};
    for (int i = 0; i < 3; ++i) {
        const double exact = wanted[i] + rounded_[i];
        const double whole = std::clamp(std::round(exact), -most, most);
        counts[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(whole);
        rounded_[i] = std::clamp(exact - whole, -1.0, 1.0);
    }
    return counts;
}

// CHAI3D's figures: 3000 N/m are felt to be stable, with the exchange's own millisecond in it.
DeviceCapabilities falcon_capabilities() {
    DeviceCapabilities falcon;
    falcon.feels = true;
    falcon.radius = 0.04;
    falcon.rate = 1000.0;
    falcon.delay = 0.001;
    falcon.max_force = 8.0;
    falcon.max_slew = 4000.0;
    falcon.max_power = 8.0;
    falcon.max_energy = 0.5;
    falcon.max_speed = 5.0;
    falcon.damping = 3000.0 * (falcon.delay + 0.5 / falcon.rate);
    falcon.max_damping = 20.0;
    falcon.mass = 0.2;
    falcon.viscous = 1.0;
    falcon.coulomb = 0.15;
    falcon.velocity_smoothed = rate_time;
    falcon.ramp = 0.3;
    return falcon;
}

}  // namespace tactus
