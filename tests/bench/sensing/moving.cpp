#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/math/body_motion.hpp"
#include "sensing/sensing_figures.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

constexpr double to_degrees = 180.0 / std::numbers::pi;
constexpr double frame_seconds = 1.0 / 30.0;
constexpr int images_to_recover = 3;

const SeenObject* object_at(std::span<const SeenObject> seen, std::size_t mesh, const Vec3& place,
                            double within) {
    const SeenObject* nearest = nullptr;
    for (const SeenObject& object : seen) {
        const double apart = glm::length(object.measured.position - place);
        if (object.mesh == mesh && apart < within) {
            within = apart;
            nearest = &object;
        }
    }
    return nearest;
}

const SeenObject* object_named(std::span<const SeenObject> seen, std::uint32_t id) {
    const auto found = std::ranges::find_if(seen, [id](const SeenObject& object) { return object.id == id; });
    return found != seen.end() ? &*found : nullptr;
}

struct Begun {
    std::vector<std::uint32_t> ids;  // by object of the scene; 0: was not found right
};

Begun begin(const SensingCase& bench, MovingScene& moving, Discovery& discovery) {
    std::span<const SeenObject> seen;
    for (int i = 0; i < MovingScene::images_to_begin; ++i) {
        seen = discovery.update(moving.look(), moving.scene.camera_pose);
    }
    Begun begun;
    for (const SceneObject& object : moving.scene.objects) {
        const SeenObject* const found = object_at(seen, object.mesh, object.pose.position, 0.03);
        begun.ids.push_back(found != nullptr && pose_error(symmetry_of(bench.library[object.mesh].name),
                                                           object.pose, found->measured)
                                                        .angle < 0.17
                                ? found->id
                                : 0);
    }
    return begun;
}

}  // namespace

Pose MovingScene::Course::at(double seconds) const {
    const double ramp = std::min(seconds, 1.0);
    const double t = 0.5 * ramp * ramp + std::max(0.0, seconds - 1.0);
    const double angle = speed * t;
    return {start.position + across * std::sin(angle) + along * (1.0 - std::cos(angle)),
            glm::normalize(turn_by(t * spin, 1.0) * start.rotation)};
}

// Never lower than it began: the table is below.
MovingScene::MovingScene(const SensingCase& bench, std::uint64_t seed)
    : scene(random_scene(bench.library, {.held = 1.0}, seed)),
      bench_(bench),
      noise_(bench_noise(seed)),
      seed_(seed) {
    RandomValues random(seed + 31);
    for (const SceneObject& object : scene.objects) {
        const Vec3 across(random.between(-0.06, 0.06), 0.0, random.between(-0.06, 0.06));
        const Vec3 along(random.between(-0.06, 0.06), random.between(0.0, 0.05), random.between(-0.06, 0.06));
        const double speed = random.between(1.0, 3.0);
        courses_.push_back(
            {object.pose, across, along, speed, random.direction() * random.between(0.0, 1.5)});
    }
}

