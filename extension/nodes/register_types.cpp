#include "nodes/register_types.hpp"

#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/godot.hpp>

#include "nodes/body_watch.hpp"
#include "nodes/depth_sensor.hpp"
#include "nodes/haptic_device.hpp"
#include "nodes/haptic_effect.hpp"
#include "nodes/haptic_feedback.hpp"
#include "nodes/haptic_field.hpp"
#include "nodes/haptic_guide.hpp"
#include "nodes/haptic_material.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/haptic_path.hpp"
#include "nodes/haptic_recorder.hpp"
#include "nodes/haptic_replay.hpp"
#include "nodes/haptic_soft_body.hpp"
#include "nodes/haptic_tool.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mmt_link.hpp"
#include "nodes/network_conditions.hpp"
#include "nodes/project_settings.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/signals.hpp"
#include "nodes/teleop_tuning.hpp"
#include "realtime/workers.hpp"

namespace tactus {

namespace {

void register_classes(godot::ModuleInitializationLevel level) {
    if (level != godot::MODULE_INITIALIZATION_LEVEL_SCENE) {
        return;
    }
    declare_project_settings();
    GDREGISTER_INTERNAL_CLASS(BodyWatch);
    GDREGISTER_CLASS(HapticMaterial);
    GDREGISTER_CLASS(HapticPath);
    GDREGISTER_CLASS(HapticField);
    GDREGISTER_CLASS(HapticGuide);
    GDREGISTER_CLASS(HapticMesh);
    GDREGISTER_CLASS(HapticSoftBody);
    GDREGISTER_CLASS(HapticDevice);
    GDREGISTER_CLASS(ProxyPointer);
    GDREGISTER_CLASS(HapticTool);
    GDREGISTER_CLASS(HapticRecorder);
    GDREGISTER_CLASS(HapticReplay);
    GDREGISTER_CLASS(HapticFeedback);
    GDREGISTER_CLASS(HapticEffect);
    GDREGISTER_CLASS(NetworkConditions);
    GDREGISTER_CLASS(TeleopTuning);
    GDREGISTER_CLASS(MMTLink);
    GDREGISTER_CLASS(DepthSensor);
    GDREGISTER_CLASS(HapticWorld);
}

void let_go(godot::ModuleInitializationLevel level) {
    if (level == godot::MODULE_INITIALIZATION_LEVEL_SCENE) {
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
