#include "shared/rough_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <unordered_map>

#include "core/geometry/shared_mesh.hpp"
#include "shared/meshes.hpp"
#include "shared/noise.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

using Index = std::uint32_t;
constexpr double turn = 2.0 * std::numbers::pi;

// Corners at the same place, to a billionth, become one; triangles that vanish by it are left out.
TriangleMesh welded(const TriangleMesh& mesh) {
    std::unordered_map<std::uint64_t, Index> known;
    std::vector<Index> same(mesh.vertices.size());
    TriangleMesh result;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        std::uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis) {
            key = key * 0x9e3779b97f4a7c15u +
                  static_cast<std::uint64_t>(std::llround(mesh.vertices[i][axis] * 1e9));
        }
        const auto [place, added] = known.try_emplace(key, static_cast<Index>(result.vertices.size()));
        if (added) {
            result.vertices.push_back(mesh.vertices[i]);
        }
        same[i] = place->second;
    }
    for (const auto& t : mesh.triangles) {
        const std::array<Index, 3> merged{same[t[0]], same[t[1]], same[t[2]]};
        if (merged[0] != merged[1] && merged[1] != merged[2] && merged[2] != merged[0]) {
            result.triangles.push_back(merged);
        }
    }
    return result;
}

// --- Surfaces given as where a function is zero, positive inside -----------------------------------------

using Field = std::function<double(const Vec3&)>;

// Each cube of the grid over [-1, 1]^3 is cut into six tetrahedra around its long diagonal, and each of those
// along the surface.
class TetrahedronMarch {
public:
    TetrahedronMarch(const Field& field, int cells) : cells_(cells), side_(cells + 1) {
        values_.reserve(static_cast<std::size_t>(side_ * side_ * side_));
        for (int i = 0; i < side_ * side_ * side_; ++i) {
            values_.push_back(field(place(static_cast<Index>(i))));
        }
    }

