#include "core/mesh/same_places.hpp"

#include <bit>

namespace tactus {

namespace {

constexpr std::uint32_t nobody = 0xffff'ffffu;

// What two vertices at one place share: also two that are no numbers, by the same bits.
std::uint64_t bits_of(double coordinate) {
    return std::bit_cast<std::uint64_t>(coordinate + 0.0);  // -0 and 0 are one
}

bool is_same(const Vec3& p, const Vec3& q) {
    return bits_of(p.x) == bits_of(q.x) && bits_of(p.y) == bits_of(q.y) && bits_of(p.z) == bits_of(q.z);
}

std::size_t hash_of(const Vec3& place) {
    std::uint64_t hash = 0x9e37'79b9'7f4a'7c15ull;
    for (int axis = 0; axis < 3; ++axis) {
        hash = (hash ^ bits_of(place[axis])) * 0xff51'afd7'ed55'8ccdull;
        hash ^= hash >> 32;
    }
    return hash;
}

}  // namespace

std::vector<std::uint32_t> same_places(std::span<const Vec3> vertices) {
    std::vector<std::uint32_t> slots(std::bit_ceil(2 * vertices.size() + 1), nobody);
    const std::size_t mask = slots.size() - 1;
    std::vector<std::uint32_t> first(vertices.size());
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        std::size_t slot = hash_of(vertices[v]) & mask;
        while (slots[slot] != nobody && !is_same(vertices[slots[slot]], vertices[v])) {
            slot = (slot + 1) & mask;
        }
        slots[slot] = slots[slot] == nobody ? v : slots[slot];
        first[v] = slots[slot];
    }
    return first;
}

std::vector<std::uint32_t> merge_places(TriangleMesh& mesh) {
    const std::vector<std::uint32_t> first = same_places(mesh.vertices);
    std::vector<std::uint32_t> place_of(first.size());
    std::uint32_t kept = 0;
    for (std::uint32_t v = 0; v < first.size(); ++v) {
        if (first[v] == v) {
            mesh.vertices[kept] = mesh.vertices[v];
            place_of[v] = kept++;
        } else {
            place_of[v] = place_of[first[v]];
        }
    }
    mesh.vertices.resize(kept);
    for (auto& triangle : mesh.triangles) {
        for (std::uint32_t& corner : triangle) {
            corner = corner < place_of.size() ? place_of[corner] : nobody;
        }
    }
    return place_of;
}

}  // namespace tactus
