#include "world/surface_feels.hpp"

#include <algorithm>

namespace tactus {

namespace {

constexpr std::size_t last_surface = 255;  // of a mesh, in Godot

bool is_by_uv(const std::optional<SurfaceFeel>& feel) {
    return feel && feel->material.by_uv && feel->images != TouchImages();
}

}  // namespace

SurfaceParts parts_for(const SurfaceFeels& feels, bool by_uv) {
    const bool has_own = std::ranges::any_of(feels, [](const auto& feel) { return feel.has_value(); });
    return {has_own, by_uv || std::ranges::any_of(feels, is_by_uv)};
}

SurfaceParts parts_of(const SurfaceMap& map) {
    return {!map.surface.empty(), !map.uv.empty()};
}

std::string problem_of(const SurfaceFeels& feels, std::size_t surface_count, const SurfaceMap* map) {
    if (surface_count < feels.size()) {
        return "they are more than 'mesh' has surfaces: take the last ones away";
    }
    const bool has_uv = map != nullptr && std::ranges::any_of(map->uv, [](const SurfaceMap::Corners& at) {
                            return at[0] != at[1];
                        });
    return std::ranges::any_of(feels, is_by_uv) && !has_uv
               ? "'mesh' has no texture coordinates for their images: give it some, or set their "
                 "'texture_mapping' to Frame"
               : "";
}

void add(SurfaceMap& map, const DrawnSurface& surface, const SurfaceParts& parts) {
    const auto& [number, corner_count, indices, uv] = surface;
    const std::size_t triangles = (indices.empty() ? corner_count : indices.size()) / 3;
    if (parts.surfaces) {
        const auto which = static_cast<std::uint8_t>(std::min(number, last_surface));
        map.surface.resize(map.surface.size() + triangles, which);
    }
    const auto place = [&](std::size_t corner) {
        const std::size_t index = indices.empty() ? corner : static_cast<std::size_t>(indices[corner]);
        return index < uv.size() ? uv[index] : std::array{0.0F, 0.0F};
    };
    for (std::size_t t = 0; parts.uv && t < triangles; ++t) {
        map.uv.push_back({place(3 * t), place(3 * t + 2), place(3 * t + 1)});
    }
}

}  // namespace tactus
