// Cloth as springs. Along an edge of length l between triangles of areas A1 and A2, k = E t (A1 + A2) / l^2:
// over a grid of equal triangles that is a sheet of modulus E, thickness t and Poisson's ratio 1/3. Across an
// inner edge it bends by the discrete Laplacian (Bergou, Wardetzky, Harmon, Zorin and Grinspun, "A quadratic
// bending model for inextensible surfaces", 2006): 1/2 D 3 / (A1 + A2) |e|^2 with D = E t^3 / (12 (1 - 1/9)),
// e the sum of the four nodes weighted by cotangents. Where the sheet is bent at rest, e has a length there.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "core/mesh/mesh_check.hpp"
#include "core/mesh/same_places.hpp"
#include "core/soft/soft_draft.hpp"

namespace tactus {

namespace {

using Edge = std::array<std::uint32_t, 2>;  // lower node first

// The triangles along an edge, by the corner that faces it.
struct Sides {
    std::array<std::uint32_t, 2> facing{};
    double area = 0.0;  // of all
    int count = 0;
};

double area_of(const std::vector<Vec3>& nodes, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return 0.5 * glm::length(glm::cross(nodes[b] - nodes[a], nodes[c] - nodes[a]));
}

// Of the angle at `at` between the ways to two others; bounded where they are nearly one.
double cotangent(const Vec3& at, const Vec3& one, const Vec3& other) {
    const Vec3 u = one - at, v = other - at;
    const double across = glm::length(glm::cross(u, v));
    return std::clamp(glm::dot(u, v) / std::max(across, 1e-30), -10.0, 10.0);
}

SoftDraft::Spring stretch(const SoftDraft& draft, const Edge& edge, const Sides& sides, double modulus) {
    const double length = glm::distance(draft.nodes[edge[0]], draft.nodes[edge[1]]);
    return {{edge[0], edge[1], edge[0], edge[0]},
            {1.0, -1.0, 0.0, 0.0},
            modulus * sides.area / (length * length),
            length};
}

SoftDraft::Spring bend(const SoftDraft& draft, const Edge& edge, const Sides& sides, double rigidity) {
    const std::array<std::uint32_t, 4> node{edge[0], edge[1], sides.facing[0], sides.facing[1]};
    std::array<Vec3, 4> x;
    std::ranges::transform(node, x.begin(), [&](std::uint32_t i) { return draft.nodes[i]; });
    const double at_first[] = {cotangent(x[0], x[1], x[2]), cotangent(x[0], x[1], x[3])};
    const double at_second[] = {cotangent(x[1], x[0], x[2]), cotangent(x[1], x[0], x[3])};
    SoftDraft::Spring spring;
    spring.node = node;
    spring.share = {at_second[0] + at_second[1], at_first[0] + at_first[1], -at_first[0] - at_second[0],
                    -at_first[1] - at_second[1]};
    spring.stiffness = 3.0 * rigidity / sides.area;
    Vec3 e(0.0);
    for (std::size_t i = 0; i < 4; ++i) {
        e += spring.share[i] * x[i];
    }
    spring.length = glm::length(e);
    return spring;
}

}  // namespace

SoftDraftResult draft_sheet(const SoftDesign& design) {
    const TriangleMesh& surface = design.surface;
    const SoftMaterial& material = design.material;
    if (std::string error = check_mesh(surface); !error.empty()) {
        return {{}, std::move(error)};
    }
    SoftDraft draft;
    draft.surface = surface;
    // Seams of texture or shading hold together, and what no triangle uses is no node.
    const std::vector<std::uint32_t> first = same_places(surface.vertices);
    std::vector<std::uint32_t> node_of(surface.vertices.size(), 0xffff'ffffu);
    std::map<Edge, Sides> edges;
    for (const auto& corners : surface.triangles) {
        std::array<std::uint32_t, 3> t{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& node = node_of[first[corners[k]]];
            if (node == 0xffff'ffffu) {
                node = static_cast<std::uint32_t>(draft.nodes.size());
                draft.nodes.push_back(surface.vertices[corners[k]]);
            }
            t[k] = node;
        }
        const double area = area_of(draft.nodes, t[0], t[1], t[2]);
        draft.mass.resize(draft.nodes.size(), 0.0);
        for (std::size_t k = 0; k < 3; ++k) {
            draft.mass[t[k]] += material.density * material.thickness * area / 3.0;
            const std::uint32_t from = t[k], to = t[(k + 1) % 3];
            if (from != to) {
                Sides& sides = edges[{std::min(from, to), std::max(from, to)}];
                sides.facing[static_cast<std::size_t>(std::min(sides.count, 1))] = t[(k + 2) % 3];
                sides.area += area;
                ++sides.count;
            }
        }
    }
    const double modulus = material.stiffness * material.thickness;
    const double rigidity = modulus * material.thickness * material.thickness / (12.0 * (1.0 - 1.0 / 9.0));
    for (const auto& [edge, sides] : edges) {
        if (sides.area > 0.0) {
            draft.springs.push_back(stretch(draft, edge, sides, modulus));
        }
    }
    for (const auto& [edge, sides] : edges) {
        if (sides.count == 2 && sides.area > 0.0) {
            draft.springs.push_back(bend(draft, edge, sides, rigidity));
        }
    }
    // A corner of triangles without area would have no mass.
    const double least = 1e-3 * material.density * material.thickness * [&] {
        double all = 0.0;
        for (const auto& [a, b, c] : surface.triangles) {
            all += area_of(surface.vertices, a, b, c);
        }
        return all;
    }() / static_cast<double>(draft.nodes.size());
    for (double& mass : draft.mass) {
        mass = std::max(mass, least);
    }
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        const std::uint32_t node = node_of[first[i]] == 0xffff'ffffu ? 0 : node_of[first[i]];
        draft.anchors.push_back({{node, node, node, node}, {1.0, 0.0, 0.0, 0.0}});
    }
    return {std::move(draft), {}};
}

}  // namespace tactus
