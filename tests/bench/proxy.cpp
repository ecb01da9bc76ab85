// The proxy, timed tick by tick and held against exact descent, beside one sphere cast of Jolt and one convex
// sweep of Bullet over the same segments.
//
//     proxy [--most=1310720] [--ticks=20000] [--rounds=4] [--checks=1500]
//     proxy --mesh=FILE.obj --hip=FILE.csv --radius=R [--static-friction=F --dynamic-friction=F]
//     [--two-sided]
//           --trace=OUT.csv
//
// The second form replays a hand path (x,y,z a line, one line a tick) over any mesh, with stiffness 1. Meshes
// are touched from both sides with and without --two-sided, which is there so that the same command line may
// serve engines that tell the difference.
//
// Times are those of one whole tick (motion and force) on one processor; of several rounds, before and after
// the casts of the others, the quietest counts: what other programs take away varies. A segment is that of
// the tick: from where the proxy is to the hand.
#include <glm/geometric.hpp>
#include <numbers>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>

#include <Jolt/Jolt.h>
// Jolt's own headers need its first one before them.
#include <Jolt/Physics/Collision/CastResult.h>
#include <Jolt/Physics/Collision/CollisionCollectorImpl.h>
#include <Jolt/Physics/Collision/CollisionDispatch.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Collision/ShapeCast.h>

#if __has_include(<btBulletCollisionCommon.h>)
#include <btBulletCollisionCommon.h>
#define TACTUS_HAS_BULLET 1
#endif

#include "core/geometry/mesh_check.hpp"
#include "core/geometry/obj_text.hpp"
#include "core/haptics/force_law.hpp"
#include "physics/jolt_runtime.hpp"
#include "proxy/rough.hpp"
#include "shared/bench_kit.hpp"
#include "shared/hand_paths.hpp"
#include "shared/meshes.hpp"
#include "shared/reference_descent.hpp"
#include "shared/touch_rig.hpp"

namespace {

using namespace tactus;
using shared::quantile;
using shared::Report;
using shared::SpanClock;
using shared::TouchRig;

struct Segment {
    Vec3 from, to;
};

struct Tick {
    Vec3 hand;
    ProxyTick proxy;
    Segment segment;
    double nanoseconds = 0.0;
    bool touching = false;
};

struct Settings {
    int ticks = 20'000;
    int rounds = 4;
    int checks = 1'500;  // ticks held against exact descent
    int most = 1'310'720;
};

std::vector<Tick> replay(const SpanClock& clock, TouchRig& rig, const std::vector<Vec3>& way) {
    std::vector<Tick> ticks;
    ticks.reserve(way.size());
    Vec3 before = way.front();
    for (const Vec3& hand : way) {
        const std::uint64_t start = clock.now();
        const ProxyTick tick = rig.tick(hand);
        const HandForce force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3);
        const std::uint64_t end = clock.now();
        ticks.push_back({hand, tick, {before, hand}, clock.nanoseconds(start, end), force.contact_count > 0});
        before = tick.position;
    }
    return ticks;
}

struct Times {
    double contact_median = 0.0, contact_p99 = 0.0, free_median = 0.0;  // (unit: microseconds)
};

Times times_of(const std::vector<Tick>& ticks) {
    std::vector<double> contact, free;
    for (const Tick& tick : ticks) {
        (tick.touching ? contact : free).push_back(tick.nanoseconds * 1e-3);
    }
    return {quantile(contact, 0.5), quantile(contact, 0.99), quantile(free, 0.5)};
}

struct Errors {
    double rms = 0.0, most = 0.0, direction = 0.0;  // (unit: meters, meters, degrees)
    int unsettled = 0, stuck = 0, checked = 0;
};

