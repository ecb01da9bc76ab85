// What came of an experiment of teleoperation: the rows of its ticks, and the figures made of them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/teleop/errors.hpp"
#include "shared/teleop_case.hpp"

namespace tactus::shared {

// Of the link, since the start.
struct LinkCounts {
    std::uint64_t packets_forth = 0, packets_back = 0, bytes_forth = 0, bytes_back = 0;
    std::uint64_t corrections = 0;  // ticks in which the model has been corrected
    std::uint64_t replays = 0, states_beyond_history = 0, samples_held = 0, samples_filled = 0;
    double round_trip = 0.0;  // as it is now (unit: seconds)
};

// One tick of the operator and what answered it, by sample.
struct TeleopRow {
    Nanoseconds time = 0;
    Vec3 hand{0.0}, velocity{0.0};           // the operator's (units: meters, meters per second)
    Vec3 force{0.0}, direct{0.0}, far{0.0};  // on the hand, of direct touch, at the far hand (unit: newtons)
    Pose model, truth;                       // of the object that is followed
    double box_error = 0.0,
           turn_error = 0.0;                 // of the dynamic body that is off most (units: meters, radians)
    double hand_error = 0.0;                 // of the far hand, after this sample (unit: meters)
    Vec3 there_hand{0.0}, there_force{0.0};  // of the far hand in this tick (units: meters, newtons)
    bool far_known = false;                  // the far side has answered this sample
    bool touches = false;                    // the operator's pointer, the object
    bool direct_touches = false;             // anything
    std::vector<bool> direct_bodies;         // which of the scene's, in its order
    bool let_go = false;                     // the pointer has let go and says so
    double jnd_share = 0.0, offset = 0.0;    // see TeleopStatistics
    double force_step = 0.0;                 // see CorrectionCost
    LinkCounts link;
    double depth = 0.0;                         // of the far hand below the surface there, after this sample
    Vec3 local_hand{0.0}, local_velocity{0.0};  // an arm of its own that touches without a link
    Vec3 local_force{0.0};
    double local_depth = 0.0;
    FeltExcess excess_1ms, excess_100ms;  // filled in by evaluate()
};

using TeleopFigures = std::map<std::string, double>;

// How many ticks lie where, by figure: bin b holds 10^(b/100) … 10^((b+1)/100), `no_bin` what is less than
// all.
using TeleopBins = std::map<std::string, std::map<int, std::uint64_t>>;
inline constexpr int no_bin = -400, last_bin = 600;

// `bodies`: names of TeleopRow::direct_bodies.
TeleopFigures evaluate(std::vector<TeleopRow>& rows, const TeleopCase& experiment,
                       const std::vector<std::string>& bodies, TeleopBins* bins);

// Every number so that it is read back bit-exact. False where not all of them are in the file.
bool write_rows(const std::string& path, const std::vector<std::string>& bodies,
                const std::vector<TeleopRow>& rows);

}  // namespace tactus::shared
