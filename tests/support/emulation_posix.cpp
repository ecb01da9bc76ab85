#include <cstdlib>

#include "support/emulation.hpp"

namespace tactus::testing {

bool under_wine() {
    return false;
}

// It shows itself nowhere; who starts it says so (tools/testing/cpp_suite.py).
bool under_qemu() {
    return std::getenv("TACTUS_EMULATOR") != nullptr;
}

}  // namespace tactus::testing
