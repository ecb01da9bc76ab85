#include "sensing/discovery/recognition.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// The turn that takes -z to where the piece is, the shortest way.
Quat look_along(const Vec3& towards) {
    const Vec3 direction = glm::normalize(towards);
    const Vec3 ahead(0.0, 0.0, -1.0);
    const Vec3 across = glm::cross(ahead, direction);
    return glm::normalize(Quat(1.0 + glm::dot(ahead, direction), across.x, across.y, across.z));
}

// Those of a piece's pixels whose four neighbours belong to it, too: no pixel beside an outline tells depth
// well.
void inner_pixels(const Segmentation& segmentation, const DepthCamera& camera, std::uint16_t piece,
                  std::vector<std::uint32_t>& inner) {
    inner.clear();
    const auto width = static_cast<std::uint32_t>(camera.width);
    const auto& of = segmentation.piece;
    for (const std::uint32_t at : segmentation.clusters[piece - 1u].pixels) {
        const std::uint32_t u = at % width;
        const bool inside = u > 0 && u + 1 < width && at >= width && at + width < of.size();
        if (inside && of[at - 1] == piece && of[at + 1] == piece && of[at - width] == piece &&
            of[at + width] == piece) {
            inner.push_back(at);
        }
    }
}

std::size_t stride_for(std::size_t count, std::size_t wanted) {
    return std::max<std::size_t>(1, count / std::max<std::size_t>(1, wanted));
}

}  // namespace

double Recognised::confidence() const {
    // A pixel that fits no mesh costs 6: what another mesh costs more, as a share of what all pixels could.
    const double margin = (cost_of_next - check.cost) / std::max(1.0, 0.25 * check.pixels);
    return std::clamp(check.quality(), 0.0, 1.0) * std::clamp(0.5 + margin, 0.0, 1.0);
}

void Recogniser::take_points(const SeenScene& scene, std::uint16_t piece) {
    const Cluster& cluster = scene.segmentation->clusters[piece - 1u];
    inner_pixels(*scene.segmentation, scene.image->camera, piece, inner_);
    const std::span<const std::uint32_t> pixels =
        inner_.size() * 3 > cluster.pixels.size() ? std::span<const std::uint32_t>(inner_) : cluster.pixels;
    const auto take = [&](PointSet& points, std::size_t wanted) {
        points.clear();
        points.add(*scene.image, scene.scale, scene.accuracy, pixels, stride_for(pixels.size(), wanted));
        points.close();
    };
    take(few_, settings_.first_points);
    take(more_, settings_.more_points);
    take(all_, pixels.size());
    deviation_ = depth_deviation(scene.accuracy, -all_.mean().z);
}

namespace {

// Closer than this to a better one, a candidate will end where that one does.
constexpr double same_place = 0.004;    // (unit: meters)
constexpr double same_cosine = 0.9985;  // of half the angle between them: 6 degrees

bool is_same(const Pose& a, const Pose& b) {
    return glm::length(a.position - b.position) < same_place &&
           std::abs(glm::dot(a.rotation, b.rotation)) > same_cosine;
}

}  // namespace

