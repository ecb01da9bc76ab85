#include "platform/large_pages.hpp"

namespace tactus {

void move_to_large_pages(std::span<const std::byte>) {}

}  // namespace tactus
