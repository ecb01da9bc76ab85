// OpenNI2 itself runs in all of these, with the synthetic camera as one of its devices.
#include "sensing/openni/camera.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>
#include <utility>

#include "scene.hpp"

namespace tactus::camera_test {
namespace {

using testing::Scene;

namespace fs = std::filesystem;

TEST(OpenNi, LeavesNoFolderBehind) {
    testing::openni();
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::temp_directory_path())) {
        EXPECT_FALSE(entry.path().filename().string().starts_with("tactus_openni_")) << entry.path();
    }
}

TEST(OpenNi, ShowsNoCameraWhereNoneIs) {
    Camera camera(testing::openni());
    EXPECT_NE(camera.open({}).find("no depth camera is there: plug one in"), std::string::npos);
    DepthImage image;
    EXPECT_EQ(camera.read(image, 0), Camera::Reading::lost);
}

TEST(Camera, SeesThroughOpenNiWhatIsThere) {
    Scene scene;
    Camera camera(testing::openni());
    ASSERT_EQ(camera.open({scene.uri()}), "");
    const DepthImage seen = testing::frame_of(camera, scene, 12345);
    const DepthImage expected = scene.image(12345);
    EXPECT_EQ(seen.depth_mm, expected.depth_mm);
    EXPECT_EQ(seen.time_us, 12345u);
    EXPECT_EQ(seen.camera.width, expected.camera.width);
    EXPECT_EQ(seen.camera.height, expected.camera.height);
    // OpenNI2 tells angles in single precision.
    EXPECT_NEAR(seen.camera.focal_x, expected.camera.focal_x, 1e-4);
    EXPECT_NEAR(seen.camera.focal_y, expected.camera.focal_y, 1e-4);
    EXPECT_EQ(seen.camera.center_x, expected.camera.center_x);
    EXPECT_EQ(check_image(seen), "");
}

TEST(Camera, SeesWhatMoves) {
    Scene scene;
    Camera camera(testing::openni());
    ASSERT_EQ(camera.open({scene.uri()}), "");
    const DepthImage before = testing::frame_of(camera, scene, 1);
    scene.move(0.05);
    const DepthImage after = testing::frame_of(camera, scene, 2);
    EXPECT_NE(before.depth_mm, after.depth_mm);
    EXPECT_EQ(after.depth_mm, scene.image().depth_mm);
}

TEST(Camera, ShowsNoiseThatIsTheSameForTheSameSeed) {
    SyntheticCamera settings;
    settings.rate = 0.0;
    const auto seen = [&](std::uint64_t seed) {
        settings.seed = seed;
        Scene scene(settings);
        Camera camera(testing::openni());
        EXPECT_EQ(camera.open({scene.uri()}), "");
        return testing::frame_of(camera, scene, 1).depth_mm;
    };
    const std::vector<std::uint16_t> first = seen(3);
    EXPECT_EQ(first, seen(3));
    EXPECT_NE(first, seen(4));
}

// OpenNI2 itself, behind which a camera changes the size of what it gives.
struct Resized {
    OpenNi openni = testing::openni();

    Resized() {
        auto* const functions = const_cast<OpenNiFunctions*>(openni.operator->());
        functions->stream_read_frame = [](OniStreamHandle stream, OniFrame** frame) {
            const OniStatus status = testing::openni()->stream_read_frame(stream, frame);
            if (status == ONI_STATUS_OK && change_frame) {
                change_frame(**frame);
            }
            return status;
        };
        functions->stream_get_property = [](OniStreamHandle stream, int property, void* data, int* size) {
            const OniStatus status = testing::openni()->stream_get_property(stream, property, data, size);
            if (status == ONI_STATUS_OK && property == ONI_STREAM_PROPERTY_VIDEO_MODE && change_mode) {
                change_mode(*static_cast<OniVideoMode*>(data));
            }
            return status;
        };
    }
    ~Resized() {
        change_frame = nullptr;
        change_mode = nullptr;
    }

    static inline std::function<void(OniFrame&)> change_frame;
    static inline std::function<void(OniVideoMode&)> change_mode;
};

