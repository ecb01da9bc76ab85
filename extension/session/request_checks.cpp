#include "session/request_checks.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

#include "physics/limits.hpp"

namespace tactus {

namespace {

std::string check_material(const TouchMaterial& m) {
    for (const double value :
         {m.stiffness, m.damping, m.static_friction, m.dynamic_friction, m.texture_depth, m.magnet_force,
          m.viscosity, m.stick_slip_stiffness, m.stick_slip_force, m.vibration_force, m.vibration_frequency,
          m.pop_through_force, m.impact_strength, m.shaft_friction, m.impact_frequency, m.stribeck_speed}) {
        if (!(value >= 0.0 && value <= limits::stiffest)) {
            return "a value of the touch material is negative, above 10^9 or not a number: set all of them "
                   "to 0 or "
                   "above";
        }
    }
    if (!(m.texture_size > 0.0 && m.texture_size <= limits::farthest) ||
        !(m.magnet_range > 0.0 && m.magnet_range <= limits::farthest)) {
        return "the touch material's texture size or magnet range is not a positive length: set both above 0 "
               "m";
    }
    if (!(m.impact_decay > 0.0 && m.impact_decay <= limits::farthest)) {
        return "the time in which the touch material's taps decay is not positive: set it above 0 s";
    }
    if (!(m.stiffening > 0.0 && m.stiffness * m.stiffening <= limits::stiffest) ||
        !(m.stiffening_depth > 0.0 && m.stiffening_depth <= limits::farthest)) {
        return "the touch material's stiffening or its depth is not above 0, or it becomes stiffer than 10^9 "
               "N/m: set the first to 1 for a surface that is as stiff at every depth";
    }
    return {};
}

std::string check_images(const TouchImages& images) {
    for (const TouchImage* image : {images.heights.get(), images.friction.get()}) {
        if (image && (image->columns == 0 || image->rows == 0 ||
                      image->values.size() != std::size_t{image->columns} * image->rows)) {
            return "an image of the touch material has no pixels, or not as many as its size says: load the "
                   "image again";
        }
    }
    return images.curve ? check_curve(*images.curve) : std::string();
}

}  // namespace

std::string check_feel(const TouchMaterial& material, const TouchDetail* detail) {
    std::string error = check_material(material);
    if (error.empty() && detail) {
        error = check_images(detail->images);
        for (const std::optional<SurfaceFeel>& surface : detail->surfaces) {
            if (error.empty() && surface) {
                error = check_feel(surface->material, nullptr);
            }
            if (error.empty() && surface) {
                error = check_images(surface->images);
            }
        }
    }
    return error;
}

std::string check_workspace(const Workspace& w) {
    constexpr double least_scale = 1.0 / limits::farthest;
    return limits::is_pose(w.pose) && w.scale > 0.0 && w.scale <= limits::farthest && w.force_limit >= 0.0 &&
                   w.force_scale >= least_scale && w.force_scale <= limits::farthest && w.edge_speed >= 0.0 &&
                   w.edge_speed <= limits::fastest && limits::is_place(w.torque) && limits::is_place(w.force)
               ? ""
               : "the device's workspace has no place, no scale above 0, no force limit, no edge speed, no "
                 "torque or no force: reset its transform and these";
}

std::string check_proxy(const ProxyDescription& d) {
    if (!is_proxy_radius(d.settings.radius)) {
        return "the proxy's radius is not a positive length: set it above 0 m";
    }
    return d.finger.modulus >= 0.0 && std::isfinite(d.finger.modulus) && d.finger.radius > 0.0 &&
                   d.finger.radius <= limits::longest_arm && d.finger.stiffness >= 0.0 &&
                   d.finger.stiffness <= limits::stiffest
               ? check_aids(d.aids)
               : "the finger's modulus or stiffness is below 0 or its radius is no positive length: set them "
                 "anew";
}

std::string check_tool(const ToolUse& use) {
    const auto is_stiffness = [](double value) { return value > 0.0 && value <= limits::stiffest; };
    if (!is_stiffness(use.settings.stiffness) || !is_stiffness(use.settings.turning_stiffness)) {
        return "the tool's stiffness or turning stiffness is not above 0: set both anew";
    }
    for (const double value : {use.settings.static_friction, use.settings.dynamic_friction}) {
        if (!(value >= 0.0 && value <= limits::stiffest)) {
            return "the tool's friction is below 0 or not a number: set static and dynamic friction anew";
        }
    }
    return limits::is_pose(use.grasp) ? check_aids(use.aids) : "the tool's grasp is no place: reset it";
}

bool is_proxy_radius(double radius) {
    return radius > 0.0 && radius <= limits::longest_arm;
}

}  // namespace tactus
