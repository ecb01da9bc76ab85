// Places that the far side sees by a camera, and says how surely.
//
// What a model is off by, d, is seen with a covariance R. Between two states the model goes its own way, of
// which a mean square Q stays open. So what it is off by has an estimate m with a covariance C:
//
//     C += Q        K = C inverse(C + R)        m += K (d - m)        C -= K C
//
// The model is put right by m where chance does not explain m, or the newest d alone; else it stays as it is,
// to the bit: where two faces meet, physics knows better than a camera. States in succession err alike, so
// that a mean of many is not as sure as C says: a share of R belongs to all of them.
#pragma once

#include "core/math/pose.hpp"
#include "core/math/types.hpp"

namespace tactus {

// What is seen to move goes on so until it is seen again: for four images of a camera's thirty a second, and
// no longer (unit: seconds).
inline constexpr double longest_guess = 0.15;

// How sure a place is: covariances about it, in the axes of the frame around.
struct PoseDoubt {
    Mat3 place{0.0};  // (unit: square meters)
    Mat3 turn{0.0};   // of the turn as a vector (unit: square radians)
    friend bool operator==(const PoseDoubt&, const PoseDoubt&) = default;
};

// Whether they can be covariances of anything, and of something that a camera sees.
bool is_sound(const PoseDoubt& doubt);

// The same in axes turned by `turn`.
PoseDoubt turned(const PoseDoubt& doubt, const Quat& turn);

// Standard deviations along the axes that are known least well, of the three that stand on the diagonal
// (unit: meters, radians).
double place_deviation(const PoseDoubt& doubt);
double turn_deviation(const PoseDoubt& doubt);

struct SeenPoseSettings {
    double contradicted = 6.0;  // deviations that chance does not explain, > 0
    double alike = 0.1;         // share of R that states in succession have in common, 0 … 1
};

// What the model is off by, along three axes.
class ModelOff {
public:
    // `off`: what is seen, off the model; `open`: root mean square of what the way since the last one leaves
    // open. By how much the model is to be put right.
    Vec3 see(const SeenPoseSettings& settings, const Vec3& off, const Mat3& chance, double open);

private:
    bool known_ = false;
    Vec3 mean_{0.0};
    Mat3 covariance_{0.0};
};

class SeenPose {
public:
    // Where the model is to be, which has it at `model` at the same sample. `open_way`, `open_turn`: see
    // PoseStep.
    Pose believe(const SeenPoseSettings& settings, const Pose& seen, const PoseDoubt& doubt,
                 const Pose& model, double open_way, double open_turn);

    void forget() { *this = {}; }

private:
    ModelOff place_, turn_;
};

}  // namespace tactus
