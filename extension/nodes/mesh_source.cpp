#include "nodes/mesh_source.hpp"

#include <algorithm>
#include <atomic>
#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/primitive_mesh.hpp>
#include <godot_cpp/variant/array.hpp>

#include "core/geometry/mesh_check.hpp"
#include "nodes/mesh_reading.hpp"
#include "realtime/workers.hpp"

namespace tactus {

using namespace godot;

namespace {

// The tree that is touched now, the one before, on the way from which the loop may still be, and one that it
// has let go of: more would only be kept for nothing.
constexpr std::size_t most_former_trees = 3;

bool is_of_triangles(const Ref<Mesh>& mesh) {
    if (Object::cast_to<PrimitiveMesh>(mesh.ptr()) != nullptr) {
        return mesh->get_class() != "PointMesh";
    }
    const auto* arrays = Object::cast_to<ArrayMesh>(mesh.ptr());
    for (int32_t i = 0; arrays != nullptr && i < mesh->get_surface_count(); ++i) {
        if (arrays->surface_get_primitive_type(i) != Mesh::PRIMITIVE_TRIANGLES) {
            return false;
        }
    }
    return arrays != nullptr;
}

}  // namespace

// Godot's get_faces() knows strips, too, but builds a tree of its own: for a large mesh that takes seconds.
MeshSource::MeshSource(const Ref<Mesh>& mesh) {
    if (!is_of_triangles(mesh)) {
        add_surface({mesh->get_faces(), PackedInt32Array(), {}});
        return;
    }
    for (int32_t i = 0; i < mesh->get_surface_count(); ++i) {
        if (std::optional<SurfaceBytes> bytes = SurfaceBytes::take(mesh, i)) {
            add_surface({{}, {}, std::move(bytes)});
        } else {
            const Array surface = mesh->surface_get_arrays(i);
            add_surface({surface[Mesh::ARRAY_VERTEX], surface[Mesh::ARRAY_INDEX], {}});
        }
    }
}

MeshSource::MeshSource(const PackedVector3Array& faces) {
    add_surface({faces, PackedInt32Array(), {}});
}

MeshSource::MeshSource(Checked checked) : is_checked_(true), checked_(std::move(checked)) {
    triangle_count_ = checked_.mesh != nullptr ? checked_.mesh->triangles.size() : 0;
}

void MeshSource::add_surface(Surface surface) {
    const int64_t listed = surface.bytes ? surface.bytes->corner_count() : surface.corners.size();
    const int64_t named = surface.bytes ? surface.bytes->index_count() : surface.indices.size();
    const int64_t corners = named == 0 ? listed : named;
    triangle_count_ += static_cast<std::size_t>(corners / 3);
    surfaces_.push_back(std::move(surface));
}

bool MeshSource::has_faces(const PackedVector3Array& faces) const {
    if (surfaces_.size() != 1 || surfaces_.front().corners.size() != faces.size()) {
        return false;
    }
    const PackedVector3Array& own = surfaces_.front().corners;
    return own.ptr() == faces.ptr() || std::equal(own.ptr(), own.ptr() + own.size(), faces.ptr());
}

void MeshSource::succeed(MeshSource& before) {
    const std::unique_lock lock(before.mutex_, std::try_to_lock);
    if (!lock.owns_lock()) {
        return;  // it is still being built: waiting would take as long as building anew
    }
    former_ = std::move(before.former_);
    for (const Kept& kept : before.kept_) {
        if (std::shared_ptr<TriangleTree> tree = kept.tree.lock()) {
            former_.push_back({kept.scaling, kept.mesh, std::move(tree)});
        }
    }
    if (former_.size() > most_former_trees) {
        former_.erase(former_.begin(), former_.end() - most_former_trees);
    }
}

const MeshSource::Checked& MeshSource::triangles() {
    const std::lock_guard lock(mutex_);
    if (is_checked_) {
        return checked_;
    }
    is_checked_ = true;
    MeshCollector collector;
    for (const Surface& surface : surfaces_) {
        surface.bytes ? collector.add(surface.bytes->corners(), surface.bytes->indices())
                      : collector.add(surface.corners, surface.indices);
    }
    const auto mesh = Workers::freed_aside(collector.take());
    checked_.error = check_mesh(*mesh);
    checked_.mesh = checked_.error.empty() ? mesh : nullptr;
    return checked_;
}

// Where the corners alone have moved, the tree keeps its form. One that only we hold is of no body any more
// and serves again; else a new one is made beside it, and bodies are swept along the way from one to the
// other.
std::shared_ptr<TriangleTree> MeshSource::refitted(const Basis& scaling, const TriangleMesh& mesh,
                                                   const ParallelRunner& run) {
    std::erase_if(former_, [&](const Former& former) {
        return former.scaling == scaling && (former.mesh->vertices.size() != mesh.vertices.size() ||
                                             former.mesh->triangles != mesh.triangles);
    });
    const auto is_like = [&](const Former& former) { return former.scaling == scaling; };
    const auto free = std::ranges::find_if(
        former_, [&](const Former& former) { return is_like(former) && former.tree.use_count() == 1; });
    if (free == former_.end()) {
        const auto touched = std::ranges::find_if(former_, is_like);
        return touched == former_.end() ? nullptr
                                        : std::make_shared<TriangleTree>(touched->tree->refitted(mesh, run));
    }
    std::atomic_thread_fence(std::memory_order_acquire);  // use_count() is relaxed
    std::shared_ptr<TriangleTree> tree = std::move(free->tree);
    former_.erase(free);
    tree->refit(mesh, run);
    return tree;
}

BuiltMesh MeshSource::built(const Basis& scaling, const ParallelRunner& run) {
    const std::lock_guard lock(mutex_);
    std::erase_if(kept_, [](const Kept& kept) { return kept.tree.expired(); });
    for (const Kept& kept : kept_) {
        if (std::shared_ptr<TriangleTree> tree = kept.tree.lock();
            tree != nullptr && kept.scaling == scaling) {
            return {kept.mesh, std::move(tree)};
        }
    }
    const std::shared_ptr<const TriangleMesh> whole = triangles().mesh;
    const auto mesh = scaling == Basis() ? whole : Workers::freed_aside(scaled(*whole, scaling));
    std::shared_ptr<TriangleTree> tree = refitted(scaling, *mesh, run);
    if (tree == nullptr) {
        tree = Workers::freed_aside(TriangleTree::build(*mesh, run));
    }
    kept_.push_back({scaling, mesh, tree});
    return {mesh, std::move(tree)};
}

}  // namespace tactus
