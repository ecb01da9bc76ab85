// The devices that libraries and a service stand in for, as tests and benches watch them. Linux only.
#pragma once

#include <memory>

#include "devices/haply/inverse3_driver.hpp"
#include "devices/runtime_library.hpp"
#include "devices/vendors/force_dimension_driver.hpp"
#include "devices/vendors/openhaptics_driver.hpp"
#include "shared/haply_service.hpp"
#include "shared/lying_figures.hpp"
#include "stand_ins/stand_ins.hpp"

namespace tactus::shared {

// Null where the library is not beside the program.
template <typename StandIn>
StandIn* stand_in(std::initializer_list<const char*> names, const char* function) {
    static RuntimeLibrary library;
    StandIn* (*get)() = nullptr;
    return library.load(names, function) && library.find({{function, get}}) ? get() : nullptr;
}

template <typename StandIn>
LyingDevice lying_device(StandIn& device, std::function<std::unique_ptr<Driver>()> driver,
                         std::function<Vec3()> force) {
    return {{std::move(driver), std::move(force), [&device] { return device.most_step.exchange(0.0); }},
            [&device](stand_ins::Field field, stand_ins::Lie lie) { device.lying.begin(field, lie); },
            [&device] { return Nanoseconds{device.lying.told_at}; }};
}

inline LyingDevice force_dimension_device() {
    static auto& dhd = *stand_in<stand_ins::ForceDimension>({"libdhd.so"}, "stand_in_force_dimension");
    return lying_device(
        dhd, [] { return std::make_unique<ForceDimensionDriver>(""); },
        [] { return Vec3(dhd.force[1].load(), dhd.force[2].load(), dhd.force[0].load()); });
}

inline LyingDevice openhaptics_device() {
    static auto& hd = *stand_in<stand_ins::OpenHaptics>({"libHD.so"}, "stand_in_openhaptics");
    return lying_device(
        hd, [] { return std::make_unique<OpenHapticsDriver>(""); },
        [] { return Vec3(hd.force[0].load(), hd.force[1].load(), hd.force[2].load()); });
}

inline LyingDevice inverse3_device(HaplyService& service) {
    return {{[&service] { return std::make_unique<Inverse3Driver>("", service.port()); },
             [&service] { return service.newest_force(); }, [&service] { return service.take_most_step(); }},
            [&service](stand_ins::Field field, stand_ins::Lie lie) { service.lie(field, lie); },
            [&service] { return service.told_at(); }};
}

}  // namespace tactus::shared
