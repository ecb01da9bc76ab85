#include "shared/unseen_meshes.hpp"

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/geometry/shared_mesh.hpp"
#include "shared/meshes.hpp"
#include "shared/noise.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

using Index = std::uint32_t;
constexpr double turn = 2.0 * std::numbers::pi;

// across x along squares of two triangles over [0, 1]^2, whose first and last columns or rows may be one.
struct Sheet {
    int across, along;
    bool is_closed_across = false, is_closed_along = false;

    TriangleMesh bent(const std::function<Vec3(double, double)>& place) const {
        const int columns = across + (is_closed_across ? 0 : 1);
        const int rows = along + (is_closed_along ? 0 : 1);
        const auto index = [&](int u, int v) {
            return static_cast<Index>((v % rows) * columns + u % columns);
        };
        TriangleMesh mesh;
        for (int v = 0; v < rows; ++v) {
            for (int u = 0; u < columns; ++u) {
                mesh.vertices.push_back(place(double(u) / across, double(v) / along));
            }
        }
        for (int v = 0; v < along; ++v) {
            for (int u = 0; u < across; ++u) {
                mesh.triangles.push_back({index(u, v), index(u + 1, v), index(u + 1, v + 1)});
                mesh.triangles.push_back({index(u, v), index(u + 1, v + 1), index(u, v + 1)});
            }
        }
        return fitted(std::move(mesh));
    }
};

// Perpendicular to both, and to each other.
struct Frame {
    Vec3 right, up;

    Frame(const Vec3& forward, const Vec3& other)
        : right(glm::normalize(glm::cross(forward, other))), up(glm::cross(forward, right)) {}
    Vec3 around(double share) const { return std::cos(turn * share) * right + std::sin(turn * share) * up; }
};

// Of a ball, what lies lower than that.
TriangleMesh lower_part(int levels, double radius, double height) {
    TriangleMesh ball = icosphere(levels, radius);
    std::erase_if(ball.triangles, [&](const std::array<Index, 3>& t) {
        return ball.vertices[t[0]].z + ball.vertices[t[1]].z + ball.vertices[t[2]].z >= 3.0 * height;
    });
    return ball;
}

}  // namespace

TriangleMesh urchin(int needles, int sides) {
    RandomValues random(77);
    TriangleMesh mesh = icosphere(4, 0.3);
    for (int i = 0; i < needles; ++i) {
        const Vec3 out = random.direction();
        const Frame frame(out, random.direction());
        const double length = random.between(0.32, 0.5);
        const double thickness = random.between(0.001, 0.01);
        const auto tip = static_cast<Index>(mesh.vertices.size());
        mesh.vertices.push_back(length * out + random.in_ball(0.02));
        for (int k = 0; k < sides; ++k) {
            mesh.vertices.push_back(0.29 * out + thickness * frame.around(double(k) / sides));
            const auto next = static_cast<Index>((k + 1) % sides);
            mesh.triangles.push_back({tip, tip + 1 + static_cast<Index>(k), tip + 1 + next});
        }
    }
    return fitted(std::move(mesh));
}

TriangleMesh knot(int around, int along) {
    const auto middle = [](double t) {
        const double wide = 1.0 + 0.4 * std::cos(12.0 * turn * t);
        return Vec3(wide * std::cos(5.0 * turn * t), wide * std::sin(5.0 * turn * t),
                    0.4 * std::sin(12.0 * turn * t));
    };
    return Sheet{around, along, true, true}.bent([&](double u, double v) {
        const Vec3 place = middle(v);
        const Frame frame(glm::normalize(middle(v + 1e-5) - place), Vec3(0.3, 0.2, 0.9));
        return place + 0.06 * (1.0 + 0.3 * std::cos(turn * (3.0 * u + 40.0 * v))) * frame.around(u);
    });
}

TriangleMesh bolt(int around, int along) {
    return Sheet{around, along, true, false}.bent([](double u, double v) {
        const double turns = 20.0 * v - u;
        const double radius = 0.3 + 0.08 * std::abs(turns - std::floor(turns) - 0.5);
        return Vec3(radius * std::cos(turn * u), radius * std::sin(turn * u), v);
    });
}

TriangleMesh scattered(int triangles) {
    RandomValues random(4321);
    TriangleMesh mesh;
    for (int i = 0; i < triangles; ++i) {
        const Vec3 place = random.in_box(0.5);
        const double size = random.magnitude(1e-4, 0.3) * (i % 50 == 0 ? 1.0 : 0.05);
        add_loose(mesh,
                  {place + random.in_ball(size), place + random.in_ball(size), place + random.in_ball(size)});
    }
    return fitted(std::move(mesh));
}

