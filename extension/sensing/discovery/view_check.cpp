#include "sensing/discovery/view_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus {

namespace {

// Cost of a pixel that does not fit at all; of one beside an outline, which may belong to either side of it;
// of one without depth.
constexpr double misfit = 6.0;
constexpr double at_rim = 2.0;
constexpr double without_depth = 1.0;

// Depths within so many standard deviations agree.
constexpr double agreeing = 4.0;

// Neighbours whose depths differ by less may be one surface (unit: millimeters).
constexpr int same_surface = 12;

PixelBox around_both(const PixelBox& a, const PixelBox& b) {
    if (a.is_empty() || b.is_empty()) {
        return a.is_empty() ? b : a;
    }
    return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right),
            std::max(a.bottom, b.bottom)};
}

}  // namespace

double ViewCheck::quality() const {
    const int wanted = pixels + seen_through;
    const int of_mesh = drawn - hidden;
    if (wanted == 0 || of_mesh <= 0) {
        return 0.0;
    }
    return std::min(static_cast<double>(explained) / wanted, static_cast<double>(confirmed) / of_mesh);
}

void ViewChecker::clear(const DepthCamera& camera) {
    if (!(drawing_.camera == camera)) {
        drawing_.clear(camera);
        return;
    }
    for (int v = drawn_.top; v < drawn_.bottom; ++v) {
        const auto row = static_cast<std::ptrdiff_t>(v) * camera.width;
        std::fill(drawing_.depth.begin() + row + drawn_.left, drawing_.depth.begin() + row + drawn_.right,
                  std::numeric_limits<float>::infinity());
        std::fill(drawing_.seen.begin() + row + drawn_.left, drawing_.seen.begin() + row + drawn_.right,
                  DepthBuffer::no_mesh);
    }
}

bool ViewChecker::is_drawn(int u, int v) const {
    const int width = drawing_.camera.width, height = drawing_.camera.height;
    return u >= 0 && v >= 0 && u < width && v < height &&
           drawing_.seen[static_cast<std::size_t>(v * width + u)] == 0;
}

// Beside an outline of the drawing, on either side.
bool ViewChecker::is_rim(int u, int v) const {
    const bool own = is_drawn(u, v);
    return is_drawn(u - 1, v) != own || is_drawn(u + 1, v) != own || is_drawn(u, v - 1) != own ||
           is_drawn(u, v + 1) != own;
}

// A mesh that is laid onto the midst of something larger agrees with it everywhere, and ends nowhere.
void ViewChecker::look_beyond(const SeenScene& scene, int u, int v, ViewCheck& found) const {
    const DepthImage& image = *scene.image;
    const int here = image.depth_mm[static_cast<std::size_t>(v * image.camera.width + u)];
    for (const auto& [du, dv] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const int x = u + du, y = v + dv;
        if (is_drawn(x, y) || x < 0 || y < 0 || x >= image.camera.width || y >= image.camera.height) {
            continue;
        }
        const auto at = static_cast<std::size_t>(y * image.camera.width + x);
        ++found.outline;
        found.goes_on +=
            scene.segmentation->stands_out[at] != 0 && std::abs(image.depth_mm[at] - here) < same_surface;
    }
}

ViewCheck ViewChecker::check(const SeenScene& scene, const LearntMesh& mesh, const Pose& mesh_in_camera,
                             std::uint16_t piece) {
    const DepthImage& image = *scene.image;
    clear(image.camera);
    drawn_ = renderer_.draw({&mesh.mesh, mesh_in_camera}, 0, drawing_);
    const PixelBox box =
        piece > 0 ? around_both(drawn_, scene.segmentation->clusters[piece - 1u].box) : drawn_;
    const double deviation = depth_deviation(scene.accuracy, -mesh_in_camera.position.z);
    ViewCheck found;
    double sum = 0.0, of_mesh = 0.0;
    for (int v = box.top; v < box.bottom; ++v) {
        for (int u = box.left; u < box.right; ++u) {
            const auto at = static_cast<std::size_t>(v * image.camera.width + u);
            const bool in_piece = piece > 0 && scene.segmentation->piece[at] == piece;
            const bool is_drawn = drawing_.seen[at] == 0;
            found.pixels += in_piece;
            found.drawn += is_drawn;
            if (!is_drawn) {
                found.cost += in_piece ? (is_rim(u, v) ? at_rim : misfit) : 0.0;
                continue;
            }
            if (image.depth_mm[at] == 0) {
                found.cost += without_depth;
                ++found.hidden;
                continue;
            }
            const double apart = scene.scale * 1e-3 * image.depth_mm[at] - drawing_.depth[at];
            const double off = apart / deviation;
            const bool agrees = std::abs(off) < agreeing;
            found.explained += in_piece && agrees;
            found.confirmed += agrees;
            sum += agrees ? apart : 0.0;
            if (agrees) {
                look_beyond(scene, u, v, found);
            }
            if (in_piece) {
                found.cost += std::min(0.5 * off * off, is_rim(u, v) ? at_rim : misfit);
            }
            if (agrees) {
                of_mesh += 0.5 * off * off;
            } else if (off < 0.0) {
                ++found.hidden;
            } else {
                const bool rim = is_rim(u, v);
                found.cost += in_piece ? 0.0 : (rim ? at_rim : misfit);
                of_mesh += rim ? 0.0 : misfit;
                found.seen_through += !rim;
                found.hidden += rim;
            }
        }
    }
    found.misfit = of_mesh / std::max(1, found.drawn - found.hidden);
    found.apart = found.confirmed > 0 ? sum / found.confirmed : 0.0;
    return found;
}

