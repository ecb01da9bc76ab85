#include "core/geometry/same_places.hpp"

#include <algorithm>
#include <bit>

namespace tactus {

namespace {

constexpr std::size_t chunk = std::size_t{1} << 15;  // vertices a task hashes
constexpr std::uint32_t table_count = 4;             // by the highest bits of the hash
constexpr std::uint32_t nobody = 0xffff'ffffu;

// What two vertices at one place share: also two that are no numbers, by the same bits.
std::uint64_t bits_of(double coordinate) {
    return std::bit_cast<std::uint64_t>(coordinate + 0.0);  // -0 and 0 are one
}

bool is_same(const Vec3& p, const Vec3& q) {
    return bits_of(p.x) == bits_of(q.x) && bits_of(p.y) == bits_of(q.y) && bits_of(p.z) == bits_of(q.z);
}

std::uint32_t hash_of(const Vec3& place) {
    std::uint64_t hash = 0x9e37'79b9'7f4a'7c15ull;
    for (int axis = 0; axis < 3; ++axis) {
        hash = (hash ^ bits_of(place[axis])) * 0xff51'afd7'ed55'8ccdull;
        hash ^= hash >> 32;
    }
    return static_cast<std::uint32_t>(hash);
}

// The first of each place among those vertices whose hash belongs to this table.
void find_first(std::span<const Vec3> vertices, std::span<const std::uint32_t> hashes, std::uint32_t table,
                std::span<std::uint32_t> first) {
    const auto is_mine = [&](std::uint32_t hash) { return hash >> 30 == table; };
    const auto mine = static_cast<std::size_t>(std::ranges::count_if(hashes, is_mine));
    std::vector<std::uint32_t> slots(std::bit_ceil(2 * mine + 1), nobody);
    const std::size_t mask = slots.size() - 1;
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        if (!is_mine(hashes[v])) {
            continue;
        }
        std::size_t slot = hashes[v] & mask;
        while (slots[slot] != nobody &&
               !(hashes[slots[slot]] == hashes[v] && is_same(vertices[slots[slot]], vertices[v]))) {
            slot = (slot + 1) & mask;
        }
        slots[slot] = std::min(slots[slot], v);
        first[v] = slots[slot];
    }
}

}  // namespace

std::vector<std::uint32_t> same_places(std::span<const Vec3> vertices, const ParallelRunner& run) {
    static_assert(table_count == 4, "the two highest bits of a hash choose its table");
    std::vector<std::uint32_t> hashes(vertices.size());
    run_in_parts(run, vertices.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::transform(&vertices[begin], &vertices[begin] + (end - begin), &hashes[begin], hash_of);
    });
    std::vector<std::uint32_t> first(vertices.size());
    run(table_count,
        [&](std::size_t table) { find_first(vertices, hashes, static_cast<std::uint32_t>(table), first); });
    return first;
}

void merge_places(TriangleMesh& mesh, const ParallelRunner& run) {
    const std::vector<std::uint32_t> first = same_places(mesh.vertices, run);
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
            corner = corner < place_of.size() ? place_of[corner] : 0xffff'ffffu;
        }
    }
}

}  // namespace tactus
