// The triangles of one surface as Godot keeps them: taken on the main thread as bytes, which copies little,
// and decoded by whoever builds with them. Mesh::surface_get_arrays() does both at once, 100 ms for two
// million triangles.
#pragma once

#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/variant/aabb.hpp>
#include <godot_cpp/variant/packed_byte_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <optional>

namespace tactus {

class SurfaceBytes {
public:
    // Main thread. Nothing where the surface is not laid out as known here.
    static std::optional<SurfaceBytes> take(const godot::Ref<godot::Mesh>& mesh, int surface);

    std::int64_t corner_count() const { return corner_count_; }
    std::int64_t index_count() const { return index_count_; }

    // Any thread.
    godot::PackedVector3Array corners() const;
    godot::PackedInt32Array indices() const;  // empty: each corner in turn

private:
    godot::PackedByteArray corner_bytes_;
    godot::PackedByteArray index_bytes_;
    std::int64_t corner_count_ = 0;
    std::int64_t index_count_ = 0;
    bool compressed_ = false;
    godot::AABB box_;  // that compressed corners are relative to
};

}  // namespace tactus
