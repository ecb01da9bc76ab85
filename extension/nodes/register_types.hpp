#pragma once

#include <gdextension_interface.h>

namespace tactus {

GDExtensionBool initialize_library(GDExtensionInterfaceGetProcAddress get_proc_address,
                                   GDExtensionClassLibraryPtr library,
                                   GDExtensionInitialization* initialization);

// All that the class reference describes; written from it (binding/bind_classes.py).
void register_public_classes();

}  // namespace tactus
