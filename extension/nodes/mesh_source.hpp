// Godot's meshes as sources of triangles (world/triangle_source.hpp). Main thread, which only copies what
// Godot has; whoever asks for the triangles reads them. Godot's packed arrays are shared, counted and never
// written to here.
#pragma once

#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <memory>

#include "world/surface_feels.hpp"
#include "world/triangle_source.hpp"

namespace tactus {

std::shared_ptr<TriangleSource> source_of(const godot::Ref<godot::Mesh>& mesh);
// Of its triangles as source_of() reads them; null where it has none of these parts.
std::shared_ptr<const SurfaceMap> surface_map_of(const godot::Ref<godot::Mesh>& mesh,
                                                 const SurfaceParts& parts);
std::shared_ptr<TriangleSource> source_of(const godot::PackedVector3Array& faces);

}  // namespace tactus
