#include <algorithm>
#include <cstdio>
#include <numbers>

#include "sensing/rival.hpp"
#include "sensing/sensing_figures.hpp"

namespace tactus::shared {

namespace {

constexpr double to_degrees = 180.0 / std::numbers::pi;

// The rival is given what stands around an object, and nothing of the table (unit: meters).
constexpr double around = 0.02;
constexpr double over_table = 0.005;

double milliseconds_since(double began) {
    return 1e3 * (seconds_now() - began);
}

std::vector<Vec3> points_of(const DepthImage& image, double scale) {
    std::vector<Vec3> points;
    std::size_t at = 0;
    for (int v = 0; v < image.camera.height; ++v) {
        for (int u = 0; u < image.camera.width; ++u) {
            if (const double depth = scale * 1e-3 * image.depth_mm[at++]; depth > 0.0) {
                points.push_back(depth * ray_through(image.camera, u, v));
            }
        }
    }
    return points;
}

std::vector<Vec3> points_around(const std::vector<Vec3>& points, const Pose& camera, const LearntMesh& mesh,
                                const Pose& in_camera) {
    const Vec3 center = to_parent(in_camera, mesh.center);
    const double reach = mesh.radius + around;
    std::vector<Vec3> near;
    for (const Vec3& point : points) {
        const Vec3 off = point - center;
        if (glm::dot(off, off) < reach * reach && to_parent(camera, point).y > over_table) {
            near.push_back(point);
        }
    }
    return near;
}

struct Compared {
    std::vector<double> ours_ms, rival_ms;

    double over_ours() { return quantile(rival_ms, 0.5) / std::max(1e-6, quantile(ours_ms, 0.5)); }
};

// It is given what depths are off by, as ours has learnt it.
void look_as_rival(const SensingCase& bench, SensingRival& rival, std::uint64_t seed, double scale,
                   StillFigures& figures) {
    const StillScene still(bench, seed, 0.85);
    const std::vector<Vec3> points = points_of(still.image(0), scale);
    double began = seconds_now();
    const std::vector<std::vector<Vec3>> pieces = rival.pieces(points);
    figures.segmentation_ms.push_back(milliseconds_since(began));
    std::vector<FirstSight> sights;
    for (const std::vector<Vec3>& piece : pieces) {
        began = seconds_now();
        const RivalMatch match = rival.recognise(piece);
        figures.new_object_ms.push_back(milliseconds_since(began));
        if (match.found) {
            sights.push_back({0, match.mesh, compose(still.scene.camera_pose, match.pose)});
        }
    }
    judge(bench, still.scene, seed, sights, figures);
}

struct FollowFigures {
    Compared times;
    std::vector<double> ours_mm, rival_mm;
};

// The rival begins each image where the truth was one image before.
void follow_as_both(const SensingCase& bench, SensingRival& rival, std::uint64_t seed,
                    FollowFigures& figures) {
    MovingScene moving(bench, seed);
    Discovery discovery(bench.meshes, bench_settings(true));
    discovery.time_with(seconds_now);
    for (int i = 0; i < MovingScene::images_to_begin; ++i) {
        discovery.update(moving.look(), moving.scene.camera_pose);
    }
    for (int i = 1; i <= MovingScene::moving_images; ++i) {
        const DepthScene before = moving.scene;
        moving.move(i);
        const DepthImage& image = moving.look();
        const Pose& camera = moving.scene.camera_pose;
        const std::span<const SeenObject> seen = discovery.update(image, camera);
        figures.times.ours_ms.push_back(1e3 * discovery.times().tracking);
        const std::vector<Vec3> points = points_of(image, discovery.depth_scale());
        double spent = 0.0;
        for (std::size_t k = 0; k < moving.scene.objects.size(); ++k) {
            const SceneObject& object = moving.scene.objects[k];
            const LearntMesh& mesh = (*bench.meshes)[object.mesh];
            const MeshSymmetry symmetry = symmetry_of(bench.library[object.mesh].name);
            const Pose from = compose(inverse(camera), before.objects[k].pose);
            const std::vector<Vec3> near = points_around(points, camera, mesh, from);
            const double began = seconds_now();
            const Pose found = compose(camera, rival.follow(object.mesh, near, from));
            spent += milliseconds_since(began);
            if (moving.seen_share(k) < MovingScene::least_seen) {
                continue;
            }
            figures.rival_mm.push_back(1e3 * pose_error(symmetry, object.pose, found).position);
            double nearest = 0.05;
            for (const SeenObject& one : seen) {
                if (one.mesh == object.mesh) {
                    nearest = std::min(nearest, pose_error(symmetry, object.pose, one.measured).position);
                }
            }
            figures.ours_mm.push_back(1e3 * nearest);
        }
        figures.times.rival_ms.push_back(spent);
    }
}

}  // namespace

void report_rival(Report& report, const SensingCase& bench) {
    std::vector<TriangleMesh> library;
    for (const LibraryMesh& known : bench.library) {
        library.push_back(known.mesh);
    }
    const std::unique_ptr<SensingRival> rival = make_pcl_rival(library);
    if (rival == nullptr) {
        std::printf("pcl            left out: ./run setup --with-sensing\n");
        return;
    }
    StillFigures ours, theirs;
    FollowFigures followed;
    for (int s = 0; s < std::min(bench.scenes, bench.rival_scenes); ++s) {
        const std::uint64_t seed = bench.first + static_cast<std::uint64_t>(s);
        const double scale = look_at(bench, seed, 0.85, true, ours);
        look_as_rival(bench, *rival, seed, scale, theirs);
        if (s % 4 == 0) {
            follow_as_both(bench, *rival, seed, followed);
        }
    }
    Compared pieces{ours.segmentation_ms, theirs.segmentation_ms};
    Compared fresh{ours.new_object_ms, theirs.new_object_ms};
    const double of_pieces = pieces.over_ours(), of_fresh = fresh.over_ours();
    const double of_following = followed.times.over_ours();
    const auto right = [](const StillFigures& figures) {
        return 100.0 * figures.pose_right / std::max(1, figures.objects);
    };
    const double slowest = std::min({of_pieces, of_fresh, of_following});
    const double ours_mm = quantile(followed.ours_mm, 0.5), theirs_mm = quantile(followed.rival_mm, 0.5);
    const double found_mm = quantile(ours.position_mm, 0.5),
                 theirs_found_mm = quantile(theirs.position_mm, 0.5);
    report.set("pcl_over_ours", slowest);
    report.set("pcl_over_ours.segmentation", of_pieces);
    report.set("pcl_over_ours.new_object", of_fresh);
    report.set("pcl_over_ours.tracking", of_following);
    report.set("pcl.pose_right_percent", right(theirs));
    report.set("pcl.ours_pose_right_percent", right(ours));
    report.set("pcl.position_median_mm", theirs_found_mm);
    report.set("pcl.ours_position_median_mm", found_mm);
    report.set("pcl.tracking_median_mm", theirs_mm);
    report.set("pcl.ours_tracking_median_mm", ours_mm);
    std::printf(
        "pcl over ours  pieces %.1f (%.2f ms), new object %.1f (%.0f ms), following three %.1f (%.1f ms); "
        "poses right %.1f %% (ours %.1f %%), median %.2f mm (%.3f), followed %.2f mm (%.3f)\n",
        of_pieces, quantile(theirs.segmentation_ms, 0.5), of_fresh, quantile(theirs.new_object_ms, 0.5),
        of_following, quantile(followed.times.rival_ms, 0.5), right(theirs), right(ours), theirs_found_mm,
        found_mm, theirs_mm, ours_mm);
}

}  // namespace tactus::shared
