#include "devices/vendors/force_dimension_driver.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/quaternion.hpp>

#include "devices/falcon/falcon_arm.hpp"
#include "platform/clock.hpp"

namespace tactus {

namespace {

constexpr int type_falcon = 60;

// The library's velocity is the mean over a window of time, the distance between its ends over its length:
// 20 ms unless another one is set (unit: milliseconds).
constexpr int windowing = 0;
constexpr int usual_window = 20;
// A Falcon's encoders have steps of 38 um at the hand, the others of 10 um and less.
constexpr int falcon_window = 8;
constexpr int fine_window = 2;

// A mean over a window is as late as a first-order filter with half of it (unit: seconds).
constexpr double smoothed_by(int window) {
    return 0.5e-3 * window;
}

// Between two readings while no loop writes (unit: nanoseconds).
constexpr Nanoseconds idle_period = 1'000'000;

// Their x points to the user, y to the right, z up; ours x to the right, y up, z to the user.
Vec3 from_device(double x, double y, double z) {
    return {y, z, x};
}

// Of the handle, from the matrix by rows in their axes.
Quat from_device(const double (&rows)[3][3]) {
    constexpr std::array theirs{1, 2, 0};  // the axis of theirs that is ours
    Mat3 turn;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            turn[column][row] =
                rows[theirs[static_cast<std::size_t>(row)]][theirs[static_cast<std::size_t>(column)]];
        }
    }
    return glm::normalize(glm::quat_cast(turn));
}

// After so long without a force its firmware lets go, whatever has become of this process (in eighths of a
// millisecond).
constexpr unsigned char watchdog_time = 16;
constexpr Nanoseconds let_go_after = watchdog_time * Nanoseconds{125'000};

// 0 is fine; 1 (too soon) and 2 (a motor gives less than asked) are no errors.
bool failed(int result) {
    return result < 0;
}

}  // namespace

std::string ForceDimensionDriver::load() {
    if (dhd_.stop != nullptr) {
        return {};
    }
    if (!library_.load({"libdrd.so.3", "libdrd.so", "libdhd.so.3", "libdhd.so", "drd64.dll", "dhd64.dll",
                        "libdrd.dylib", "libdhd.dylib"},
                       "dhdGetDeviceCount")) {
        return "Force Dimension's library is not installed: install its SDK, so that libdrd or libdhd is "
               "where the "
               "system looks for libraries";
    }
    const bool all = library_.find({
        {"dhdGetDeviceCount", dhd_.device_count},
        {"dhdOpenID", dhd_.open_id},
        {"dhdClose", dhd_.close},
        {"dhdGetSystemType", dhd_.system_type},
        {"dhdGetSystemName", dhd_.system_name},
        {"dhdEnableForce", dhd_.enable_force},
        {"dhdGetPosition", dhd_.get_position},
        {"dhdGetLinearVelocity", dhd_.get_velocity},
        {"dhdSetForce", dhd_.set_force},
        {"dhdGetButtonMask", dhd_.get_buttons},
        {"dhdSetGravityCompensation", dhd_.set_gravity_compensation},
        {"dhdErrorGetLastStr", dhd_.last_error},
        {"dhdStop", dhd_.stop},
    });
    library_.find({{"dhdSetWatchdog", set_watchdog_}});
    library_.find({{"dhdConfigLinearVelocity", set_velocity_window_}});
    library_.find({
        {"dhdHasWrist", wrist_.has_wrist},
        {"dhdHasActiveWrist", wrist_.has_active_wrist},
        {"dhdGetOrientationFrame", wrist_.get_frame},
        {"dhdSetForceAndTorqueAndGripperForce", wrist_.set_all},
    });
    return all ? ""
               : "Force Dimension's library is of a version that lacks what is needed: install SDK 3.9 or "
                 "later";
}

std::string ForceDimensionDriver::open(const std::atomic<bool>&) {
    if (std::string problem = load(); !problem.empty()) {
        return problem;
    }
    const int count = dhd_.device_count();
    std::string problem = wanted_.empty()
                              ? "no device of Force Dimension is plugged in: plug it in, with its power"
                              : "the device " + wanted_ + " is not plugged in";
    for (int i = 0; i < count && !is_open_; ++i) {
        if (!claim_.take("Force Dimension " + std::to_string(i))) {
            problem = "another HapticDevice has the device: plug in a second one, or let one node have it";
        } else if (std::string why = open_one(i); !why.empty()) {
            problem = std::move(why);
        }
    }
    if (!is_open_) {
        claim_.give_back();
        return problem;
    }
    return {};
}