// A tick is stuck when the proxy stops short of the place that descent reaches from it.
Errors errors_of(const std::vector<Tick>& ticks, const TriangleMesh& mesh, double radius, int checks) {
    shared::ReferenceDescent reference(mesh, radius);
    const auto touching = static_cast<int>(std::ranges::count_if(ticks, &Tick::touching));
    const int every = std::max(1, touching / std::max(1, checks));
    Errors errors;
    double sum = 0.0;
    int seen = 0;
    for (const Tick& tick : ticks) {
        if (!tick.touching) {
            continue;
        }
        const bool unfinished = tick.proxy.status & proxy_unfinished;
        if (seen++ % every != 0 && !unfinished) {
            continue;
        }
        const shared::ReferencePlace place = reference.settle(tick.proxy.position, tick.hand);
        errors.unsettled += !place.settled;
        const auto error =
            static_cast<double>(glm::distance(place.position, shared::SlowVec3(tick.proxy.position)));
        const Vec3 pull = tick.proxy.position - tick.hand;
        const Vec3 right_pull = Vec3(place.position) - tick.hand;
        const double sine = glm::length(glm::cross(pull, right_pull));
        errors.direction = std::max(errors.direction,
                                    std::atan2(sine, glm::dot(pull, right_pull)) * 180.0 / std::numbers::pi);
        errors.most = std::max(errors.most, error);
        errors.stuck += error > 1e-5 || unfinished;
        sum += error * error;
        ++errors.checked;
    }
    errors.rms = errors.checked > 0 ? std::sqrt(sum / errors.checked) : 0.0;
    return errors;
}

std::vector<Segment> contact_segments(const std::vector<Tick>& ticks, std::size_t most) {
    std::vector<Segment> segments;
    for (const Tick& tick : ticks) {
        if (tick.touching) {
            segments.push_back(tick.segment);
        }
    }
    const std::size_t every = std::max<std::size_t>(1, segments.size() / most);
    std::vector<Segment> chosen;
    for (std::size_t i = 0; i < segments.size(); i += every) {
        chosen.push_back(segments[i]);
    }
    return chosen;
}

// Median time of `cast` over the segments (unit: microseconds).
template <class Cast>
double median_over(const SpanClock& clock, const std::vector<Segment>& segments, int rounds, Cast&& cast) {
    double best = 1e300;
    for (int round = 0; round < rounds; ++round) {
        std::vector<double> times;
        for (const Segment& segment : segments) {
            const std::uint64_t start = clock.now();
            cast(segment);
            times.push_back(clock.nanoseconds(start, clock.now()) * 1e-3);
        }
        best = std::min(best, quantile(times, 0.5));
    }
    return best;
}

