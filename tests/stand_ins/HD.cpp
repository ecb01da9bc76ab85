// Stands in for OpenHaptics' libHD: its own thread ticks a thousand times a second.
#include <pthread.h>
#include <time.h>

#include <cstring>

#include "stand_ins/stand_ins.hpp"

namespace {

tactus::stand_ins::OpenHaptics device;
constexpr unsigned the_one = 7;

pthread_t ticking;
unsigned (*task)(void*) = nullptr;
void* task_data = nullptr;
bool in_frame = false;

void check(bool right) {
    device.wrong_calls += right ? 0 : 1;
}

void* tick(void*) {
    while (device.ticks) {
        const timespec span{0, 1'000'000};
        nanosleep(&span, nullptr);
        if (task != nullptr && !device.hangs) {
            task(task_data);
        }
    }
    return nullptr;
}

}  // namespace

#define STAND_IN extern "C" __attribute__((visibility("default")))

struct HDErrorInfo {
    unsigned code;
    int internal;
    unsigned device;
};

STAND_IN tactus::stand_ins::OpenHaptics* stand_in_openhaptics() {
    return &device;
}
STAND_IN unsigned hdInitDevice(const char*) {
    if (device.unplugged) {
        return ~0u;
    }
    check(!device.is_open);
    device.is_open = true;
    return the_one;
}
STAND_IN void hdDisableDevice(unsigned id) {
    check(id == the_one && device.is_open && !device.ticks);
    device.is_open = false;
}
STAND_IN void hdMakeCurrentDevice(unsigned id) {
    check(id == the_one);
}
STAND_IN void hdBeginFrame(unsigned id) {
    check(id == the_one && !in_frame);
    in_frame = true;
    ++device.frames;
}
STAND_IN void hdEndFrame(unsigned id) {
    check(id == the_one && in_frame);
    in_frame = false;
}
STAND_IN void hdEnable(unsigned what) {
    check(what == 0x4000);
}
STAND_IN void hdGetDoublev(unsigned what, double* values) {
    switch (what) {
        case 0x2050:
            check(in_frame);
            for (int i = 0; i < 3; ++i) {
                values[i] = device.position[i];
            }
            return;
        case 0x2051:
            check(in_frame);
            values[0] = values[1] = values[2] = 0.0;
            return;
        case 0x2052:  // a quarter turn about z, by columns
            check(in_frame);
            std::memset(values, 0, 16 * sizeof(double));
            values[1] = 1.0;
            values[4] = -1.0;
            values[10] = values[15] = 1.0;
            return;
        case 0x2551: {
            const double box[6] = {-80.0, -60.0, -35.0, 80.0, 60.0, 35.0};
            std::memcpy(values, box, sizeof box);
            return;
        }
        case 0x2622:
            check(device.has_six_motors);
            values[0] = 188.0;
            return;
        case 0x2603:
            values[0] = 3.3;
            return;
        case 0x2604:
            values[0] = 0.88;
            return;
        default:
            check(false);
    }
}
STAND_IN void hdGetIntegerv(unsigned what, int* value) {
    check(what == 0x2000 || what == 0x2600 || what == 0x2554 || what == 0x2555);
    check(what != 0x2000 || in_frame);
    if (what == 0x2554) {
        *value = device.has_six_motors ? 6 : 3;
        return;
    }
    *value = what == 0x2000 ? device.buttons.load() : what == 0x2600 ? 1000 : 1;
}
STAND_IN const char* hdGetString(unsigned what) {
    check(what == 0x2501 || what == 0x2504);
    return what == 0x2501 ? "Touch" : "0815";
}
STAND_IN void hdSetDoublev(unsigned what, const double* values) {
    check((what == 0x2700 || (what == 0x2703 && device.has_six_motors)) && in_frame);
    for (int i = 0; i < 3; ++i) {
        (what == 0x2700 ? device.force : device.torque)[i] = values[i];
    }
}
STAND_IN unsigned long hdScheduleAsynchronous(unsigned (*callback)(void*), void* data, unsigned short) {
    task = callback;
    task_data = data;
    return 1;
}
STAND_IN void hdUnschedule(unsigned long id) {
    check(id == 1);
    task = nullptr;
}
STAND_IN void hdStartScheduler() {
    check(!device.ticks);
    device.ticks = true;
    pthread_create(&ticking, nullptr, tick, nullptr);
}
STAND_IN void hdStopScheduler() {
    if (device.ticks.exchange(false)) {
        pthread_join(ticking, nullptr);
        for (auto& one : device.force) {
            one = 0.0;
        }
    }
}
STAND_IN HDErrorInfo hdGetError() {
    return {device.unplugged ? 0x0302u : 0u, 0, the_one};
}
STAND_IN unsigned hdCheckCalibration() {
    return device.calibration;
}
STAND_IN void hdUpdateCalibration(unsigned style) {
    check(style == 1);
    device.calibration = 0x5000;
}
