#include "nodes/mesh_library.hpp"

#include <godot_cpp/classes/dir_access.hpp>
#include <godot_cpp/classes/file_access.hpp>
#include <godot_cpp/classes/json.hpp>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/dictionary.hpp>

#include "nodes/addon_folder.hpp"
#include "nodes/conversions.hpp"
#include "world/mesh_file.hpp"

namespace tactus {

namespace {

using godot::FileAccess;
using godot::String;

String all_names() {
    return String(", ").join(mesh_library_names());
}

}  // namespace

String mesh_library_folder() {
    return addon_folder().path_join("meshes");
}

godot::PackedStringArray mesh_library_names() {
    godot::PackedStringArray names;
    const godot::PackedStringArray files = godot::DirAccess::get_files_at(mesh_library_folder());
    for (std::int64_t i = 0; i < files.size(); ++i) {
        const String file = files[i];
        if (file.get_extension() == "obj") {
            names.push_back(file.get_basename());
        }
    }
    names.sort();
    return names;
}

std::shared_ptr<TriangleSource> load_library_mesh(const String& name) {
    const auto failed = [](std::string why) {
        return std::make_shared<TriangleSource>(TriangleSource::Checked{nullptr, std::move(why)});
    };
    const String path = mesh_library_folder().path_join(name + String(".obj"));
    if (!is_mesh_name(from_godot(name)) || !FileAccess::file_exists(path)) {
        return failed(from_godot("the mesh library has no mesh '" + name + "': choose one of " + all_names() +
                                 ", or put " + name + ".obj into " + mesh_library_folder()));
    }
    // As bytes, not as a string of the engine's: that would take four times as much, and again for its UTF-8.
    const godot::Ref<FileAccess> file = FileAccess::open(path, FileAccess::READ);
    const auto size = file.is_valid() ? static_cast<std::int64_t>(file->get_length()) : 0;
    if (std::string too_large = problem_of_size(from_godot(path), size); !too_large.empty()) {
        return failed(std::move(too_large));
    }
    const godot::PackedByteArray bytes = size > 0 ? file->get_buffer(size) : godot::PackedByteArray();
    return std::make_shared<TriangleSource>(
        read_mesh_file(from_godot(path),
                       {reinterpret_cast<const char*>(bytes.ptr()), static_cast<std::size_t>(bytes.size())}));
}

LibraryEntry mesh_library_entry(const String& name) {
    const String path = mesh_library_folder().path_join("library.json");
    const godot::Variant whole = FileAccess::file_exists(path)
                                     ? godot::JSON::parse_string(FileAccess::get_file_as_string(path))
                                     : godot::Variant();
    if (whole.get_type() != godot::Variant::DICTIONARY) {
        return {};
    }
    const godot::Dictionary entry = godot::Dictionary(whole).get(name, godot::Dictionary());
    return {entry.get("mass_kg", 0.0), entry.get("source", "")};
}

}  // namespace tactus
