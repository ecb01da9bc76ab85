// Recordings as OpenNI2 itself makes them.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>

#include "scene.hpp"
#include "sensing/openni/camera.hpp"
#include "sensing/recording/recorded_frames.hpp"
#include "sensing/source.hpp"

namespace tactus::recording_test {
namespace {

using testing::Scene;

namespace fs = std::filesystem;

constexpr int frames_recorded = 12;

// What is left out of a frame of 320 × 240 by the recordings' codec: its last pixels.
constexpr std::size_t lost_pixels = 16;

std::vector<std::uint16_t> without_end(const DepthImage& image) {
    return {image.depth_mm.begin(), image.depth_mm.end() - lost_pixels};
}

// A device and its stream, as OpenNI2's own recorder wants them.
class Recording : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        path_ = fs::temp_directory_path() / ("tactus_recording_" + std::to_string(getpid()) + ".oni");
        record();
    }
    static void TearDownTestSuite() { fs::remove(path_); }

    static void record() {
        Scene scene;
        scene.show(1);
        Camera camera(testing::openni());
        ASSERT_EQ(camera.open({.uri = scene.uri(), .record_to = path_.string()}), "");
        DepthImage image;
        for (int i = 0; i < frames_recorded; ++i) {
            scene.move(0.005 * i);
            scene.show(frame_time(i));
            ASSERT_EQ(camera.read(image, 2000), Camera::Reading::frame);
            images_.push_back(scene.image(frame_time(i)));
        }
    }
    static std::uint64_t frame_time(int number) { return 33333u * static_cast<std::uint64_t>(number + 1); }

    static inline fs::path path_;
    static inline std::vector<DepthImage> images_;
};

// Open, and read to its end as fast as it can be.
std::unique_ptr<RecordedFrames> played(const fs::path& path, const Playback::Choice& choice) {
    auto frames = std::make_unique<RecordedFrames>();
    EXPECT_EQ(frames->open(path.string(), choice), "");
    return frames;
}

TEST_F(Recording, PlaysBackEveryFrameAndEnds) {
    const auto frames = played(path_, {.repeats = false, .as_fast_as_read = true});
    DepthImage image;
    std::size_t next = 0;
    std::optional<std::uint64_t> first;
    FrameSource::Reading last = FrameSource::Reading::frame;
    for (int i = 0; i < 100 && last != FrameSource::Reading::ended; ++i) {
        last = frames->read(image, 100);
        if (last != FrameSource::Reading::frame) {
            continue;
        }
        while (next < images_.size() && without_end(images_[next]) != without_end(image)) {
            ++next;  // the recorder may have missed the first ones
        }
        ASSERT_LT(next, images_.size()) << "a frame that was never recorded";
        // The recorder's times begin with the first image.
        if (!first) {
            first = images_[next].time_us - image.time_us;
        }
        EXPECT_EQ(image.time_us, images_[next].time_us - *first);
        EXPECT_NEAR(image.camera.focal_x, images_[next].camera.focal_x, 1e-3);
        EXPECT_NEAR(image.camera.focal_y, images_[next].camera.focal_y, 1e-3);
        ++next;
    }
    EXPECT_EQ(last, FrameSource::Reading::ended);
    EXPECT_EQ(next, images_.size());
}

TEST_F(Recording, BeginsAgainWhereItRepeats) {
    const auto frames = played(path_, {.repeats = true, .as_fast_as_read = true});
    DepthImage image;
    for (int i = 0; i < 3 * frames_recorded; ++i) {
        ASSERT_EQ(frames->read(image, 2000), FrameSource::Reading::frame) << i;
    }
}

TEST_F(Recording, WhereNoFileCanBeIsSaidSo) {
    Scene scene;
    scene.show(1);
    Camera camera(testing::openni());
    const std::string error = camera.open({.uri = scene.uri(), .record_to = "/nowhere/images.oni"});
    EXPECT_NE(error.find("cannot be recorded into '/nowhere/images.oni'"), std::string::npos) << error;
    EXPECT_EQ(camera.open({.uri = scene.uri()}), "");
}

