#include "world/soft_plan.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/soft/soft_model.hpp"

namespace tactus {

SoftPlan::Built SoftPlan::built() {
    const std::lock_guard<std::mutex> alone(building_);
    if (Built known = built_so_far(); known.model != nullptr || !known.error.empty()) {
        return known;
    }
    SoftModelResult made = make();
    Built built{std::move(made.model), nullptr, std::move(made.error)};
    if (built.model != nullptr) {
        built.view = std::make_shared<SoftView>(built.model->surface.vertices);
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    built_ = std::move(built);
    return built_;
}

SoftPlan::Built SoftPlan::built_so_far() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return built_;
}

bool SoftPlan::is_for(const SceneFrame& frame, double seconds) const {
    constexpr double rounding = 1e-6;  // of Godot's places (unit: meters)
    const Mat3& made = description_.frame.axes;
    return has_only_drifted(made, frame.axes, frame.axes) &&
           glm::distance(description_.frame.origin, frame.origin) < rounding &&
           description_.seconds == seconds;
}

SoftModelResult SoftPlan::make() const {
    const SoftDescription& d = description_;
    const auto place = [&](const Vec3& point) { return d.frame.origin + d.frame.axes * point; };
    if (d.source == nullptr && d.tetrahedra.empty()) {
        return {nullptr, "it has no mesh: set 'mesh', or 'points' and 'tetrahedra'"};
    }
    if (d.source == nullptr) {
        std::vector<Vec3> points = d.points;
        std::ranges::transform(points, points.begin(), place);
        return make_soft_tetrahedra(points, d.tetrahedra, d.material, d.held, d.seconds);
    }
    const TriangleSource::Checked& read = d.source->triangles();
    if (read.mesh == nullptr) {
        return {nullptr, read.error};
    }
    // Turned over where it is mirrored, so that outside stays outside.
    TriangleMesh mesh = scaled(*read.mesh, d.frame.axes);
    for (Vec3& vertex : mesh.vertices) {
        vertex += d.frame.origin;
    }
    // One beyond the owner's vertices is none of the mesh's either.
    HeldParts held = d.held;
    if (!read.merged.empty()) {
        std::erase_if(held.vertices, [&](std::uint32_t vertex) { return vertex >= read.merged.size(); });
        std::ranges::transform(held.vertices, held.vertices.begin(),
                               [&](std::uint32_t vertex) { return read.merged[vertex]; });
    }
    return d.form == SoftDescription::Form::sheet
               ? make_soft_sheet(mesh, d.material, held, d.seconds)
               : make_soft_volume(mesh, d.cells, d.material, held, d.seconds);
}

}  // namespace tactus
