#include <gdextension_interface.h>

#include <godot_cpp/godot.hpp>

#include "echo.hpp"
#include "engine_calls.hpp"
#include "nodes.hpp"

namespace {

using namespace godot;

void initialize(ModuleInitializationLevel level) {
    if (level != MODULE_INITIALIZATION_LEVEL_SCENE) {
        return;
    }
    using namespace probe;
    GDREGISTER_CLASS(BindingEcho);
    GDREGISTER_CLASS(BindingNode);
    GDREGISTER_CLASS(BindingDerived);
    GDREGISTER_CLASS(BindingMaterial);
    GDREGISTER_CLASS(BindingMesh);
    GDREGISTER_CLASS(BindingEngineCalls);
}

}  // namespace

extern "C" GDE_EXPORT GDExtensionBool binding_probe_init(GDExtensionInterfaceGetProcAddress get_proc_address,
                                                         GDExtensionClassLibraryPtr library,
                                                         GDExtensionInitialization* initialization) {
    const GDExtensionBinding::InitObject init(get_proc_address, library, initialization);
    init.register_initializer(&initialize);
    init.set_minimum_library_initialization_level(MODULE_INITIALIZATION_LEVEL_SCENE);
    return init.init();
}
