// Stands in for Force Dimension's libdhd.
#include <time.h>

#include <cstring>

#include "stand_ins/stand_ins.hpp"

namespace {

using tactus::stand_ins::Field;

tactus::stand_ins::ForceDimension device;
constexpr char the_one = 0;

bool fails(const char* function) {
    const char* const name = device.fails;
    return name != nullptr && std::strcmp(name, function) == 0;
}

// 0, or an error where the call is out of place.
int checked(char id, bool is_in_place = true) {
    const bool right = id == the_one && device.is_open && is_in_place;
    device.wrong_calls += right ? 0 : 1;
    return right && !device.unplugged ? 0 : -1;
}
// The same, of a function that may be made to fail.
int result_of(const char* function, char id, bool is_in_place = true) {
    const int result = checked(id, is_in_place);
    return fails(function) ? -1 : result;
}

void wait_while_hung() {
    while (device.hangs || device.lying.is_silent()) {
        const timespec span{0, 1'000'000};
        nanosleep(&span, nullptr);
    }
}

// Whether it was.
bool wait_while_overtaken(const char* function) {
    const char* const name = device.overtaken;
    if (name == nullptr || std::strcmp(name, function) != 0) {
        return false;
    }
    const int before = device.stops;
    while (device.stops == before) {
        const timespec span{0, 100'000};
        nanosleep(&span, nullptr);
    }
    device.overtaken = nullptr;
    return true;
}

}  // namespace

#define STAND_IN extern "C" __attribute__((visibility("default")))

STAND_IN tactus::stand_ins::ForceDimension* stand_in_force_dimension() {
    return &device;
}
STAND_IN int dhdGetDeviceCount() {
    return device.unplugged ? 0 : device.devices.load();
}
STAND_IN int dhdOpenID(char id) {
    if (id != the_one || device.in_use || device.unplugged) {
        return -1;
    }
    device.wrong_calls += device.is_open ? 1 : 0;
    device.is_open = true;
    device.braked = device.is_stale = false;
    device.velocity_window = 20;
    return the_one;
}
STAND_IN int dhdClose(char id) {
    const int result = checked(id);
    device.is_open = device.forces_on = false;
    for (auto& one : device.force) {
        one = 0.0;
    }
    return result;
}
STAND_IN int dhdGetSystemType(char id) {
    return checked(id) == 0 ? 33 : -1;
}
STAND_IN const char* dhdGetSystemName(char id) {
    return checked(id) == 0 ? "omega.3" : nullptr;
}
STAND_IN int dhdEnableForce(unsigned char on, char id) {
    device.is_stale = wait_while_overtaken("dhdEnableForce") || device.is_stale;
    device.forces_on = on != 0;
    return result_of("dhdEnableForce", id);
}
STAND_IN int dhdGetPosition(double* x, double* y, double* z, char id) {
    wait_while_hung();
    *x = device.position[0];
    *y = device.lying.told(Field::position, device.position[1], device.position[1] + 0.03);
    *z = device.position[2];
    return result_of("dhdGetPosition", id);
}
STAND_IN int dhdGetLinearVelocity(double* x, double* y, double* z, char id) {
    *x = *z = 0.0;
    *y = device.lying.velocity();
    return result_of("dhdGetLinearVelocity", id) == 0 ? 1
                                                      : -1;  // asked too soon after the last time: no error
}
STAND_IN int dhdSetForce(double x, double y, double z, char id) {
    wait_while_overtaken("dhdSetForce");
    const int result = result_of("dhdSetForce", id, device.forces_on || device.braked);
    if (result != 0 || !device.forces_on) {
        return -1;
    }
    tactus::stand_ins::set_force(device.force, device.most_step, x, y, z);
    device.braked = false;
    ++device.set_forces;
    device.stale_forces += device.is_stale ? 1 : 0;
    return 0;
}
STAND_IN int dhdHasWrist(char id) {
    return checked(id) == 0 && device.has_wrist ? 1 : 0;
}
STAND_IN int dhdHasActiveWrist(char id) {
    return dhdHasWrist(id);
}
STAND_IN int dhdGetOrientationFrame(double rows[3][3], char id) {
    const double way = device.lying.told(Field::rotation, 1.0, -1.0);  // a leap is half a turn about x
    const double turn[3][3] = {{1.0, 0.0, 0.0}, {0.0, 0.0, -way}, {0.0, way, 0.0}};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            rows[row][column] = turn[row][column];
        }
    }
    return result_of("dhdGetOrientationFrame", id, device.has_wrist);
}
STAND_IN int dhdSetForceAndTorqueAndGripperForce(double x, double y, double z, double tx, double ty,
                                                 double tz, double grip, char id) {
    const int result = dhdSetForce(x, y, z, id);
    device.wrong_calls += device.has_wrist && grip == 0.0 ? 0 : 1;
    device.torque[0] = tx;
    device.torque[1] = ty;
    device.torque[2] = tz;
    return result;
}
STAND_IN int dhdSetWatchdog(unsigned char time, char id) {
    device.watchdog = time;
    return checked(id);
}
STAND_IN int dhdConfigLinearVelocity(int window, int mode, char id) {
    const int result = result_of("dhdConfigLinearVelocity", id, window > 0 && mode == 0);
    device.velocity_window = result == 0 ? window : device.velocity_window.load();
    return result;
}
STAND_IN unsigned dhdGetButtonMask(char id) {
    const bool leaps = device.lying.swaps_buttons();
    return checked(id) == 0 ? (leaps ? ~device.buttons.load() : device.buttons.load()) : 0u;
}
STAND_IN int dhdSetGravityCompensation(int, char id) {
    return checked(id);
}
STAND_IN int dhdStop(char id) {
    const int result = checked(id);
    for (auto& one : device.force) {
        one = 0.0;
    }
    device.braked = true;
    device.forces_on = device.is_stale = false;
    ++device.stops;
    return result;
}
STAND_IN const char* dhdErrorGetLastStr() {
    return device.in_use ? "device already opened" : "communication error";
}