const DepthImage& MovingScene::look() {
    ++taken_;
    draw_scene(bench_.library, scene, exact_);
    image_ = noisy_image(exact_, noise_, seed_ * 1000 + taken_, 33'333u * taken_);
    return image_;
}

void MovingScene::move(int images) {
    for (std::size_t k = 0; k < courses_.size(); ++k) {
        scene.objects[k].pose = courses_[k].at(frame_seconds * images);
    }
}

Vec3 MovingScene::velocity(std::size_t object, int images) const {
    constexpr double aside = 1e-4;
    const double seconds = frame_seconds * images;
    return (courses_[object].at(seconds + aside).position - courses_[object].at(seconds - aside).position) /
           (2.0 * aside);
}

double MovingScene::seen_share(std::size_t object) const {
    DepthScene alone = scene;
    alone.objects = {scene.objects[object]};
    DepthBuffer buffer;
    draw_scene(bench_.library, alone, buffer);
    const auto whole = std::ranges::count(buffer.seen, std::uint16_t{0});
    const auto seen = std::ranges::count(exact_.seen, static_cast<std::uint16_t>(object));
    return whole > 0 ? static_cast<double>(seen) / static_cast<double>(whole) : 0.0;
}

void report_moving(Report& report, const SensingCase& bench) {
    std::vector<double> position_mm, angle_deg, told_mm, told_deg, frame_ms, speed_error;
    int lost = 0, followed = 0;
    for (int s = 0; s < std::max(1, bench.scenes / 5); ++s) {
        const std::uint64_t seed = bench.first + static_cast<std::uint64_t>(s);
        MovingScene moving(bench, seed);
        Discovery discovery(bench.meshes, bench_settings(true));
        discovery.time_with(seconds_now);
        const Begun begun = begin(bench, moving, discovery);
        for (int i = 1; i <= MovingScene::moving_images; ++i) {
            moving.move(i);
            const std::span<const SeenObject> seen =
                discovery.update(moving.look(), moving.scene.camera_pose);
            const DiscoveryTimes& times = discovery.times();
            frame_ms.push_back(1e3 * (times.plane + times.segmentation + times.tracking));
            for (std::size_t k = 0; k < begun.ids.size(); ++k) {
                if (begun.ids[k] == 0 || moving.seen_share(k) < MovingScene::least_seen) {
                    continue;
                }
                ++followed;
                const SeenObject* const object = object_named(seen, begun.ids[k]);
                const Pose& truth = moving.scene.objects[k].pose;
                const MeshSymmetry symmetry = symmetry_of(bench.library[moving.scene.objects[k].mesh].name);
                if (object == nullptr || object->state == SeenState::lost ||
                    object->state == SeenState::hidden) {
                    ++lost;
                    if (bench.talks) {
                        std::printf("  scene %llu, image %d: %s is not followed (%s)\n",
                                    static_cast<unsigned long long>(seed), i,
                                    bench.library[moving.scene.objects[k].mesh].name.c_str(),
                                    object == nullptr
                                        ? "forgotten"
                                        : (object->state == SeenState::lost ? "lost" : "hidden"));
                    }
                    continue;
                }
                const PoseError seen_error = pose_error(symmetry, truth, object->measured);
                const PoseError told_error = pose_error(symmetry, truth, object->pose);
                position_mm.push_back(1e3 * seen_error.position);
                angle_deg.push_back(seen_error.angle * to_degrees);
                told_mm.push_back(1e3 * told_error.position);
                told_deg.push_back(told_error.angle * to_degrees);
                speed_error.push_back(glm::length(object->linear_velocity - moving.velocity(k, i)));
            }
        }
    }
    const double median = quantile(position_mm, 0.5), turned = quantile(angle_deg, 0.5);
    const double p95 = quantile(frame_ms, 0.95);
    report.set("tracking_median_mm", median);
    report.set("tracking_median_deg", turned);
    report.set("tracking.position_p95_mm", quantile(position_mm, 0.95));
    report.set("tracking.rotation_p95_deg", quantile(angle_deg, 0.95));
    report.set("tracking.filtered_median_mm", quantile(told_mm, 0.5));
    report.set("tracking.filtered_median_deg", quantile(told_deg, 0.5));
    report.set("tracking.velocity_error_median_m_s", quantile(speed_error, 0.5));
    report.set("tracking.not_followed_percent", 100.0 * lost / std::max(1, followed));
    report.set("tracking_p95_ms", p95);
    std::printf(
        "moving         median %.3f mm, %.3f degrees (p95 %.2f, %.2f; filtered %.3f, %.3f), velocity %.4f "
        "m/s off, not "
        "followed %.2f %%; %.2f ms an image (p95; median %.2f)\n",
        median, turned, quantile(position_mm, 0.95), quantile(angle_deg, 0.95), quantile(told_mm, 0.5),
        quantile(told_deg, 0.5), quantile(speed_error, 0.5), 100.0 * lost / std::max(1, followed), p95,
        quantile(frame_ms, 0.5));
}

void report_recovery(Report& report, const SensingCase& bench) {
    int moved = 0, recovered = 0;
    for (int s = 0; s < bench.scenes; ++s) {
        const std::uint64_t seed = bench.first + static_cast<std::uint64_t>(s);
        MovingScene moving(bench, seed);
        Discovery discovery(bench.meshes, bench_settings(true));
        const Begun begun = begin(bench, moving, discovery);
        RandomValues random(seed + 32);
        for (SceneObject& object : moving.scene.objects) {
            Vec3 way = 0.02 * random.direction();
            way.y = std::abs(way.y);
            object.pose = {
                object.pose.position + way,
                glm::normalize(turn_by(15.0 / to_degrees * random.direction(), 1.0) * object.pose.rotation)};
        }
        std::span<const SeenObject> seen;
        for (int i = 0; i < images_to_recover; ++i) {
            seen = discovery.update(moving.look(), moving.scene.camera_pose);
        }
        for (std::size_t k = 0; k < begun.ids.size(); ++k) {
            if (begun.ids[k] == 0 || moving.seen_share(k) < MovingScene::least_seen) {
                continue;
            }
            ++moved;
            const SceneObject& object = moving.scene.objects[k];
            const SeenObject* const found = object_named(seen, begun.ids[k]);
            const PoseError error =
                found != nullptr
                    ? pose_error(symmetry_of(bench.library[object.mesh].name), object.pose, found->measured)
                    : PoseError{1.0, 1.0};
            const bool is_right = error.position < 0.005 && error.angle * to_degrees < 5.0;
            recovered += is_right;
            if (bench.talks && !is_right) {
                std::printf("  scene %llu: %s is %.1f mm, %.1f degrees off after its jump\n",
                            static_cast<unsigned long long>(seed), bench.library[object.mesh].name.c_str(),
                            1e3 * error.position, error.angle * to_degrees);
            }
        }
    }
    report.set("recovery_percent", 100.0 * recovered / std::max(1, moved));
    std::printf("recovery       %d of %d within 5 mm and 5 degrees after %d images\n", recovered, moved,
                images_to_recover);
}

}  // namespace tactus::shared
