// What lives as long as the library: names, the wrappers of the engine's singletons.

#include <godot_cpp/private/lifetime.hpp>

#include <godot_cpp/private/interface.hpp>
#include <godot_cpp/private/names.hpp>
#include <godot_cpp/private/ptrcall.hpp>
#include <mutex>
#include <vector>

namespace godot::internal {

namespace {

std::mutex names_mutex;
InternedName* first_name = nullptr;

std::mutex singletons_mutex;
std::vector<GodotObject*> singletons;

}  // namespace

InternedName::InternedName(const char* text) {
    interface.string_name_new_with_utf8_chars(storage_, text);
    const std::lock_guard lock(names_mutex);
    next_ = first_name;
    first_name = this;
}

void release_names() {
    const std::lock_guard lock(names_mutex);
    for (InternedName* name = first_name; name != nullptr; name = name->next_) {
        reinterpret_cast<StringName*>(name->storage_)->~StringName();
        interface.string_name_new_with_utf8_chars(name->storage_, "");
    }
    first_name = nullptr;
}

GodotObject* find_singleton(const char* name) {
    const StringName key(name);
    GodotObject* object = interface.global_get_singleton(key._native_ptr());
    if (object != nullptr) {
        const std::lock_guard lock(singletons_mutex);
        singletons.push_back(object);
    }
    return object;
}

// Their wrappers must go before the engine's singletons do, and before this library does.
void release_singletons() {
    const std::lock_guard lock(singletons_mutex);
    for (GodotObject* object : singletons) {
        interface.object_free_instance_binding(object, token);
    }
    singletons.clear();
}

}  // namespace godot::internal