namespace {

// Where an outline is farther off than this, it is another one.
constexpr int outline_reach = 5;  // (unit: pixels)

// An outline is sure to a part of a pixel: two even chances of one pixel, and jitter.
constexpr double outline_deviation = 0.7;  // (unit: pixels)

// Beyond an outline the next surface is farther away by at least this (unit: meters).
constexpr double outline_jump = 0.02;

// Of the piece, along a row or a column of the image.
class PieceEdge {
public:
    PieceEdge(const SeenScene& scene, std::uint16_t piece) : scene_(scene), piece_(piece) {}

    // How many steps (du, dv) beyond the pixel the piece ends, negative where it ends before; false where it
    // does not end nearby, or not before something farther away. Beside a strip without depth it does not
    // count: there the projector's light ends, maybe in the midst of a face.
    bool ends_at(int u, int v, int du, int dv, int& steps) const {
        steps = 0;
        if (is_piece(u, v)) {
            while (steps <= outline_reach && is_piece(u + (steps + 1) * du, v + (steps + 1) * dv)) {
                ++steps;
            }
        } else {
            --steps;
            while (-steps <= outline_reach && !is_piece(u + steps * du, v + steps * dv)) {
                --steps;
            }
        }
        if (std::abs(steps) > outline_reach) {
            return false;
        }
        const int beyond = told(u + (steps + 1) * du, v + (steps + 1) * dv);
        const int last = told(u + steps * du, v + steps * dv);
        return 1e-3 * scene_.scale * (beyond - last) > outline_jump;
    }

private:
    bool is_inside(int u, int v) const {
        return u >= 0 && v >= 0 && u < scene_.image->camera.width && v < scene_.image->camera.height;
    }
    std::size_t at(int u, int v) const {
        return static_cast<std::size_t>(v * scene_.image->camera.width + u);
    }
    bool is_piece(int u, int v) const {
        return is_inside(u, v) && scene_.segmentation->piece[at(u, v)] == piece_;
    }
    // Beyond the border of the image nothing is known: as if it were near.
    int told(int u, int v) const { return is_inside(u, v) ? scene_.image->depth_mm[at(u, v)] : 1; }

    const SeenScene& scene_;
    std::uint16_t piece_;
};

}  // namespace