std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

constexpr std::uintmax_t no_disk_has = std::uintmax_t{1} << 60;
constexpr std::uintmax_t written_at_least = 20'000;  // holds a frame whole
constexpr off_t filling = 512 << 20;                 // more than other programs write in between

// A folder of its own for each test.
class RecordingFiles : public ::testing::Test {
protected:
    RecordingFiles() {
        fs::create_directories(folder_);
        scene_.show(1);
    }
    ~RecordingFiles() override { fs::remove_all(folder_); }

    std::set<std::string> names() const {
        std::set<std::string> names;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
            names.insert(entry.path().filename().string());
        }
        return names;
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    // As another program does.
    void fill_disk() const {
        const int file = open(path("other").c_str(), O_CREAT | O_WRONLY, 0600);
        ASSERT_EQ(posix_fallocate(file, 0, filling), 0);
        close(file);
    }
    // OpenNI2 writes in a thread of its own, and what that has not begun when a recording ends is left out.
    void record_frames(Camera& camera, const std::string& name) {
        while (fs::file_size(path(name)) < written_at_least) {
            read_frames(camera, 1);
        }
    }
    void read_frames(Camera& camera, int count) {
        DepthImage image;
        for (int i = 1; i <= count; ++i) {
            scene_.move(0.005);
            scene_.show(33333u * static_cast<std::uint64_t>(i));
            ASSERT_EQ(camera.read(image, 2000), Camera::Reading::frame);
        }
    }

    fs::path folder_ = fs::temp_directory_path() / ("tactus_images_" + std::to_string(getpid()));
    Scene scene_;
};

TEST_F(RecordingFiles, AreNeverWrittenOver) {
    std::ofstream(path("images.oni")) << "of yesterday";
    for (const char* const name : {"images_2.oni", "images_3.oni"}) {
        Camera camera(testing::openni());
        ASSERT_EQ(camera.open({.uri = scene_.uri(), .record_to = path("images.oni")}), "");
        record_frames(camera, name);
    }
    EXPECT_EQ(content(path("images.oni")), "of yesterday");
    EXPECT_EQ(names(), (std::set<std::string>{"images.oni", "images_2.oni", "images_3.oni"}));
    RecordedFrames frames;
    EXPECT_EQ(frames.open(path("images_3.oni"), {}), "");
}

TEST_F(RecordingFiles, OfACopyAreNeverWrittenOver) {
    {
        Camera camera(testing::openni());
        ASSERT_EQ(camera.open({.uri = scene_.uri(), .record_to = path("images.oni")}), "");
        record_frames(camera, "images.oni");
    }
    std::ofstream(path("copy.oni")) << "of yesterday";
    std::string error;
    EXPECT_TRUE(open_source({.uri = path("images.oni"), .record_to = path("copy.oni")}, "", error)) << error;
    EXPECT_EQ(content(path("copy.oni")), "of yesterday");
    EXPECT_EQ(content(path("copy_2.oni")), content(path("images.oni")));
}

TEST_F(RecordingFiles, OfACameraThatIsNotThereAreNone) {
    for (int i = 0; i < 3; ++i) {
        Camera camera(testing::openni());
        EXPECT_NE(camera.open({.uri = "no camera", .record_to = path("images.oni")}), "");
    }
    EXPECT_TRUE(names().empty());
}

TEST_F(RecordingFiles, AreNotBegunOnADiskThatIsFull) {
    {
        Camera camera(testing::openni());
        const Camera::Choice choice{
            .uri = scene_.uri(), .record_to = path("images.oni"), .kept_free = no_disk_has};
        ASSERT_EQ(camera.open(choice), "");
        read_frames(camera, 4);
        EXPECT_NE(camera.remark().find("is not recorded, as its disk is nearly full"), std::string::npos)
            << camera.remark();
    }
    EXPECT_TRUE(names().empty());
}

