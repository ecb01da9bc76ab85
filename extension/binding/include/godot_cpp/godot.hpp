#pragma once

#include <gdextension_interface.h>

#include <godot_cpp/core/defs.hpp>
#include <godot_cpp/private/interface.hpp>

namespace godot {

enum ModuleInitializationLevel {
    MODULE_INITIALIZATION_LEVEL_CORE = GDEXTENSION_INITIALIZATION_CORE,
    MODULE_INITIALIZATION_LEVEL_SERVERS = GDEXTENSION_INITIALIZATION_SERVERS,
    MODULE_INITIALIZATION_LEVEL_SCENE = GDEXTENSION_INITIALIZATION_SCENE,
    MODULE_INITIALIZATION_LEVEL_EDITOR = GDEXTENSION_INITIALIZATION_EDITOR,
    MODULE_INITIALIZATION_LEVEL_MAX
};

class GDExtensionBinding {
public:
    using Callback = void (*)(ModuleInitializationLevel level);

    // Used by the entry point alone: hands the engine's interface over and says what to run at which level.
    class InitObject {
    public:
        InitObject(GDExtensionInterfaceGetProcAddress get_proc_address, GDExtensionClassLibraryPtr library,
                   GDExtensionInitialization* initialization);
        void register_initializer(Callback initializer) const;
        void register_terminator(Callback terminator) const;
        void set_minimum_library_initialization_level(ModuleInitializationLevel level) const;
        GDExtensionBool init() const;

    private:
        GDExtensionInterfaceGetProcAddress get_proc_address_;
        GDExtensionClassLibraryPtr library_;
        GDExtensionInitialization* initialization_;
    };
};

namespace internal {

// A static object of this type (made by doc_data.py) carries the class reference of the extension's own
// classes into the library; the editor gets it when it starts. The data is zlib-compressed XML.
class DocDataRegistration {
public:
    DocDataRegistration(const char* hash, int uncompressed_size, int compressed_size,
                        const unsigned char* data);
};

}  // namespace internal
}  // namespace godot