    TriangleMesh cut() {
        constexpr int around[7] = {1, 3, 2, 6, 4, 5, 1};  // corners of the cube as bits x, y, z
        for (int z = 0; z < cells_; ++z) {
            for (int y = 0; y < cells_; ++y) {
                for (int x = 0; x < cells_; ++x) {
                    for (int i = 0; i < 6; ++i) {
                        cut_one({corner(x, y, z, 0), corner(x, y, z, around[i]),
                                 corner(x, y, z, around[i + 1]), corner(x, y, z, 7)});
                    }
                }
            }
        }
        return std::move(mesh_);
    }

private:
    Index corner(int x, int y, int z, int bits) const {
        return static_cast<Index>(((z + (bits >> 2)) * side_ + y + ((bits >> 1) & 1)) * side_ + x +
                                  (bits & 1));
    }
    Vec3 place(Index corner) const {
        const auto side = static_cast<Index>(side_);
        const Vec3 index(corner % side, corner / side % side, corner / (side * side));
        return 2.0 * index / static_cast<double>(cells_) - Vec3(1.0);
    }
    Index between(Index a, Index b) {
        const std::uint64_t key = (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
        const auto [known, added] = known_.try_emplace(key, static_cast<Index>(mesh_.vertices.size()));
        if (added) {
            const double t = std::clamp(values_[a] / (values_[a] - values_[b]), 1e-4, 1.0 - 1e-4);
            mesh_.vertices.push_back((1.0 - t) * place(a) + t * place(b));
        }
        return known->second;
    }
    // Counter-clockwise from where the field is negative.
    void add(Index a, Index b, Index c, Index inner) {
        const Vec3& p = mesh_.vertices[a];
        const Vec3 normal = glm::cross(mesh_.vertices[b] - p, mesh_.vertices[c] - p);
        if (glm::dot(normal, place(inner) - p) > 0.0) {
            std::swap(b, c);
        }
        mesh_.triangles.push_back({a, b, c});
    }
    void cut_one(const std::array<Index, 4>& tetrahedron) {
        Index in[4];
        Index out[4];
        int inside = 0;
        int outside = 0;
        for (const Index i : tetrahedron) {
            if (values_[i] > 0.0) {
                in[inside++] = i;
            } else {
                out[outside++] = i;
            }
        }
        if (inside == 1) {
            add(between(in[0], out[0]), between(in[0], out[1]), between(in[0], out[2]), in[0]);
        } else if (inside == 3) {
            add(between(out[0], in[0]), between(out[0], in[1]), between(out[0], in[2]), in[0]);
        } else if (inside == 2) {
            const Index a = between(in[0], out[0]);
            const Index b = between(in[0], out[1]);
            const Index c = between(in[1], out[1]);
            const Index d = between(in[1], out[0]);
            add(a, b, c, in[0]);
            add(a, c, d, in[0]);
        }
    }

    int cells_, side_;
    std::vector<double> values_;
    std::unordered_map<std::uint64_t, Index> known_;
    TriangleMesh mesh_;
};

// Every triangle in four.
TriangleMesh split_in_four(const TriangleMesh& mesh) {
    struct Side {
        std::uint64_t key;
        std::size_t slot;
    };
    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Index a = mesh.triangles[i][k];
            const Index b = mesh.triangles[i][(k + 1) % 3];
            sides.push_back({(static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b), 3 * i + k});
        }
    }
    std::ranges::sort(
        sides, [](const Side& p, const Side& q) { return p.key != q.key ? p.key < q.key : p.slot < q.slot; });
    TriangleMesh finer;
    finer.vertices = mesh.vertices;
    std::vector<Index> middle(sides.size());
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (i == 0 || sides[i].key != sides[i - 1].key) {
            const auto a = static_cast<std::size_t>(sides[i].key >> 32);
            const auto b = static_cast<std::size_t>(sides[i].key & 0xffff'ffffu);
            finer.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
        }
        middle[sides[i].slot] = static_cast<Index>(finer.vertices.size() - 1);
    }
    finer.triangles.reserve(4 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const Index ab = middle[3 * i];
        const Index bc = middle[3 * i + 1];
        const Index ca = middle[3 * i + 2];
        finer.triangles.insert(finer.triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    return finer;
}

// Newton along the gradient, no farther than `most`.
Vec3 put_onto(const Field& field, Vec3 p, double most) {
    constexpr double h = 1e-6;
    for (int i = 0; i < 2; ++i) {
        const double value = field(p);
        const Vec3 slope = Vec3(field(p + Vec3(h, 0, 0)) - value, field(p + Vec3(0, h, 0)) - value,
                                field(p + Vec3(0, 0, h)) - value) /
                           h;
        const double squared = glm::dot(slope, slope);
        if (squared < 1e-12) {
            break;
        }
        const Vec3 step = slope * (-value / squared);
        p += step * std::min(1.0, most / std::max(1e-300, glm::length(step)));
    }
    return p;
}

TriangleMesh sculpted(const Field& field, int cells, int levels) {
    TriangleMesh mesh = TetrahedronMarch(field, cells).cut();
    for (int level = 0; level < levels; ++level) {
        const std::size_t old = mesh.vertices.size();
        mesh = split_in_four(mesh);
        for (std::size_t i = old; i < mesh.vertices.size(); ++i) {
            mesh.vertices[i] = put_onto(field, mesh.vertices[i], 0.5 / cells);
        }
    }
    return fitted(std::move(mesh));
}

double to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 way = b - a;
    return glm::distance(p, a + way * std::clamp(glm::dot(p - a, way) / glm::dot(way, way), 0.0, 1.0));
}

struct Branch {
    Vec3 from, to;
    double thickness;
};

void grow(std::vector<Branch>& all, RandomValues& random, const Branch& last, int forks) {
    all.push_back(last);
    if (forks == 0) {
        return;
    }
    const Vec3 ahead = last.to - last.from;
    for (int i = 0; i < 2; ++i) {
        const Vec3 way = glm::normalize(ahead + 0.9 * glm::length(ahead) * random.direction());
        grow(all, random,
             {last.to, last.to + way * (glm::length(ahead) * random.between(0.7, 0.85)),
              0.72 * last.thickness},
             forks - 1);
    }
}

// --- Spheres whose surface is moved in and out -----------------------------------------------------------

double hilly(const Vec3& direction) {
    const double ridge = 1.0 - std::abs(fractal_noise(3.0 * direction + Vec3(7.0), 3));
    return 1.0 + 0.18 * fractal_noise(1.7 * direction, 2) + 0.06 * ridge * ridge;
}

double with_pores(const Vec3& direction) {
    return hilly(direction) + 0.02 * fractal_noise(17.0 * direction, 5);
}

TriangleMesh moved_sphere(int levels, double (*height)(const Vec3&), double factor) {
    TriangleMesh mesh = icosphere(levels, 1.0);
    for (Vec3& v : mesh.vertices) {
        v *= factor * height(v);
    }
    return mesh;
}

struct Cap {
    Vec3 center;
    double cosine;
};

std::vector<Cap> random_caps(RandomValues& random, int count, double least, double most) {
    std::vector<Cap> caps;
    for (int i = 0; i < count; ++i) {
        caps.push_back({random.direction(), std::cos(random.magnitude(least, most))});
    }
    return caps;
}

