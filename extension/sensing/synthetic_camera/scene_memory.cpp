#include "sensing/synthetic_camera/scene_memory.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>

namespace tactus {

namespace {

void require(const std::string& error) {
    if (!error.empty()) {
        throw std::runtime_error(error);
    }
}

PlainPose plain(const Pose& pose) {
    const Quat& turn = pose.rotation;
    return {{pose.position.x, pose.position.y, pose.position.z}, {turn.w, turn.x, turn.y, turn.z}};
}

Pose pose_of(const PlainPose& plain) {
    const auto& [w, x, y, z] = plain.rotation;
    return {{plain.position[0], plain.position[1], plain.position[2]}, Quat(w, x, y, z)};
}

std::size_t bytes_of(const MeshView& mesh) {
    return sizeof(MeshHeader) + mesh.vertices.size_bytes() + mesh.triangles.size_bytes();
}

// Rounded up, so that the next mesh's numbers lie where they may.
std::size_t aligned(std::size_t bytes) {
    return (bytes + 7) / 8 * 8;
}

std::size_t bytes_of(std::span<const MeshView> meshes) {
    std::size_t bytes = aligned(sizeof(SceneHeader));
    for (const MeshView& mesh : meshes) {
        bytes += aligned(bytes_of(mesh));
    }
    return bytes;
}

void write_mesh(const MeshView& mesh, std::byte* to) {
    const MeshHeader header{static_cast<std::uint32_t>(mesh.vertices.size()),
                            static_cast<std::uint32_t>(mesh.triangles.size())};
    std::memcpy(to, &header, sizeof header);
    std::memcpy(to + sizeof header, mesh.vertices.data(), mesh.vertices.size_bytes());
    std::memcpy(to + sizeof header + mesh.vertices.size_bytes(), mesh.triangles.data(),
                mesh.triangles.size_bytes());
}

// Takes the next part of a file, as far as there is one.
class Cursor {
public:
    explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}

    std::span<const std::byte> take(std::size_t bytes) {
        if (bytes > rest_.size()) {
            throw std::runtime_error("the scene's file is cut off");
        }
        const std::span<const std::byte> taken = rest_.first(bytes);
        rest_ = rest_.subspan(bytes);
        return taken;
    }

private:
    std::span<const std::byte> rest_;
};

TriangleMesh read_mesh(Cursor& cursor) {
    MeshHeader header;
    std::memcpy(&header, cursor.take(sizeof header).data(), sizeof header);
    const std::size_t vertex_bytes = std::size_t{header.vertex_count} * sizeof(Vec3);
    const std::size_t triangle_bytes = std::size_t{header.triangle_count} * 3 * sizeof(std::uint32_t);
    const std::span<const std::byte> vertices = cursor.take(vertex_bytes);
    const std::span<const std::byte> triangles = cursor.take(triangle_bytes);
    const std::size_t used = sizeof header + vertex_bytes + triangle_bytes;
    cursor.take(aligned(used) - used);
    TriangleMesh mesh{std::vector<Vec3>(header.vertex_count),
                      std::vector<std::array<std::uint32_t, 3>>(header.triangle_count)};
    std::memcpy(mesh.vertices.data(), vertices.data(), vertex_bytes);
    std::memcpy(mesh.triangles.data(), triangles.data(), triangle_bytes);
    for (const auto& triangle : mesh.triangles) {
        if (*std::max_element(triangle.begin(), triangle.end()) >= header.vertex_count) {
            throw std::runtime_error("a triangle of the scene's file names a corner that is not there");
        }
    }
    return mesh;
}

bool is_sound(const SceneHeader& header, std::size_t bytes) {
    return header.magic == SceneHeader::expected_magic && header.bytes == bytes && header.width >= 16 &&
           header.height >= 16 && header.width <= 1280 && header.height <= 1024 &&
           header.field_of_view > 0.1 && header.field_of_view < 3.0 && header.rate >= 0.0 &&
           header.rate <= 240.0 && std::abs(header.depth_error) < 0.5 && header.noise >= 0.0 &&
           header.noise <= 100.0 && header.has_image <= 1;
}

std::string path_of(const std::string& uri) {
    if (!uri.starts_with(synthetic_scheme)) {
        throw std::runtime_error("not the name of a synthetic camera: " + uri);
    }
    return uri.substr(std::strlen(synthetic_scheme));
}

}  // namespace

