#include "nodes/project_settings.hpp"

#include <cmath>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <limits>

namespace tactus {

using namespace godot;

namespace {

constexpr const char* force_limit = "tactus/safety/force_limit";
constexpr const char* real_time = "tactus/haptic_thread/real_time";

void declare(const char* name, const Variant& initial, PropertyHint hint, const char* hint_text) {
    ProjectSettings& settings = *ProjectSettings::get_singleton();
    if (!settings.has_setting(name)) {
        settings.set_setting(name, initial);
    }
    settings.set_initial_value(name, initial);
    settings.set_as_basic(name, true);
    Dictionary info;
    info["name"] = name;
    info["type"] = static_cast<int64_t>(initial.get_type());
    info["hint"] = static_cast<int64_t>(hint);
    info["hint_string"] = hint_text;
    settings.add_property_info(info);
}

}  // namespace

void declare_project_settings() {
    declare(force_limit, 0.0, PROPERTY_HINT_RANGE, "0,40,0.1,or_greater,suffix:N (0: no limit)");
    declare(real_time, true, PROPERTY_HINT_NONE, "");
}

// 0, and what is no limit, is none.
double project_force_limit() {
    const double limit = ProjectSettings::get_singleton()->get_setting(force_limit, 0.0);
    return limit > 0.0 ? limit : std::numeric_limits<double>::infinity();
}

bool project_wants_real_time() {
    return ProjectSettings::get_singleton()->get_setting(real_time, true);
}

}  // namespace tactus
