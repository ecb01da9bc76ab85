// What the bench of sensing measures, one function for each part of it.
#pragma once

#include <memory>
#include <vector>

#include "sensing/discovery/discovery.hpp"
#include "shared/bench_kit.hpp"
#include "shared/depth_scenes.hpp"

namespace tactus::shared {

struct SensingCase {
    std::vector<LibraryMesh> library;
    std::shared_ptr<const std::vector<LearntMesh>> meshes;
    int scenes = 200;
    std::uint64_t first = 5000;  // seed of the first scene
    bool talks = false;          // of what goes wrong
};

// For what a discovery tells of its own time.
inline double seconds_now() {
    static const SpanClock clock;
    return 1e-9 * clock.nanoseconds(0, clock.now());
}

// Camera and depth error of a scene; where the support's place is known, as after a calibration by it.
DiscoverySettings bench_settings(bool support_known);
DepthNoise bench_noise(std::uint64_t seed);

// Objects that rest or are held still, seen for the first time; keys begin with `prefix`.
void report_still(Report& report, const SensingCase& bench, const std::string& prefix, double distance,
                  bool support_known);
// Objects that move for 90 images, and objects that are suddenly 20 mm and 15 degrees elsewhere.
void report_moving(Report& report, const SensingCase& bench);
void report_recovery(Report& report, const SensingCase& bench);
// A body at rest that is seen with 1 mm of chance.
void report_rest(Report& report, const SensingCase& bench);
// What two seconds of touch teach.
void report_parameters(Report& report, const SensingCase& bench);

}  // namespace tactus::shared
