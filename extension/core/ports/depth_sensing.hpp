// The eyes: a depth camera in, known objects with their poses out. They live in a shared library of their
// own, which is loaded when a scene asks for them; this file is its whole door. Plain values cross it,
// nothing is thrown through it, and neither side frees what the other made.
//
// Threads: everything belongs to the sensor's owner. The sensor looks on a thread of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "core/math/pose.hpp"
#include "core/teleop/seen_pose.hpp"

namespace tactus {

// Both sides must have been built from the same file: another one has another number.
inline constexpr int depth_sensing_version = 5;

// The one function that the library shows: const DepthSensing* (*)(int version); null where it is of another
// version.
inline constexpr const char* depth_sensing_entry = "tactus_depth_sensing";

// A mesh that may be seen, or that the synthetic camera shows. Copied by whoever is given one.
struct MeshView {
    std::span<const Vec3> vertices;                           // (unit: meters)
    std::span<const std::array<std::uint32_t, 3>> triangles;  // counter-clockwise from outside
};

// What is found where: the mesh and its mass stand at `mesh` in the library that the sensor was given.
struct KnownMesh {
    const char* name = "";
    MeshView mesh;
    double mass = 0.0;  // (unit: kilograms)
};

struct CameraChoice {
    const char* uri = "";  // OpenNI2's name of a camera, or the path of an .oni recording; empty: the first
                           // camera that is there
    int width = 320;       // of the image, as nearly as the camera has it (unit: pixels)
    bool repeats = true;   // a recording, when it has come to its end
    bool as_fast_as_read = false;  // a recording: every frame is looked at, however long that takes
    const char* record_to = "";    // a file (.oni) that its images are written to as well; empty: none
};

struct SensorSettings {
    Pose camera;                  // in the scene; looks along its −z
    double min_confidence = 0.5;  // of an object to be told of, 0 to 1
    double max_rate = 30.0;       // frames looked at in a second; the others are dropped
    // From what a camera sees to its image, at least; less than 0: it is taken for newer (unit: seconds).
    double camera_delay = 0.0;
    bool wants_cloud = false;
    bool wants_surface = false;
    // Where the support is level at a known height, the camera's error of depth is learnt from it.
    bool knows_support = false;
    double support_height = 0.0;  // in the scene (unit: meters)
};

enum class SensorState : std::uint8_t {
    closed,
    opening,  // or waiting for the next try
    waiting,  // it is open and no frame has come yet, or none for a while
    seeing,
    ended,  // the recording is at its end
};

// cut: it is followed, and partly outside the image; hidden: something nearer stands before it.
enum class SightState : std::uint8_t { found, tracked, cut, hidden, lost };

struct SightedObject {
    std::uint64_t id = 0;    // stays while it is followed, also when it is lost for a while
    std::int32_t mesh = -1;  // in the library; −1: none of it, its hull is in `hull`
    SightState state = SightState::found;
    Pose pose;                   // in the scene
    PoseDoubt covariance;        // of the pose
    PoseDoubt chance;            // of that, what is not the same in every image
    Vec3 linear_velocity{0.0};   // (unit: meters per second)
    Vec3 angular_velocity{0.0};  // (unit: radians per second)
    bool rests = false;
    double confidence = 0.0;  // 0 to 1
    MeshView hull;
};

struct SupportPlane {
    bool is_found = false;
    Vec3 normal{0.0, 1.0, 0.0};  // in the scene
    double offset = 0.0;         // of a point p of it: dot(normal, p) (unit: meters)
    double residual = 0.0;       // root mean square of its points (unit: meters)
};

struct SensorTimes {
    double segmentation = 0.0;  // (unit: seconds)
    double objects = 0.0;       // recognition and tracking (unit: seconds)
    double frame = 0.0;         // all of it, from the camera's frame on (unit: seconds)
};

// What was seen last. All it points to stays until the next take() of the same sensor.
struct Sight {
    SensorState state = SensorState::closed;
    const char* text = "";          // what it does, or why it does not and what to do
    std::uint64_t frames = 0;       // looked at so far, since it was opened
    std::uint64_t dropped = 0;      // damaged, or come while another one was looked at
    std::uint64_t camera_time = 0;  // of this frame, on the camera's own clock (unit: microseconds)
    Nanoseconds seen_at = 0;  // on the machine's monotonic clock, as the objects are told: see camera_delay
    Pose camera;              // in the scene, as the objects and the plane were told by it
    std::span<const SightedObject> objects;
    std::span<const glm::vec3> cloud;  // in the frame of the camera (unit: meters)
    // Over what is not recognised, in the scene; from sight to sight of the same camera only its corners
    // move.
    MeshView surface;
    SupportPlane plane;
    double depth_scale = 1.0;  // true depth over told depth; 1 where the support's height is not known
    SensorTimes times;
};

class SensorPort {
public:
    // At once; the camera is opened by the sensor's thread, again and again while it is not there.
    virtual void open(const CameraChoice& choice) noexcept = 0;
    virtual void close() noexcept = 0;
    // Recognition begins anew.
    virtual void set_library(std::span<const KnownMesh> meshes) noexcept = 0;
    virtual void set_settings(const SensorSettings& settings) noexcept = 0;
    // The newest that is there: true where another frame has been seen since the last time.
    virtual bool take() noexcept = 0;
    virtual const Sight& sight() const noexcept = 0;
    // Ends its thread.
    virtual void destroy() noexcept = 0;

protected:
    ~SensorPort() = default;
};

// How far from the truth the synthetic camera is.
struct SyntheticCamera {
    int width = 320, height = 240;  // (unit: pixels)
    double field_of_view = 1.0;     // horizontal (unit: radians)
    double rate = 30.0;             // frames a second; 0: one for each show()
    double depth_error = 0.01;      // of every depth, which nobody has calibrated away
    double noise = 1.0;             // of a Kinect's; 0: none
    std::uint64_t seed = 1;
};

struct ShownBody {
    std::uint32_t mesh = 0;
    Pose pose;  // in the scene
};

// A scene that the synthetic camera looks at. It is an ordinary OpenNI2 device whose driver lies beside this
// library.
class SyntheticScene {
public:
    // For CameraChoice::uri. Empty where there is none; error() says why.
    virtual const char* uri() const noexcept = 0;
    virtual const char* error() const noexcept = 0;
    // The bodies as they stand from now on. `time`: of the frame that shows them, on the machine's monotonic
    // clock (unit: microseconds).
    virtual void show(const Pose& camera, std::span<const ShownBody> bodies, std::uint64_t time) noexcept = 0;
    // As if its plug were pulled, and put in again.
    virtual void set_plugged(bool is_plugged) noexcept = 0;
    virtual void destroy() noexcept = 0;

protected:
    ~SyntheticScene() = default;
};

struct FoundCamera {
    std::array<char, 256> uri{};
    std::array<char, 256> name{};
};

// The library.
struct DepthSensing {
    int version = depth_sensing_version;
    // Null: there is no memory or thread for it.
    SensorPort* (*make_sensor)() noexcept = nullptr;
    // At most max_shown_bodies bodies are shown.
    SyntheticScene* (*make_scene)(const SyntheticCamera& camera,
                                  std::span<const MeshView> meshes) noexcept = nullptr;
    // How many cameras there are; the first are in `into`. Below zero: OpenNI2 is not there, and `error` says
    // what to do.
    int (*scan)(std::span<FoundCamera> into, std::span<char> error) noexcept = nullptr;
};

inline constexpr std::size_t max_shown_bodies = 64;

}  // namespace tactus
