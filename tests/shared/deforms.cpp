#include "shared/deforms.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::shared {

namespace {

// cells x cells squares in x-z; with a thickness, two of them and a rim.
TriangleMesh sheet(int cells, double size, double thickness) {
    TriangleMesh mesh;
    const auto side = static_cast<std::uint32_t>(cells + 1);
    const std::uint32_t layers = thickness > 0.0 ? 2 : 1;
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
        for (std::uint32_t z = 0; z < side; ++z) {
            for (std::uint32_t x = 0; x < side; ++x) {
                mesh.vertices.push_back({size * (x / static_cast<double>(cells) - 0.5), -thickness * layer,
                                         size * (z / static_cast<double>(cells) - 0.5)});
            }
        }
        for (std::uint32_t z = 0; z + 1 < side; ++z) {
            for (std::uint32_t x = 0; x + 1 < side; ++x) {
                const std::uint32_t corner = layer * side * side + z * side + x;
                mesh.triangles.push_back({corner, corner + side, corner + 1});
                mesh.triangles.push_back({corner + 1, corner + side, corner + side + 1});
            }
        }
    }
    return mesh;
}

}  // namespace

std::shared_ptr<const TouchShape> touch_of(const TriangleMesh& mesh) {
    const PlacedShape placed{MeshShape{std::make_shared<const TriangleMesh>(mesh)}, {}};
    return make_touch_shape({&placed, 1}).shape;
}

std::shared_ptr<const TouchShape> refitted(const TouchShape& before, const TriangleMesh& moved) {
    auto after = std::make_shared<TouchShape>(before);
    TouchPart& part = after->parts.front();
    const auto tree = std::make_shared<const TriangleTree>(part.tree()->refitted(moved));
    part.surface = tree;
    part.touchable = nullptr;  // of the tree before
    part.radius = tree->radius();
    after->reach = glm::length(tree->center()) + tree->radius();
    return after;
}

RandomWay::RandomWay(RandomValues& random, double farthest, double size, bool gentle) {
    const double amplitude = farthest / 3.0;  // all four waves hardly ever add up
    for (Wave& wave : waves_) {
        const double steepest = gentle ? 0.2 / amplitude : 1e300;
        wave.amplitude = amplitude * random.direction();
        wave.frequency = std::min(random.between(0.3, 12.0) / size, steepest) * random.direction();
        wave.phase = random.between(0.0, 6.283);
    }
}

Vec3 RandomWay::of(const Vec3& place) const {
    Vec3 way(0.0);
    for (const Wave& wave : waves_) {
        way += wave.amplitude * std::sin(glm::dot(wave.frequency, place) + wave.phase);
    }
    return way;
}

Vec3 RandomWay::origin_of(const Vec3& place) const {
    Vec3 origin = place;
    for (int i = 0; i < 200; ++i) {
        origin = place - of(origin);
    }
    return origin;
}

TriangleMesh moved(const TriangleMesh& rest, const RandomWay& way) {
    TriangleMesh mesh = rest;
    for (Vec3& v : mesh.vertices) {
        v += way.of(v);
    }
    return mesh;
}

void DeformFigures::add(const DeformFigures& other) {
    deformations += other.deformations;
    passes += other.passes;
    let_out += other.let_out;
    touched += other.touched;
    farthest = std::max(farthest, other.farthest);
}

DeformFigures play_deforms(std::uint64_t seed) {
    RandomValues random(seed);
    const double radius = random.magnitude(1e-3, 0.1);
    const int kind = static_cast<int>(seed % 4);  // ball, crumpled ball, sheet, thin plate
    const bool flat = kind >= 2;
    const double size = radius * (flat ? 120.0 : random.magnitude(3.0, 30.0));
    const TriangleMesh rest =
        flat ? sheet(24, size, kind == 3 ? 0.3 * radius : 0.0) : icosphere(random.below(3) + 1, size);
    const bool gentle = flat;
    RandomWay way(random, 0.0, size, true);
    TriangleMesh mesh = rest;
    TouchRig rig(radius);
    std::vector<std::shared_ptr<const TouchShape>> forms{touch_of(mesh)};
    const int body = rig.add(forms.back());
    Vec3 hand = flat ? Vec3(0.0, 3.0 * radius, 0.0) : (size + 2.0 * radius) * random.direction();
    if (flat && random.flip()) {
        hand.y = -4.0 * radius;
    }
    rig.tick(hand);
    DeformFigures figures;
    for (int i = 0; i < 20; ++i) {
        // Presses in a little, or waits beside.
        const Vec3 target = flat ? way.of(Vec3(0.0)) : Vec3(0.0);
        hand += std::min(random.between(0.0, 4.0) * radius, glm::distance(hand, target)) *
                (glm::distance(hand, target) > 0.0 ? glm::normalize(target - hand) : Vec3(0.0));
        for (int k = 0; k < 3; ++k) {
            rig.tick(hand);
        }
        const Vec3 before = rig.proxy.position();
        const RandomWay next(random, random.between(0.2, 5.0) * radius, size, gentle);
        TriangleMesh deformed = moved(rest, next);
        if (kind == 1) {
            for (Vec3& v : deformed.vertices) {
                v += random.in_ball(2.5 * radius);
            }
        }
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
            figures.farthest =
                std::max(figures.farthest, glm::distance(mesh.vertices[v], deformed.vertices[v]) / radius);
        }
        forms.push_back(refitted(*forms.back(), deformed));
        rig.scene.begin_tick();
        rig.scene.deform(body, *forms.back());
        const ProxyTick tick = rig.proxy.move(rig.scene, hand);
        const bool let_out = (tick.status & (proxy_letting_out | proxy_absent)) != 0;
        bool passed = false;
        if (flat) {
            const double was = way.origin_of(before).y;
            const double is = next.origin_of(tick.position).y;
            passed = (was > -0.15 * radius) != (is > -0.15 * radius);
        } else {
            passed = winding(mesh, before) != winding(deformed, tick.position);
        }
        ++figures.deformations;
        figures.let_out += let_out;
        figures.passes += passed && !let_out;
        figures.touched += (tick.status & proxy_touching) != 0;
        mesh = deformed;
        way = next;
        if (let_out) {  // on from a free place
            hand = flat ? way.of(Vec3(0.0)) + Vec3(0.0, 8.0 * radius, 0.0)
                        : hand + (3.0 * size + 20.0 * radius) * glm::normalize(hand + Vec3(1e-9));
            for (int k = 0; k < 3; ++k) {
                rig.tick(hand);
            }
            if (!flat) {
                hand = (size + 6.0 * radius) * random.direction();
                rig.tick(hand);
            }
        }
    }
    return figures;
}

}  // namespace tactus::shared
