#include "world/mesh_file.hpp"

#include "core/mesh/mesh_check.hpp"
#include "core/mesh/obj_file.hpp"

namespace tactus {

bool is_mesh_name(std::string_view name) {
    return !name.empty() && name.find_first_of("/\\:") == std::string_view::npos;
}

std::string problem_of_size(const std::string& path, std::int64_t bytes) {
    const auto limit = static_cast<std::int64_t>(ObjLimits{}.bytes);
    return bytes <= limit ? ""
                          : path + ": the file has " + std::to_string(bytes) + " bytes, the limit is " +
                                std::to_string(limit) + ": split it into several meshes";
}

TriangleSource::Checked read_mesh_file(const std::string& path, std::string_view bytes) {
    ObjResult read = read_obj_file(bytes);
    const std::string wrong = read.error.empty() ? check_mesh(read.mesh) : read.error;
    if (!wrong.empty()) {
        return {nullptr, path + ": " + wrong};
    }
    return {std::make_shared<TriangleMesh>(std::move(read.mesh)), {}};
}

}  // namespace tactus
