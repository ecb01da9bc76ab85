// A span of time as libraries in C take it.
#pragma once

#include <sys/time.h>

#include "core/math/types.hpp"

namespace tactus {

// Cut to whole microseconds; none below 0.
inline timeval time_value(Nanoseconds span) {
    const Nanoseconds counted = span > 0 ? span : 0;
    timeval value{};
    value.tv_sec = static_cast<decltype(value.tv_sec)>(counted / nanoseconds_per_second);
    value.tv_usec = static_cast<decltype(value.tv_usec)>(counted % nanoseconds_per_second / 1000);
    return value;
}

}  // namespace tactus