void resize(OniFrame& frame, int width, int height) {
    frame.width = frame.videoMode.resolutionX = width;
    frame.height = frame.videoMode.resolutionY = height;
}

// Reads until something has come, of a scene that is shown for it.
Camera::Reading read_shown(Camera& camera, Scene& scene, DepthImage& image, std::uint64_t time) {
    scene.show(time);
    Camera::Reading reading = Camera::Reading::nothing;
    for (int i = 0; i < 50 && reading == Camera::Reading::nothing; ++i) {
        reading = camera.read(image, 100);
    }
    return reading;
}

// Smaller ones became the top left of the image, with things where there are none.
TEST(Camera, GivesNoImageWhereFramesAreNotOfTheirSize) {
    Scene scene;
    const Resized resized;
    Camera camera(resized.openni);
    ASSERT_EQ(camera.open({scene.uri()}), "");
    const DepthImage whole = testing::frame_of(camera, scene, 1);
    const int width = whole.camera.width, height = whole.camera.height;
    std::uint64_t time = 1;
    for (const auto& [w, h] : {std::pair{width / 2, height / 2},
                               {width, height / 2},
                               {2 * width, height},
                               {2 * width, 2 * height},
                               {0, 0},
                               {-width, height}}) {
        Resized::change_frame = [w, h](OniFrame& frame) { resize(frame, w, h); };
        DepthImage image = whole;
        EXPECT_EQ(read_shown(camera, scene, image, ++time), Camera::Reading::damaged) << w << " × " << h;
        EXPECT_NE(camera.trouble().find("were announced"), std::string::npos) << camera.trouble();
        EXPECT_EQ(image.depth_mm, whole.depth_mm) << w << " × " << h;
        Resized::change_frame = nullptr;
        EXPECT_EQ(testing::frame_of(camera, scene, ++time).depth_mm, whole.depth_mm) << w << " × " << h;
        EXPECT_EQ(camera.trouble(), "");
    }
}

// As after another program has set another video mode.
TEST(Camera, FollowsASizeThatItAnnounces) {
    Scene scene;
    const Resized resized;
    Camera camera(resized.openni);
    ASSERT_EQ(camera.open({scene.uri()}), "");
    const DepthImage whole = testing::frame_of(camera, scene, 1);
    const int width = whole.camera.width / 2, height = whole.camera.height / 2;
    Resized::change_frame = [=](OniFrame& frame) { resize(frame, width, height); };
    Resized::change_mode = [=](OniVideoMode& mode) {
        mode.resolutionX = width;
        mode.resolutionY = height;
    };
    const DepthImage smaller = testing::frame_of(camera, scene, 2);
    EXPECT_EQ(smaller.camera.width, width);
    EXPECT_EQ(smaller.camera.height, height);
    EXPECT_NEAR(smaller.camera.focal_x, 0.5 * whole.camera.focal_x, 1e-6);
    EXPECT_EQ(check_image(smaller), "");
    for (const int row : {0, 7, height - 1}) {
        EXPECT_EQ(smaller.depth_mm[static_cast<std::size_t>(row * width)],
                  whole.depth_mm[static_cast<std::size_t>(row * 2 * width)])
            << row;
    }
}

TEST(Camera, KeepsItsRate) {
    SyntheticCamera settings = testing::exact_camera();
    settings.rate = 60.0;
    Scene scene(settings);
    scene.show(1);
    Camera camera(testing::openni());
    ASSERT_EQ(camera.open({scene.uri()}), "");
    DepthImage image;
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(camera.read(image, 2000), Camera::Reading::frame);
    }
}

