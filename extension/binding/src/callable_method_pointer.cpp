#include <godot_cpp/variant/callable_method_pointer.hpp>

#include <cstring>
#include <functional>
#include <godot_cpp/private/checked_call.hpp>
#include <godot_cpp/private/interface.hpp>
#include <string_view>

namespace godot::internal {

namespace {

const MethodTarget& target_of(void* userdata) {
    return *static_cast<const MethodTarget*>(userdata);
}

bool is_alive(const MethodTarget& target) {
    return target.object_id == 0 || interface.object_get_instance_from_id(target.object_id) != nullptr;
}

void call(void* userdata, const GDExtensionConstVariantPtr* arguments, GDExtensionInt count,
          GDExtensionVariantPtr result, GDExtensionCallError* error) {
    const MethodTarget& target = target_of(userdata);
    if (!is_alive(target)) {
        error->error = GDEXTENSION_CALL_ERROR_INSTANCE_IS_NULL;
        return;
    }
    call_checked(*target.bind, target.instance, arguments, count, result, error);
}

GDExtensionBool is_valid(void* userdata) {
    return is_alive(target_of(userdata));
}

void free_target(void* userdata) {
    delete static_cast<MethodTarget*>(userdata);
}

int compare(const MethodTarget& a, const MethodTarget& b) {
    if (a.object_id != b.object_id) {
        return a.object_id < b.object_id ? -1 : 1;
    }
    if (a.kind != b.kind) {
        return std::less<const void*>()(a.kind, b.kind) ? -1 : 1;
    }
    return std::memcmp(a.pointer, b.pointer, sizeof(a.pointer));
}

uint32_t hash(void* userdata) {
    const MethodTarget& target = target_of(userdata);
    const std::string_view bytes(reinterpret_cast<const char*>(target.pointer), sizeof(target.pointer));
    return static_cast<uint32_t>(std::hash<std::string_view>()(bytes) ^
                                 std::hash<uint64_t>()(target.object_id));
}

GDExtensionBool equal(void* a, void* b) {
    return compare(target_of(a), target_of(b)) == 0;
}

GDExtensionBool less_than(void* a, void* b) {
    return compare(target_of(a), target_of(b)) < 0;
}

GDExtensionInt argument_count(void* userdata, GDExtensionBool* valid) {
    *valid = 1;
    return static_cast<GDExtensionInt>(target_of(userdata).bind->argument_list.size());
}

}  // namespace

Callable make_callable(std::unique_ptr<MethodTarget> target) {
    GDExtensionCallableCustomInfo2 info{};
    info.object_id = target->object_id;
    info.callable_userdata = target.release();
    info.token = token;
    info.call_func = &call;
    info.is_valid_func = &is_valid;
    info.free_func = &free_target;
    info.hash_func = &hash;
    info.equal_func = &equal;
    info.less_than_func = &less_than;
    info.get_argument_count_func = &argument_count;
    Callable callable;
    callable.~Callable();
    interface.callable_custom_create2(callable._native_ptr(), &info);
    return callable;
}

}  // namespace godot::internal
