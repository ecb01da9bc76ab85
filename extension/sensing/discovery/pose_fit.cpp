#include "sensing/discovery/pose_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

using Floats = float __attribute__((vector_size(32)));
using Bits = std::int32_t __attribute__((vector_size(32)));

constexpr std::size_t lanes = PointSet::lanes;

// A surface turned farther from the camera than this is not what a point lies on (cosine).
constexpr float least_facing = 0.05f;

// Fewer points than this do not hold six unknowns.
constexpr double least_weight = 12.0;

Floats all(float value) {
    return Floats{value, value, value, value, value, value, value, value};
}

Floats load(const float* from) {
    Floats value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

Floats where(Bits mask, Floats yes) {
    return reinterpret_cast<Floats>(reinterpret_cast<Bits>(yes) & mask);
}

Bits truncated(Floats value) {
    return __builtin_convertvector(value, Bits);
}

Floats clamped(Floats value, float high) {
    const Floats low = all(0.0f), most = all(high);
    value = value > low ? value : low;
    return value < most ? value : most;
}

struct Planes {
    Floats x, y, z, c;
};

Planes planes_at(const FieldPlane* planes, Bits index) {
    Planes found;
    for (std::size_t i = 0; i < lanes; ++i) {
        const FieldPlane& plane = planes[index[i]];
        found.x[i] = plane.x;
        found.y[i] = plane.y;
        found.z[i] = plane.z;
        found.c[i] = plane.c;
    }
    return found;
}

double sum_of(Floats value) {
    double sum = 0.0;
    for (std::size_t i = 0; i < lanes; ++i) {
        sum += value[i];
    }
    return sum;
}

// What is the same for all points.
struct Frame {
    float turn[3][3];  // camera's frame to the mesh's
    float shift[3];
    float eye[3];  // the camera in the mesh's frame
    float low[3];
    float per_cell;
    float most[3];  // last cell along each axis
    std::int32_t sizes[2];

    Frame(const MeshField& field, const Pose& mesh_in_camera) {
        const Mat3 back = glm::transpose(glm::mat3_cast(mesh_in_camera.rotation));
        const Vec3 origin = -(back * mesh_in_camera.position);
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                turn[i][j] = static_cast<float>(back[j][i]);
            }
            shift[i] = static_cast<float>(origin[i]);
            eye[i] = shift[i];
            low[i] = static_cast<float>(field.low()[i]);
            most[i] = static_cast<float>(field.sizes()[i]) - 0.5f;
        }
        per_cell = static_cast<float>(1.0 / field.cell());
        sizes[0] = field.sizes()[0];
        sizes[1] = field.sizes()[1];
    }
};

}  // namespace

void PointSet::clear() {
    for (std::vector<float>* const of : {&x_, &y_, &z_, &variance_, &counts_}) {
        of->clear();
    }
    count_ = 0;
    sum_ = Vec3(0.0);
}

void PointSet::add(const Vec3& point, double deviation) {
    if (!std::isfinite(glm::dot(point, point)) || !(deviation > 0.0)) {
        return;
    }
    x_.push_back(static_cast<float>(point.x));
    y_.push_back(static_cast<float>(point.y));
    z_.push_back(static_cast<float>(point.z));
    variance_.push_back(static_cast<float>(deviation * deviation));
    counts_.push_back(1.0f);
    ++count_;
    sum_ += point;
}

void PointSet::add(const DepthImage& image, double scale, const DepthAccuracy& accuracy,
                   std::span<const std::uint32_t> pixels, std::size_t stride) {
    const auto width = static_cast<std::uint32_t>(image.camera.width);
    for (std::size_t i = 0; i < pixels.size(); i += stride) {
        const std::uint32_t at = pixels[i];
        const double depth = scale * 1e-3 * image.depth_mm[at];
        if (depth > 0.0) {
            add(depth * ray_through(image.camera, at % width, at / width), depth_deviation(accuracy, depth));
        }
    }
}

void PointSet::close() {
    while (x_.size() % lanes != 0) {
        x_.push_back(x_.front());
        y_.push_back(y_.front());
        z_.push_back(z_.front());
        variance_.push_back(variance_.front());
        counts_.push_back(0.0f);
    }
}

