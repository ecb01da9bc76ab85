#include "core/geometry/corners_by_place.hpp"

#include "core/geometry/same_places.hpp"

namespace tactus {

namespace {

constexpr std::size_t triangles_a_task = std::size_t{1} << 15;
constexpr std::size_t range_count = 2;  // ranges of vertices that are sorted side by side

}  // namespace

CornersByPlace corners_by_place(const TriangleMesh& mesh, const ParallelRunner& run) {
    const std::size_t vertex_count = mesh.vertices.size();
    const std::vector<std::uint32_t> same = same_places(mesh.vertices, run);
    CornersByPlace sorted{std::vector<TriangleCorners>(mesh.triangles.size()),
                          std::vector<std::uint32_t>(vertex_count + 1),
                          std::vector<EdgeLink>(3 * mesh.triangles.size())};
    run_in_parts(run, mesh.triangles.size(), triangles_a_task,
                 [&](std::size_t, std::size_t t, std::size_t end) {
                     for (; t < end; ++t) {
                         for (std::size_t k = 0; k < 3; ++k) {
                             sorted.triangles[t][k] = same[mesh.triangles[t][k]];
                         }
                     }
                 });
    const std::size_t range = vertex_count / range_count + 1;
    const auto visit = [&](std::size_t task, auto&& visitor) {
        for (std::uint32_t t = 0; t < sorted.triangles.size(); ++t) {
            for (unsigned k = 0; k < 3; ++k) {
                const std::uint32_t v = sorted.triangles[t][k];
                if (v - task * range < range) {
                    visitor(v, EdgeLink::to(t, k));
                }
            }
        }
    };
    run(range_count,
        [&](std::size_t task) { visit(task, [&](std::uint32_t v, EdgeLink) { ++sorted.first[v]; }); });
    std::uint32_t sum = 0;
    for (std::uint32_t& first : sorted.first) {
        sum += first;
        first = sum;
    }
    // Each list is filled from its end; then `first` is where it begins.
    run(range_count, [&](std::size_t task) {
        visit(task, [&](std::uint32_t v, EdgeLink corner) { sorted.corner[--sorted.first[v]] = corner; });
    });
    return sorted;
}

}  // namespace tactus
