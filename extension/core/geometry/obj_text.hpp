// Wavefront .obj text to triangles: positions and faces, and nothing else of the format.
#pragma once

#include <string>
#include <string_view>

#include "core/geometry/triangle_mesh.hpp"

namespace tactus {

struct ObjResult {
    TriangleMesh mesh;
    std::string error;  // "line 12: …", what is wrong there; empty where the text was understood
};

// Faces of more than three corners become a fan around their first. Negative indices count back from the
// newest vertex. Texture coordinates, normals, groups, materials, lines and points are passed over. The
// numbers are read the same way in every locale. A mesh without triangles is no error here: see check_mesh.
ObjResult read_obj_text(std::string_view text);

}  // namespace tactus