// The cheapest ones, each of them at a place of its own.
void Recogniser::keep_best(std::size_t count) {
    std::ranges::sort(candidates_, [](const Candidate& a, const Candidate& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.aspect < b.aspect;
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < candidates_.size() && kept < count; ++i) {
        const bool is_new =
            std::none_of(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(kept),
                         [&](const Candidate& other) { return is_same(other.pose, candidates_[i].pose); });
        if (is_new) {
            candidates_[kept++] = candidates_[i];
        }
    }
    candidates_.resize(kept);
}

void Recogniser::draw_closer(const LearntMesh& mesh, const PointSet& points, double first_reach,
                             double last_reach, int steps) {
    for (Candidate& candidate : candidates_) {
        candidate.pose = fit_pose(mesh.field, points, candidate.pose, first_reach, last_reach, steps).pose;
        candidate.cost = fit_sums(mesh.field, points, candidate.pose, last_reach).cost;
    }
}

void Recogniser::lay_views(const LearntMesh& mesh) {
    const Vec3 middle = all_.mean();
    const Quat look = look_along(middle);
    candidates_.clear();
    for (std::size_t i = 0; i < mesh.aspects.size(); ++i) {
        const MeshAspect& aspect = mesh.aspects[i];
        candidates_.push_back(
            {{middle - look * aspect.seen, glm::normalize(look * aspect.rotation)}, 0.0, i});
    }
    const double wide = settings_.first_reach, narrow = 0.6 * settings_.first_reach;
    const double reach = std::max(0.008, 6.0 * deviation_);
    draw_closer(mesh, few_, wide, wide, 1);
    keep_best(settings_.tried);
    draw_closer(mesh, few_, wide, narrow, 3);
    keep_best(settings_.refined);
    draw_closer(mesh, more_, narrow, reach, 5);
    keep_best(settings_.drawn);
}

Recognised Recogniser::best_of(const SeenScene& scene, const LearntMesh& mesh, std::uint16_t piece) {
    lay_views(mesh);
    Recognised best;
    for (const Candidate& candidate : candidates_) {
        const ViewCheck check = checker_.check(scene, mesh, candidate.pose, piece);
        if (best.check.pixels == 0 || check.cost < best.check.cost) {
            best.check = check;
            best.fit.pose = candidate.pose;
        }
    }
    const double last = settings_.last_reach_deviations * deviation_;
    best.fit = fit_pose(mesh.field, all_, best.fit.pose, std::max(0.008, 1.5 * last), last, 6);
    best.check = checker_.check(scene, mesh, best.fit.pose, piece);
    return best;
}

// Pixel by pixel and with the outline: what can slide along itself is held by where it ends.
void Recogniser::refine(const SeenScene& scene, const LearntMesh& mesh, std::uint16_t piece,
                        Recognised& one) {
    one.check = checker_.check(scene, mesh, one.fit.pose, piece);
    for (int step = 0; step < settings_.last_steps; ++step) {
        one.fit.sums = {};
        checker_.add_depths(scene, mesh, one.fit.pose, piece, settings_.last_reach_deviations, one.fit.sums);
        checker_.add_outline(scene, one.fit.pose, piece, one.fit.sums);
        const Recognised before = one;
        if (!step_pose(one.fit)) {
            return;
        }
        one.check = checker_.check(scene, mesh, one.fit.pose, piece);
        if (one.check.cost > before.check.cost) {
            one = before;
            return;
        }
    }
}

Recognised Recogniser::follow(const SeenScene& scene, const LearntMesh& mesh, const Pose& start,
                              std::uint16_t piece) {
    Recognised one;
    one.fit.pose = start;
    refine(scene, mesh, piece, one);
    return one;
}

Recognised Recogniser::find(const SeenScene& scene, const LearntMesh& mesh, std::uint16_t piece) {
    take_points(scene, piece);
    Recognised best = best_of(scene, mesh, piece);
    refine(scene, mesh, piece, best);
    return best;
}

std::vector<Recognised> Recogniser::recognise(const SeenScene& scene, std::span<const LearntMesh> meshes,
                                              std::uint16_t piece) {
    take_points(scene, piece);
    std::vector<Recognised> found;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        found.push_back(best_of(scene, meshes[i], piece));
        found.back().mesh = i;
    }
    const auto by_cost = [](const Recognised& one) { return one.check.cost; };
    std::ranges::stable_sort(found, {}, by_cost);
    const std::size_t promising = std::min<std::size_t>(2, found.size());
    for (std::size_t i = 0; i < promising; ++i) {
        refine(scene, meshes[found[i].mesh], piece, found[i]);
    }
    std::ranges::stable_sort(found, {}, by_cost);
    for (std::size_t i = 0; i < found.size(); ++i) {
        // Every pixel unexplained: what no mesh at all costs.
        const double none = 6.0 * found[i].check.pixels;
        found[i].cost_of_next = found.size() > 1 ? found[i == 0 ? 1 : 0].check.cost : none;
    }
    return found;
}

}  // namespace tactus