// A pixel's ray r meets the face at z r. When the mesh moves by dp = v + w x q there, the face is met at
// z + n . dp / (n . r): one row (n, q x n) / (n . r) for each told depth, with the weight that fit_sums()
// gives, too: what is seen from the side is sure to a part of a pixel only.
void ViewChecker::add_depths(const SeenScene& scene, const LearntMesh& mesh, const Pose& mesh_in_camera,
                             std::uint16_t piece, double reach_deviations, FitSums& sums) const {
    const DepthImage& image = *scene.image;
    const Mat3 back = glm::transpose(glm::mat3_cast(mesh_in_camera.rotation));
    for (int v = drawn_.top; v < drawn_.bottom; ++v) {
        for (int u = drawn_.left; u < drawn_.right; ++u) {
            const auto at = static_cast<std::size_t>(v * image.camera.width + u);
            const bool counts = piece == 0 || scene.segmentation->piece[at] == piece;
            if (drawing_.seen[at] != 0 || image.depth_mm[at] == 0 || !counts) {
                continue;
            }
            const double depth = drawing_.depth[at];
            const double deviation = depth_deviation(scene.accuracy, depth);
            const double off = scene.scale * 1e-3 * image.depth_mm[at] - depth;
            const double share = off / (reach_deviations * deviation);
            if (!(std::abs(share) < 1.0)) {
                continue;
            }
            const Vec3 ray = back * ray_through(image.camera, u, v);
            const Vec3 q = depth * ray - back * mesh_in_camera.position;
            const Vec3& n = mesh.normals[drawing_.face[at]];
            const double along = glm::dot(n, ray);
            const double facing = along * along / glm::dot(ray, ray);
            if (facing < 1e-4) {
                continue;
            }
            const double tukey = (1.0 - share * share) * (1.0 - share * share);
            const double weight = tukey / (deviation * deviation * (facing + sideways * sideways));
            const Vec3 turning = glm::cross(q, n);
            const Vector6 row{n.x, n.y, n.z, turning.x, turning.y, turning.z};
            sums.weight += tukey;
            for (std::size_t a = 0; a < 6; ++a) {
                sums.sums[a] += weight * row[a] * off * along;
                for (std::size_t b = 0; b <= a; ++b) {
                    sums.squares[a][b] += weight * row[a] * row[b];
                }
            }
        }
    }
}

// The point p of the outline is seen at u = cx + fx x / d, v = cy - fy y / d, with d = -z. Moved by dp, it is
// seen du = fx (dx + (x / d) dz) / d and dv = -fy (dy + (y / d) dz) / d away. Along the outline's normal m in
// the image that is to be the distance to the piece's outline: one row of the normal equations, with
// dp = R (v + w x q) for q in the mesh's frame.
void ViewChecker::add_outline(const SeenScene& scene, const Pose& mesh_in_camera, std::uint16_t piece,
                              FitSums& sums) const {
    const DepthCamera& camera = scene.image->camera;
    const PieceEdge edge(scene, piece);
    const Mat3 back = glm::transpose(glm::mat3_cast(mesh_in_camera.rotation));
    for (int v = drawn_.top; v < drawn_.bottom; ++v) {
        for (int u = drawn_.left; u < drawn_.right; ++u) {
            if (!is_drawn(u, v) || !is_rim(u, v)) {
                continue;
            }
            const auto weigh = [&](int du, int dv) { return is_drawn(u + du, v + dv) ? 0 : 1; };
            // Out of the drawing, by Sobel's differences.
            const int out_u = weigh(1, -1) + 2 * weigh(1, 0) + weigh(1, 1) - weigh(-1, -1) -
                              2 * weigh(-1, 0) - weigh(-1, 1);
            const int out_v = weigh(-1, 1) + 2 * weigh(0, 1) + weigh(1, 1) - weigh(-1, -1) -
                              2 * weigh(0, -1) - weigh(1, -1);
            const bool by_row = std::abs(out_u) >= std::abs(out_v);
            const int du = by_row ? (out_u > 0) - (out_u < 0) : 0;
            const int dv = by_row ? 0 : (out_v > 0) - (out_v < 0);
            int steps = 0;
            if ((du == 0 && dv == 0) || is_drawn(u + du, v + dv) || !edge.ends_at(u, v, du, dv, steps)) {
                continue;
            }
            const double length = std::hypot(out_u, out_v);
            const double mu = out_u / length, mv = out_v / length;
            const double off = steps * (by_row ? std::abs(mu) : std::abs(mv));
            const double depth = drawing_.depth[static_cast<std::size_t>(v * camera.width + u)];
            const Vec3 point = depth * ray_through(camera, u, v);
            const double fu = mu * camera.focal_x / depth, fv = -mv * camera.focal_y / depth;
            const Vec3 to_point(fu, fv, (fu * point.x + fv * point.y) / depth);
            const Vec3 n = back * to_point;
            const Vec3 q = back * (point - mesh_in_camera.position);
            const Vec3 turning = glm::cross(q, n);
            const Vector6 row{n.x, n.y, n.z, turning.x, turning.y, turning.z};
            const double share = off / (outline_reach + 1);
            const double weight = (1.0 - share * share) / (outline_deviation * outline_deviation);
            for (std::size_t a = 0; a < 6; ++a) {
                sums.sums[a] += weight * row[a] * off;
                for (std::size_t b = 0; b <= a; ++b) {
                    sums.squares[a][b] += weight * row[a] * row[b];
                }
            }
        }
    }
}

}  // namespace tactus
