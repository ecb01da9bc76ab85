// Where a mesh has to be for the points of a depth image to lie on it.
//
// Robust point-to-plane least squares. A point p of the camera's frame is q = inverse(T) p in the mesh's
// frame, where the field tells the plane n . q = c next to it. A small motion of the mesh in its own frame,
// v and w about its origin, takes q to q - v - w x q:
//
//     r = n . q - c        r(v, w) = r - n . v - (q x n) . w
//
// A depth is off by chance along the ray, so r is off by |n . ray| times that: this is its weight. It is
// multiplied by Tukey's (1 - (r / reach)^2)^2, which ends where a point is no part of the mesh. A point
// inside the mesh that is nearest to a surface which faces away from the camera does not count: the camera
// cannot have seen it through the mesh.
#pragma once

#include <span>
#include <vector>

#include "core/math/small_matrix.hpp"
#include "sensing/discovery/depth_accuracy.hpp"
#include "sensing/discovery/mesh_field.hpp"
#include "sensing/image/depth_image.hpp"

namespace tactus {

// Of a depth's deviation so much stays where a surface is seen from the side (as a cosine): a pixel is not
// sure to a part of its width.
inline constexpr double sideways = 0.25;

// Points of the camera's frame, as structure of arrays; the rest of the last eight has weight zero.
class PointSet {
public:
    static constexpr std::size_t lanes = 8;

    void clear();
    // A point that is not finite is left out.
    void add(const Vec3& point, double deviation);
    // Of an image: every `stride`-th of the pixels.
    void add(const DepthImage& image, double scale, const DepthAccuracy& accuracy,
             std::span<const std::uint32_t> pixels, std::size_t stride = 1);
    // After the last `add`.
    void close();

    std::size_t size() const { return count_; }
    Vec3 mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : Vec3(0.0); }
    Vec3 point(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }
    const float* x() const { return x_.data(); }
    const float* y() const { return y_.data(); }
    const float* z() const { return z_.data(); }
    const float* variance() const { return variance_.data(); }
    const float* counts() const { return counts_.data(); }
    std::size_t padded_size() const { return x_.size(); }

private:
    std::vector<float> x_, y_, z_;
    std::vector<float> variance_;  // along the ray (unit: square meters)
    std::vector<float> counts_;    // 1, or 0 for what fills up the last lanes
    std::size_t count_ = 0;
    Vec3 sum_{0.0};
};

// The normal equations at a pose: squares x = sums, for x = (v, w) in the mesh's frame.
struct FitSums {
    Matrix6 squares{};  // only the lower triangle
    Vector6 sums{};
    double weight = 0.0;  // sum of Tukey's weights: how many points count
    double cost = 0.0;    // sum of min(r^2, reach^2) over all points (unit: square meters)
};

FitSums fit_sums(const MeshField& field, const PointSet& points, const Pose& mesh_in_camera, double reach);

struct PoseFit {
    Pose pose;           // of the mesh in the camera's frame
    FitSums sums;        // at the last step's start
    bool sound = false;  // false: too few points were near, the pose is where it was
};

// How unsure the mesh's place already is: what points do not tell stays near where it was.
struct FitPrior {
    double place = 0.02;  // standard deviation (unit: meters), > 0
    double turn = 0.3;    // (unit: radians), > 0
};

// Steps with reaches that shrink evenly from `first_reach` to `last_reach` (unit: meters).
PoseFit fit_pose(const MeshField& field, const PointSet& points, const Pose& start, double first_reach,
                 double last_reach, int steps, const FitPrior& prior = {});

// One step from `fit.pose` by `fit.sums`; false, and nothing has changed, where they do not hold it.
bool step_pose(PoseFit& fit, const FitPrior& prior = {});

// Covariance of v and w about the mesh's origin, both in the camera's axes (unit: meters, radians).
Matrix6 fit_covariance(const PoseFit& fit, const FitPrior& prior);

// The same covariance in axes turned by `turn`.
Matrix6 turned_covariance(const Matrix6& covariance, const Quat& turn);

// The mesh moved by v and turned by w, both in its own frame.
Pose moved_in_own_frame(const Pose& pose, const Vec3& v, const Vec3& w);

}  // namespace tactus
