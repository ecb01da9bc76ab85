// The sensor before cameras that do what cameras should not.
#include "sensing/watch/sensor.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
#include <thread>

#include "shared/depth_scenes.hpp"

namespace tactus::sensor_test {
namespace {

using Reading = FrameSource::Reading;

const std::vector<LibraryMesh>& library() {
    static const std::vector<LibraryMesh> cube = shared::library_meshes({"cube"});
    return cube;
}

Pose cube_at(double along) {
    Pose pose = shared::resting_pose(library()[0], false, 1);
    pose.position.x += along;
    return pose;
}

DepthImage table_image(std::uint64_t time_us, double along) {
    shared::DepthScene scene{kinect_camera(320, 240), shared::camera_above_table(0.85, 0.8), {}};
    scene.objects.push_back({0, cube_at(along)});
    DepthBuffer exact;
    shared::draw_scene(library(), scene, exact);
    DepthNoise noise;
    noise.error_share = 0.0;
    return noisy_image(exact, noise, time_us, time_us);
}

// What comes of the camera, each time that it is asked.
struct Script {
    std::mutex mutex;
    std::function<Reading(DepthImage& image)> next = [](DepthImage&) { return Reading::nothing; };
    std::string trouble = "the camera is odd: unplug it";
    int opened = 0;

    void play(std::function<Reading(DepthImage& image)> what) {
        const std::lock_guard lock(mutex);
        next = std::move(what);
    }
};

class ScriptedCamera final : public FrameSource {
public:
    explicit ScriptedCamera(Script& script) : script_(script), trouble_(script.trouble) {}
    Reading read(DepthImage& image, int) override {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const std::lock_guard lock(script_.mutex);
        return script_.next(image);
    }
    const std::string& name() const override { return name_; }
    const std::string& trouble() const override { return trouble_; }

private:
    Script& script_;
    std::string name_ = "the camera", trouble_;
};

struct Destroy {
    void operator()(Sensor* sensor) const { sensor->destroy(); }
};

class Watching : public ::testing::Test {
protected:
    Watching()
        : sensor_(new Sensor([this](const SourceChoice&, std::string&) {
              const std::lock_guard lock(script_.mutex);
              ++script_.opened;
              return std::make_unique<ScriptedCamera>(script_);
          })) {
        SensorSettings settings;
        settings.camera = shared::camera_above_table(0.85, 0.8);
        settings.max_rate = 0.0;
        sensor_->set_settings(settings);
    }
    // Of the cube, in the library.
    void teach() {
        const LibraryMesh& cube = library().front();
        const KnownMesh known{"cube", {cube.mesh.vertices, cube.mesh.triangles}, 1.0};
        sensor_->set_library(std::span(&known, 1));
    }
    void open() { sensor_->open({"camera"}); }
    bool until(const std::function<bool(const Sight&)>& holds) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (std::chrono::steady_clock::now() < deadline) {
            sensor_->take();
            if (holds(sensor_->sight())) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        ADD_FAILURE() << "not reached; it says: " << sensor_->sight().text;
        return false;
    }
    bool until_said(const std::string& words) {
        return until([&](const Sight& sight) {
            return sight.state == SensorState::waiting &&
                   std::string(sight.text).find(words) != std::string::npos;
        });
    }
    bool until_seeing() {
        return until([](const Sight& sight) { return sight.state == SensorState::seeing; });
    }

    Script script_;
    std::unique_ptr<Sensor, Destroy> sensor_;  // goes before the script
};

// Images that go on, 33 ms apart.
std::function<Reading(DepthImage&)> images(double along, std::uint64_t from_us = 0) {
    return [along, time = from_us](DepthImage& image) mutable {
        image = table_image(time += 33'333, along);
        return Reading::frame;
    };
}

TEST_F(Watching, DamagedImagesAreSaidAndTheWayBackIsOpen) {
    script_.play([](DepthImage&) { return Reading::damaged; });
    open();
    EXPECT_TRUE(until_said("the camera is odd"));
    script_.play(images(0.0));
    EXPECT_TRUE(until_seeing());
    script_.play([](DepthImage&) { return Reading::damaged; });
    EXPECT_TRUE(until_said("the camera is odd")) << "also where it has seen before";
    EXPECT_GT(sensor_->sight().dropped, 1u);
    script_.play(images(0.0));
    EXPECT_TRUE(until_seeing());
}

TEST_F(Watching, OneDamagedImageAmongOthersChangesNothing) {
    script_.play([good = images(0.0), count = 0](DepthImage& image) mutable {
        return ++count % 3 == 0 ? Reading::damaged : good(image);
    });
    open();
    ASSERT_TRUE(until_seeing());
    bool kept = true;
    const auto until_dropped = [&](std::uint64_t count) {
        return until([&](const Sight& sight) {
            kept = kept && sight.state == SensorState::seeing;
            return sight.dropped > count;
        });
    };
    EXPECT_TRUE(until_dropped(20));
    // Also on a machine that is so busy that the damaged one is a second late.
    script_.play([good = images(0.0), count = 0](DepthImage& image) mutable {
        std::this_thread::sleep_for(std::chrono::milliseconds(count == 1 ? 1100 : 0));
        return ++count % 3 == 2 ? Reading::damaged : good(image);
    });
    EXPECT_TRUE(until_dropped(sensor_->sight().dropped + 2));
    EXPECT_TRUE(kept);
}

TEST_F(Watching, ACameraThatIsBackWithAnotherClockIsFollowed) {
    teach();
    script_.play(images(-0.1, 900'000'000));
    open();
    const auto stands_at = [](double along) {
        return [along](const Sight& sight) {
            return sight.objects.size() == 1 && sight.objects[0].mesh == 0 &&
                   glm::distance(sight.objects[0].pose.position, cube_at(along).position) < 0.005;
        };
    };
    ASSERT_TRUE(until(stands_at(-0.1)));
    const std::uint64_t id = sensor_->sight().objects[0].id;
    script_.play([](DepthImage&) { return Reading::lost; });
    ASSERT_TRUE(until([](const Sight& sight) { return sight.state == SensorState::opening; }));
    script_.play(images(0.05));
    EXPECT_TRUE(until(stands_at(0.05)));
    EXPECT_EQ(sensor_->sight().objects[0].id, id);
    const std::lock_guard lock(script_.mutex);
    EXPECT_GE(script_.opened, 2);
}

// A driver that throws, or gives what is no image at all.
TEST_F(Watching, AnyImageIsSurvived) {
    script_.play([](DepthImage& image) {
        image = {kinect_camera(320, 240), std::vector<std::uint16_t>(12, 900), 7};
        return Reading::frame;
    });
    open();
    EXPECT_TRUE(until_said("were announced"));
    script_.play([](DepthImage&) -> Reading { throw std::runtime_error("out of order"); });
    EXPECT_TRUE(until([](const Sight& sight) {
        return std::string(sight.text).find("out of order") != std::string::npos;
    }));
    script_.play([](DepthImage& image) {
        image = table_image(~std::uint64_t{0}, 0.0);
        return Reading::frame;
    });
    EXPECT_TRUE(until_seeing());
}

}  // namespace
}  // namespace tactus::sensor_test