SceneWriter::SceneWriter(const SyntheticCamera& camera, std::span<const MeshView> meshes) {
    require(file_.create("tactus_scene_", bytes_of(meshes)));
    header_ = new (file_.bytes().data()) SceneHeader;
    header_->bytes = file_.bytes().size();
    header_->width = camera.width;
    header_->height = camera.height;
    header_->field_of_view = camera.field_of_view;
    header_->rate = camera.rate;
    header_->depth_error = camera.depth_error;
    header_->noise = camera.noise;
    header_->seed = camera.seed;
    header_->mesh_count = static_cast<std::uint32_t>(meshes.size());
    std::byte* to = file_.bytes().data() + aligned(sizeof(SceneHeader));
    for (const MeshView& mesh : meshes) {
        write_mesh(mesh, to);
        to += aligned(bytes_of(mesh));
    }
}

template <class Change>
void SceneWriter::change(const Change& change) {
    const std::uint32_t before = header_->sequence.load(std::memory_order_relaxed);
    header_->sequence.store(before + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    change();
    header_->sequence.store(before + 2, std::memory_order_release);
}

void SceneWriter::show(const Pose& camera, std::span<const ShownBody> bodies, std::uint64_t time) {
    const std::span<const ShownBody> shown = bodies.first(std::min(bodies.size(), max_shown_bodies));
    change([&] {
        ++header_->shown;
        header_->time = time;
        header_->camera = plain(camera);
        header_->body_count = static_cast<std::uint32_t>(shown.size());
        for (std::size_t i = 0; i < shown.size(); ++i) {
            header_->bodies[i] = {shown[i].mesh, 0, plain(shown[i].pose)};
        }
    });
}

void SceneWriter::set_plug(Plug plug) {
    change([&] { header_->plug = plug; });
}

SceneReader::SceneReader(const std::string& uri) {
    require(file_.open(path_of(uri)));
    const std::size_t bytes = file_.bytes().size();
    header_ = reinterpret_cast<const SceneHeader*>(file_.bytes().data());
    if (bytes < sizeof(SceneHeader) || !is_sound(*header_, bytes)) {
        throw std::runtime_error("not the file of a scene, or of another version: " + file_.path());
    }
    camera_ = {header_->width,       header_->height, header_->field_of_view, header_->rate,
               header_->depth_error, header_->noise,  header_->seed};
    Cursor cursor(file_.bytes());
    cursor.take(aligned(sizeof(SceneHeader)));
    if (header_->has_image != 0) {
        const std::size_t pixels =
            static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
        const std::size_t image_bytes = pixels * sizeof(float);
        image_ = {reinterpret_cast<const float*>(cursor.take(aligned(image_bytes)).data()), pixels};
    }
    for (std::uint32_t i = 0; i < header_->mesh_count; ++i) {
        meshes_.push_back(read_mesh(cursor));
    }
}

bool SceneReader::read(SceneState& state) const {
    // The writer needs a microsecond.
    constexpr int max_tries = 1000;
    for (int i = 0; i < max_tries; ++i) {
        const std::uint32_t before = header_->sequence.load(std::memory_order_acquire);
        if (before % 2 != 0) {
            continue;
        }
        state.shown = header_->shown;
        state.plug = header_->plug;
        state.time = header_->time;
        state.camera = pose_of(header_->camera);
        state.bodies.clear();
        const std::size_t count = std::min<std::size_t>(header_->body_count, max_shown_bodies);
        for (std::size_t body = 0; body < count; ++body) {
            const PlainBody& shown = header_->bodies[body];
            if (shown.mesh < meshes_.size()) {
                state.bodies.push_back({shown.mesh, pose_of(shown.pose)});
            }
        }
        state.image.assign(image_.begin(), image_.end());
        std::atomic_thread_fence(std::memory_order_acquire);
        if (header_->sequence.load(std::memory_order_relaxed) == before) {
            return true;
        }
    }
    return false;
}

}  // namespace tactus
