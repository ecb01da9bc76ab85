// An Admission as the system can carry it out.
#pragma once

#include "network/admission.hpp"
#include "platform/packet_filter.hpp"

namespace tactus {

// From now on the system itself drops what `admission` does not admit, before a thread is woken and before
// anything is copied. False where it cannot: then everything comes.
bool attach_filter(SocketHandle socket, const Admission& admission);

}  // namespace tactus
