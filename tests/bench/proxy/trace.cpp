#include "proxy/trace.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <vector>

#include "core/haptics/force_law.hpp"
#include "core/mesh/mesh_check.hpp"
#include "core/mesh/obj_text.hpp"
#include "shared/bench_kit.hpp"
#include "shared/touch_rig.hpp"
#include "support/process.hpp"

namespace tactus::bench {

namespace {

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

}  // namespace

int write_trace(const TraceSettings& settings) {
    std::string text;
    std::vector<Vec3> way;
    if (!read_text(settings.mesh, text) || !read_path(settings.path, way)) {
        return 2;
    }
    const ObjResult obj = read_obj_text(text);
    const std::string problem = obj.error.empty() ? check_mesh(obj.mesh) : obj.error;
    if (!problem.empty()) {
        std::fprintf(stderr, "%s: %s\n", settings.mesh.c_str(), problem.c_str());
        return 2;
    }
    if (!(settings.radius > 0.0)) {
        std::fprintf(stderr, "--radius must be above 0\n");
        return 2;
    }
    shared::KeptFile file(settings.output);
    std::FILE* const out = file.get();
    if (!out) {
        return 2;
    }
    testing::stay_on_one_processor();
    const shared::SpanClock clock;
    shared::TouchRig rig(settings.radius);
    rig.add(obj.mesh, {},
            TouchMaterial{1.0, 0.0, std::max(settings.static_friction, settings.dynamic_friction),
                          settings.dynamic_friction});
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
    return file.keep() ? 0 : 1;
}

}  // namespace tactus::bench
