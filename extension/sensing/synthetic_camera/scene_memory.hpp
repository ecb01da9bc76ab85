// The scene that a synthetic camera looks at, in a file that whoever has the scene writes and the camera's
// driver reads while it is being written. Both map it into their memory.
//
// Layout: SceneHeader, with `has_image` an image, then for every mesh a MeshHeader, its vertices (3 doubles
// each) and its triangles (3 indices each). All but what is marked "changes" is written before the file has
// its name. What changes is guarded by `sequence`: odd while it is written, another even number afterwards.
//
// An image is what another renderer has drawn: for each pixel, by rows from the top, its exact depth along
// the camera's axis (floats, unit: meters); what is not above 0 is nothing. It changes, and is seen in place
// of the bodies. tools/measuring/depth_file.py writes such files.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "core/ports/depth_sensing.hpp"
#include "platform/mapped_file.hpp"

namespace tactus {

inline constexpr const char* synthetic_scheme = "tactus-scene:";

struct PlainPose {
    std::array<double, 3> position{};     // (unit: meters)
    std::array<double, 4> rotation{1.0};  // w, x, y, z
};

struct PlainBody {
    std::uint32_t mesh = 0;
    std::uint32_t padding = 0;
    PlainPose pose;
};

enum class Plug : std::uint32_t {
    in,
    out,
    gone,  // for ever: nobody has this scene any more
};

struct SceneHeader {
    static constexpr std::uint64_t expected_magic = 0x32656e6563537354;  // "TsScene2"

    std::uint64_t magic = expected_magic;
    std::uint64_t bytes = 0;  // of the whole file
    std::int32_t width = 0, height = 0;
    double field_of_view = 0.0, rate = 0.0, depth_error = 0.0, noise = 0.0;
    std::uint64_t seed = 0;
    std::uint32_t mesh_count = 0;
    std::uint32_t has_image = 0;  // 0 or 1

    // changes:
    std::atomic<std::uint32_t> sequence{0};
    std::uint32_t shown = 0;  // how often show() has been called
    Plug plug = Plug::in;
    std::uint32_t body_count = 0;
    std::uint64_t time = 0;  // (unit: microseconds)
    PlainPose camera;
    PlainBody bodies[max_shown_bodies];
};
// As programs in other languages have it.
static_assert(offsetof(SceneHeader, sequence) == 72 && offsetof(SceneHeader, time) == 88);
static_assert(sizeof(SceneHeader) == 152 + max_shown_bodies * sizeof(PlainBody));

struct MeshHeader {
    std::uint32_t vertex_count = 0;
    std::uint32_t triangle_count = 0;
};

// What one frame shows.
struct SceneState {
    std::uint32_t shown = 0;
    Plug plug = Plug::in;
    std::uint64_t time = 0;  // (unit: microseconds)
    Pose camera;
    std::vector<ShownBody> bodies;
    std::vector<float> image;  // empty: the bodies are drawn
};

// For whoever has the scene: one thread.
class SceneWriter {
public:
    // Throws std::runtime_error.
    SceneWriter(const SyntheticCamera& camera, std::span<const MeshView> meshes);
    ~SceneWriter() { set_plug(Plug::gone); }

    std::string uri() const { return synthetic_scheme + file_.path(); }
    void show(const Pose& camera, std::span<const ShownBody> bodies, std::uint64_t time);
    void set_plug(Plug plug);

private:
    template <class Change>
    void change(const Change& change);

    MappedFile file_;
    SceneHeader* header_ = nullptr;
};

// For the driver. What does not make sense is refused when it is opened; what is torn is read again.
class SceneReader {
public:
    // Throws std::runtime_error.
    explicit SceneReader(const std::string& uri);

    const SyntheticCamera& camera() const { return camera_; }
    const std::vector<TriangleMesh>& meshes() const { return meshes_; }
    // False where somebody writes all the time.
    bool read(SceneState& state) const;

private:
    MappedFile file_;
    const SceneHeader* header_ = nullptr;
    SyntheticCamera camera_;
    std::span<const float> image_;  // empty: there is none
    std::vector<TriangleMesh> meshes_;
};

}  // namespace tactus
