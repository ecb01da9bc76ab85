#include "core/mesh/closed_mesh.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/common.hpp>
#include <utility>
#include <vector>

namespace tactus {

namespace {

// Where a surface is drawn around a full turn, its seam is closed but for the rounding of single precision:
// as a share of what the seams extend over.
constexpr double seam_width = 1e-6;
constexpr std::size_t max_rim = 20'000;  // vertices; what has more is no solid with seams

std::uint64_t mixed(std::uint64_t x) {  // the finaliser of splitmix64
    x = (x ^ (x >> 30)) * 0xbf58'476d'1ce4'e5b9u;
    x = (x ^ (x >> 27)) * 0x94d0'49bb'1331'11ebu;
    return x ^ (x >> 31);
}

struct Sum {
    std::uint64_t low = 0, high = 0;
};

std::uint64_t number_of(const Vec3& corner) {
    std::uint64_t number = 0x9e37'79b9'7f4a'7c15u;
    for (int axis = 0; axis < 3; ++axis) {
        const double coordinate = corner[axis] == 0.0 ? 0.0 : corner[axis];  // -0 is 0
        number = mixed(number ^ std::bit_cast<std::uint64_t>(coordinate)) + 0x9e37'79b9'7f4a'7c15u;
    }
    return number;
}

// The same edge the other way takes away what this way adds.
void add_edge(Sum& sum, std::uint64_t from, std::uint64_t to) {
    const std::uint64_t there = mixed(from + 3 * std::rotl(to, 17));
    const std::uint64_t back = mixed(to + 3 * std::rotl(from, 17));
    sum.low += there - back;
    sum.high += mixed(there + 1) - mixed(back + 1);
}

using Numbers = std::vector<std::uint64_t>;  // by vertex

bool is_balanced(const TriangleMesh& mesh, const Numbers& numbers) {
    Sum sum;
    for (const auto& [a, b, c] : mesh.triangles) {
        add_edge(sum, numbers[a], numbers[b]);
        add_edge(sum, numbers[b], numbers[c]);
        add_edge(sum, numbers[c], numbers[a]);
    }
    return sum.low == 0 && sum.high == 0;
}

// The vertices with an edge that runs one way more often than the other: what each neighbour is reached by
// has to cancel, over all vertices at the same place.
std::vector<std::uint32_t> rim_of(const TriangleMesh& mesh, const Numbers& numbers) {
    Numbers sums(mesh.vertices.size(), 0);
    for (const auto& triangle : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
            sums[from] += mixed(numbers[to]);
            sums[to] -= mixed(numbers[from]);
        }
    }
    std::vector<std::uint32_t> suspects;
    for (std::uint32_t v = 0; v < sums.size(); ++v) {
        if (sums[v] != 0) {
            suspects.push_back(v);
        }
    }
    std::ranges::sort(suspects, {}, [&](std::uint32_t v) { return numbers[v]; });
    std::vector<std::uint32_t> rim;
    for (std::size_t first = 0, last = 0; first < suspects.size(); first = last) {
        std::uint64_t sum = 0;
        for (; last < suspects.size() && numbers[suspects[last]] == numbers[suspects[first]]; ++last) {
            sum += sums[suspects[last]];
        }
        if (sum != 0) {
            rim.insert(rim.end(), suspects.begin() + static_cast<std::ptrdiff_t>(first),
                       suspects.begin() + static_cast<std::ptrdiff_t>(last));
        }
    }
    return rim;
}

// Gives places on the rim that are within rounding of each other the same number.
void weld(const TriangleMesh& mesh, std::vector<std::uint32_t> rim, Numbers& numbers) {
    double farthest = 0.0;
    for (const std::uint32_t v : rim) {
        const Vec3 size = glm::abs(mesh.vertices[v] - mesh.vertices[rim.front()]);
        farthest = std::max({farthest, size.x, size.y, size.z});
    }
    const double same = seam_width * farthest;
    std::ranges::sort(rim, {}, [&](std::uint32_t v) { return mesh.vertices[v].x; });
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const Vec3& place = mesh.vertices[rim[i]];
        for (std::size_t k = i; k-- > 0 && place.x - mesh.vertices[rim[k]].x <= same;) {
            const Vec3 apart = glm::abs(place - mesh.vertices[rim[k]]);
            if (apart.y <= same && apart.z <= same) {
                numbers[rim[i]] = numbers[rim[k]];
                break;
            }
        }
    }
}

}  // namespace

bool is_closed(const TriangleMesh& mesh) {
    Numbers numbers(mesh.vertices.size());
    std::ranges::transform(mesh.vertices, numbers.begin(), number_of);
    if (mesh.triangles.empty() || is_balanced(mesh, numbers)) {
        return !mesh.triangles.empty();
    }
    std::vector<std::uint32_t> rim = rim_of(mesh, numbers);
    if (rim.size() > max_rim) {
        return false;
    }
    weld(mesh, std::move(rim), numbers);
    return is_balanced(mesh, numbers);
}

}  // namespace tactus
