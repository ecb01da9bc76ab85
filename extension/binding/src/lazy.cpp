#include <godot_cpp/private/lazy.hpp>

#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/private/interface.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <vector>

namespace godot::internal {

namespace {

// Stands for a method that was looked for in vain.
const char nowhere = 0;

// Function pointers carry no data that another thread must see first, so no ordering is needed.
template <class Function, class Find>
Function remembered(std::atomic<Function>& found, const Find& find) {
    Function function = found.load(std::memory_order_relaxed);
    if (function == nullptr) {
        function = find();
        found.store(function, std::memory_order_relaxed);
    }
    return function;
}

}  // namespace

GDExtensionMethodBindPtr EngineMethod::find() {
    const GDExtensionMethodBindPtr method = remembered(found_, [this]() -> GDExtensionMethodBindPtr {
        const StringName class_key(class_name_);
        const StringName key(name_);
        const GDExtensionMethodBindPtr bind =
            interface.classdb_get_method_bind(class_key._native_ptr(), key._native_ptr(), hash_);
        if (bind == nullptr) {
            ERR_PRINT(
                vformat("This Godot has no method %s.%s with the expected signature.", class_name_, name_));
        }
        return bind != nullptr ? bind : &nowhere;
    });
    return method != &nowhere ? method : nullptr;
}

void EngineMethod::ptrcall(GodotObject* self, const void* const* arguments, void* result) {
    if (const GDExtensionMethodBindPtr method = find()) {
        interface.object_method_bind_ptrcall(method, self, arguments, result);
    }
}

Variant EngineMethod::call(GodotObject* self, const Variant* values, size_t count) {
    std::vector<const void*> pointers(count);
    for (size_t i = 0; i < count; ++i) {
        pointers[i] = values + i;
    }
    Variant result;
    if (const GDExtensionMethodBindPtr method = find()) {
        GDExtensionCallError error{};
        result.~Variant();
        interface.object_method_bind_call(method, self, pointers.data(), static_cast<GDExtensionInt>(count),
                                          result._native_ptr(), &error);
    }
    return result;
}

void BuiltinMethod::call(void* self, const void* const* arguments, void* result, int32_t count) {
    const GDExtensionPtrBuiltInMethod method = remembered(found_, [this] {
        const StringName key(name_);
        return interface.variant_get_ptr_builtin_method(type_, key._native_ptr(), hash_);
    });
    method(self, arguments, result, count);
}

void Constructor::call(void* memory, const void* const* arguments) {
    remembered(found_, [this] { return interface.variant_get_ptr_constructor(type_, index_); })(memory,
                                                                                                arguments);
}

void Destructor::call(void* memory) {
    remembered(found_, [this] { return interface.variant_get_ptr_destructor(type_); })(memory);
}

void BinaryOperator::call(const void* left, const void* right, void* result) {
    const GDExtensionPtrOperatorEvaluator evaluate = remembered(
        found_, [this] { return interface.variant_get_ptr_operator_evaluator(operator_, left_, right_); });
    evaluate(left, right, result);
}

void UtilityFunction::call(const void* const* arguments, void* result, int32_t count) {
    const GDExtensionPtrUtilityFunction function = remembered(found_, [this] {
        const StringName key(name_);
        return interface.variant_get_ptr_utility_function(key._native_ptr(), hash_);
    });
    function(result, arguments, count);
}

}  // namespace godot::internal
