#include "nodes/register_types.hpp"

#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/godot.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "devices/driver_device.hpp"
#include "nodes/body_watch.hpp"
#include "nodes/conversions.hpp"
#include "nodes/input_watch.hpp"
#include "nodes/project_settings.hpp"
#include "nodes/signals.hpp"
#include "realtime/workers.hpp"

namespace tactus {

namespace {

void register_classes(godot::ModuleInitializationLevel level) {
    if (level != godot::MODULE_INITIALIZATION_LEVEL_SCENE) {
        return;
    }
    declare_project_settings();
    GDREGISTER_INTERNAL_CLASS(BodyWatch);
    GDREGISTER_INTERNAL_CLASS(InputWatch);
    register_public_classes();
    DriverDevice::when_left_behind(
        [](const std::string& text) { godot::UtilityFunctions::push_error(to_godot(text)); });
}

void let_go(godot::ModuleInitializationLevel level) {
    if (level == godot::MODULE_INITIALIZATION_LEVEL_SCENE) {
        DriverDevice::when_left_behind(nullptr);
        Workers::end_shared();
        forget_signals();
    }
}

}  // namespace

GDExtensionBool initialize_library(GDExtensionInterfaceGetProcAddress get_proc_address,
                                   GDExtensionClassLibraryPtr library,
                                   GDExtensionInitialization* initialization) {
    const godot::GDExtensionBinding::InitObject init(get_proc_address, library, initialization);
    init.register_initializer(register_classes);
    init.register_terminator(let_go);
    init.set_minimum_library_initialization_level(godot::MODULE_INITIALIZATION_LEVEL_SCENE);
    return init.init();
}

}  // namespace tactus
