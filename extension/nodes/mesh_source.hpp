// The triangles of one Godot mesh, and the trees over them: read once, built once for each scale, shared by
// every body that is made of them.
//
// Threads: made on the main thread, which only copies what Godot has; triangles() and built() do the work and
// may be called by any thread. Godot's packed arrays are shared, counted and never written to here.
#pragma once

#include <array>
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/basis.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/touch_shape.hpp"
#include "nodes/surface_bytes.hpp"

namespace tactus {

// A mesh at one scale, ready to be touched.
struct BuiltMesh {
    std::shared_ptr<const TriangleMesh> mesh;
    std::shared_ptr<const TriangleTree> tree;
};

class MeshSource {
public:
    struct Checked {
        std::shared_ptr<const TriangleMesh> mesh;  // null where there is an error
        std::string error;                         // what is wrong and what to do
    };

    explicit MeshSource(const godot::Ref<godot::Mesh>& mesh);
    explicit MeshSource(const godot::PackedVector3Array& faces);
    explicit MeshSource(Checked checked);  // read elsewhere

    // The same mesh with its corners elsewhere: trees that nobody touches any more are refitted, not rebuilt.
    void succeed(MeshSource& before);

    // About, before anything is built.
    std::size_t triangle_count() const { return triangle_count_; }
    bool has_faces(const godot::PackedVector3Array& faces) const;

    const Checked& triangles();
    // Of sound triangles only.
    BuiltMesh built(const godot::Basis& scaling, const ParallelRunner& run);

private:
    struct Surface {
        godot::PackedVector3Array corners;
        godot::PackedInt32Array indices;    // into corners; empty: each corner in turn
        std::optional<SurfaceBytes> bytes;  // instead of both
    };
    // One scale. The tree is weakly held: it lives as long as a body is made of it.
    struct Kept {
        godot::Basis scaling;
        std::shared_ptr<const TriangleMesh> mesh;
        std::weak_ptr<TriangleTree> tree;
    };
    // A tree over these triangles as they were before.
    struct Former {
        godot::Basis scaling;
        std::shared_ptr<const TriangleMesh> mesh;
        std::shared_ptr<TriangleTree> tree;
    };

    void add_surface(Surface surface);
    std::shared_ptr<TriangleTree> refitted(const godot::Basis& scaling, const TriangleMesh& mesh,
                                           const ParallelRunner& run);

    std::vector<Surface> surfaces_;
    std::size_t triangle_count_ = 0;
    std::recursive_mutex mutex_;  // of all below: who comes second waits and shares
    bool is_checked_ = false;
    Checked checked_;
    std::vector<Kept> kept_;
    std::vector<Former> former_;
};

}  // namespace tactus
