#include <algorithm>
#include <cstring>
#include <godot_cpp/classes/object.hpp>
#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/core/memory.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/private/class_access.hpp>
#include <godot_cpp/private/class_table.hpp>
#include <godot_cpp/private/interface.hpp>
#include <godot_cpp/private/ptrcall.hpp>
#include <mutex>
#include <string>
#include <unordered_map>

namespace godot {

namespace internal {

namespace {

thread_local Construction announced;

// Engine classes without a wrapper of their own (CSGBox3D) get that of their nearest base
// (GeometryInstance3D).
std::mutex nearest_mutex;
std::unordered_map<std::string, const GDExtensionInstanceBindingCallbacks*> nearest;

const GDExtensionInstanceBindingCallbacks* callbacks_of(const char* class_name) {
    const EngineClass* end = engine_classes + engine_class_count;
    const EngineClass* found = std::lower_bound(
        engine_classes, end, class_name,
        [](const EngineClass& entry, const char* name) { return std::strcmp(entry.name, name) < 0; });
    return found != end && std::strcmp(found->name, class_name) == 0 ? found->callbacks : nullptr;
}

const GDExtensionInstanceBindingCallbacks* callbacks_of(GodotObject* object) {
    StringName class_name;
    interface.object_get_class_name(object, library, class_name._native_ptr());
    std::string name = String(class_name).utf8().get_data();
    if (const auto* callbacks = callbacks_of(name.c_str())) {
        return callbacks;
    }
    const std::lock_guard lock(nearest_mutex);
    const auto known = nearest.find(name);
    if (known != nearest.end()) {
        return known->second;
    }
    const GDExtensionInstanceBindingCallbacks* callbacks = nullptr;
    for (StringName base = class_name; callbacks == nullptr;
         callbacks = callbacks_of(String(base).utf8().get_data())) {
        base = parent_class(base);
        if (base == "") {
            base = "Object";
        }
    }
    nearest.emplace(std::move(name), callbacks);
    return callbacks;
}

}  // namespace

ConstructionScope::ConstructionScope(const Construction& construction) : outer_(announced) {
    announced = construction;
}

void ConstructionScope::finish() {
    announced = outer_;
}

Object* get_object_instance_binding(GodotObject* object) {
    if (object == nullptr) {
        return nullptr;
    }
    void* binding = interface.object_get_instance_binding(object, token, nullptr);
    if (binding == nullptr) {
        binding = interface.object_get_instance_binding(object, token, callbacks_of(object));
    }
    return static_cast<Object*>(static_cast<Wrapped*>(binding));
}

GodotObject* object_of_ref(const void* ref) {
    return interface.ref_get_object(ref);
}

void store_in_ref(void* ref, GodotObject* object) {
    interface.ref_set_object(ref, object);
}

void notify_postinitialize(Wrapped* object) {
    static_cast<Object*>(object)->notification(Object::NOTIFICATION_POSTINITIALIZE);
}

void destroy_object(GodotObject* object) {
    interface.object_destroy(object);
}

bool init_reference(GodotObject* object) {
    return static_cast<RefCounted*>(get_object_instance_binding(object))->init_ref();
}

bool add_reference(GodotObject* object) {
    return static_cast<RefCounted*>(get_object_instance_binding(object))->reference();
}

bool drop_reference(GodotObject* object) {
    return static_cast<RefCounted*>(get_object_instance_binding(object))->unreference();
}

const GDExtensionPropertyInfo* publish_property_list(const List<PropertyInfo>& properties, uint32_t* count) {
    *count = static_cast<uint32_t>(properties.size());
    if (properties.is_empty()) {
        return nullptr;
    }
    // One entry more than announced: it remembers the memory that the entries point into.
    auto* owned = new std::vector<PropertyInfo>(properties.begin(), properties.end());
    auto* views = new GDExtensionPropertyInfo[owned->size() + 1];
    for (size_t i = 0; i < owned->size(); ++i) {
        views[i] = (*owned)[i].view();
    }
    views[owned->size()].name = owned;
    return views;
}

void release_property_list(GDExtensionClassInstancePtr, const GDExtensionPropertyInfo* list, uint32_t count) {
    if (list != nullptr) {
        delete static_cast<std::vector<PropertyInfo>*>(list[count].name);
        delete[] list;
    }
}

void write_back(const PropertyInfo& from, GDExtensionPropertyInfo* to) {
    to->type = static_cast<GDExtensionVariantType>(from.type);
    *static_cast<StringName*>(to->name) = from.name;
    *static_cast<StringName*>(to->class_name) = from.class_name;
    to->hint = from.hint;
    *static_cast<String*>(to->hint_string) = from.hint_string;
    to->usage = from.usage;
}

}  // namespace internal

Wrapped::Wrapped(const StringName& engine_class) {
    const internal::Construction construction = internal::announced;
    internal::announced = {};
    ERR_FAIL_COND_MSG(construction.callbacks == nullptr, "Objects of Godot classes are made with memnew().");
    const bool recreated = construction.existing_object != nullptr;
    _owner = recreated ? construction.existing_object
                       : internal::interface.classdb_construct_object2(engine_class._native_ptr());
    ERR_FAIL_NULL_MSG(_owner, "The engine could not make the object.");
    if (construction.extension_class != nullptr && !recreated) {
        internal::interface.object_set_instance(_owner, construction.extension_class->_native_ptr(), this);
    }
    internal::interface.object_set_instance_binding(_owner, internal::token, this, construction.callbacks);
}

String Wrapped::_to_string() const {
    return "<" + static_cast<const Object*>(this)->get_class() + "#" +
           itos(static_cast<int64_t>(static_cast<const Object*>(this)->get_instance_id())) + ">";
}

PropertyInfo::PropertyInfo(const GDExtensionPropertyInfo* info)
    : type(static_cast<Variant::Type>(info->type)),
      name(*static_cast<const StringName*>(info->name)),
      class_name(*static_cast<const StringName*>(info->class_name)),
      hint(info->hint),
      hint_string(*static_cast<const String*>(info->hint_string)),
      usage(info->usage) {}

GDExtensionPropertyInfo PropertyInfo::view() {
    return {static_cast<GDExtensionVariantType>(type),
            name._native_ptr(),
            class_name._native_ptr(),
            hint,
            hint_string._native_ptr(),
            usage};
}

Object* ObjectDB::get_instance(uint64_t object_id) {
    return internal::get_object_instance_binding(internal::interface.object_get_instance_from_id(object_id));
}

}  // namespace godot
