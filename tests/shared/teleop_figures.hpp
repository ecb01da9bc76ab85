// What came of an experiment of teleoperation: the rows of its ticks, and the figures made of them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/teleop/errors.hpp"
#include "shared/teleop_case.hpp"

namespace tactus::shared {

// One tick of the operator and what answered it, by sample.
struct TeleopRow {
    Nanoseconds time = 0;
    Vec3 hand{0.0}, velocity{0.0};           // the operator's (units: meters, meters per second)
    Vec3 force{0.0}, direct{0.0}, far{0.0};  // on the hand, of direct touch, at the far hand (unit: newtons)
    Pose model, truth;                       // of the object that is followed
    double box_error = 0.0,
           turn_error = 0.0;               // of the dynamic body that is off most (units: meters, radians)
    double hand_error = 0.0;               // of the far hand, after this sample (unit: meters)
    bool far_known = false;                // the far side has answered this sample
    bool touches = false;                  // the operator's pointer, the object
    bool direct_touches = false;           // anything
    bool let_go = false;                   // the pointer has let go and says so
    bool told = false;                     // the model has been corrected, in this tick or before
    double jnd_share = 0.0, offset = 0.0;  // see TeleopStatistics
    double depth = 0.0;                    // of the far hand below the surface there, after this sample
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

// `ports`: the hand's and the far side's, of the whole run.
struct TeleopPorts {
    PortEnergy hand, far;
    // The most that the hand, and that both together, have been given on balance at any moment since the
    // start (unit: joules).
    double hand_most = 0.0, link_created = 0.0;
};

TeleopFigures evaluate(std::vector<TeleopRow>& rows, const TeleopCase& experiment, const TeleopPorts& ports,
                       TeleopBins* bins);

// False where not all of them are in the file.
bool write_rows(const std::string& path, const std::vector<TeleopRow>& rows);

}  // namespace tactus::shared
