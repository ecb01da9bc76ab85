#pragma once

namespace godot::internal {

// T, but named only when a template is used: lets a header speak of a class that is complete by then.
template <class T, class...>
struct Later {
    using type = T;
};

}  // namespace godot::internal
