#include <algorithm>
#include <cstdio>
#include <numbers>

#include "sensing/sensing_figures.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

constexpr double to_degrees = 180.0 / std::numbers::pi;

// A scene is looked at until everything in it had its turn: one new piece an image.
constexpr int images = 7;

// What is found farther off than this from an object is another one (unit: meters).
constexpr double same_object = 0.06;

}  // namespace

void judge(const SensingCase& bench, const DepthScene& scene, std::uint64_t seed,
           const std::vector<FirstSight>& sights, StillFigures& figures) {
    std::vector<bool> used(sights.size(), false);
    for (const SceneObject& object : scene.objects) {
        ++figures.objects;
        std::size_t nearest = sights.size();
        double least = same_object;
        for (std::size_t i = 0; i < sights.size(); ++i) {
            const double apart = glm::length(sights[i].pose.position - object.pose.position);
            if (!used[i] && apart < least) {
                least = apart;
                nearest = i;
            }
        }
        const std::string& name = bench.library[object.mesh].name;
        if (nearest == sights.size()) {
            ++figures.missed;
            if (bench.talks) {
                std::printf("  scene %llu: %s was not found\n", static_cast<unsigned long long>(seed),
                            name.c_str());
            }
            continue;
        }
        used[nearest] = true;
        const FirstSight& sight = sights[nearest];
        const PoseError error = pose_error(symmetry_of(name), object.pose, sight.pose);
        const bool right = sight.mesh == object.mesh;
        figures.right += right;
        figures.pose_right += right && error.position < 0.015 && error.angle * to_degrees < 10.0;
        if (right) {
            figures.position_mm.push_back(1e3 * error.position);
            figures.angle_deg.push_back(error.angle * to_degrees);
        }
        if (bench.talks && (!right || error.position > 0.002 || error.angle * to_degrees > 1.5)) {
            std::printf("  scene %llu: %s seen as %s, %.2f mm, %.2f degrees off\n",
                        static_cast<unsigned long long>(seed), name.c_str(),
                        sight.mesh == SeenObject::no_mesh ? "a hull" : bench.library[sight.mesh].name.c_str(),
                        1e3 * error.position, error.angle * to_degrees);
        }
    }
    figures.surplus += static_cast<int>(std::ranges::count(used, false));
}

StillScene::StillScene(const SensingCase& bench, std::uint64_t seed, double distance)
    : scene(random_scene(bench.library, {.distance = distance}, seed)), seed_(seed) {
    draw_scene(bench.library, scene, exact_);
}

DepthImage StillScene::image(int index) const {
    return noisy_image(exact_, bench_noise(seed_), seed_ * 100 + static_cast<std::uint64_t>(index),
                       33'333u * static_cast<unsigned>(index + 1));
}

double look_at(const SensingCase& bench, std::uint64_t seed, double distance, bool support_known,
               StillFigures& figures) {
    const StillScene still(bench, seed, distance);
    const DepthScene& scene = still.scene;
    Discovery discovery(bench.meshes, bench_settings(support_known));
    discovery.time_with(seconds_now);
    std::vector<FirstSight> sights;
    for (int i = 0; i < images; ++i) {
        const std::span<const SeenObject> seen = discovery.update(still.image(i), scene.camera_pose);
        const DiscoveryTimes& times = discovery.times();
        figures.segmentation_ms.push_back(1e3 * (times.plane + times.segmentation));
        bool is_new = false;
        for (const SeenObject& object : seen) {
            if (std::ranges::none_of(sights, [&](const FirstSight& one) { return one.id == object.id; })) {
                sights.push_back({object.id, object.mesh, object.measured});
                is_new = is_new || object.mesh != SeenObject::no_mesh;
            }
        }
        if (is_new) {
            figures.new_object_ms.push_back(1e3 * times.recognition);
        }
    }
    judge(bench, scene, seed, sights, figures);
    return discovery.depth_scale();
}

DepthNoise bench_noise(std::uint64_t seed) {
    DepthNoise noise;
    noise.error_share = RandomValues(seed + 77'000).between(-0.01, 0.01);
    return noise;
}

SeeingSettings bench_settings(bool support_known) {
    SeeingSettings settings;
    if (support_known) {
        settings.support = WorldPlane{};
    }
    return settings;
}

void report_still(Report& report, const SensingCase& bench, const std::string& prefix, double distance,
                  bool support_known) {
    StillFigures figures;
    for (int i = 0; i < bench.scenes; ++i) {
        look_at(bench, bench.first + static_cast<std::uint64_t>(i), distance, support_known, figures);
    }
    const double percent = 100.0 / std::max(1, figures.objects);
    report.set(prefix + "objects", figures.objects);
    report.set(prefix + "identity_right_percent", percent * figures.right);
    report.set(prefix + "pose_right_percent", percent * figures.pose_right);
    report.set(prefix + "missed_percent", percent * figures.missed);
    report.set(prefix + "surplus_percent", percent * figures.surplus);
    const double position = quantile(figures.position_mm, 0.5), angle = quantile(figures.angle_deg, 0.5);
    const double far = quantile(figures.position_mm, 0.95), turned = quantile(figures.angle_deg, 0.95);
    report.set(prefix + "position_median_mm", position);
    report.set(prefix + "rotation_median_deg", angle);
    report.set(prefix + "position_p95_mm", far);
    report.set(prefix + "rotation_p95_deg", turned);
    const double segmentation = quantile(figures.segmentation_ms, 0.95);
    const double fresh = quantile(figures.new_object_ms, 0.95);
    report.set(prefix + "segmentation_p95_ms", segmentation);
    report.set(prefix + "new_object_p95_ms", fresh);
    std::printf(
        "%-14s %d objects: identity %.2f %%, pose %.2f %%, missed %.2f %%, surplus %.2f %%; median %.3f mm, "
        "%.3f "
        "degrees, p95 %.3f mm, %.3f degrees; segmentation %.2f ms, new object %.1f ms (p95; median %.1f)\n",
        (prefix.empty() ? "still" : prefix).c_str(), figures.objects, percent * figures.right,
        percent * figures.pose_right, percent * figures.missed, percent * figures.surplus, position, angle,
        far, turned, segmentation, fresh, quantile(figures.new_object_ms, 0.5));
}

}  // namespace tactus::shared
