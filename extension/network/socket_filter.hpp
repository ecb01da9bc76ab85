// An Admission as the system can carry it out.
#pragma once

#include <cstdint>

#include "network/admission.hpp"

namespace tactus {

// From now on the system itself drops what `admission` does not admit, before a thread is woken and before
// anything is copied. False where it cannot: then everything comes.
bool attach_filter(int file, const Admission& admission);

// Datagrams that were dropped there so far, for want of room included; 0 where the system does not say.
std::uint64_t dropped_by_system(int file);

}  // namespace tactus
