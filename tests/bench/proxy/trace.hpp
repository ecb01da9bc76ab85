// The replay of any path over any mesh, tick by tick, so that another engine can be held beside it.
#pragma once

#include <string>

namespace tactus::bench {

struct TraceSettings {
    std::string mesh;  // .obj
    std::string path;  // .csv: x,y,z in the first three columns, a line a tick; a first line may name them
    std::string output;
    double radius = 0.0;
    double static_friction = 0.0, dynamic_friction = 0.0;
};

// 0, or 2 with a message on stderr where an input cannot be used.
int write_trace(const TraceSettings& settings);

}  // namespace tactus::bench
