// Memory that is read here and there over many megabytes: in pages of 2 MiB an address is found without
// walking through four tables, twice as many on a virtual machine.
#pragma once

#include <cstddef>
#include <span>

namespace tactus {

// Moves what is in those bytes to large pages, where the system has some to give, at once: takes as long as
// copying them, so never on the haptic thread. What was read there stays, addresses too. Where it can't be
// done nothing happens.
void move_to_large_pages(std::span<const std::byte> bytes);

}  // namespace tactus
