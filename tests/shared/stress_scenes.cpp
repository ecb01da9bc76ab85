#include "shared/stress_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "shared/meshes.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/settled_shape.hpp"

namespace tactus::shared {

namespace {

StressSetting named(const char* name) {
    StressSetting s;
    s.name = name;
    s.mesh = std::make_shared<TriangleMesh>();
    return s;
}

int inside(const StressSetting& s, const Vec3& p) {
    return winding(*s.mesh, p);
}

void add_triangle(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
}

void add_quad(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    add_triangle(mesh, a, b, c);
    add_triangle(mesh, a, c, d);
}

StressSetting soup(RandomValues& random) {
    StressSetting s = named("soup");
    *s.mesh = shared::soup(20 + random.below(100), 1.0, static_cast<unsigned>(random.below(1 << 30)));
    return s;
}

StressSetting slivers(RandomValues& random) {
    StressSetting s = named("slivers");
    const int count = 20 + random.below(60);
    for (int i = 0; i < count; ++i) {
        const Vec3 a = random.in_ball(1.0);
        const Vec3 b = random.flip() ? random.in_ball(1.0) : a + random.in_ball(0.3);
        const double width = random.below(4) == 0 ? 0.0 : random.magnitude(1e-18, 1e-2);
        add_triangle(*s.mesh, a, b, a + (b - a) * random.between(-0.2, 1.2) + random.in_ball(1.0) * width);
    }
    add_triangle(*s.mesh, random.in_ball(1.0), random.in_ball(1.0), random.in_ball(1.0));
    return s;
}

StressSetting wedge(RandomValues& random) {
    StressSetting s = named("wedge");
    const double angle = (random.flip() ? random.between(0.5, 179.5) : (random.flip() ? 0.5 : 179.5)) *
                         std::numbers::pi / 180.0;
    *s.mesh = shared::groove(angle, 8.0);
    for (Vec3& v : s.mesh->vertices) {
        v *= Vec3(4.0, 4.0, 1.0);
    }
    // Beside which wall, seen around the edge.
    s.side = [angle](const StressSetting& at, const Vec3& world) {
        const Vec3 p = at.from_world(world);
        return std::abs(std::atan2(p.x, p.y)) < 0.5 * angle ? 1 : 0;
    };
    return s;
}

StressSetting plates(RandomValues& random) {
    StressSetting s = named("plates");
    const double gap = random.below(3) == 0 ? 0.0 : random.magnitude(1e-12, 1e-3);
    for (const double y : {0.0, -gap}) {
        add_quad(*s.mesh, {-4.0, y, -4.0}, {4.0, y, -4.0}, {4.0, y, 4.0}, {-4.0, y, 4.0});
    }
    s.side = [](const StressSetting& at, const Vec3& world) {
        const Vec3 p = at.from_world(world);
        return p.y > 0.0 ? 1 : -1;
    };
    return s;
}

StressSetting t_junctions(RandomValues& random) {
    StressSetting s = named("T-junctions");
    add_quad(*s.mesh, {-4.0, 0.0, -4.0}, {0.0, 0.0, -4.0}, {0.0, 0.0, 4.0}, {-4.0, 0.0, 4.0});
    const int pieces = 2 + random.below(40);
    const double lift = random.between(-0.3, 0.3);  // the fine half may lean
    for (int i = 0; i < pieces; ++i) {
        const double z0 = -4.0 + 8.0 * i / pieces;
        const double z1 = -4.0 + 8.0 * (i + 1) / pieces;
        add_quad(*s.mesh, {0.0, 0.0, z0}, {4.0, 4.0 * lift, z0}, {4.0, 4.0 * lift, z1}, {0.0, 0.0, z1});
    }
    s.side = [lift](const StressSetting& at, const Vec3& world) {
        const Vec3 p = at.from_world(world);
        return p.y > std::max(p.x, 0.0) * lift ? 1 : -1;
    };
    return s;
}

StressSetting box(RandomValues& random) {
    StressSetting s = named("box");
    const Vec3 half(random.between(0.1, 0.8), random.magnitude(1e-9, 0.8), random.between(0.1, 0.8));
    *s.mesh = shared::box(half);
    s.side = inside;
    s.deforms = true;
    return s;
}

StressSetting star(RandomValues& random) {
    StressSetting s = named("star");
    *s.mesh = shared::icosphere(1 + random.below(2), 1.0);
    for (Vec3& v : s.mesh->vertices) {
        v *= random.between(0.3, 0.9);
    }
    s.side = inside;
    s.deforms = true;
    return s;
}

constexpr int hill_cells = 12;
constexpr double hill_size = 6.0;

StressSetting hills(RandomValues& random) {
    StressSetting s = named("hills");
    constexpr int side = hill_cells + 1;
    for (int i = 0; i < side * side; ++i) {
        s.mesh->vertices.push_back({hill_size * (i % side / double{hill_cells} - 0.5),
                                    random.between(-0.3, 0.3),
                                    hill_size * (i / side / double{hill_cells} - 0.5)});
    }
    for (std::uint32_t z = 0; z < hill_cells; ++z) {
        for (std::uint32_t x = 0; x < hill_cells; ++x) {
            const std::uint32_t a = z * side + x;
            s.mesh->triangles.push_back({a, a + side, a + 1});
            s.mesh->triangles.push_back({a + 1, a + side, a + side + 1});
        }
    }
    s.deforms = true;
    s.side = [](const StressSetting& at, const Vec3& world) {
        const Vec3 p = at.from_world(world);
        const double u = std::clamp((p.x / hill_size + 0.5) * hill_cells, 0.0, hill_cells - 1e-9);
        const double v = std::clamp((p.z / hill_size + 0.5) * hill_cells, 0.0, hill_cells - 1e-9);
        const int x = static_cast<int>(u);
        const int z = static_cast<int>(v);
        const double a = u - x;
        const double b = v - z;
        const auto height = [&](int i, int j) {
            return at.from_world(at.mesh->vertices[static_cast<std::size_t>((z + j) * side + x + i)]).y;
        };
        const double surface =
            a + b <= 1.0 ? height(0, 0) * (1.0 - a - b) + height(1, 0) * a + height(0, 1) * b
                         : height(1, 1) * (a + b - 1.0) + height(0, 1) * (1.0 - a) + height(1, 0) * (1.0 - b);
        return p.y > surface ? 1 : -1;
    };
    return s;
}

// A pit (or, from below, a spike) of many facets that meet in one corner.
StressSetting pit(RandomValues& random) {
    StressSetting s = named("pit");
    const int sides = 3 + random.below(120);
    const double slope = random.magnitude(0.02, 20.0);
    const double wide = std::min(4.0, 8.0 / slope);
    const auto rim = [&](int i) {
        const double a = 2.0 * std::numbers::pi * i / sides;
        return Vec3(wide * std::cos(a), wide * slope, wide * std::sin(a));
    };
    for (int i = 0; i < sides; ++i) {
        add_triangle(*s.mesh, Vec3(0.0), rim(i), rim((i + 1) % sides));
    }
    s.reach = 0.2;
    s.radius = 0.01;
    return s;
}

// Sheets that share one edge, like the pages of a book.
StressSetting book(RandomValues& random) {
    StressSetting s = named("book");
    const int pages = 3 + random.below(9);
    std::vector<double> angles;
    for (int i = 0; i < pages; ++i) {
        angles.push_back(random.between(-std::numbers::pi, std::numbers::pi));
        const Vec3 out(4.0 * std::cos(angles.back()), 4.0 * std::sin(angles.back()), 0.0);
        const Vec3 along(0.0, 0.0, 4.0);
        add_quad(*s.mesh, -along, along, out + along, out - along);
    }
    std::ranges::sort(angles);
    s.side = [angles](const StressSetting& at, const Vec3& world) {
        const Vec3 p = at.from_world(world);
        const auto below =
            static_cast<int>(std::ranges::upper_bound(angles, std::atan2(p.y, p.x)) - angles.begin());
        return below % static_cast<int>(angles.size());
    };
    return s;
}

// --- Large meshes, each made once --------------------------------------------------------------------------

struct DenseMesh {
    const char* name;
    std::shared_ptr<TriangleMesh> mesh;
    std::shared_ptr<const TouchShape> shape;
    std::unique_ptr<const JudgeTree> tree;
    bool closed;
};

DenseMesh dense(const char* name, bool closed, TriangleMesh mesh) {
    DenseMesh made{name, std::make_shared<TriangleMesh>(std::move(mesh)), nullptr, nullptr, closed};
    const PlacedShape placed{MeshShape{made.mesh}, {}};
    made.shape = make_touch_shape({&placed, 1}).shape;
    settle(*made.shape);
    made.tree = std::make_unique<const JudgeTree>(*made.mesh);
    return made;
}

const DenseMesh& dense_mesh(std::size_t index) {
    static std::array<std::unique_ptr<const DenseMesh>, 6> made;
    if (!made[index]) {
        const auto make = [&] {
            switch (index) {
                case 0:
                    return dense("a heap of a million", false, clustered(1, 1'000'000));
                case 1:
                    return dense("heaps", false, clustered(6, 20'000));
                case 2:
                    return dense("gear", true, gear(40'000));
                case 3:
                    return dense("cavity", true, cavity(7));
                case 4:
                    return dense("graded", true, graded(256, 500));
                default:
                    return dense("scan", false, scanned(6));
            }
        };
        made[index] = std::make_unique<const DenseMesh>(make());
    }
    return *made[index];
}

}  // namespace

StressSetting make_small_setting(RandomValues& random) {
    constexpr StressSetting (*kinds[])(RandomValues&) = {soup, slivers, wedge, plates, t_junctions,
                                                         box,  star,    hills, pit,    book};
    StressSetting s = kinds[random.below(static_cast<int>(std::size(kinds)))](random);
    s.radius *= random.magnitude(0.1, 3.0);
    s.scale = random.flip() ? 1.0 : random.magnitude(1e-3, 1e3);
    s.place = random.below(3) == 0 ? std::min(1e4, 1e6 * s.scale) * random.direction() : Vec3(0.0);
    for (Vec3& v : s.mesh->vertices) {
        v = s.to_world(v);
    }
    return s;
}

StressSetting make_dense_setting(RandomValues& random) {
    const DenseMesh& large = dense_mesh(static_cast<std::size_t>(random.below(6)));
    StressSetting s;
    s.name = large.name;
    s.mesh = large.mesh;
    s.shape = large.shape;
    s.tree = large.tree.get();
    s.radius = random.magnitude(0.01, 0.25);
    s.reach = s.radius * random.magnitude(0.3, 3.0);
    // Most corners are where most triangles are.
    s.around =
        large.mesh
            ->vertices[static_cast<std::size_t>(random.below(static_cast<int>(large.mesh->vertices.size())))];
    return s;
}

std::shared_ptr<const TouchShape> narrowed_dense(const StressSetting& setting) {
    static std::map<std::pair<const TouchShape*, int>, std::shared_ptr<const TouchShape>> made;
    const int octave = static_cast<int>(std::floor(std::log2(setting.radius)));
    const auto [at, is_new] = made.try_emplace({setting.shape.get(), octave}, setting.shape);
    if (is_new) {
        if (auto shape = narrowed(*setting.shape, std::exp2(octave))) {
            settle(*shape);
            at->second = std::move(shape);
        }
    }
    return at->second;
}

void deform(StressSetting& setting, RandomValues& random, double farthest) {
    const double share = farthest / setting.scale;
    const Vec3 sizes = random.in_box(share);
    for (Vec3& v : setting.mesh->vertices) {
        Vec3 p = setting.from_world(v);
        if (std::string_view(setting.name) == "hills") {
            p.y = std::clamp(p.y + random.between(-share, share), -0.6, 0.6);
        } else if (std::string_view(setting.name) == "star") {
            const double length = glm::length(p);
            p *= std::clamp(length + random.between(-share, share), 0.25, 1.0) / length;
        } else {
            for (int axis = 0; axis < 3; ++axis) {
                const double half = std::clamp(std::abs(p[axis]) + sizes[axis], 0.02, 1.0);
                p[axis] = p[axis] < 0.0 ? -half : half;
            }
        }
        v = setting.to_world(p);
    }
}

}  // namespace tactus::shared
