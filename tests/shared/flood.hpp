// A flood of datagrams at a side that talks over a real socket of this machine.
#pragma once

#include <string>

namespace tactus::shared {

struct FloodSettings {
    double packets_per_s = 100'000.0;
    double seconds = 6.0;  // of each of the rounds, quiet and flooded in turn
    int rounds = 3;
};

struct FloodFigures {
    std::string error;
    double packets_per_s = 0.0;       // that were thrown
    double reached = 0.0;             // share of them that the network thread had to look at
    bool from_peers_address = false;  // false: the system does not permit it; only a stranger's own was used
    double tick_over_quiet = 0.0;     // median of the tick's processor time, flooded over quiet
    double tick_p99_over_quiet = 0.0;
    double network_thread_percent = 0.0;  // of one processor, flooded
    double quiet_network_thread_percent = 0.0;
    double honest_lost_percent = 0.0;  // of the far side's own packets
};

FloodFigures run_flood(const FloodSettings& settings);

}  // namespace tactus::shared