JPH::Vec3 to_jolt(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

double jolt_median(const SpanClock& clock, const TriangleMesh& mesh, double radius,
                   const std::vector<Segment>& segments, int rounds) {
    start_jolt();
    JPH::VertexList vertices;
    for (const Vec3& v : mesh.vertices) {
        vertices.push_back({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
    }
    JPH::IndexedTriangleList triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
        triangles.push_back({a, b, c});
    }
    const auto made = JPH::MeshShapeSettings(std::move(vertices), std::move(triangles)).Create();
    if (made.HasError()) {
        std::fprintf(stderr, "Jolt refuses the mesh: %s\n", made.GetError().c_str());
        return 0.0;
    }
    const JPH::SphereShape sphere(static_cast<float>(radius));
    sphere.SetEmbedded();
    const JPH::ShapeCastSettings settings;
    const JPH::ShapeFilter everything;
    return median_over(clock, segments, rounds, [&](const Segment& segment) {
        const JPH::ShapeCast cast(&sphere, JPH::Vec3::sOne(), JPH::Mat44::sTranslation(to_jolt(segment.from)),
                                  to_jolt(segment.to - segment.from));
        JPH::ClosestHitCollisionCollector<JPH::CastShapeCollector> hit;
        JPH::CollisionDispatch::sCastShapeVsShapeLocalSpace(
            cast, settings, made.Get(), JPH::Vec3::sOne(), everything, JPH::Mat44::sIdentity(),
            JPH::SubShapeIDCreator(), JPH::SubShapeIDCreator(), hit);
    });
}

#if TACTUS_HAS_BULLET
btVector3 to_bullet(const Vec3& v) {
    return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}

double bullet_median(const SpanClock& clock, const TriangleMesh& mesh, double radius,
                     const std::vector<Segment>& segments, int rounds) {
    std::vector<float> vertices;
    for (const Vec3& v : mesh.vertices) {
        vertices.insert(vertices.end(),
                        {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
    }
    std::vector<int> indices;
    for (const auto& t : mesh.triangles) {
        indices.insert(indices.end(),
                       {static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
    }
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(mesh.triangles.size());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices.data());
    part.m_triangleIndexStride = 3 * sizeof(int);
    part.m_numVertices = static_cast<int>(mesh.vertices.size());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices.data());
    part.m_vertexStride = 3 * sizeof(float);
    part.m_vertexType = PHY_FLOAT;
    btTriangleIndexVertexArray triangles;
    triangles.addIndexedMesh(part, PHY_INTEGER);
    btBvhTriangleMeshShape shape(&triangles, true);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broad_phase;
    btCollisionWorld world(&dispatcher, &broad_phase, &configuration);
    btCollisionObject object;
    object.setCollisionShape(&shape);
    world.addCollisionObject(&object);
    btSphereShape sphere(static_cast<btScalar>(radius));
    const double median = median_over(clock, segments, rounds, [&](const Segment& segment) {
        const btTransform from(btQuaternion::getIdentity(), to_bullet(segment.from));
        const btTransform to(btQuaternion::getIdentity(), to_bullet(segment.to));
        btCollisionWorld::ClosestConvexResultCallback hit(from.getOrigin(), to.getOrigin());
        world.convexSweepTest(&sphere, from, to, hit);
    });
    world.removeCollisionObject(&object);
    return median;
}
#endif

std::string radius_text(double radius) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", radius);
    return text;
}

double build_milliseconds(const TriangleMesh& mesh, int rounds) {
    double best = 1e300;
    for (int i = 0; i < rounds; ++i) {
        const auto start = std::chrono::steady_clock::now();
        const TriangleTree tree = TriangleTree::build(mesh, shared::run_on_two_threads);
        best = std::min(
            best,
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

struct Case {
    std::string name;
    const TriangleMesh& mesh;
    double radius;
    std::vector<Vec3> way;
};

void measure(const SpanClock& clock, const Settings& settings, const Case& one, double build_ms,
             Report& report) {
    const std::string name = one.name + "_r" + radius_text(one.radius);
    Times best{1e300, 1e300, 1e300};
    std::vector<Tick> ticks;
    double bytes = 0.0;
    const PlacedShape placed{MeshShape{std::make_shared<const TriangleMesh>(one.mesh)}, {}};
    const std::shared_ptr<const TouchShape> shape =
        make_touch_shape({&placed, 1}, shared::run_on_two_threads).shape;
    const auto play_rounds = [&] {
        for (int round = 0; round < settings.rounds; ++round) {
            TouchRig rig(one.radius);
            rig.add(shape);
            bytes = static_cast<double>(rig.scene.parts()[0].part->tree()->bytes());
            ticks = replay(clock, rig, one.way);
            const Times times = times_of(ticks);
            best = {std::min(best.contact_median, times.contact_median),
                    std::min(best.contact_p99, times.contact_p99),
                    std::min(best.free_median, times.free_median)};
        }
    };
    play_rounds();
    const Errors errors = errors_of(ticks, one.mesh, one.radius, settings.checks);
    const std::vector<Segment> segments = contact_segments(ticks, 3'000);
    const double jolt = jolt_median(clock, one.mesh, one.radius, segments, settings.rounds);
    double bullet = 0.0;
#if TACTUS_HAS_BULLET
    bullet = bullet_median(clock, one.mesh, one.radius, segments, settings.rounds);
#endif
    play_rounds();

    report.set(name + ".contact_median_us", best.contact_median);
    report.set(name + ".contact_p99_us", best.contact_p99);
    report.set(name + ".free_median_us", best.free_median);
    report.set(name + ".contact_ticks", static_cast<double>(std::ranges::count_if(ticks, &Tick::touching)));
    report.set(name + ".error_rms", errors.rms);
    report.set(name + ".error_max", errors.most);
    report.set(name + ".force_direction_max_deg", errors.direction);
    report.set(name + ".stuck_ticks", errors.stuck);
    report.set(name + ".checked_ticks", errors.checked);
    report.set(name + ".reference_unsettled", errors.unsettled);
    report.set(name + ".build_ms", build_ms);
    report.set(name + ".bytes_per_triangle", bytes / static_cast<double>(one.mesh.triangles.size()));
    report.set(name + ".jolt_cast_us", jolt);
    report.set(name + ".jolt_cast_over_tick", jolt / best.contact_median);
#if TACTUS_HAS_BULLET
    report.set(name + ".bullet_sweep_us", bullet);
    report.set(name + ".bullet_sweep_over_tick", bullet / best.contact_median);
#endif
    std::printf("%-22s %8.2f %8.2f %8.3f %10.1e %10.1e %10.1e %6d %8.1f %7.1f %9.1f %9.1f\n", name.c_str(),
                best.contact_median, best.contact_p99, best.free_median, errors.rms, errors.most,
                errors.direction, errors.stuck, build_ms,
                bytes / static_cast<double>(one.mesh.triangles.size()), jolt / best.contact_median,
                bullet / best.contact_median);
    std::fflush(stdout);
}

// Largest deviation from Coulomb while the hand is drawn along a groove (180 degrees: a plane) at constant
// depth.
double friction_error_percent(double degrees) {
    constexpr double radius = 0.05;
    constexpr double depth = 0.02;
    const double half = 0.5 * degrees * std::numbers::pi / 180.0;
    double worst = 0.0;
    for (const double friction : {0.1, 0.3, 0.5, 1.0}) {
        TouchRig rig(radius);
        rig.add(shared::groove(2.0 * half, 20.0), {}, TouchMaterial{1.0, 0.0, friction, friction});
        const double height = radius / std::sin(half);
        rig.draw({0.0, height + 0.01, -2.0}, {0.0, height - depth, -2.0}, 20);
        for (int i = 0; i <= 4'000; ++i) {
            const Vec3 hand(0.0, height - depth, -2.0 + 0.001 * i);
            const ProxyTick tick = rig.tick(hand);
            if (i < 1'000) {
                continue;
            }
            const Vec3 force =
                contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3).total;
            const double coulomb =
                friction * depth / std::sin(half);  // both walls: 2 * depth / (2 sin(half))
            worst = std::max(worst, 100.0 * std::abs(-force.z / coulomb - 1.0));
        }
    }
    return worst;
}

// How far the proxy strays while the hand rests for a million ticks (unit: meters).
double still_movement_max() {
    double worst = 0.0;
    const TriangleMesh sphere = shared::icosphere(4, 1.0);
    const TriangleMesh hills = shared::terrain(64, 2.0, 0.1);
    for (int scene = 0; scene < 4; ++scene) {
        TouchRig rig(0.02);
        const double friction = scene % 2 ? 0.3 : 0.0;
        rig.add(scene < 2 ? sphere : hills, {}, TouchMaterial{1.0, 0.0, friction, friction});
        const Vec3 hand = scene < 2 ? Vec3(0.1, 0.95, 0.05) : Vec3(0.11, -0.2, 0.23);
        rig.draw(hand + Vec3(0.05, 0.6, 0.02), hand, 200);
        for (int i = 0; i < 200; ++i) {
            rig.tick(hand);
        }
        const Vec3 settled = rig.proxy.position();
        for (int i = 0; i < 250'000; ++i) {
            worst = std::max(worst, glm::distance(rig.tick(hand).position, settled));
        }
    }
    return worst;
}

int run_rough(const bench::RoughSettings& settings) {
    if (!shared::stay_on_one_processor()) {
        std::fprintf(stderr, "the system does not let this program stay on one processor: times will vary\n");
    }
    Report report;
    bench::measure_rough(SpanClock(), settings, report);
    return report.write_json(shared::result_path("proxy")) ? 0 : 1;
}

int run_all(const Settings& settings) {
    if (!shared::stay_on_one_processor()) {
        std::fprintf(stderr, "the system does not let this program stay on one processor: times will vary\n");
    }
    const SpanClock clock;
    Report report;
    std::printf("%-22s %8s %8s %8s %10s %10s %10s %6s %8s %7s %9s %9s\n", "case", "med us", "p99 us",
                "free us", "err rms", "err max", "dir deg", "stuck", "build", "B/tri", "jolt/tick",
                "bullet/t.");
    const TriangleMesh box = shared::box(Vec3(0.5, 0.7, 0.6));
    for (const double radius : {0.05, 0.01}) {
        measure(clock, settings,
                {"box_12", box, radius, shared::around_box(Vec3(0.5, 0.7, 0.6), radius, settings.ticks)},
                build_milliseconds(box, settings.rounds), report);
    }
    for (int level = 2; level <= 8; ++level) {
        const int count = 20 << (2 * level);
        if (count > settings.most) {
            break;
        }
        const TriangleMesh mesh = shared::icosphere(level, 1.0);
        const double build_ms = build_milliseconds(mesh, settings.rounds);
        for (const double radius : {0.05, 0.01}) {
            measure(clock, settings,
                    {"sphere_" + std::to_string(count), mesh, radius,
                     shared::around_sphere(radius, settings.ticks)},
                    build_ms, report);
        }
    }
    constexpr int cells = 512;
    constexpr double size = 5.12;
    if (2 * cells * cells <= settings.most) {
        const TriangleMesh mesh = shared::terrain(cells, size, 0.2);
        const double build_ms = build_milliseconds(mesh, settings.rounds);
        for (const double radius : {0.05, 0.01}) {
            measure(clock, settings,
                    {"terrain_524288", mesh, radius,
                     shared::over_terrain(mesh, cells, size, radius, settings.ticks)},
                    build_ms, report);
        }
    }
    constexpr std::pair<const char*, double> grooves[] = {
        {"plane", 180.0}, {"groove60", 60.0}, {"groove90", 90.0}, {"groove120", 120.0}};
    for (const auto& [name, degrees] : grooves) {
        const double error = friction_error_percent(degrees);
        report.set(std::string("friction.") + name + "_error_percent", error);
        std::printf("friction, %s: %.4f %% off Coulomb\n", name, error);
    }
    const double movement = still_movement_max();
    report.set("still.movement_max", movement);
    std::printf("still hand: proxy moved by %g m in 10^6 ticks\n", movement);
    return report.write_json(shared::result_path("proxy")) ? 0 : 1;
}

// --- the replay of any path over any mesh
// ---------------------------------------------------------------------------

bool read_text(const std::string& path, std::string& text) {
    const std::ifstream file(path, std::ios::binary);
    if (!file) {
        std::fprintf(stderr, "%s cannot be read\n", path.c_str());
        return false;
    }
    std::ostringstream all;
    all << file.rdbuf();
    text = all.str();
    return true;
}

// x,y,z in the first three columns; a first line without numbers names the columns.
bool read_path(const std::string& path, std::vector<Vec3>& way) {
    std::string text;
    if (!read_text(path, text)) {
        return false;
    }
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        Vec3 p(0.0);
        const char* at = line.data();
        const char* const end = at + line.size();
        bool sound = true;
        for (int axis = 0; axis < 3 && sound; ++axis) {
            while (at < end && (*at == ',' || *at == ' ' || *at == '\t' || *at == ';')) {
                ++at;
            }
            const auto [read_to, error] = std::from_chars(at, end, p[axis]);
            sound = error == std::errc{} && std::isfinite(p[axis]);
            at = read_to;
        }
        const bool empty = line.find_first_not_of(" \t\r") == line.npos;
        if (sound) {
            way.push_back(p);
        } else if (number > 1 && !empty) {
            std::fprintf(stderr, "%s, line %d: expected x,y,z\n", path.c_str(), number);
            return false;
        }
    }
    return !way.empty();
}

int trace(const std::string& mesh_path, const std::string& hip_path, double radius, double static_friction,
          double dynamic_friction, const std::string& trace_path) {
    std::string text;
    std::vector<Vec3> way;
    if (!read_text(mesh_path, text) || !read_path(hip_path, way)) {
        return 2;
    }
    const ObjResult obj = read_obj_text(text);
    const std::string problem = obj.error.empty() ? check_mesh(obj.mesh) : obj.error;
    if (!problem.empty()) {
        std::fprintf(stderr, "%s: %s\n", mesh_path.c_str(), problem.c_str());
        return 2;
    }
    if (!(radius > 0.0)) {
        std::fprintf(stderr, "--radius must be above 0\n");
        return 2;
    }
    std::FILE* const out = std::fopen(trace_path.c_str(), "w");
    if (!out) {
        std::perror(trace_path.c_str());
        return 2;
    }
    shared::stay_on_one_processor();
    const SpanClock clock;
    TouchRig rig(radius);
    rig.add(obj.mesh, {},
            TouchMaterial{1.0, 0.0, std::max(static_friction, dynamic_friction), dynamic_friction});
    std::fputs("tick,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,compute_ns,contacts\n", out);
    for (std::size_t i = 0; i < way.size(); ++i) {
        const std::uint64_t start = clock.now();
        const ProxyTick tick = rig.tick(way[i]);
        const HandForce force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3);
        const double nanoseconds = clock.nanoseconds(start, clock.now());
        std::fprintf(out, "%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.0f,%zu\n", i, tick.position.x,
                     tick.position.y, tick.position.z, force.total.x, force.total.y, force.total.z,
                     nanoseconds, rig.proxy.touching().size());
    }
    return std::fclose(out) == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    shared::Options options(argc, argv);
    if (options.has("mesh") || options.has("hip") || options.has("trace")) {
        const std::string mesh = options.text("mesh");
        const std::string hip = options.text("hip");
        const std::string out = options.text("trace");
        const double radius = options.number("radius", 0.0);
        const double dynamic_friction = options.number("dynamic-friction", 0.0);
        const double static_friction = options.number("static-friction", dynamic_friction);
        options.has("two-sided");
        if (!options.understood() || mesh.empty() || hip.empty() || out.empty()) {
            std::fprintf(stderr, "proxy --mesh=FILE.obj --hip=FILE.csv --radius=R --trace=OUT.csv\n");
            return 2;
        }
        return trace(mesh, hip, radius, static_friction, dynamic_friction, out);
    }
    if (const std::string only = options.text("only"); only.starts_with("rough")) {
        bench::RoughSettings rough;
        rough.only = only;
        rough.ticks = static_cast<int>(options.number("ticks", rough.ticks));
        rough.checks = static_cast<int>(options.number("checks", rough.checks));
        rough.replays = static_cast<int>(options.number("replays", rough.replays));
        return options.understood() ? run_rough(rough) : 2;
    }
    Settings settings;
    settings.ticks = static_cast<int>(options.number("ticks", settings.ticks));
    settings.rounds = static_cast<int>(options.number("rounds", settings.rounds));
    settings.checks = static_cast<int>(options.number("checks", settings.checks));
    settings.most = static_cast<int>(options.number("most", settings.most));
    return options.understood() ? run_all(settings) : 2;
}