bool is_within(const std::vector<Cap>& caps, const Vec3& direction) {
    return std::ranges::any_of(caps, [&](const Cap& c) { return glm::dot(c.center, direction) > c.cosine; });
}

}  // namespace

TriangleMesh fitted(TriangleMesh mesh) {
    Vec3 low(std::numeric_limits<double>::infinity());
    Vec3 high(-low);
    for (const Vec3& v : mesh.vertices) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    const Vec3 size = high - low;
    const double scale = 1.0 / std::max({size.x, size.y, size.z});
    for (Vec3& v : mesh.vertices) {
        v = scale * (v - 0.5 * (low + high));
    }
    return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
    for (const auto& [a, b, c] : more.triangles) {
        mesh.triangles.push_back({first + a, first + b, first + c});
    }
}

TriangleMesh scanned(int levels) {
    RandomValues random(101);
    const TriangleMesh base = icosphere(levels, 1.0);
    const double edge = 1.2 / std::exp2(levels);
    TriangleMesh mesh = base;
    for (Vec3& v : mesh.vertices) {
        // Pulled together here and apart there: neighbours are 5 times closer in one place than in another.
        const Vec3 pull(fractal_noise(1.3 * v + Vec3(3.0), 2), fractal_noise(1.3 * v + Vec3(31.0), 2),
                        fractal_noise(1.3 * v + Vec3(57.0), 2));
        const Vec3 direction = glm::normalize(v + 0.6 * pull);
        v = direction * hilly(direction) + 0.25 * edge * random.in_ball(1.0);
    }
    const std::vector<Cap> holes = [&] {
        std::vector<Cap> all = random_caps(random, 40, 0.01, 0.06);
        const std::vector<Cap> wide = random_caps(random, 4, 0.1, 0.35);
        all.insert(all.end(), wide.begin(), wide.end());
        return all;
    }();
    const std::vector<Cap> twice = random_caps(random, 6, 0.2, 0.5);
    TriangleMesh second;
    second.vertices = mesh.vertices;
    for (Vec3& v : second.vertices) {
        v += 0.2 * edge * random.in_ball(1.0);
    }
    std::vector<std::array<Index, 3>> kept;
    for (const auto& t : mesh.triangles) {
        const Vec3 direction =
            glm::normalize(base.vertices[t[0]] + base.vertices[t[1]] + base.vertices[t[2]]);
        if (is_within(holes, direction)) {
            continue;
        }
        kept.push_back(t);
        if (is_within(twice, direction)) {
            second.triangles.push_back(t);
        }
    }
    mesh.triangles = std::move(kept);
    append(mesh, second);
    return fitted(std::move(mesh));
}

TriangleMesh blobs(int cells, int levels) {
    RandomValues random(202);
    std::vector<std::pair<Vec3, double>> balls;
    for (int i = 0; i < 24; ++i) {
        balls.emplace_back(random.in_ball(0.62), random.between(0.05, 0.15));
    }
    const Field field = [balls](const Vec3& p) {
        double sum = -1.0;
        for (const auto& [center, radius] : balls) {
            sum += radius * radius / (glm::dot(p - center, p - center) + 1e-4);
        }
        return sum + 0.03 * fractal_noise(9.0 * p, 2);
    };
    return sculpted(field, cells, levels);
}

TriangleMesh branches(int cells, int levels) {
    RandomValues random(303);
    std::vector<Branch> all;
    grow(all, random, {{0.0, -0.8, 0.0}, {0.0, -0.3, 0.0}, 0.1}, 5);
    const Field field = [all](const Vec3& p) {
        double sum = 0.0;  // a soft least distance: branches melt where they meet
        for (const Branch& b : all) {
            const double gap = to_line(p, b.from, b.to) - b.thickness;
            sum += gap < 0.6 ? std::exp(-40.0 * gap) : 0.0;
        }
        return sum > 0.0 ? std::log(sum) / 40.0 : -0.6;
    };
    return sculpted(field, cells, levels);
}

TriangleMesh displaced(int levels) {
    return fitted(moved_sphere(levels, with_pores, 1.0));
}

TriangleMesh shell(int levels) {
    TriangleMesh mesh = moved_sphere(levels, hilly, 1.0);
    TriangleMesh inner = moved_sphere(levels, hilly, 1.0 - 4e-4);
    for (auto& t : inner.triangles) {
        std::swap(t[1], t[2]);
    }
    append(mesh, inner);
    return fitted(std::move(mesh));
}

