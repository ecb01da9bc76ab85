// The entry of the library, and what the engine's levels of initialisation do here.

#include <godot_cpp/godot.hpp>

#include <algorithm>

#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/private/lifetime.hpp>
#include <godot_cpp/private/names.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <vector>

namespace godot {

namespace internal {

GDExtensionClassLibraryPtr library = nullptr;
void* token = nullptr;
extern int current_level;

namespace {

struct DocData {
    int uncompressed_size = 0;
    int compressed_size = 0;
    const unsigned char* data = nullptr;
};

GDExtensionBinding::Callback initializer = nullptr;
GDExtensionBinding::Callback terminator = nullptr;
DocData doc_data;

constexpr int64_t compression_deflate = 1;  // FileAccess::COMPRESSION_DEFLATE

void load_class_reference() {
    if (doc_data.data == nullptr || interface.editor_help_load_xml_from_utf8_chars_and_len == nullptr) {
        return;
    }
    PackedByteArray compressed;
    compressed.resize(doc_data.compressed_size);
    std::copy(doc_data.data, doc_data.data + doc_data.compressed_size, compressed.ptrw());
    const PackedByteArray xml = compressed.decompress(doc_data.uncompressed_size, compression_deflate);
    ERR_FAIL_COND_MSG(xml.size() != doc_data.uncompressed_size,
                      "The class reference of the extension is damaged.");
    interface.editor_help_load_xml_from_utf8_chars_and_len(reinterpret_cast<const char*>(xml.ptr()),
                                                           xml.size());
}

void initialize_level(void*, GDExtensionInitializationLevel level) {
    current_level = level;
    if (initializer != nullptr) {
        initializer(static_cast<ModuleInitializationLevel>(level));
    }
    if (level == GDEXTENSION_INITIALIZATION_EDITOR) {
        load_class_reference();
    }
}

void deinitialize_level(void*, GDExtensionInitializationLevel level) {
    current_level = level;
    if (terminator != nullptr) {
        terminator(static_cast<ModuleInitializationLevel>(level));
    }
    release_classes(level);
    // The servers among the singletons are destroyed between this level and the next one.
    if (level == GDEXTENSION_INITIALIZATION_SCENE) {
        release_singletons();
    }
    if (level == GDEXTENSION_INITIALIZATION_CORE) {
        release_names();
    }
}

}  // namespace

DocDataRegistration::DocDataRegistration(const char*, int uncompressed_size, int compressed_size,
                                         const unsigned char* data) {
    doc_data = {uncompressed_size, compressed_size, data};
}

}  // namespace internal

GDExtensionBinding::InitObject::InitObject(GDExtensionInterfaceGetProcAddress get_proc_address,
                                           GDExtensionClassLibraryPtr library,
                                           GDExtensionInitialization* initialization)
    : get_proc_address_(get_proc_address), library_(library), initialization_(initialization) {
    initialization_->minimum_initialization_level = GDEXTENSION_INITIALIZATION_CORE;
}

void GDExtensionBinding::InitObject::register_initializer(Callback initializer) const {
    internal::initializer = initializer;
}

void GDExtensionBinding::InitObject::register_terminator(Callback terminator) const {
    internal::terminator = terminator;
}

void GDExtensionBinding::InitObject::set_minimum_library_initialization_level(
    ModuleInitializationLevel level) const {
    initialization_->minimum_initialization_level = static_cast<GDExtensionInitializationLevel>(level);
}

GDExtensionBool GDExtensionBinding::InitObject::init() const {
    internal::load_interface(get_proc_address_);
    internal::library = library_;
    internal::token = library_;
    initialization_->initialize = &internal::initialize_level;
    initialization_->deinitialize = &internal::deinitialize_level;
    if (internal::interface.classdb_construct_object2 == nullptr) {
        internal::interface.print_error("The extension needs Godot 4.4 or newer.", __FUNCTION__, __FILE__,
                                        __LINE__, 1);
        return 0;
    }
    return 1;
}

}  // namespace godot
