#include "shared/field_figures.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/force_law.hpp"
#include "core/mesh/iso_surface.hpp"
#include "shared/bench_kit.hpp"
#include "shared/fields.hpp"
#include "shared/hand_paths.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::shared {

FieldFigures play_field_sphere(std::uint32_t samples, double proxy_radius, int ticks) {
    // Room for the sphere, and for two samples beyond it.
    const double voxel = 2.0 / (samples - 5.0);
    const OwnField field =
        sampled({samples, samples, samples}, Vec3(voxel), [](const Vec3& p) { return glm::length(p) - 1.0; });
    FieldFigures figures;
    TouchRig rig(proxy_radius);
    const auto begin = std::chrono::steady_clock::now();
    const TriangleMesh mesh = iso_surface(field.get()).mesh;
    rig.add(mesh);
    figures.build_milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    figures.triangles = static_cast<double>(mesh.triangles.size());
    const SpanClock clock;
    for (const Vec3& hand : around_sphere(proxy_radius, ticks)) {
        const std::uint64_t start = clock.now();
        const ProxyTick tick = rig.tick(hand);
        const HandForce force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3);
        const double microseconds = 1e-3 * clock.nanoseconds(start, clock.now());
        ++figures.ticks;
        if (force.contact_count == 0) {
            figures.free_microseconds.push_back(microseconds);
            continue;
        }
        ++figures.contact_ticks;
        figures.microseconds.push_back(microseconds);
        if (tick.status & proxy_unfinished) {
            ++figures.unfinished;
            continue;
        }
        const double rest = 1.0 + proxy_radius;
        const double error = glm::distance(tick.position, glm::normalize(hand) * rest);
        const double height = std::abs(glm::length(tick.position) - rest);
        figures.error_voxels = std::max(figures.error_voxels, error / voxel);
        figures.height_error_voxels = std::max(figures.height_error_voxels, height / voxel);
    }
    return figures;
}

}  // namespace tactus::shared
