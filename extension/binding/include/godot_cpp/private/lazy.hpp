#pragma once

// Functions of the engine that are looked up at their first call and remembered. Each stands as a static in
// the one wrapper that uses it and costs nothing until then. Any thread may call: two that come first find
// the same answer.

#include <gdextension_interface.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <godot_cpp/core/defs.hpp>

namespace godot {

class Variant;

namespace internal {

// A method of an engine class. When this Godot has none of that signature, that is reported and calls do
// nothing.
class EngineMethod {
public:
    constexpr EngineMethod(const char* class_name, const char* name, int64_t hash)
        : class_name_(class_name), name_(name), hash_(hash) {}
    void ptrcall(GodotObject* self, const void* const* arguments, void* result);
    Variant call(GodotObject* self, const Variant* values, size_t count);

private:
    GDExtensionMethodBindPtr find();

    const char* class_name_;
    const char* name_;
    int64_t hash_;
    std::atomic<GDExtensionMethodBindPtr> found_ = nullptr;
};

// A method of a built-in type.
class BuiltinMethod {
public:
    constexpr BuiltinMethod(GDExtensionVariantType type, const char* name, int64_t hash)
        : type_(type), name_(name), hash_(hash) {}
    void call(void* self, const void* const* arguments, void* result, int32_t count);

private:
    GDExtensionVariantType type_;
    const char* name_;
    int64_t hash_;
    std::atomic<GDExtensionPtrBuiltInMethod> found_ = nullptr;
};

class Constructor {
public:
    constexpr Constructor(GDExtensionVariantType type, int32_t index) : type_(type), index_(index) {}
    void call(void* memory, const void* const* arguments);

private:
    GDExtensionVariantType type_;
    int32_t index_;
    std::atomic<GDExtensionPtrConstructor> found_ = nullptr;
};

class Destructor {
public:
    constexpr explicit Destructor(GDExtensionVariantType type) : type_(type) {}
    void call(void* memory);

private:
    GDExtensionVariantType type_;
    std::atomic<GDExtensionPtrDestructor> found_ = nullptr;
};

class BinaryOperator {
public:
    constexpr BinaryOperator(GDExtensionVariantOperator op, GDExtensionVariantType left,
                             GDExtensionVariantType right)
        : operator_(op), left_(left), right_(right) {}
    void call(const void* left, const void* right, void* result);

private:
    GDExtensionVariantOperator operator_;
    GDExtensionVariantType left_;
    GDExtensionVariantType right_;
    std::atomic<GDExtensionPtrOperatorEvaluator> found_ = nullptr;
};

class UtilityFunction {
public:
    constexpr UtilityFunction(const char* name, int64_t hash) : name_(name), hash_(hash) {}
    void call(const void* const* arguments, void* result, int32_t count);

private:
    const char* name_;
    int64_t hash_;
    std::atomic<GDExtensionPtrUtilityFunction> found_ = nullptr;
};

}  // namespace internal
}  // namespace godot