TriangleMesh crumpled(int cells) {
    return Sheet{cells, cells}.bent([](double u, double v) {
        const Vec3 flat(u - 0.5, v - 0.5, 0.0);
        const auto noise = [&](double off) { return fractal_noise(3.0 * flat + Vec3(off, off, off), 6); };
        return flat + 0.12 * Vec3(noise(0.0), noise(17.3), 2.0 * noise(41.7));
    });
}

TriangleMesh klein_bottle(int around, int across) {
    return Sheet{around, across}.bent([](double a, double b) {
        const double half = 0.5 * turn * a, u = turn * a, v = turn * b;
        const double wide = 2.0 + std::cos(half) * std::sin(v) - std::sin(half) * std::sin(2.0 * v);
        return Vec3(wide * std::cos(u), wide * std::sin(u),
                    std::sin(half) * std::sin(v) + std::cos(half) * std::sin(2.0 * v));
    });
}

TriangleMesh pit(int slivers, double tilt) {
    TriangleMesh mesh;
    mesh.vertices.push_back({tilt, 0.0, -0.35});
    for (int i = 0; i < slivers; ++i) {
        const Vec3 out(std::cos(turn * i / slivers), std::sin(turn * i / slivers), 0.0);
        mesh.vertices.insert(mesh.vertices.end(), {0.4 * out, 0.5 * out});
    }
    for (int i = 0; i < slivers; ++i) {
        const auto here = static_cast<Index>(1 + 2 * i);
        const auto next = static_cast<Index>(1 + 2 * ((i + 1) % slivers));
        mesh.triangles.insert(mesh.triangles.end(),
                              {{0, here, next}, {here, here + 1, next + 1}, {here, next + 1, next}});
    }
    return mesh;
}

TriangleMesh socket(int levels, double radius) {
    TriangleMesh mesh = lower_part(levels, radius, 0.3 * radius);
    append(mesh, lower_part(3, 0.5, 0.1));
    return mesh;
}

TriangleMesh comb(int plates, int cells) {
    RandomValues random(9);
    TriangleMesh mesh;
    double x = -0.5;
    for (int i = 0; i < plates; ++i, x += random.magnitude(0.015, 0.11)) {
        TriangleMesh plate = grid_box(Vec3(0.002, 0.45, 0.45), cells);
        for (Vec3& v : plate.vertices) {
            v.x += x;
        }
        append(mesh, plate);
    }
    return fitted(std::move(mesh));
}

TriangleMesh stairs(int steps) {
    TriangleMesh mesh;
    for (int i = 0; i <= steps; ++i) {
        const double x = double(i) / steps - 0.5;
        for (const double rise : {0.0, 1e-4}) {
            const double z = 0.3 * std::sin(6.0 * x) + rise;
            mesh.vertices.insert(mesh.vertices.end(), {Vec3(x, -0.5, z), Vec3(x, 0.5, z)});
        }
    }
    for (Index i = 0; i + 3 < mesh.vertices.size(); i += 2) {
        mesh.triangles.insert(mesh.triangles.end(), {{i, i + 2, i + 3}, {i, i + 3, i + 1}});
    }
    return fitted(std::move(mesh));
}

std::span<const RoughMesh> unseen_meshes() {
    static constexpr RoughMesh all[] = {
        {"urchin", [] { return urchin(3'000, 6); }},
        {"urchin", [] { return urchin(20'000, 12); }},
        {"knot", [] { return knot(24, 2'000); }},
        {"knot", [] { return knot(64, 9'000); }},
        {"bolt", [] { return bolt(100, 800); }},
        {"bolt", [] { return bolt(500, 1'600); }},
        {"scattered", [] { return scattered(20'000); }},
        {"scattered", [] { return scattered(200'000); }},
        {"crumpled", [] { return crumpled(150); }},
        {"crumpled", [] { return crumpled(700); }},
        {"klein", [] { return klein_bottle(400, 200); }},
        {"pit", [] { return pit(3'000, 0.0); }},
        {"pit", [] { return pit(20'000, 0.05); }},
        {"socket", [] { return socket(5, 0.2002); }},
        {"socket", [] { return socket(7, 0.202); }},
        {"comb", [] { return comb(14, 4); }},
        {"comb", [] { return comb(14, 60); }},
        {"stairs", [] { return stairs(1'000); }},
        {"stairs", [] { return stairs(20'000); }},
    };
    return all;
}

}  // namespace tactus::shared
