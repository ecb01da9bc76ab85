#include "shared/depth_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include "core/mesh/obj_text.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

constexpr double table_half = 0.9;  // (unit: meters)

TriangleMesh table() {
    constexpr double h = table_half;
    return {{{-h, 0.0, -h}, {-h, 0.0, h}, {h, 0.0, h}, {h, 0.0, -h}}, {{0, 1, 2}, {0, 2, 3}}};
}

Quat about(const Vec3& axis, double angle) {
    return glm::angleAxis(angle, axis);
}

// Turns the face that looks along `down` in the mesh's frame to the table.
Quat standing_on(const Vec3& down) {
    const Vec3 to(0.0, -1.0, 0.0);
    const double cosine = glm::dot(down, to);
    if (cosine < -0.999999) {
        return about({1.0, 0.0, 0.0}, std::numbers::pi);
    }
    const Vec3 across = glm::cross(down, to);
    return glm::normalize(Quat(1.0 + cosine, across.x, across.y, across.z));
}

// A face that a mesh can lie on.
Vec3 resting_face(const std::string& name, RandomValues& random) {
    const Vec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
    if (name == "torus") {
        return random.flip() ? y : -y;
    }
    if (name == "cylinder") {
        const double around = random.between(0.0, 2.0 * std::numbers::pi);
        const Vec3 side(std::cos(around), 0.0, std::sin(around));
        return random.flip() ? side : (random.flip() ? y : -y);
    }
    if (name == "bracket") {
        const Vec3 faces[] = {-y, -x, z, -z};
        return faces[random.below(4)];
    }
    if (name == "cube" || name == "wedge") {
        const Vec3 faces[] = {-y, x, z, -z};
        return faces[random.below(4)];
    }
    return random.direction();
}

double lowest(const TriangleMesh& mesh, const Quat& rotation) {
    double low = std::numeric_limits<double>::infinity();
    for (const Vec3& vertex : mesh.vertices) {
        low = std::min(low, (rotation * vertex).y);
    }
    return low;
}

double radius_of(const TriangleMesh& mesh) {
    double squared = 0.0;
    for (const Vec3& vertex : mesh.vertices) {
        squared = std::max(squared, glm::dot(vertex, vertex));
    }
    return std::sqrt(squared);
}

std::vector<int> pixels_of(const DepthBuffer& buffer, std::size_t objects) {
    std::vector<int> counts(objects, 0);
    for (const std::uint16_t seen : buffer.seen) {
        if (seen < objects) {
            ++counts[seen];
        }
    }
    return counts;
}

bool are_visible(const std::vector<LibraryMesh>& library, const DepthScene& scene, double least) {
    DepthBuffer buffer;
    draw_scene(library, scene, buffer);
    const std::vector<int> together = pixels_of(buffer, scene.objects.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        DepthScene alone = scene;
        alone.objects = {scene.objects[i]};
        draw_scene(library, alone, buffer);
        const int whole = pixels_of(buffer, 1)[0];
        if (whole == 0 || together[i] < least * whole) {
            return false;
        }
    }
    return true;
}

bool is_free(const std::vector<LibraryMesh>& library, const std::vector<SceneObject>& others,
             const SceneObject& one) {
    return std::ranges::none_of(others, [&](const SceneObject& other) {
        const double apart = glm::length(other.pose.position - one.pose.position);
        return apart < radius_of(library[other.mesh].mesh) + radius_of(library[one.mesh].mesh);
    });
}

