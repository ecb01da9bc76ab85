#include "sensing/sensor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "scene.hpp"

namespace tactus {
namespace {

using testing::Scene;

struct Destroy {
    void operator()(Sensor* sensor) const { sensor->destroy(); }
};
using OwnedSensor = std::unique_ptr<Sensor, Destroy>;

OwnedSensor sensor() {
    return OwnedSensor(new Sensor(testing::driver_path()));
}

// Where the scene's camera is, and with its points.
OwnedSensor sensor_of(const Scene& scene) {
    OwnedSensor made = sensor();
    SensorSettings settings;
    settings.camera = scene.camera();
    settings.wants_cloud = true;
    made->set_settings(settings);
    return made;
}

// Takes until it holds, at most for seconds.
bool until(Sensor& sensor, const std::function<bool(const Sight&)>& holds) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < deadline) {
        sensor.take();
        if (holds(sensor.sight())) {
            return true;
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

TEST(Sensor, SeesACloudWhereTheTableIs) {
    Scene scene;
    scene.show(7);
    const OwnedSensor eyes = sensor_of(scene);
    const std::string uri = scene.uri();
    eyes->open({uri.c_str()});
    ASSERT_TRUE(until(*eyes, [](const Sight& sight) { return sight.state == SensorState::seeing; }));
    const Sight& sight = eyes->sight();
    EXPECT_EQ(sight.camera_time, 7u);
    EXPECT_GT(sight.arrived, 0);
    EXPECT_EQ(sight.cloud.size(),
              static_cast<std::size_t>(std::ranges::count_if(
                  scene.image().depth_mm, [](std::uint16_t depth) { return depth != 0; })));
    // In front of the camera.
    for (const glm::vec3& point : sight.cloud) {
        ASSERT_LT(point.z, -0.3f);
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
    ASSERT_TRUE(until(*eyes, [](const Sight& sight) { return sight.camera_time == 1; }));
    eyes->open({second.c_str()});
    ASSERT_TRUE(until(*eyes, [](const Sight& sight) { return sight.camera_time == 2; }));
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

TEST(Sensor, RefusesAnImageInWhichNothingCanBeSeen) {
    Scene scene;
    scene.writer().show({{0.0, 100.0, 0.0}}, {}, 1);
    const OwnedSensor eyes = sensor_of(scene);
    const std::string uri = scene.uri();
    eyes->open({uri.c_str()});
    EXPECT_TRUE(until(*eyes, [](const Sight& sight) {
        return std::string(sight.text).find("holds no depth") != std::string::npos;
    }));
    EXPECT_EQ(eyes->sight().frames, 0u);
    EXPECT_GT(eyes->sight().dropped, 0u);
}

}  // namespace
}  // namespace tactus
