// The mesh library's files, wherever they come from.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "world/triangle_source.hpp"

namespace tactus {

// Whether it names a mesh, and is no way out of the library's folder.
bool is_mesh_name(std::string_view name);

// Why a file of so many bytes is not read; empty where it is.
std::string problem_of_size(const std::string& path, std::int64_t bytes);

// The triangles of an .obj file, or what is wrong with it and what to do.
TriangleSource::Checked read_mesh_file(const std::string& path, std::string_view bytes);

}  // namespace tactus
