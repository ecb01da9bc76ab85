// Work that may be spread over threads: whoever prepares meshes hands in how.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace tactus {

// Runs task(0) … task(count - 1), in any order, on any threads, and returns when all are done.
using ParallelRunner = std::function<void(std::size_t count, const std::function<void(std::size_t)>& task)>;

inline void run_serially(std::size_t count, const std::function<void(std::size_t)>& task) {
    for (std::size_t i = 0; i < count; ++i) {
        task(i);
    }
}

// Runs part(index, begin, end) over 0 … count in parts of `size`: the borders do not depend on the runner.
template <class Part>
void run_in_parts(const ParallelRunner& run, std::size_t count, std::size_t size, Part&& part) {
    run((count + size - 1) / size,
        [&](std::size_t i) { part(i, i * size, std::min(count, (i + 1) * size)); });
}

}  // namespace tactus
