// Programs for another system or processor run here in an emulator, which cannot do all that they ask for.
#pragma once

namespace tactus::testing {

// Whether it is Wine that runs this program for Windows, or QEMU that runs this one for another processor.
// What they cannot do is skipped, and said.
bool under_wine();
bool under_qemu();

}  // namespace tactus::testing
