// Triangles that somebody has modelled, scanned or typed: from a file's text or a scene's arrays to a tree, a
// hull, a field, a body that gives or a tool, and a hand that touches it.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/mesh/closed_mesh.hpp"
#include "core/mesh/convex_hull.hpp"
#include "core/mesh/iso_surface.hpp"
#include "core/mesh/mesh_check.hpp"
#include "core/mesh/obj_file.hpp"
#include "core/soft/soft_body.hpp"
#include "core/tool/tool_proxy.hpp"
#include "fuzz_target.hpp"
#include "shared/deforms.hpp"
#include "shared/meshes.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::fuzz {
namespace {

enum Kind : std::uint8_t { text, touched, deformed, hull, field, soft, sheet, tool, heights, count };

constexpr std::size_t max_corners = 64, max_triangles = 128;

bool is_sound(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::vector<Vec3> places(Numbers& numbers) {
    std::vector<Vec3> all(numbers.byte() % (max_corners + 1));
    for (Vec3& place : all) {
        place = numbers.vector();
    }
    return all;
}

TriangleMesh mesh(Numbers& numbers) {
    TriangleMesh made;
    made.vertices = places(numbers);
    made.triangles.resize(numbers.byte() % (max_triangles + 1));
    for (auto& triangle : made.triangles) {
        for (std::uint32_t& corner : triangle) {
            const std::uint8_t number = numbers.byte();
            // One that is not there, now and then.
            corner = number < 0xff ? number % std::max<std::uint32_t>(1, made.vertices.size())
                                   : numbers.integer<std::uint32_t>();
        }
    }
    return made;
}

void draw(shared::TouchRig& rig, Numbers& numbers, int ticks) {
    for (int i = 0; i < ticks; ++i) {
        const ProxyTick tick = rig.tick(numbers.vector());
        must(is_sound(tick.position) && is_sound(tick.slide), "a pointer is at a place");
    }
}

double any_radius(Numbers& numbers) {
    return 1e-3 * (1 + numbers.byte());
}

void touch(const TriangleMesh& made, Numbers& numbers) {
    const std::string wrong = check_mesh(made);
    MeshShape shape{std::make_shared<const TriangleMesh>(made), 0.0, numbers.flag()};
    shape.smooth_below = numbers.flag() ? 1.0 : 0.0;
    shared::TouchRig rig(any_radius(numbers));
    const int body = rig.add(Shape(shape), Pose{});
    must(body < 0 || wrong.empty(), "what can be touched is sound");
    must(body >= 0 || !wrong.empty() || shape.one_sided, "what is sound can be touched");
    if (body < 0) {
        return;
    }
    draw(rig, numbers, 8);
    // It is put elsewhere under the hand.
    rig.tick(numbers.vector(), body, {numbers.vector(), Quat(1.0, 0.0, 0.0, 0.0)});
    draw(rig, numbers, 4);
}

void read_text(std::span<const std::byte> bytes) {
    ObjLimits limits;
    limits.polygon_work = 1'000'000;
    const std::string_view words(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const ObjResult read = read_obj_file(words, limits);
    must(read.error.empty() || read.mesh.triangles.empty(), "a text that is not understood gives nothing");
    if (check_mesh(read.mesh).empty()) {
        Numbers nothing({});
        touch(read.mesh, nothing);
    }
}

// The same triangles, their corners elsewhere, under the hand.
void deform(Numbers& numbers) {
    TriangleMesh made = mesh(numbers);
    if (!check_mesh(made).empty()) {
        return;
    }
    shared::TouchRig rig(any_radius(numbers));
    std::vector<std::shared_ptr<const TouchShape>> forms{shared::touch_of(made)};
    const int body = rig.add(forms[0]);
    draw(rig, numbers, 4);
    for (int i = 0; i < 4; ++i) {
        const std::size_t first = numbers.below(made.vertices.size());
        for (std::size_t k = first; k < made.vertices.size() && k < first + 8; ++k) {
            made.vertices[k] += numbers.vector();
        }
        if (!check_mesh(made).empty()) {
            return;
        }
        forms.push_back(shared::refitted(*forms.back(), made));
        rig.scene.begin_tick();
        must(rig.scene.deform(body, *forms.back()), "the same triangles are a form of the same body");
        must(is_sound(rig.proxy.move(rig.scene, numbers.vector()).position),
             "a pointer on what deforms is at a place");
        draw(rig, numbers, 1);
    }
}

void wrap(Numbers& numbers) {
    const std::vector<Vec3> points = places(numbers);
    const TriangleMesh made = convex_hull(points);
    constexpr double far = 1e6;
    const bool is_near = std::ranges::all_of(
        points, [](const Vec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < far; });
    if (is_near && !made.triangles.empty()) {
        must(check_mesh(made).empty(), "a hull can be touched");
        must(is_closed(made), "a hull is closed");
    }
}

void fill_field(Numbers& numbers) {
    SampledField made;
    for (std::uint32_t& size : made.size) {
        const std::uint8_t number = numbers.byte();
        size = number < 0xf8 ? number % 8 : numbers.integer<std::uint32_t>();
    }
    made.spacing = numbers.vector();
    made.iso = numbers.real();
    made.inside_above = numbers.flag();
    std::vector<float> values(numbers.below(1024));
    for (float& value : values) {
        value = static_cast<float>(numbers.real());
    }
    made.values = values;
    const IsoSurface surface = iso_surface(made);
    must(surface.error.empty() || surface.mesh.triangles.empty(), "a field that has no surface gives none");
    if (check_mesh(surface.mesh).empty()) {
        must(is_closed(surface.mesh), "the surface of a field is closed");
    }
}

void give(Numbers& numbers, bool is_sheet) {
    const TriangleMesh made = mesh(numbers);
    SoftMaterial material;
    for (double* const value : {&material.stiffness, &material.poisson_ratio, &material.density,
                                &material.thickness, &material.damping, &material.drag, &material.friction}) {
        *value *= numbers.flag() ? 1.0 : numbers.real();
    }
    const HeldParts held{numbers.vector(), numbers.vector(), {numbers.byte(), numbers.byte()}};
    const SoftModelResult result = is_sheet
                                       ? make_soft_sheet(made, material, held, 1e-3)
                                       : make_soft_volume(made, numbers.byte() % 8, material, held, 1e-3);
    must((result.model == nullptr) == !result.error.empty(), "what gives is made, or it is said why not");
    if (result.model == nullptr) {
        return;
    }
    SoftBody body(result.model);
    std::vector<Vec3> surface(result.model->surface.vertices.size());
    for (int i = 0; i < 4; ++i) {
        SoftPush push;
        push.triangle = static_cast<std::uint32_t>(numbers.below(result.model->surface.triangles.size()));
        push.weights = Vec3(1.0 / 3.0);
        push.force = numbers.vector();
        push.stiffness = 1.0 + std::abs(1e-3 * numbers.integer<std::int16_t>());
        push.sticks = numbers.flag();
        if (is_sound(push.force) && glm::length(push.force) < 1e6) {
            body.step({0.0, -9.81, 0.0}, {&push, 1}, {});
        }
        body.write_surface(surface);
        must(std::ranges::all_of(surface, is_sound), "every place of what gives is one");
    }
}

void hold_tool(Numbers& numbers) {
    ToolShapeSettings settings;
    settings.max_spheres = 1 + numbers.byte() % 32;
    settings.tolerance = 1e-3 * (1 + numbers.byte());
    const ToolShapeResult made = make_tool_shape(mesh(numbers), settings);
    must((made.shape == nullptr) == !made.error.empty(), "a tool is made, or it is said why not");
    if (made.shape == nullptr) {
        return;
    }
    must(made.shape->spheres.size() <= settings.max_spheres, "a tool has no more spheres than it may");
    shared::TouchRig rig(0.01);
    rig.add(shared::box(Vec3(0.5)));
    ToolProxy held(made.shape, 64, {});
    for (int i = 0; i < 4; ++i) {
        rig.scene.begin_tick();
        const ToolTick tick = held.move(rig.scene, {numbers.vector(), Quat(1.0, 0.0, 0.0, 0.0)});
        must(is_sound(tick.pose.position) && is_sound(tick.force) && is_sound(tick.torque),
             "a tool is at a place");
    }
}

void raise(Numbers& numbers) {
    HeightFieldShape made;
    const bool is_large = numbers.byte() >= 0xf8;
    made.columns = is_large ? numbers.integer<std::uint32_t>() : numbers.byte() % 16;
    made.rows = is_large ? numbers.integer<std::uint32_t>() : numbers.byte() % 16;
    made.scale = numbers.vector();
    auto values = std::make_shared<std::vector<float>>(numbers.below(257));
    for (float& value : *values) {
        value = static_cast<float>(numbers.real());
    }
    made.heights = values;
    shared::TouchRig rig(any_radius(numbers));
    if (rig.add(Shape(made)) >= 0) {
        draw(rig, numbers, 8);
    }
}

}  // namespace

void play(std::span<const std::byte> input) {
    Numbers numbers(input);
    switch (numbers.byte() % Kind::count) {
        case text:
            return read_text(numbers.rest());
        case touched:
            return touch(mesh(numbers), numbers);
        case deformed:
            return deform(numbers);
        case hull:
            return wrap(numbers);
        case field:
            return fill_field(numbers);
        case soft:
            return give(numbers, false);
        case sheet:
            return give(numbers, true);
        case tool:
            return hold_tool(numbers);
        default:
            return raise(numbers);
    }
}

namespace {

// As Numbers reads them.
class Written {
public:
    explicit Written(Kind kind) { byte(kind); }
    Written& byte(std::size_t value) {
        bytes.push_back(static_cast<std::byte>(value));
        return *this;
    }
    Written& vector(const Vec3& v) {
        for (const double part : {v.x, v.y, v.z}) {
            const auto steps = static_cast<std::int16_t>(std::lround(1e3 * part));
            byte(0)
                .byte(static_cast<std::uint16_t>(steps) & 0xffu)
                .byte(static_cast<std::uint16_t>(steps) >> 8u);
        }
        return *this;
    }
    Written& places(const std::vector<Vec3>& all) {
        byte(all.size());
        for (const Vec3& place : all) {
            vector(place);
        }
        return *this;
    }
    Written& mesh(const TriangleMesh& mesh) {
        places(mesh.vertices).byte(mesh.triangles.size());
        for (const auto& triangle : mesh.triangles) {
            byte(triangle[0]).byte(triangle[1]).byte(triangle[2]);
        }
        return *this;
    }
    Bytes bytes;
};

}  // namespace

std::vector<Bytes> seeds() {
    const TriangleMesh ball = shared::icosphere(1, 0.1), block = shared::box(Vec3(0.05)),
                       cloth = shared::terrain(4, 0.2, 0.02);
    std::vector<Bytes> all;
    constexpr std::string_view words =
        "o Box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 -1e-1\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\nf -1 -2 -3 \\\n\nl "
        "1 2\n";
    all.push_back(of_kind(text, std::as_bytes(std::span(words))));
    for (const TriangleMesh* const mesh : {&ball, &block, &cloth}) {
        for (const Kind kind : {touched, deformed}) {
            Written one(kind);
            one.mesh(*mesh).byte(0).byte(1).byte(9);
            for (int i = 0; i < 16; ++i) {
                one.vector({0.02 * i - 0.15, 0.12 - 0.01 * i, 0.01});
            }
            all.push_back(std::move(one.bytes));
        }
        all.push_back(std::move(Written(hull).places(mesh->vertices).bytes));
    }
    Written cube(field);
    cube.byte(4).byte(4).byte(4).vector(Vec3(0.05)).byte(0).byte(0).byte(0).byte(0).byte(64).byte(0);
    for (int i = 0; i < 64; ++i) {
        const bool is_inside = i % 4 % 3 != 0 && i / 4 % 4 % 3 != 0 && i / 16 % 3 != 0;
        cube.byte(0).byte(is_inside ? 0xf0 : 20).byte(is_inside ? 0xff : 0);
    }
    all.push_back(std::move(cube.bytes));
    for (const Kind kind : {soft, sheet}) {
        Written one(kind);
        one.mesh(kind == soft ? block : cloth);
        for (int i = 0; i < 7; ++i) {
            one.byte(1);
        }
        one.vector(Vec3(-1.0)).vector({1.0, -0.04, 1.0}).byte(0).byte(1).byte(3);
        all.push_back(std::move(one.bytes));
    }
    Written held(tool);
    held.byte(31).byte(9).mesh(block);
    for (int i = 0; i < 4; ++i) {
        held.vector({0.0, 0.8 - 0.1 * i, 0.0});
    }
    all.push_back(std::move(held.bytes));
    Written hills(heights);
    hills.byte(0).byte(4).byte(4).vector({0.1, 1.0, 0.1}).byte(16).byte(0);
    for (int i = 0; i < 16; ++i) {
        hills.byte(0).byte(static_cast<std::size_t>(7 * i % 30)).byte(0);
    }
    hills.byte(9).vector({0.0, 0.1, 0.0}).vector({0.0, -0.1, 0.0}).vector({0.1, -0.1, 0.05});
    all.push_back(std::move(hills.bytes));
    return all;
}

}  // namespace tactus::fuzz
