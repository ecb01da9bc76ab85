// The library's door. Everything behind it may use what only newer processors have; this file does not, so
// that on an older one it can say so and leave Godot running.
#include <gdextension_interface.h>

#include <cstdio>
#include <godot_cpp/core/defs.hpp>

#include "nodes/register_types.hpp"
#include "platform/processor.hpp"

namespace {

void refuse_to_load(GDExtensionInterfaceGetProcAddress get_proc_address, const char* missing) {
    const auto print_error =
        reinterpret_cast<GDExtensionInterfacePrintError>(get_proc_address("print_error"));
    if (print_error != nullptr) {
        char text[256];
        std::snprintf(text, sizeof text,
                      "Tactus needs %s: the haptic nodes are not available on this machine.", missing);
        print_error(text, __func__, __FILE__, __LINE__, false);
    }
}

}  // namespace

extern "C" GDE_EXPORT GDExtensionBool tactus_library_init(GDExtensionInterfaceGetProcAddress get_proc_address,
                                                          GDExtensionClassLibraryPtr library,
                                                          GDExtensionInitialization* initialization) {
    if (const char* const missing = tactus::missing_in_processor()) {
        refuse_to_load(get_proc_address, missing);
        return false;
    }
    return tactus::initialize_library(get_proc_address, library, initialization);
}
