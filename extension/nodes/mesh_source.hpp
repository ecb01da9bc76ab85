// Godot's meshes as sources of triangles (world/triangle_source.hpp). Main thread, which only copies what
// Godot has; whoever asks for the triangles reads them. Godot's packed arrays are shared, counted and never
// written to here.
#pragma once

#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <memory>
#include <optional>

#include "world/surface_feels.hpp"
#include "world/triangle_source.hpp"

namespace tactus {

// The corners of a surface's triangles, three a triangle; those of a strip are taken apart.
struct SurfaceCorners {
    godot::PackedVector3Array corners;
    godot::PackedInt32Array indices;  // none: each corner in turn
    godot::PackedVector2Array uv;
};
// Nothing of points and lines, which have no triangles.
std::optional<SurfaceCorners> corners_of(const godot::Ref<godot::Mesh>& mesh, int surface);

std::shared_ptr<TriangleSource> source_of(const godot::Ref<godot::Mesh>& mesh);
// Of its triangles as source_of() reads them; null where it has none of these parts.
std::shared_ptr<const SurfaceMap> surface_map_of(const godot::Ref<godot::Mesh>& mesh,
                                                 const SurfaceParts& parts);
std::shared_ptr<TriangleSource> source_of(const godot::PackedVector3Array& faces);

}  // namespace tactus