FitSums fit_sums(const MeshField& field, const PointSet& points, const Pose& mesh_in_camera, double reach) {
    const Frame f(field, mesh_in_camera);
    const auto square_reach = static_cast<float>(reach * reach);
    Floats squares[21] = {};
    Floats sums[6] = {};
    Floats weights{}, cost{};
    for (std::size_t i = 0; i < points.padded_size(); i += lanes) {
        const Floats px = load(points.x() + i), py = load(points.y() + i), pz = load(points.z() + i);
        const Floats x = f.turn[0][0] * px + f.turn[0][1] * py + f.turn[0][2] * pz + f.shift[0];
        const Floats y = f.turn[1][0] * px + f.turn[1][1] * py + f.turn[1][2] * pz + f.shift[1];
        const Floats z = f.turn[2][0] * px + f.turn[2][1] * py + f.turn[2][2] * pz + f.shift[2];
        const Floats cx = (x - f.low[0]) * f.per_cell, cy = (y - f.low[1]) * f.per_cell,
                     cz = (z - f.low[2]) * f.per_cell;
        const Floats ix = clamped(cx, f.most[0]), iy = clamped(cy, f.most[1]), iz = clamped(cz, f.most[2]);
        const Bits covered = (ix == cx) & (iy == cy) & (iz == cz);
        const Planes n = planes_at(field.planes(),
                                   (truncated(iz) * f.sizes[1] + truncated(iy)) * f.sizes[0] + truncated(ix));
        const Floats r = n.x * x + n.y * y + n.z * z - n.c;
        const Floats rx = x - f.eye[0], ry = y - f.eye[1], rz = z - f.eye[2];
        const Floats along = n.x * rx + n.y * ry + n.z * rz;  // negative where the surface faces the camera
        const Floats far = rx * rx + ry * ry + rz * rz;
        const Floats square_facing = along * along / far;
        const Bits faces = (along < 0.0f) & (square_facing > least_facing * least_facing);
        const Bits counts = covered & (faces | (r > 0.0f));
        const Floats square = r * r;
        const Floats counted = load(points.counts() + i);
        const Floats capped = square < square_reach ? square : all(square_reach);
        cost += counted * (where(counts, capped) + where(~counts, all(square_reach)));
        const Floats left = 1.0f - capped / square_reach;
        const Floats tukey = where(counts, counted * left * left);
        const Floats w =
            tukey / (load(points.variance() + i) * (square_facing + static_cast<float>(sideways * sideways)));
        const Floats j[6] = {n.x, n.y, n.z, y * n.z - z * n.y, z * n.x - x * n.z, x * n.y - y * n.x};
        weights += tukey;
        std::size_t k = 0;
        for (std::size_t a = 0; a < 6; ++a) {
            const Floats wj = w * j[a];
            sums[a] += wj * r;
            for (std::size_t b = 0; b <= a; ++b) {
                squares[k++] += wj * j[b];
            }
        }
    }
    FitSums found;
    std::size_t k = 0;
    for (std::size_t a = 0; a < 6; ++a) {
        found.sums[a] = sum_of(sums[a]);
        for (std::size_t b = 0; b <= a; ++b) {
            found.squares[a][b] = sum_of(squares[k++]);
        }
    }
    found.weight = sum_of(weights);
    found.cost = sum_of(cost);
    return found;
}

Pose moved_in_own_frame(const Pose& pose, const Vec3& v, const Vec3& w) {
    const double angle = glm::length(w);
    const Quat turn = angle > 0.0 ? glm::angleAxis(angle, w / angle) : Quat(1.0, 0.0, 0.0, 0.0);
    return {pose.position + pose.rotation * v, glm::normalize(pose.rotation * turn)};
}

namespace {

bool factor_with_prior(const FitSums& sums, const FitPrior& prior, Matrix6& factor) {
    Matrix6 squares = sums.squares;
    for (std::size_t i = 0; i < 3; ++i) {
        squares[i][i] += 1.0 / (prior.place * prior.place);
        squares[i + 3][i + 3] += 1.0 / (prior.turn * prior.turn);
    }
    return cholesky(squares, factor);
}

}  // namespace

bool step_pose(PoseFit& fit, const FitPrior& prior) {
    Matrix6 factor{};
    if (!(fit.sums.weight >= least_weight) || !factor_with_prior(fit.sums, prior, factor)) {
        return false;
    }
    const Vector6 x = solve_cholesky(factor, fit.sums.sums);
    const Vec3 v(x[0], x[1], x[2]), w(x[3], x[4], x[5]);
    if (!std::isfinite(glm::dot(v, v) + glm::dot(w, w))) {
        return false;
    }
    fit.pose = moved_in_own_frame(fit.pose, v, w);
    fit.sound = true;
    return true;
}

PoseFit fit_pose(const MeshField& field, const PointSet& points, const Pose& start, double first_reach,
                 double last_reach, int steps, const FitPrior& prior) {
    PoseFit fit{start, {}, false};
    for (int step = 0; step < steps; ++step) {
        const double share = steps > 1 ? static_cast<double>(step) / (steps - 1) : 1.0;
        fit.sums = fit_sums(field, points, fit.pose, std::lerp(first_reach, last_reach, share));
        if (!step_pose(fit, prior)) {
            return {start, fit.sums, false};
        }
    }
    return fit;
}

Matrix6 fit_covariance(const PoseFit& fit, const FitPrior& prior) {
    Matrix6 factor{};
    Matrix6 own{};
    if (factor_with_prior(fit.sums, prior, factor)) {
        own = inverse_of_cholesky(factor);
    } else {
        for (std::size_t i = 0; i < 3; ++i) {
            own[i][i] = prior.place * prior.place;
            own[i + 3][i + 3] = prior.turn * prior.turn;
        }
    }
    return turned_covariance(own, fit.pose.rotation);
}

Matrix6 turned_covariance(const Matrix6& covariance, const Quat& by) {
    const Mat3 turn = glm::mat3_cast(by);
    Matrix6 turned{};
    for (std::size_t a = 0; a < 6; ++a) {
        for (std::size_t b = 0; b < 6; ++b) {
            const std::size_t a0 = a / 3 * 3, b0 = b / 3 * 3;
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) {
                    turned[a][b] += turn[static_cast<int>(i)][static_cast<int>(a - a0)] *
                                    covariance[a0 + i][b0 + j] *
                                    turn[static_cast<int>(j)][static_cast<int>(b - b0)];
                }
            }
        }
    }
    return turned;
}

}  // namespace tactus
