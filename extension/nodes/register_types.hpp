#pragma once

#include <gdextension_interface.h>

namespace tactus {

GDExtensionBool initialize_library(GDExtensionInterfaceGetProcAddress get_proc_address,
                                   GDExtensionClassLibraryPtr library,
                                   GDExtensionInitialization* initialization);

}  // namespace tactus
