#include "platform/processor.hpp"

namespace tactus {

void relax_processor() {
    asm volatile("yield");
}

// Vectors and fused multiply-adds belong to every processor of the family.
const char* missing_in_processor() {
    return nullptr;
}

}  // namespace tactus
