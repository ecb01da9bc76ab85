// What differs between processors and not between systems.
#pragma once

namespace tactus {

// Tells the processor that a loop only waits, which frees its sibling and saves power.
void relax_processor();

// What this processor would need to run the rest of the program, in words; null where it has it. The file
// behind it is compiled for any processor of its family.
const char* missing_in_processor();

}  // namespace tactus
