#include "world/seen_library.hpp"

#include <algorithm>
#include <utility>

#include "physics/solid_properties.hpp"

namespace tactus {

namespace {

// Of what nobody knows the mass of: that of water (unit: kilograms per cubic meter).
constexpr double unknown_density = 1000.0;

// Nothing weighs less (unit: kilograms).
constexpr double least_mass = 1e-3;

// As if it were of water.
double mass_of(const TriangleMesh& mesh) {
    const std::optional<SolidProperties> solid = solid_properties(mesh);
    return solid ? unknown_density * solid->volume : 0.0;
}

}  // namespace

void SeenLibrary::add(std::string name, const TriangleSource::Checked& triangles, double mass) {
    if (triangles.mesh == nullptr) {
        error_ = triangles.error;
        return;
    }
    meshes_.push_back({std::move(name), triangles.mesh, mass});
}

std::vector<KnownMesh> SeenLibrary::known() const {
    std::vector<KnownMesh> known;
    for (const Mesh& one : meshes_) {
        known.push_back({one.name.c_str(), {one.mesh->vertices, one.mesh->triangles}, one.mass});
    }
    return known;
}

const SeenLibrary::Mesh* SeenLibrary::find(std::int32_t mesh) const {
    const auto index = static_cast<std::size_t>(mesh);
    return mesh >= 0 && index < meshes_.size() ? &meshes_[index] : nullptr;
}

std::string SeenLibrary::name_of(std::int32_t mesh) const {
    const Mesh* const known = find(mesh);
    return known != nullptr ? known->name : "unknown";
}

SeenForm SeenLibrary::form_of(const SightedObject& object) const {
    SeenForm form;
    form.name = name_of(object.mesh) + "_" + std::to_string(object.id);
    if (const Mesh* const known = find(object.mesh)) {
        form.known = known->name;
        form.mesh = known->mesh;
        form.mass = known->mass;
    } else {
        const auto& [vertices, triangles] = object.hull;
        form.mesh = std::make_shared<TriangleMesh>(
            TriangleMesh{{vertices.begin(), vertices.end()}, {triangles.begin(), triangles.end()}});
    }
    form.mass = std::max(least_mass, form.mass > 0.0 ? form.mass : mass_of(*form.mesh));
    return form;
}

}  // namespace tactus