double turned_by(const Quat& turn) {
    return 2.0 * std::atan2(glm::length(Vec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
}

// The smallest turn to any of the 24 that carry a cube onto itself.
double turned_by_modulo_cube(const Quat& turn) {
    double least = std::numeric_limits<double>::infinity();
    const Vec3 axes[] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    const Quat faces[] = {{1.0, 0.0, 0.0, 0.0},
                          about(axes[0], 0.5 * std::numbers::pi),
                          about(axes[0], std::numbers::pi),
                          about(axes[0], -0.5 * std::numbers::pi),
                          about(axes[2], 0.5 * std::numbers::pi),
                          about(axes[2], -0.5 * std::numbers::pi)};
    for (const Quat& face : faces) {
        for (int quarter = 0; quarter < 4; ++quarter) {
            least =
                std::min(least, turned_by(turn * face * about(axes[1], 0.5 * std::numbers::pi * quarter)));
        }
    }
    return least;
}

}  // namespace

MeshSymmetry symmetry_of(const std::string& name) {
    if (name == "icosphere") {
        return MeshSymmetry::full;
    }
    if (name == "torus" || name == "cylinder") {
        return MeshSymmetry::axis;
    }
    return name == "cube" ? MeshSymmetry::cube : MeshSymmetry::none;
}

std::vector<LibraryMesh> library_meshes(const std::vector<std::string>& names) {
    std::vector<LibraryMesh> library;
    for (const std::string& name : names) {
        std::ifstream file("meshes/" + name + ".obj");
        std::stringstream text;
        text << file.rdbuf();
        ObjResult read = read_obj_text(text.str());
        if (!file || !read.error.empty() || read.mesh.triangles.empty()) {
            std::fprintf(stderr, "meshes/%s.obj cannot be read: run this in the project's folder\n",
                         name.c_str());
            std::exit(2);
        }
        library.push_back({name, std::move(read.mesh), 0.0});
    }
    return library;
}

const std::vector<std::string>& six_meshes() {
    static const std::vector<std::string> names{"cube", "icosphere", "torus", "blob", "cylinder", "bracket"};
    return names;
}

Pose resting_pose(const LibraryMesh& mesh, bool held, std::uint64_t seed) {
    RandomValues random(seed);
    const Quat yaw = about({0.0, 1.0, 0.0}, random.between(0.0, 2.0 * std::numbers::pi));
    const Quat rotation =
        glm::normalize(held ? random.rotation() : yaw * standing_on(resting_face(mesh.name, random)));
    const double over = held ? random.between(0.005, 0.08) : 0.0;
    return {{0.0, over - lowest(mesh.mesh, rotation), 0.0}, rotation};
}

Pose camera_above_table(double distance, double elevation) {
    const Vec3 place(0.0, distance * std::sin(elevation), distance * std::cos(elevation));
    return {place, about({1.0, 0.0, 0.0}, -elevation)};
}

DepthScene random_scene(const std::vector<LibraryMesh>& library, const SceneChoice& choice,
                        std::uint64_t seed) {
    RandomValues random(seed);
    DepthScene scene;
    scene.camera = kinect_camera(choice.width, choice.height);
    do {
        scene.camera_pose = camera_above_table(choice.distance, random.between(0.6, 1.1));
        scene.objects.clear();
        while (scene.objects.size() < static_cast<std::size_t>(choice.objects)) {
            SceneObject one;
            one.mesh = static_cast<std::size_t>(random.below(static_cast<int>(library.size())));
            one.pose = resting_pose(library[one.mesh], random.unit() < choice.held,
                                    seed * 1000 + static_cast<std::uint64_t>(random.below(1'000'000)));
            one.pose.position += Vec3(random.between(-0.24, 0.24), 0.0, random.between(-0.15, 0.15));
            if (is_free(library, scene.objects, one)) {
                scene.objects.push_back(one);
            } else if (random.below(50) == 0) {
                scene.objects.clear();
            }
        }
    } while (!are_visible(library, scene, choice.least_visible));
    return scene;
}

void draw_scene(const std::vector<LibraryMesh>& library, const DepthScene& scene, DepthBuffer& buffer) {
    static const TriangleMesh ground = table();
    const Pose to_camera = inverse(scene.camera_pose);
    std::vector<PosedMesh> meshes;
    for (const SceneObject& object : scene.objects) {
        meshes.push_back({&library[object.mesh].mesh, compose(to_camera, object.pose)});
    }
    meshes.push_back({&ground, to_camera});
    DepthRenderer().render(scene.camera, meshes, buffer);
}

PoseError pose_error(MeshSymmetry symmetry, const Pose& truth, const Pose& found) {
    const double position = glm::length(found.position - truth.position);
    const Quat turn = glm::conjugate(truth.rotation) * found.rotation;
    switch (symmetry) {
        case MeshSymmetry::full:
            return {position, 0.0};
        case MeshSymmetry::cube:
            return {position, turned_by_modulo_cube(turn)};
        case MeshSymmetry::axis: {
            const double cosine = std::abs((turn * Vec3(0.0, 1.0, 0.0)).y);
            return {position, std::acos(std::min(1.0, cosine))};
        }
        case MeshSymmetry::none:
            break;
    }
    return {position, turned_by(turn)};
}

}  // namespace tactus::shared
