// Things on a table before a depth camera, seeded, for tests and benches of sensing/.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sensing/discovery/learnt_mesh.hpp"
#include "sensing/image/depth_noise.hpp"
#include "sensing/image/depth_renderer.hpp"

namespace tactus::shared {

// Which turns of a mesh look the same.
enum class MeshSymmetry { none, cube, axis, full };  // axis: any turn about y, and upside down

MeshSymmetry symmetry_of(const std::string& name);

// meshes/NAME.obj of the project the program runs in, with the masses of library.json left out; a program
// that runs elsewhere ends with a message.
std::vector<LibraryMesh> library_meshes(const std::vector<std::string>& names);

// cube, icosphere, torus, blob, cylinder, bracket
const std::vector<std::string>& six_meshes();

struct SceneObject {
    std::size_t mesh = 0;  // index in the library
    Pose pose;             // in the world
};

// The table's top is the plane y = 0.
struct DepthScene {
    DepthCamera camera;
    Pose camera_pose;  // in the world
    std::vector<SceneObject> objects;
};

struct SceneChoice {
    double distance = 0.85;  // of the camera from the middle of the table (unit: meters)
    int objects = 3;
    double held = 0.25;          // share of objects that are held over the table, turned anyhow
    double least_visible = 0.5;  // share of each object that no other one hides
    int width = 320, height = 240;
};

// Objects that do not touch each other, rest on the table or are held over it, and are seen as far as the
// choice says.
DepthScene random_scene(const std::vector<LibraryMesh>& library, const SceneChoice& choice,
                        std::uint64_t seed);

// The object turned as it may lie, at any place above the origin; `held`: turned anyhow.
Pose resting_pose(const LibraryMesh& mesh, bool held, std::uint64_t seed);

// A camera at `distance` from the middle of the table, `elevation` above it (unit: radians).
Pose camera_above_table(double distance, double elevation);

// All that the camera sees: objects are numbered as in the scene, the table has the number after the last.
void draw_scene(const std::vector<LibraryMesh>& library, const DepthScene& scene, DepthBuffer& buffer);

struct PoseError {
    double position = 0.0;  // (unit: meters)
    double angle = 0.0;     // (unit: radians)
};
PoseError pose_error(MeshSymmetry symmetry, const Pose& truth, const Pose& found);

}  // namespace tactus::shared
