#include "support/emulation.hpp"

namespace tactus::testing {

bool under_wine() {
    return false;
}

}  // namespace tactus::testing
