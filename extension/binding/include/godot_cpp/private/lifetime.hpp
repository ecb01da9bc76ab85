#pragma once

namespace godot::internal {

// When the library is closed: what would otherwise outlive it.
void release_singletons();
void release_classes(int level);

}  // namespace godot::internal