TEST_F(RecordingFiles, EndWholeBeforeTheDiskIsFull) {
    {
        Camera camera(testing::openni());
        const std::uintmax_t free = fs::space(folder_).available;
        const Camera::Choice choice{
            .uri = scene_.uri(), .record_to = path("images.oni"), .kept_free = free - filling / 2};
        ASSERT_EQ(camera.open(choice), "");
        record_frames(camera, "images.oni");
        EXPECT_EQ(camera.remark(), "");
        fill_disk();
        read_frames(camera, 4);
        EXPECT_NE(camera.remark().find("ends here, as its disk is nearly full"), std::string::npos)
            << camera.remark();
    }
    RecordedFrames frames;
    EXPECT_EQ(frames.open(path("images.oni"), {}), "");
}

// OpenNI2 tells of no write that fails: what it wrote before is played, the program goes on.
TEST_F(RecordingFiles, OfADiskThatIsFullEndNoProgram) {
    const auto limited = [this] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{80'000, 80'000};
        setrlimit(RLIMIT_FSIZE, &limit);
        Camera camera(testing::openni());
        if (camera.open({.uri = scene_.uri(), .record_to = path("images.oni")}).empty()) {
            read_frames(camera, 40);
        }
        camera.close();
        std::_Exit(HasFailure() ? 1 : 0);
    };
    EXPECT_EXIT(limited(), ::testing::ExitedWithCode(0), "");
    EXPECT_GT(fs::file_size(path("images.oni")), 70'000u);
    RecordedFrames frames;
    const std::string error = frames.open(path("images.oni"), {});
    EXPECT_TRUE(error.empty()) << error;
}

// OpenNI2's own player, which a changed byte ends, is not to be had by the name of a file either.
TEST_F(Recording, NoFileIsPlayedByOpenNi) {
    const fs::path other = path_.string() + ".recording";
    fs::copy_file(path_, other, fs::copy_options::overwrite_existing);
    Camera camera(testing::openni());
    EXPECT_NE(camera.open({.uri = other.string()}).find("there is no camera"), std::string::npos);
    fs::remove(other);
}

TEST_F(Recording, ThatIsPlayedIsRecordedByACopy) {
    const fs::path copy = path_.string() + ".copy.oni";
    std::string error;
    ASSERT_TRUE(open_source({.uri = path_.string(), .record_to = copy.string()}, "", error)) << error;
    EXPECT_EQ(fs::file_size(copy), fs::file_size(path_));
    fs::remove(copy);
    EXPECT_FALSE(open_source({.uri = path_.string(), .record_to = "/nowhere/images.oni"}, "", error));
    EXPECT_NE(error.find("cannot be recorded into '/nowhere/images.oni'"), std::string::npos) << error;
}

// Its header is full of numbers that OpenNI2's player believes: 328 of 1,192 such files ended the program.
TEST_F(Recording, WithAnyByteOfItsHeaderChangedEndsNoProgram) {
    std::ifstream file(path_, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    const fs::path damaged = path_.string() + ".damaged.oni";
    std::ofstream(damaged, std::ios::binary) << whole;
    int played_files = 0;
    for (std::size_t at = 0; at < 620; ++at) {
        for (const char value : {'\xff', '\x80'}) {
            std::fstream change(damaged, std::ios::binary | std::ios::in | std::ios::out);
            change.seekp(static_cast<std::streamoff>(at)).put(value);
            change.close();
            RecordedFrames frames;
            const std::string error =
                frames.open(damaged.string(), {.repeats = false, .as_fast_as_read = true});
            DepthImage image;
            played_files += error.empty();
            for (int i = 0; error.empty() && i < 3; ++i) {
                frames.read(image, 0);
            }
            change.open(damaged, std::ios::binary | std::ios::in | std::ios::out);
            change.seekp(static_cast<std::streamoff>(at)).put(whole[at]);
        }
    }
    EXPECT_GT(played_files, 0);
    EXPECT_LT(played_files, 1240);
    fs::remove(damaged);
}

}  // namespace
}  // namespace tactus::recording_test