TEST(Camera, IsLostWhenItsPlugIsPulledAndFoundAgain) {
    Scene scene;
    Camera camera(testing::openni());
    ASSERT_EQ(camera.open({scene.uri()}), "");
    testing::frame_of(camera, scene, 1);
    scene.writer().set_plug(Plug::out);
    DepthImage image;
    Camera::Reading last = Camera::Reading::nothing;
    for (int i = 0; i < 50 && last != Camera::Reading::lost; ++i) {
        last = camera.read(image, 20);
    }
    EXPECT_EQ(last, Camera::Reading::lost);
    EXPECT_NE(camera.open({scene.uri()}).find("there is no camera"), std::string::npos);
    scene.writer().set_plug(Plug::in);
    // OpenNI2 hears of it a little later.
    std::string error = "never tried";
    for (int i = 0; i < 100 && !error.empty(); ++i) {
        error = camera.open({scene.uri()});
        std::this_thread::sleep_for(std::chrono::milliseconds(error.empty() ? 0 : 10));
    }
    ASSERT_EQ(error, "");
    EXPECT_EQ(testing::frame_of(camera, scene, 2).depth_mm, scene.image().depth_mm);
}

TEST(Camera, TwoSeeTheirOwnScenes) {
    Scene one;
    Scene other;
    other.move(0.05);
    Camera first(testing::openni());
    Camera second(testing::openni());
    ASSERT_EQ(first.open({one.uri()}), "");
    ASSERT_EQ(second.open({other.uri()}), "");
    EXPECT_EQ(testing::frame_of(first, one, 1).depth_mm, one.image().depth_mm);
    EXPECT_EQ(testing::frame_of(second, other, 1).depth_mm, other.image().depth_mm);
}

// As another program writes it, here MuJoCo's renderer through tools/measuring/depth_file.py.
TEST(Camera, SeesTheImageThatAnotherRendererHasDrawn) {
    const SyntheticCamera settings = testing::exact_camera();
    const std::size_t pixels = static_cast<std::size_t>(settings.width * settings.height);
    MappedFile file;
    ASSERT_EQ(file.create("tactus_scene_", sizeof(SceneHeader) + pixels * sizeof(float)), "");
    auto* const header = new (file.bytes().data()) SceneHeader;
    header->bytes = file.bytes().size();
    header->width = settings.width;
    header->height = settings.height;
    header->field_of_view = settings.field_of_view;
    header->has_image = 1;
    header->shown = 1;
    header->time = 7;
    const std::span<float> depths(reinterpret_cast<float*>(file.bytes().data() + sizeof(SceneHeader)),
                                  pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        depths[i] = i % 5 == 0 ? 0.0f : 0.5f + 1e-3f * static_cast<float>(i % 1000);
    }
    Camera camera(testing::openni());
    ASSERT_EQ(camera.open({synthetic_scheme + file.path()}), "");
    DepthImage image;
    Camera::Reading last = Camera::Reading::nothing;
    for (int i = 0; i < 50 && last != Camera::Reading::frame; ++i) {
        last = camera.read(image, 100);
    }
    ASSERT_EQ(last, Camera::Reading::frame);
    EXPECT_EQ(image.time_us, 7u);
    ASSERT_EQ(image.depth_mm.size(), pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const long expected = i % 5 == 0 ? 0 : std::lround(1000.0f * depths[i]);
        ASSERT_EQ(static_cast<long>(image.depth_mm[i]), expected) << i;
    }
    header->plug = Plug::gone;
}

TEST(Camera, RefusesASceneThatIsDamaged) {
    const fs::path damaged = fs::temp_directory_path() / "tactus_damaged_scene";
    const std::string path = Scene().uri().substr(std::string(synthetic_scheme).size());
    Scene scene;
    const std::string whole = scene.uri().substr(std::string(synthetic_scheme).size());
    for (const std::uintmax_t bytes : {0u, 7u, 100u, 6000u}) {
        fs::copy_file(whole, damaged, fs::copy_options::overwrite_existing);
        fs::resize_file(damaged, std::min(bytes, fs::file_size(whole) - 1));
        Camera camera(testing::openni());
        const std::string error = camera.open({synthetic_scheme + damaged.string()});
        EXPECT_NE(error.find("there is no camera"), std::string::npos) << bytes << ": " << error;
    }
    fs::remove(damaged);
    Camera camera(testing::openni());
    EXPECT_NE(camera.open({synthetic_scheme + path}).find("No such file"), std::string::npos);
}

}  // namespace
}  // namespace tactus::camera_test
