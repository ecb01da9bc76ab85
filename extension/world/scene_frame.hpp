// A frame as an engine's scene has it: with scale, mirroring and shear, which touch and physics do not know.
#pragma once

#include <string>

#include "core/math/pose.hpp"

namespace tactus {

struct SceneFrame {
    Mat3 axes{1.0};
    Vec3 origin{0.0};  // (unit: meters)
    bool operator==(const SceneFrame&) const = default;
};

// The placement of `inner` in the parent of `outer`.
inline SceneFrame compose(const SceneFrame& outer, const SceneFrame& inner) {
    return {outer.axes * inner.axes, outer.axes * inner.origin + outer.origin};
}

// Where it stands and how it is turned; what it scales, mirrors or shears is left out.
Pose pose_of(const SceneFrame& frame);

// What pose_of() leaves out, as seen from the pose's own frame. Exactly 1 where there is none but for what
// single precision rounds.
Mat3 scaling_of(const SceneFrame& frame);

// But for what single precision rounds: the scaling of a frame that turns is another one each time.
bool same_scaling(const Mat3& a, const Mat3& b);

// Whether a frame that was made with `made` and had `before` when it was seen last has only drifted to `now`.
// A frame that turns by small rotations one after another rounds each of them, and its scaling wanders off
// without bound: a step that rounding explains is no scaling, up to a thousandth of what it was made with.
bool has_only_drifted(const Mat3& made, const Mat3& before, const Mat3& now);

// By how much lengths are larger in it, on the average of its axes; whether that is the same along each, but
// for a thousandth.
double mean_scale(const SceneFrame& frame);
bool is_even(const SceneFrame& frame);

// What keeps something from being touched there, in the world, and what to do; empty where nothing does.
std::string problem_of_place(const SceneFrame& frame);

// What keeps a shape from having this frame in its body; empty where nothing does.
std::string problem_of_shape_frame(const SceneFrame& frame);

}  // namespace tactus
