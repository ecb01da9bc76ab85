#include "devices/vendors/openhaptics_driver.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <mutex>
#include <vector>

#include "platform/clock.hpp"

namespace tactus {

namespace {

enum : unsigned {
    hd_buttons = 0x2000,
    hd_position = 0x2050,  // (unit: millimeters)
    hd_velocity = 0x2051,  // (unit: millimeters per second)
    hd_transform = 0x2052,
    hd_model = 0x2501,
    hd_serial = 0x2504,
    hd_workspace = 0x2551,  // corners of the usable part (unit: millimeters)
    hd_output_dof = 0x2554,
    hd_calibration_style = 0x2555,
    hd_update_rate = 0x2600,
    hd_max_force = 0x2603,
    hd_continuous_force = 0x2604,
    hd_max_torque = 0x2622,  // (unit: newton millimeters)
    hd_force = 0x2700,
    hd_torque = 0x2703,  // (the same unit)
    hd_force_output = 0x4000,
    hd_calibration_update = 0x5001,
    hd_calibration_by_hand = 0x5002,
    hd_device_fault = 0x0300,
    hd_communication = 0x0302,
    hd_timer = 0x0304,
};
constexpr unsigned no_device = ~0u;
constexpr unsigned goes_on = 1;
constexpr unsigned short default_priority = 0x7fff;
constexpr double millimeters = 1e-3;

// The library has one for all its devices.
struct Scheduler {
    std::mutex mutex;
    std::vector<const OpenHapticsDriver*> devices;
    bool runs = false;
    std::atomic<bool> has_served{false};  // a frame since its start: a force may have been given
};
Scheduler scheduler;

bool is_fault(unsigned code) {
    return code >= hd_device_fault && code <= hd_timer;
}

}  // namespace

std::string OpenHapticsDriver::load() {
    if (hd_.get_error != nullptr) {
        return {};
    }
    if (!library_.load({"libHD.so.3.4", "libHD.so", "hd.dll"}, "hdInitDevice")) {
        return "OpenHaptics is not installed: install 3D Systems' OpenHaptics and its device driver";
    }
    const bool all = library_.find({
        {"hdInitDevice", hd_.init_device},
        {"hdDisableDevice", hd_.disable_device},
        {"hdMakeCurrentDevice", hd_.make_current},
        {"hdBeginFrame", hd_.begin_frame},
        {"hdEndFrame", hd_.end_frame},
        {"hdEnable", hd_.enable},
        {"hdGetDoublev", hd_.get_doubles},
        {"hdGetIntegerv", hd_.get_integers},
        {"hdGetString", hd_.get_string},
        {"hdSetDoublev", hd_.set_doubles},
        {"hdStartScheduler", hd_.start_scheduler},
        {"hdStopScheduler", hd_.stop_scheduler},
        {"hdScheduleAsynchronous", hd_.schedule},
        {"hdUnschedule", hd_.unschedule},
        {"hdCheckCalibration", hd_.check_calibration},
        {"hdUpdateCalibration", hd_.update_calibration},
        {"hdGetError", hd_.get_error},
    });
    return all ? "" : "the installed OpenHaptics lacks what is needed: install version 3.4 or later";
}

std::string OpenHapticsDriver::problem_of(const Error& error) const {
    return "OpenHaptics refuses the device '" + (wanted_.empty() ? std::string("Default Device") : wanted_) +
           "' (error " + std::to_string(error.code) +
           "): plug it in, and pair it in the maker's set-up under that name";
}

std::string OpenHapticsDriver::open(const std::atomic<bool>&) {
    if (std::string problem = load(); !problem.empty()) {
        return problem;
    }
    if (!claim_.take("OpenHaptics " + wanted_)) {
        return "another HapticDevice has this device: set 'device_id' to the name of another one in the "
               "maker's "
               "set-up";
    }
    const std::lock_guard lock(scheduler.mutex);
    // A device comes while the scheduler does not run, which takes the others' forces away.
    if (std::ranges::any_of(scheduler.devices, [](const auto* other) { return other->gives_force(); })) {
        return "the device is looked for when the others give no force: let their hands touch nothing for a "
               "moment";
    }
    stop_scheduler();
    std::string problem = add_to_scheduler();
    if (!scheduler.devices.empty()) {
        start_scheduler();
    }
    if (const Error error = hd_.get_error(); problem.empty() && error.code != 0) {
        problem = problem_of(error);
    }
    return problem;
}

bool OpenHapticsDriver::gives_force() const {
    const ForceSlot* const forces = forces_.load(std::memory_order_acquire);
    return forces != nullptr && forces->due().looked_at != 0;
}

// A device comes, and goes, while it does not run.
std::string OpenHapticsDriver::add_to_scheduler() {
    device_ = hd_.init_device(wanted_.empty() ? nullptr : wanted_.c_str());
    if (const Error error = hd_.get_error(); device_ == no_device || is_fault(error.code)) {
        return problem_of(error);
    }
    hd_.make_current(device_);
    id_ = wanted_.empty() ? std::string(hd_.get_string(hd_model)) + " " + hd_.get_string(hd_serial) : wanted_;
    read_capabilities();
    hd_.enable(hd_force_output);
    fault_ = 0;
    is_stopped_ = false;
    task_ = hd_.schedule(serve, this, default_priority);
    scheduler.devices.push_back(this);
    return {};
}

void OpenHapticsDriver::start_scheduler() {
    if (!scheduler.runs) {
        scheduler.has_served.store(false, std::memory_order_release);
        hd_.start_scheduler();
        scheduler.runs = true;
    }
}

void OpenHapticsDriver::stop_scheduler() {
    if (scheduler.runs) {
        hd_.stop_scheduler();
        scheduler.runs = false;
    }
}

void OpenHapticsDriver::read_capabilities() {
    std::array<double, 6> box{};
    double most = 0.0, lasting = 0.0, torque = 0.0;
    int rate = 0, motors = 0;
    hd_.get_doubles(hd_workspace, box.data());
    hd_.get_doubles(hd_max_force, &most);
    hd_.get_doubles(hd_continuous_force, &lasting);
    hd_.get_integers(hd_update_rate, &rate);
    hd_.get_integers(hd_output_dof, &motors);
    if (motors == 6) {
        hd_.get_doubles(hd_max_torque, &torque);
    }
    capabilities_ = {};
    capabilities_.feels = true;
    capabilities_.rotates = true;
    capabilities_.radius = 0.5 * millimeters * std::min({box[3] - box[0], box[4] - box[1], box[5] - box[2]});
    capabilities_.rate = rate > 0 ? rate : 1000.0;
    capabilities_.delay = 1.0 / capabilities_.rate;
    capabilities_.max_force = std::max(most, lasting);
    capabilities_.max_torque = millimeters * torque;
    capabilities_.max_torque_slew = 500.0 * capabilities_.max_torque;
    capabilities_.max_slew = 500.0 * capabilities_.max_force;
    capabilities_.max_power = 3.0;
    capabilities_.max_energy = 0.3;
    capabilities_.max_speed = 5.0;
    // What its maker calls its stiffest wall (1 N/mm) with a millisecond of delay.
    capabilities_.damping = 1000.0 * (capabilities_.delay + 0.5 / capabilities_.rate);
    capabilities_.max_damping = 5.0;
    capabilities_.velocity_smoothed = unstated_smoothing;
    capabilities_.ramp = 0.3;
}

void OpenHapticsDriver::close() {
    claim_.give_back();
    if (device_ == no_device || hd_.get_error == nullptr) {
        return;
    }
    const std::lock_guard lock(scheduler.mutex);
    stop_scheduler();
    if (task_ != 0) {
        hd_.unschedule(task_);
        std::erase(scheduler.devices, this);
    }
    hd_.disable_device(device_);
    device_ = no_device;
    task_ = 0;
    forces_.store(nullptr);
    if (!scheduler.devices.empty()) {
        start_scheduler();
    }
}

unsigned OpenHapticsDriver::serve(void* driver) {
    static_cast<OpenHapticsDriver*>(driver)->serve_frame();
    return goes_on;
}

void OpenHapticsDriver::serve_frame() {
    // What the library does not fill in is no number.
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    Vec3 position(nothing), velocity(nothing);
    std::array<double, 16> transform;
    transform.fill(nothing);
    int buttons = 0;
    scheduler.has_served.store(true, std::memory_order_release);
    served_.at = monotonic_now();
    hd_.begin_frame(device_);
    hd_.get_doubles(hd_position, &position.x);
    hd_.get_doubles(hd_velocity, &velocity.x);
    hd_.get_doubles(hd_transform, transform.data());
    hd_.get_integers(hd_buttons, &buttons);
    ForceSlot* const forces = forces_.load(std::memory_order_acquire);
    const Vec3 force = forces != nullptr ? forces->living(monotonic_now()) : Vec3(0.0);
    hd_.set_doubles(hd_force, &force.x);
    if (capabilities_.max_torque > 0.0) {
        const Vec3 torque = (forces != nullptr ? forces->torque() : Vec3(0.0)) / millimeters;
        hd_.set_doubles(hd_torque, &torque.x);
    }
    hd_.end_frame(device_);
    if (forces != nullptr) {
        forces->given(monotonic_now());
    }
    if (const Error error = hd_.get_error(); is_fault(error.code)) {
        fault_.store(error.code, std::memory_order_release);
    }
    served_.sample.position = millimeters * position;
    served_.sample.velocity = millimeters * velocity;
    const Mat3 turn(Vec3(transform[0], transform[1], transform[2]),
                    Vec3(transform[4], transform[5], transform[6]),
                    Vec3(transform[8], transform[9], transform[10]));
    served_.sample.rotation = glm::normalize(glm::quat_cast(turn));
    served_.sample.buttons = static_cast<std::uint32_t>(buttons);
    served_.calibration = hd_.check_calibration();
    served_.sample.connected = served_.calibration < hd_calibration_update;
    frames_.publish(served_);
    served_signal_.wake();
}

Driver::Exchange OpenHapticsDriver::exchange(ForceSlot& forces, Nanoseconds until, DriverReading& reading) {
    forces_.store(&forces, std::memory_order_release);
    if (is_stopped_.exchange(false, std::memory_order_acq_rel)) {
        const std::lock_guard lock(scheduler.mutex);
        start_scheduler();
    }
    const auto has_news = [this] {
        return frames_.is_fresh() || fault_.load(std::memory_order_acquire) != 0 ||
               is_stopped_.load(std::memory_order_acquire);
    };
    served_signal_.wait_until(until, {}, has_news);
    if (fault_.load(std::memory_order_acquire) != 0) {
        return Exchange::lost;
    }
    if (!frames_.refresh()) {
        return Exchange::nothing;
    }
    reading.sample = frames_.front().sample;
    reading.at = frames_.front().at;
    calibration_ = frames_.front().calibration;
    if (calibration_ == hd_calibration_update) {
        int style = 0;
        hd_.make_current(device_);
        hd_.get_integers(hd_calibration_style, &style);
        hd_.update_calibration(static_cast<unsigned>(style));
    }
    return Exchange::reading;
}

// Its servo thread is what is stuck; stopped, the device gives no force. exchange() starts it again: until it
// has served a frame there is no force to take, and it is left to start.
void OpenHapticsDriver::let_go() {
    const std::lock_guard lock(scheduler.mutex);
    if (scheduler.runs && !scheduler.has_served.load(std::memory_order_acquire)) {
        return;
    }
    stop_scheduler();
    is_stopped_.store(true, std::memory_order_release);
    served_signal_.wake();
}

std::string OpenHapticsDriver::advice() const {
    return calibration_ == hd_calibration_by_hand
               ? "the device does not know where it is yet: put its stylus into the "
                 "inkwell until its light stays on"
               : "";
}

}  // namespace tactus
