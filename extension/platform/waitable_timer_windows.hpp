// Windows's timers, for the files of this folder that wait with one.
#pragma once

#include <windows.h>

#include "core/math/types.hpp"

namespace tactus::windows {

// One of high resolution (Windows 10 from 1803 on), or an ordinary one, for which the system is asked to look
// at its timers every millisecond. Null: neither.
HANDLE open_timer();

// Goes off after `span` (> 0), once.
void arm(HANDLE timer, Nanoseconds span);

}  // namespace tactus::windows
