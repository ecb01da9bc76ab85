// Wavefront .obj text to triangles: positions and faces, and nothing else of the format.
#pragma once

#include <string>
#include <string_view>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

struct ObjResult {
    TriangleMesh mesh;
    std::string error;  // "line 12: …", what is wrong there; empty where the text was understood
};

// What a text may hold: beyond it the answer is an error, not an hour of waiting or the end of memory.
struct ObjLimits {
    std::size_t bytes = std::size_t{1} << 30;
    std::size_t vertices = std::size_t{1} << 29;
    std::size_t triangles = std::size_t{1} << 29;
    std::int64_t polygon_work = 4'000'000'000;  // comparisons of corners, for faces that are no fan: seconds
};

// Faces of more than three corners are cut into triangles (see add_polygon); corners that come again and
// again in the same order make one face. Negative indices count back from the newest vertex; others may name
// vertices that come later. Lines end with LF, CR LF or CR, and go on after a \ at their end. Texture
// coordinates, normals, groups, materials, lines and points are passed over. The numbers are read the same
// way in every locale. A mesh without triangles is no error here: see check_mesh.
ObjResult read_obj_text(std::string_view text, const ObjLimits& limits = {});

}  // namespace tactus
