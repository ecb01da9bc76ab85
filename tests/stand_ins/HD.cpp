// Stands in for OpenHaptics' libHD: its own thread ticks a thousand times a second.
#include <pthread.h>
#include <time.h>

#include <cstring>

#include "stand_ins/stand_ins.hpp"

namespace {

using tactus::stand_ins::Field;

tactus::stand_ins::OpenHaptics device;
constexpr unsigned the_one = 7, the_second = 8;  // that one by its name alone

pthread_t ticking;
struct Task {
    unsigned (*callback)(void*) = nullptr;
    void* data = nullptr;
};
Task tasks[2];
bool in_frame = false;
unsigned current = 0;

bool is_known(unsigned id) {
    return id == the_one || id == the_second;
}

void check(bool right) {
    device.wrong_calls += right ? 0 : 1;
}

void* tick(void*) {
    for (int waited = -device.start_time; device.ticks; ++waited) {
        const timespec span{0, 1'000'000};
        nanosleep(&span, nullptr);
        if (waited < 0 || !device.ticks) {
            continue;
        }
        for (const Task& task : tasks) {
            if (task.callback != nullptr && !device.hangs && !device.lying.is_silent()) {
                task.callback(task.data);
            }
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
STAND_IN unsigned hdInitDevice(const char* name) {
    if (device.unplugged) {
        return ~0u;
    }
    check(!device.ticks);
    if (name != nullptr && std::strcmp(name, "Missing") == 0) {
        return ~0u;
    }
    if (name != nullptr && std::strcmp(name, "Second") == 0) {
        return the_second;
    }
    check(!device.is_open);
    device.is_open = true;
    return the_one;
}
STAND_IN void hdDisableDevice(unsigned id) {
    check(is_known(id) && !device.ticks && (id == the_second || device.is_open));
    device.is_open = device.is_open && id == the_second;
}
STAND_IN void hdMakeCurrentDevice(unsigned id) {
    check(is_known(id));
}
STAND_IN void hdBeginFrame(unsigned id) {
    check(is_known(id) && !in_frame);
    in_frame = true;
    current = id;
    ++device.frames;
}
STAND_IN void hdEndFrame(unsigned id) {
    check(id == current && in_frame);
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
            values[0] = device.lying.told(Field::position, values[0], values[0] + 30.0);
            return;
        case 0x2051:
            check(in_frame);
            values[1] = values[2] = 0.0;
            values[0] = 1e3 * device.lying.velocity();
            return;
        case 0x2052:  // a quarter turn about z, by columns; a leap is half a turn more
            check(in_frame);
            std::memset(values, 0, 16 * sizeof(double));
            values[1] = device.lying.told(Field::rotation, 1.0, -1.0);
            values[4] = -values[1];
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
    const bool leaps = what == 0x2000 && device.lying.swaps_buttons();
    const int buttons = leaps ? ~device.buttons.load() : device.buttons.load();
    *value = what == 0x2000 ? buttons : what == 0x2600 ? 1000 : 1;
}
STAND_IN const char* hdGetString(unsigned what) {
    check(what == 0x2501 || what == 0x2504);
    return what == 0x2501 ? "Touch" : "0815";
}
STAND_IN void hdSetDoublev(unsigned what, const double* values) {
    check((what == 0x2700 || (what == 0x2703 && device.has_six_motors)) && in_frame);
    if (what == 0x2700 && current == the_second) {
        tactus::stand_ins::set_force(device.second_force, device.most_step, values[0], values[1], values[2]);
        return;
    }
    if (what == 0x2700) {
        tactus::stand_ins::set_force(device.force, device.most_step, values[0], values[1], values[2]);
        return;
    }
    for (int i = 0; i < 3; ++i) {
        device.torque[i] = values[i];
    }
}
STAND_IN unsigned long hdScheduleAsynchronous(unsigned (*callback)(void*), void* data, unsigned short) {
    Task& free = tasks[0].callback == nullptr ? tasks[0] : tasks[1];
    check(free.callback == nullptr);
    free = {callback, data};
    return &free == &tasks[0] ? 1 : 2;
}
STAND_IN void hdUnschedule(unsigned long id) {
    check(id == 1 || id == 2);
    tasks[id - 1] = {};
}
STAND_IN void hdStartScheduler() {
    check(!device.ticks);
    device.ticks = true;
    pthread_create(&ticking, nullptr, tick, nullptr);
}
STAND_IN void hdStopScheduler() {
    if (device.ticks.exchange(false)) {
        ++device.stops;
        pthread_join(ticking, nullptr);
        for (int i = 0; i < 3; ++i) {
            device.force[i] = device.second_force[i] = 0.0;
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
