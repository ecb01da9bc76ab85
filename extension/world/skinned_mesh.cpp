#include "world/skinned_mesh.hpp"

#include <algorithm>
#include <utility>

#include "core/mesh/same_places.hpp"

namespace tactus {

namespace {

constexpr std::uint32_t nobody = 0xffff'ffffu;

std::size_t influences_of(const SkinCollector::Surface& surface) {
    const std::size_t count = surface.corners.empty() ? 0 : surface.bones.size() / surface.corners.size();
    return surface.weights.size() == surface.bones.size() ? count : 0;
}

Vec3 along_bones(const SkinnedMesh& mesh, const SkinPose& pose, std::size_t vertex, const Vec3& place) {
    Vec3 sum(0.0);
    double all = 0.0;
    for (std::size_t i = vertex * mesh.influences; i < (vertex + 1) * mesh.influences; ++i) {
        if (const double weight = mesh.weights[i]; weight > 0.0 && mesh.bones[i] < pose.bones.size()) {
            const SceneFrame& bone = pose.bones[mesh.bones[i]];
            sum += weight * (bone.axes * place + bone.origin);
            all += weight;
        }
    }
    return all > 0.0 ? sum / all : place;
}

}  // namespace

SkinnedMesh SkinCollector::take() {
    SkinnedMesh mesh;
    std::size_t shape_count = 0;
    std::vector<Vec3> corners;
    for (const Surface& surface : surfaces_) {
        mesh.influences = std::max(mesh.influences, influences_of(surface));
        shape_count = std::max(shape_count, surface.shapes.size());
        corners.insert(corners.end(), surface.corners.begin(), surface.corners.end());
    }
    const std::vector<std::uint32_t> first = same_places(corners);
    std::vector<std::uint32_t> vertex_of(corners.size());
    mesh.shapes.resize(shape_count);
    std::size_t before = 0;
    for (const Surface& surface : surfaces_) {
        const std::size_t influences = influences_of(surface);
        for (std::size_t i = 0; i < surface.corners.size(); ++i) {
            if (first[before + i] != before + i) {
                vertex_of[before + i] = vertex_of[first[before + i]];
                continue;
            }
            vertex_of[before + i] = static_cast<std::uint32_t>(mesh.rest.vertices.size());
            mesh.rest.vertices.push_back(surface.corners[i]);
            for (std::size_t k = 0; k < mesh.influences; ++k) {
                const std::size_t at = i * influences + k;
                const bool is_one = k < influences && surface.bones[at] >= 0 && surface.bones[at] < 0xffff;
                mesh.bones.push_back(is_one ? static_cast<std::uint16_t>(surface.bones[at]) : 0);
                mesh.weights.push_back(is_one ? surface.weights[at] : 0.0F);
            }
            for (std::size_t shape = 0; shape < shape_count; ++shape) {
                const bool has_way = shape < surface.shapes.size() && i < surface.shapes[shape].size();
                mesh.shapes[shape].push_back(has_way ? surface.shapes[shape][i] : Vec3(0.0));
            }
        }
        const auto vertex = [&](std::size_t i) {
            const std::size_t corner =
                surface.indices.empty() ? i : static_cast<std::size_t>(surface.indices[i]);
            return corner < surface.corners.size() ? vertex_of[before + corner] : nobody;
        };
        const std::size_t count = surface.indices.empty() ? surface.corners.size() : surface.indices.size();
        for (std::size_t i = 0; i + 2 < count; i += 3) {
            mesh.rest.triangles.push_back({vertex(i), vertex(i + 2), vertex(i + 1)});
        }
        before += surface.corners.size();
    }
    return mesh;
}

TriangleMesh posed(const SkinnedMesh& mesh, const SkinPose& pose) {
    TriangleMesh posed = mesh.rest;
    const std::size_t shapes = std::min(mesh.shapes.size(), pose.shapes.size());
    for (std::size_t shape = 0; shape < shapes; ++shape) {
        for (std::size_t i = 0; pose.shapes[shape] != 0.0 && i < posed.vertices.size(); ++i) {
            posed.vertices[i] += pose.shapes[shape] * mesh.shapes[shape][i];
        }
    }
    for (std::size_t i = 0; i < posed.vertices.size(); ++i) {
        posed.vertices[i] =
            pose.place.axes * along_bones(mesh, pose, i, posed.vertices[i]) + pose.place.origin;
    }
    return posed;
}

std::shared_ptr<TriangleSource> source_of(std::shared_ptr<const SkinnedMesh> mesh, SkinPose pose) {
    const std::size_t count = mesh->rest.triangles.size();
    return std::make_shared<TriangleSource>(
        [mesh = std::move(mesh), pose = std::move(pose)] { return posed(*mesh, pose); }, count);
}

}  // namespace tactus