TriangleMesh rounded_box(int segments) {
    const Vec3 half(0.5, 0.31, 0.22);
    constexpr double fillet = 0.03;
    const int lines = 2 * segments + 2;
    TriangleMesh mesh;
    for (int face = 0; face < 6; ++face) {
        const int up = face / 2;
        const int u = (up + 1) % 3;
        const int v = (up + 2) % 3;
        const double sign = face % 2 == 0 ? 1.0 : -1.0;
        const auto first = static_cast<Index>(mesh.vertices.size());
        const auto tangent = [&](int i) {  // of the angle around the edge: -1 to 0, the flat, 0 to 1
            const double share =
                (i <= segments ? i - segments : i - segments - 1) / static_cast<double>(segments);
            return std::tan(0.125 * turn * share);
        };
        for (int j = 0; j < lines; ++j) {
            for (int i = 0; i < lines; ++i) {
                Vec3 normal(0.0);
                normal[up] = sign;
                normal[u] = tangent(i);
                normal[v] = tangent(j);
                Vec3 base(0.0);
                base[up] = sign * (half[up] - fillet);
                base[u] = (i <= segments ? -1.0 : 1.0) * (half[u] - fillet);
                base[v] = (j <= segments ? -1.0 : 1.0) * (half[v] - fillet);
                mesh.vertices.push_back(base + fillet * glm::normalize(normal));
            }
        }
        for (int j = 0; j + 1 < lines; ++j) {
            for (int i = 0; i + 1 < lines; ++i) {
                const Index a = first + static_cast<Index>(j * lines + i);
                const Index b = a + 1;
                const Index c = a + static_cast<Index>(lines);
                const Index d = c + 1;
                if (sign > 0.0) {
                    mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
                } else {
                    mesh.triangles.insert(mesh.triangles.end(), {{a, d, b}, {a, c, d}});
                }
            }
        }
    }
    return fitted(welded(mesh));
}

TriangleMesh gear(int points) {
    constexpr int teeth = 24;
    constexpr double half_height = 0.12;
    const int bored = std::max(12, points / 7);
    // Flanks that are steep but not sheer, with rounded tips and roots.
    const auto rim = [&](double angle) {
        const double wave = std::tanh(4.0 * std::sin(teeth * angle)) / std::tanh(4.0);
        const double r = 0.46 + 0.04 * wave;
        return Vec3(r * std::cos(angle), 0.0, r * std::sin(angle));
    };
    const auto bore = [&](double angle) { return Vec3(0.1 * std::cos(angle), 0.0, 0.1 * std::sin(angle)); };
    TriangleMesh mesh;
    const Vec3 up(0.0, half_height, 0.0);
    for (int i = 0; i < points; ++i) {
        const Vec3 p = rim(turn * i / points);
        mesh.vertices.insert(mesh.vertices.end(), {p + up, p - up});
    }
    for (int i = 0; i < bored; ++i) {
        const Vec3 p = bore(turn * i / bored);
        mesh.vertices.insert(mesh.vertices.end(), {p + up, p - up});
    }
    const auto outer = [&](int i, int below) { return static_cast<Index>(2 * (i % points) + below); };
    const auto inner = [&](int i, int below) {
        return static_cast<Index>(2 * points + 2 * (i % bored) + below);
    };
    for (int i = 0; i < points; ++i) {
        mesh.triangles.push_back({outer(i, 0), outer(i + 1, 0), outer(i, 1)});
        mesh.triangles.push_back({outer(i + 1, 0), outer(i + 1, 1), outer(i, 1)});
    }
    for (int i = 0; i < bored; ++i) {
        mesh.triangles.push_back({inner(i, 0), inner(i, 1), inner(i + 1, 0)});
        mesh.triangles.push_back({inner(i + 1, 0), inner(i, 1), inner(i + 1, 1)});
    }
    // Both rings are walked around at once, whichever is behind goes on.
    for (int i = 0, k = 0; i < points || k < bored;) {
        const bool at_rim = k == bored || (i < points && i * bored <= k * points);
        for (int below = 0; below < 2; ++below) {
            const Index a = outer(i, below);
            const Index b = inner(k, below);
            const Index c = at_rim ? outer(i + 1, below) : inner(k + 1, below);
            if (below) {
                mesh.triangles.push_back({a, c, b});
            } else {
                mesh.triangles.push_back({a, b, c});
            }
        }
        ++(at_rim ? i : k);
    }
    return fitted(std::move(mesh));
}