// Empty where it is open now, or is not the one that is wanted.
std::string ForceDimensionDriver::open_one(int index) {
    const int device = dhd_.open_id(static_cast<char>(index));
    if (failed(device)) {
        return std::string("the device cannot be opened: ") + dhd_.last_error() +
               " (is another program using it? may this user open it?)";
    }
    device_ = static_cast<char>(device);
    is_open_ = true;
    const char* const name = dhd_.system_name(device_);
    id_ = std::string(name != nullptr ? name : "device") + "-" + std::to_string(index);
    if (!wanted_.empty() && wanted_ != id_) {
        close();
        return {};
    }
    type_ = dhd_.system_type(device_);
    dhd_.set_gravity_compensation(1, device_);
    if (failed(dhd_.enable_force(1, device_))) {
        const std::string why = dhd_.last_error();
        close();
        return "the device gives no force: " + why;
    }
    is_watched_ = set_watchdog_ != nullptr && !failed(set_watchdog_(watchdog_time, device_));
    turns_ = wrist_.has_wrist != nullptr && wrist_.has_wrist(device_) > 0;
    twists_ = turns_ && wrist_.has_active_wrist(device_) > 0;
    set_velocity_window();
    read_at_ = set_at_ = monotonic_now();
    enabled_after_ = stops_.load(std::memory_order_relaxed);
    return {};
}

void ForceDimensionDriver::set_velocity_window() {
    const int window = type_ == type_falcon ? falcon_window : fine_window;
    const bool is_set =
        set_velocity_window_ != nullptr && !failed(set_velocity_window_(window, windowing, device_));
    velocity_smoothed_ = smoothed_by(is_set ? window : usual_window);
}

bool ForceDimensionDriver::set(const Vec3& force, const Vec3& torque) {
    set_at_ = monotonic_now();
    return !failed(twists_
                       ? wrist_.set_all(force.z, force.x, force.y, torque.z, torque.x, torque.y, 0.0, device_)
                       : dhd_.set_force(force.z, force.x, force.y, device_));
}

// The watchdog's dhdStop() may come at any moment. A force that was looked up before it is not given after
// it: the library refuses it, which is no loss of the device, or it is taken away again where the forces were
// being switched on meanwhile. The next one begins at nothing.
bool ForceDimensionDriver::send(ForceSlot& forces) {
    const unsigned stops = stops_.load(std::memory_order_acquire);
    if (stops != enabled_after_) {
        forces.taken();
    }
    const Nanoseconds now = monotonic_now();
    const Vec3 force = forces.living(now);
    if (stops % 2 != 0) {
        return true;
    }
    // They are off after dhdStop(), or its firmware may have switched them off.
    if (stops != enabled_after_ || (is_watched_ && now - set_at_ >= let_go_after)) {
        dhd_.enable_force(1, device_);
        enabled_after_ = stops;
    }
    const bool is_set = set(force, forces.torque());
    if (stops_.load(std::memory_order_acquire) != stops) {
        dhd_.stop(device_);
        return true;
    }
    forces.given(monotonic_now());
    return is_set;
}

void ForceDimensionDriver::close() {
    if (is_open_) {
        set(Vec3(0.0), Vec3(0.0));
        dhd_.close(device_);
        is_open_ = false;
        claim_.give_back();
    }
}

// The force goes out when the loop has written it, the reading is taken before the loop looks for the next.
Driver::Exchange ForceDimensionDriver::exchange(ForceSlot& forces, Nanoseconds until,
                                                DriverReading& reading) {
    forces.wait_for_write(std::min(until, forces.end() != 0 ? forces.end() + 1 : read_at_ + idle_period));
    if (!send(forces)) {
        return lost();
    }
    timer_.sleep_until(std::min(until, forces.next_reading()));
    reading.at = read_at_ = monotonic_now();
    return read(reading.sample) ? Exchange::reading : lost();
}

Driver::Exchange ForceDimensionDriver::lost() {
    const char* const why = dhd_.last_error();
    why_lost_ = why != nullptr ? why : "";
    return Exchange::lost;
}

bool ForceDimensionDriver::read(DeviceSample& sample) {
    double x = 0.0, y = 0.0, z = 0.0, vx = 0.0, vy = 0.0, vz = 0.0;
    if (failed(dhd_.get_position(&x, &y, &z, device_)) || failed(dhd_.get_velocity(&vx, &vy, &vz, device_))) {
        return false;
    }
    sample.position = from_device(x, y, z);
    sample.velocity = from_device(vx, vy, vz);
    sample.buttons = dhd_.get_buttons(device_);
    sample.connected = true;
    if (double rows[3][3]{}; turns_) {
        if (failed(wrist_.get_frame(rows, device_))) {
            return false;
        }
        sample.rotation = from_device(rows);
    }
    return true;
}

// Brakes, and no force.
void ForceDimensionDriver::let_go() {
    stops_.fetch_add(1, std::memory_order_acq_rel);
    dhd_.stop(device_);
    stops_.fetch_add(1, std::memory_order_acq_rel);
}

// What the library does not tell is held to what the smallest of its devices can do.
DeviceCapabilities ForceDimensionDriver::capabilities() const {
    DeviceCapabilities device = falcon_capabilities();
    if (type_ != type_falcon) {
        device.radius = 0.06;
        device.max_force = 12.0;
        device.damping = 3.0;
    }
    device.velocity_smoothed = velocity_smoothed_;
    device.rotates = turns_;
    device.max_torque = twists_ ? 0.15 : 0.0;
    device.max_torque_slew = 50.0;
    return device;
}

}  // namespace tactus
