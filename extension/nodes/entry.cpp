// The library's door. Everything behind it is compiled for processors with AVX2 and FMA; this file is not, so
// that on an older one it can say so and leave Godot running.
#include <gdextension_interface.h>

#include "nodes/register_types.hpp"

namespace {

bool processor_suffices() {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
}

void refuse_to_load(GDExtensionInterfaceGetProcAddress get_proc_address) {
    const auto print_error =
        reinterpret_cast<GDExtensionInterfacePrintError>(get_proc_address("print_error"));
    if (print_error != nullptr) {
        print_error(
            "Tactus needs a processor with AVX2 and FMA (Intel since 2013, AMD since 2015): the haptic nodes "
            "are not "
            "available on this machine.",
            __func__, __FILE__, __LINE__, false);
    }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) GDExtensionBool
tactus_library_init(GDExtensionInterfaceGetProcAddress get_proc_address, GDExtensionClassLibraryPtr library,
                    GDExtensionInitialization* initialization) {
    if (!processor_suffices()) {
        refuse_to_load(get_proc_address);
        return false;
    }
    return tactus::initialize_library(get_proc_address, library, initialization);
}
