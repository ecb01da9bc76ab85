// Programs for another system run here in an emulator of it, which cannot do all that the system does.
#pragma once

namespace tactus::testing {

// Whether it is Wine that runs this program for Windows. What it cannot do is skipped, and said.
bool under_wine();

}  // namespace tactus::testing
