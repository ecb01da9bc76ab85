// What the bench of sensing measures, one function for each part of it.
#pragma once

#include <memory>
#include <vector>

#include "sensing/discovery/discovery.hpp"
#include "shared/bench_kit.hpp"
#include "shared/depth_scenes.hpp"

namespace tactus::shared {

struct SensingCase {
    std::vector<LibraryMesh> library;
    std::shared_ptr<const std::vector<LearntMesh>> meshes;
    int scenes = 200;
    std::uint64_t first = 5000;  // seed of the first scene
    bool talks = false;          // of what goes wrong
    int rival_scenes = 12;       // of each kind, that the rival looks at
};

// For what a discovery tells of its own time.
inline double seconds_now() {
    static const SpanClock clock;
    return 1e-9 * clock.nanoseconds(0, clock.now());
}

// Camera and depth error of a scene; where the support's place is known, as after a calibration by it.
SeeingSettings bench_settings(bool support_known);
DepthNoise bench_noise(std::uint64_t seed);

// What was found in still scenes, against their truth.
struct StillFigures {
    int objects = 0, missed = 0, right = 0, pose_right = 0, surplus = 0;
    std::vector<double> position_mm, angle_deg, segmentation_ms, new_object_ms;
};

// An object as it was seen for the first time.
struct FirstSight {
    std::uint32_t id = 0;
    std::size_t mesh = 0;
    Pose pose;  // in the world
};

// A scene of a seed, and the images of it.
class StillScene {
public:
    StillScene(const SensingCase& bench, std::uint64_t seed, double distance);
    DepthImage image(int index) const;

    const DepthScene scene;

private:
    std::uint64_t seed_;
    DepthBuffer exact_;
};

// Adds to the figures what was seen right and wrong.
void judge(const SensingCase& bench, const DepthScene& scene, std::uint64_t seed,
           const std::vector<FirstSight>& sights, StillFigures& figures);
// Looks at a scene until everything in it had its turn. True depth over told depth, as it was learnt.
double look_at(const SensingCase& bench, std::uint64_t seed, double distance, bool support_known,
               StillFigures& figures);

// A scene in which everything is held and goes its own way, and a camera before it.
class MovingScene {
public:
    static constexpr int images_to_begin = 6;  // while nothing moves
    static constexpr int moving_images = 90;
    // Less of an object than this is seen: others hide it.
    static constexpr double least_seen = 0.5;

    MovingScene(const SensingCase& bench, std::uint64_t seed);

    // The next image, of what is where it is.
    const DepthImage& look();
    // Where everything is when so many images have been taken since it began to move.
    void move(int images);
    // From that time on, and velocity.
    Vec3 velocity(std::size_t object, int images) const;
    // Share of the object's pixels that no other one hides, by the last image.
    double seen_share(std::size_t object) const;

    DepthScene scene;

private:
    // On an ellipse about where it was, turning about an axis that stays: from rest, evenly faster over a
    // second.
    struct Course {
        Pose start;
        Vec3 across{0.0}, along{0.0};  // half axes (unit: meters)
        double speed = 1.0;            // around (unit: radians per second)
        Vec3 spin{0.0};                // (unit: radians per second)

        Pose at(double seconds) const;
    };

    const SensingCase& bench_;
    DepthNoise noise_;
    std::uint64_t seed_;
    unsigned taken_ = 0;
    DepthBuffer exact_;
    DepthImage image_;
    std::vector<Course> courses_;
};

// Objects that rest or are held still, seen for the first time; keys begin with `prefix`.
void report_still(Report& report, const SensingCase& bench, const std::string& prefix, double distance,
                  bool support_known);
// Objects that move for 90 images, and objects that are suddenly 20 mm and 15 degrees elsewhere.
void report_moving(Report& report, const SensingCase& bench);
void report_recovery(Report& report, const SensingCase& bench);
// The same by PCL's usual path: how much longer it takes, and how right it is. Says so where the machine has
// no PCL.
void report_rival(Report& report, const SensingCase& bench);
// A body at rest that is seen with 1 mm of chance.
void report_rest(Report& report, const SensingCase& bench);
// What a sensor that looks on a thread of its own adds to the ticks of a loop that touches.
void report_tick(Report& report, const SensingCase& bench);
// What two seconds of touch teach.
void report_parameters(Report& report, const SensingCase& bench);

}  // namespace tactus::shared
