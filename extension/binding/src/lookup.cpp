// Names to function pointers: each of these runs once per call site, the result is kept there.

#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/private/interface.hpp>
#include <godot_cpp/private/names.hpp>
#include <godot_cpp/private/ptrcall.hpp>
#include <godot_cpp/private/vararg.hpp>
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

GDExtensionMethodBindPtr find_engine_method(const char* class_name, const char* method_name, int64_t hash) {
    const StringName class_key(class_name);
    const StringName method_key(method_name);
    const GDExtensionMethodBindPtr method =
        interface.classdb_get_method_bind(class_key._native_ptr(), method_key._native_ptr(), hash);
    if (method == nullptr) {
        ERR_PRINT(String("This Godot has no method ") + class_name + "." + method_name +
                  " with the expected signature.");
    }
    return method;
}

void ptrcall_engine_method(GDExtensionMethodBindPtr method, GodotObject* self, const void* const* arguments,
                           void* result) {
    if (method != nullptr) {
        interface.object_method_bind_ptrcall(method, self, arguments, result);
    }
}

Variant call_vararg_engine_method(GDExtensionMethodBindPtr method, GodotObject* self, const Variant* values,
                                  size_t count) {
    std::vector<const void*> pointers(count);
    for (size_t i = 0; i < count; ++i) {
        pointers[i] = values + i;
    }
    Variant result;
    GDExtensionCallError error{};
    if (method != nullptr) {
        result.~Variant();
        interface.object_method_bind_call(method, self, pointers.data(), static_cast<GDExtensionInt>(count),
                                          result._native_ptr(), &error);
    }
    return result;
}

GDExtensionPtrBuiltInMethod find_builtin_method(GDExtensionVariantType type, const char* method_name,
                                                int64_t hash) {
    const StringName key(method_name);
    return interface.variant_get_ptr_builtin_method(type, key._native_ptr(), hash);
}

GDExtensionPtrUtilityFunction find_utility_function(const char* name, int64_t hash) {
    const StringName key(name);
    return interface.variant_get_ptr_utility_function(key._native_ptr(), hash);
}

GDExtensionPtrOperatorEvaluator find_operator(GDExtensionVariantOperator op, GDExtensionVariantType left,
                                              GDExtensionVariantType right) {
    return interface.variant_get_ptr_operator_evaluator(op, left, right);
}

GDExtensionPtrConstructor find_constructor(GDExtensionVariantType type, int32_t index) {
    return interface.variant_get_ptr_constructor(type, index);
}

GDExtensionPtrDestructor find_destructor(GDExtensionVariantType type) {
    return interface.variant_get_ptr_destructor(type);
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
