// The meshes that a depth sensor knows, and what is made of an object that it sees. Owner's thread only.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "core/ports/depth_sensing.hpp"
#include "world/triangle_source.hpp"

namespace tactus {

// What an object looks and weighs like: as the library has it, or as its hull shows it.
struct SeenForm {
    std::string name;   // of its mesh, and its number: a body's name goes over the network and must stay
    std::string known;  // its mesh's name in the library; empty: nobody knows it
    std::shared_ptr<const TriangleMesh> mesh;
    double mass = 0.0;  // (unit: kilograms), > 0

    bool is_known() const { return !known.empty(); }
};

class SeenLibrary {
public:
    // One that cannot be read is left out.
    void add(std::string name, const TriangleSource::Checked& triangles, double mass);

    // For the sensor; as long as nothing is added.
    std::vector<KnownMesh> known() const;
    // Why the last one that was left out was; empty where all are there.
    const std::string& error() const { return error_; }

    // "cube", or what an object is called that nobody knows.
    std::string name_of(std::int32_t mesh) const;
    SeenForm form_of(const SightedObject& object) const;

private:
    struct Mesh {
        std::string name;
        std::shared_ptr<const TriangleMesh> mesh;
        double mass = 0.0;  // (unit: kilograms); 0: unknown
    };

    const Mesh* find(std::int32_t mesh) const;  // null: none of these

    std::vector<Mesh> meshes_;
    std::string error_;
};

}  // namespace tactus