TriangleMesh graded(int sectors, int rings) {
    constexpr double finest = 1e-5;
    RandomValues random(404);
    // The pole lies on the circle that the hand goes around.
    const Vec3 pole = glm::normalize(Vec3(0.62, 0.31, 0.72));
    const Vec3 side = glm::normalize(glm::cross(pole, Vec3(0.23, 0.95, -0.11)));
    const Vec3 other = glm::cross(pole, side);
    const double ratio = std::pow(std::numbers::pi / finest, 1.0 / rings);
    TriangleMesh mesh;
    mesh.vertices.push_back(pole);
    double angle = finest;
    for (int ring = 0; ring < rings - 1; ++ring, angle *= ratio) {
        const double spacing = std::min(angle * (ratio - 1.0), std::sin(angle) * turn / sectors);
        for (int i = 0; i < sectors; ++i) {
            const double around = turn * (i + 0.5 * (ring % 2)) / sectors;
            const Vec3 direction = std::cos(angle) * pole +
                                   std::sin(angle) * (std::cos(around) * side + std::sin(around) * other);
            mesh.vertices.push_back(direction * (1.0 + random.between(-0.4, 0.4) * spacing));
        }
    }
    mesh.vertices.push_back(-pole);
    const auto at = [&](int ring, int i) { return static_cast<Index>(1 + ring * sectors + i % sectors); };
    const auto last = static_cast<Index>(mesh.vertices.size() - 1);
    for (int i = 0; i < sectors; ++i) {
        mesh.triangles.push_back({0, at(0, i), at(0, i + 1)});
        for (int ring = 0; ring < rings - 2; ++ring) {
            const int shift = ring % 2;
            mesh.triangles.push_back({at(ring, i), at(ring + 1, i + shift), at(ring, i + 1)});
            mesh.triangles.push_back({at(ring, i + 1 - shift), at(ring + 1, i), at(ring + 1, i + 1)});
        }
        mesh.triangles.push_back({at(rings - 2, i), last, at(rings - 2, i + 1)});
    }
    return fitted(std::move(mesh));
}

TriangleMesh clustered(int heaps, int triangles_per_heap) {
    RandomValues random(505);
    TriangleMesh mesh = icosphere(3, 0.47);
    const Vec3 first = glm::normalize(Vec3(0.62, 0.31, 0.72));
    const Vec3 second = glm::normalize(glm::cross(first, Vec3(0.23, 0.95, -0.11)));
    for (int heap = 0; heap < heaps; ++heap) {
        const double angle = turn * (heap + 0.3) / (2.5 * heaps);
        const Vec3 center = 0.47 * (std::cos(angle) * first + std::sin(angle) * second);
        const double size = 0.01 * (1.0 + heap % 3);
        for (int i = 0; i < triangles_per_heap; ++i) {
            const Vec3 place = center + random.in_ball(size);
            const double edge = random.magnitude(1e-4, 2.5e-3);
            add_loose(mesh, {place + random.in_ball(edge), place + random.in_ball(edge),
                             place + random.in_ball(edge)});
        }
    }
    return fitted(std::move(mesh));
}

TriangleMesh cavity(int levels) {
    TriangleMesh mesh = moved_sphere(4, hilly, 1.0);
    TriangleMesh inner = icosphere(levels, 1.0);
    for (auto& t : inner.triangles) {
        std::swap(t[1], t[2]);
    }
    mesh = fitted(std::move(mesh));
    for (Vec3& v : inner.vertices) {
        v *= 0.3;
    }
    append(mesh, inner);
    return mesh;
}

std::span<const RoughMesh> rough_meshes() {
    static constexpr RoughMesh all[] = {
        {"scan", [] { return scanned(3); }},
        {"scan", [] { return scanned(5); }},
        {"scan", [] { return scanned(6); }},
        {"scan", [] { return scanned(8); }},
        {"blobs", [] { return blobs(24, 0); }},
        {"blobs", [] { return blobs(48, 1); }},
        {"blobs", [] { return blobs(54, 3); }},
        {"branches", [] { return branches(64, 0); }},
        {"branches", [] { return branches(64, 2); }},
        {"displaced", [] { return displaced(5); }},
        {"displaced", [] { return displaced(7); }},
        {"shell", [] { return shell(6); }},
        {"box", [] { return rounded_box(4); }},
        {"box", [] { return rounded_box(40); }},
        {"gear", [] { return gear(2'400); }},
        {"gear", [] { return gear(40'000); }},
        {"graded", [] { return graded(48, 80); }},
        {"graded", [] { return graded(256, 500); }},
        {"clusters", [] { return clustered(3, 5'000); }},
        {"clusters", [] { return clustered(6, 50'000); }},
        {"cavity", [] { return cavity(7); }},
        {"funnel", [] { return funnel(2'000, 0.0); }},
        {"funnel", [] { return funnel(5'000, 1.0); }},
    };
    return all;
}

}  // namespace tactus::shared
