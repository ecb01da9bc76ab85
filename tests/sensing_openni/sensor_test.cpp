#include "sensing/watch/sensor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>
#include <vector>

#include "platform/clock.hpp"
#include "scene.hpp"
#include "sensing/source.hpp"

namespace tactus::sensor_test {
namespace {

using testing::Scene;

struct Destroy {
    void operator()(Sensor* sensor) const { sensor->destroy(); }
};
using OwnedSensor = std::unique_ptr<Sensor, Destroy>;

OwnedSensor sensor() {
    return OwnedSensor(new Sensor([](const SourceChoice& choice, std::string& error) {
        return open_source(choice, testing::driver_path(), error);
    }));
}

// Where the scene's camera is, and with its points.
OwnedSensor sensor_of(const Scene& scene) {
    OwnedSensor made = sensor();
    SensorSettings settings;
    settings.camera = scene.camera();
    settings.wants_cloud = true;
    settings.max_rate = 0.0;  // every image
    made->set_settings(settings);
    return made;
}

// Takes until it holds, at most for seconds. `show`, now and then: what is shown once while a camera starts
// OpenNI2 may leave out.
bool until(Sensor& sensor, const std::function<bool(const Sight&)>& holds,
           const std::function<void()>& show = nullptr) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (int i = 1; std::chrono::steady_clock::now() < deadline; ++i) {
        sensor.take();
        if (holds(sensor.sight())) {
            return true;
        }
        if (show && i % 100 == 0) {
            show();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ADD_FAILURE() << "not reached; it says: " << sensor.sight().text;
    return false;
}

TEST(Sensor, IsClosedUntilItIsOpened) {
    const OwnedSensor eyes = sensor();
    EXPECT_FALSE(eyes->take());
    EXPECT_EQ(eyes->sight().state, SensorState::closed);
}

TEST(Sensor, SaysWhatItWaitsFor) {
    const OwnedSensor eyes = sensor();
    eyes->open({});
    EXPECT_TRUE(until(*eyes, [](const Sight& sight) {
        return sight.state == SensorState::opening &&
               std::string(sight.text).find("plug one in") != std::string::npos;
    }));
}

TEST(Sensor, KnowsWhenItsImageWasTaken) {
    SyntheticCamera camera = testing::exact_camera();
    camera.rate = 30.0;
    Scene scene(camera);
    const Nanoseconds shown = monotonic_now();
    scene.show(static_cast<std::uint64_t>(shown / 1000));
    const OwnedSensor eyes = sensor_of(scene);
    const std::string uri = scene.uri();
    eyes->open({uri.c_str()});
    ASSERT_TRUE(until(*eyes, [](const Sight& sight) { return sight.frames > 1; }));
    EXPECT_GE(eyes->sight().seen_at, shown - 1000);
    EXPECT_LT(eyes->sight().seen_at, monotonic_now());
    EXPECT_EQ(eyes->sight().seen_at, static_cast<Nanoseconds>(eyes->sight().camera_time) * 1000);
}

// Also of a clock that is this machine's own: its offset is what a scene says that it is.
TEST(Sensor, TakesAnImageForAsOldAsItIsTold) {
    Scene scene;
    scene.show(50'000);
    const OwnedSensor eyes = sensor_of(scene);
    SensorSettings settings;
    settings.camera = scene.camera();
    settings.camera_delay = 0.02;
    eyes->set_settings(settings);
    const std::string uri = scene.uri();
    eyes->open({uri.c_str()});
    ASSERT_TRUE(
        until(*eyes, [](const Sight& sight) { return sight.frames > 0; }, [&] { scene.show(50'000); }));
    EXPECT_EQ(eyes->sight().seen_at, 50'000'000 - 20'000'000);
}

TEST(Sensor, SeesACloudWhereTheTableIs) {
    Scene scene;
    scene.show(7);
    const OwnedSensor eyes = sensor_of(scene);
    const std::string uri = scene.uri();
    eyes->open({uri.c_str()});
    ASSERT_TRUE(until(
        *eyes, [](const Sight& sight) { return sight.state == SensorState::seeing; },
        [&] { scene.show(7); }));
    const Sight& sight = eyes->sight();
    EXPECT_EQ(sight.camera_time, 7u);
    EXPECT_EQ(sight.seen_at, 7000) << "as the camera says";
    EXPECT_EQ(sight.cloud.size(),
              static_cast<std::size_t>(std::ranges::count_if(
                  scene.image().depth_mm, [](std::uint16_t depth) { return depth != 0; })));
    // In front of the camera.
    for (const glm::vec3& point : sight.cloud) {
        ASSERT_LT(point.z, -0.3f);
    }
}

// Their stacks are given back to the system, and with them those of threads that have ended before.
void end_many_threads() {
    std::vector<std::thread> threads(16);
    std::atomic<bool> ends{false};
    for (std::thread& thread : threads) {
        thread = std::thread([&] { ends.wait(false); });
    }
    ends = true;
    ends.notify_all();
    for (std::thread& thread : threads) {
        thread.join();
    }
}

// OpenNI2 asks after all who have ever waited for an image (see lasting_thread.hpp).
TEST(Sensor, OneAfterTheOtherSees) {
    Scene scene;
    scene.show(7);
    const std::string uri = scene.uri();
    for (int i = 0; i < 4; ++i) {
        OwnedSensor eyes = sensor_of(scene);
        eyes->open({uri.c_str()});
        ASSERT_TRUE(until(
            *eyes, [](const Sight& sight) { return sight.state == SensorState::seeing; },
            [&] { scene.show(7); }));
        eyes.reset();
        end_many_threads();
    }
}

TEST(Sensor, FindsACameraThatIsPluggedInAgain) {
    SyntheticCamera settings = testing::exact_camera();
    settings.rate = 60.0;
    Scene scene(settings);
    scene.show(1);
    const OwnedSensor eyes = sensor_of(scene);
    const std::string uri = scene.uri();
    eyes->open({uri.c_str()});
    const auto sees = [](const Sight& sight) { return sight.state == SensorState::seeing; };
    ASSERT_TRUE(until(*eyes, sees));
    scene.writer().set_plug(Plug::out);
    ASSERT_TRUE(until(*eyes, [](const Sight& sight) { return sight.state == SensorState::opening; }));
    const std::size_t cloud = eyes->sight().cloud.size();
    EXPECT_GT(cloud, 0u) << "the last good sight stays";
    scene.writer().set_plug(Plug::in);
    EXPECT_TRUE(until(*eyes, sees));
}

TEST(Sensor, TakesAnotherCameraAtOnce) {
    Scene one;
    Scene other;
    one.show(1);
    other.show(2);
    const OwnedSensor eyes = sensor_of(one);
    const std::string first = one.uri();
    const std::string second = other.uri();
    eyes->open({first.c_str()});
    ASSERT_TRUE(
        until(*eyes, [](const Sight& sight) { return sight.camera_time == 1; }, [&] { one.show(1); }));
    eyes->open({second.c_str()});
    ASSERT_TRUE(
        until(*eyes, [](const Sight& sight) { return sight.camera_time == 2; }, [&] { other.show(2); }));
    eyes->close();
    EXPECT_TRUE(until(*eyes, [](const Sight& sight) { return sight.state == SensorState::closed; }));
}

TEST(Sensor, FindsTheMeshesOfItsLibraryWhereTheyAre) {
    SyntheticCamera settings;
    settings.rate = 30.0;
    settings.depth_error = 0.0;
    Scene scene(settings);
    scene.show(1);
    const OwnedSensor eyes = sensor_of(scene);
    const TriangleMesh box = shared::box({0.05, 0.04, 0.03});
    const std::array<KnownMesh, 1> library{KnownMesh{"box", testing::view_of(box), 0.7}};
    eyes->set_library(library);
    const std::string uri = scene.uri();
    eyes->open({uri.c_str()});
    const auto found = [](const Sight& sight) {
        return std::ranges::any_of(sight.objects,
                                   [](const SightedObject& object) { return object.mesh == 0; });
    };
    ASSERT_TRUE(until(*eyes, found));
    const Sight& sight = eyes->sight();
    const auto seen = std::ranges::find(sight.objects, 0, &SightedObject::mesh);
    EXPECT_LT(glm::distance(seen->pose.position, scene.box().position), 0.003);
    EXPECT_GT(seen->confidence, 0.5);
    EXPECT_TRUE(sight.plane.is_found);
    EXPECT_NEAR(sight.plane.offset, 0.0, 0.003);
    // The ball is none of the library.
    EXPECT_TRUE(until(*eyes, [](const Sight& now) {
        return std::ranges::any_of(now.objects, [](const SightedObject& object) {
            return object.mesh < 0 && !object.hull.vertices.empty();
        });
    }));
}

// Two bodies at one place throw each other away in a model.
TEST(Sensor, KnowsWhatMovesOnceAndWhereItIs) {
    SyntheticCamera camera;
    camera.rate = 0.0;
    camera.depth_error = 0.0;
    Scene scene(camera);
    const OwnedSensor eyes = sensor_of(scene);
    const TriangleMesh box = shared::box({0.05, 0.04, 0.03});
    const std::array<KnownMesh, 1> library{KnownMesh{"box", testing::view_of(box), 0.7}};
    eyes->set_library(library);
    const std::string uri = scene.uri();
    eyes->open({uri.c_str()});
    // OpenNI2 may leave out what is shown while a camera starts, and each image is shown once.
    ASSERT_TRUE(until(*eyes, [](const Sight& sight) { return sight.state == SensorState::waiting; }));
    for (int frame = 1; frame <= 300; ++frame) {
        const auto time = static_cast<std::uint64_t>(frame) * 33333;
        scene.move(0.04 * std::sin(1.2 * 1e-6 * static_cast<double>(time)));
        const Vec3 true_place = scene.box().position;
        scene.show(time);
        ASSERT_TRUE(until(*eyes, [&](const Sight& sight) { return sight.camera_time == time; })) << frame;
        int known = 0;
        for (const SightedObject& object : eyes->sight().objects) {
            if (object.mesh == 0 && object.state != SightState::lost) {
                ++known;
                EXPECT_LT(glm::distance(object.pose.position, true_place), 0.02) << frame;
                EXPECT_LT(glm::length(object.linear_velocity), 0.5) << frame;
                EXPECT_LT(glm::length(object.angular_velocity), 10.0) << frame;
            }
        }
        EXPECT_LE(known, 1) << frame;
    }
}

TEST(Sensor, RefusesAnImageInWhichNothingCanBeSeen) {
    Scene scene;
    const auto show_nothing = [&] { scene.writer().show({{0.0, 100.0, 0.0}}, {}, 1); };
    show_nothing();
    const OwnedSensor eyes = sensor_of(scene);
    const std::string uri = scene.uri();
    eyes->open({uri.c_str()});
    EXPECT_TRUE(until(
        *eyes,
        [](const Sight& sight) {
            return std::string(sight.text).find("holds no depth") != std::string::npos;
        },
        show_nothing));
    EXPECT_EQ(eyes->sight().frames, 0u);
    EXPECT_GT(eyes->sight().dropped, 0u);
}

}  // namespace
}  // namespace tactus::sensor_test
