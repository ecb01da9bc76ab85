#include <algorithm>
#include <godot_cpp/classes/class_db_singleton.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/private/bind_virtual.hpp>
#include <godot_cpp/private/checked_call.hpp>
#include <godot_cpp/private/interface.hpp>
#include <godot_cpp/private/lifetime.hpp>
#include <memory>

namespace godot {

namespace internal {

int current_level = GDEXTENSION_INITIALIZATION_CORE;

namespace {

struct OwnClass {
    StringName name;
    StringName parent;
    int level;
    std::vector<std::unique_ptr<MethodBind>> methods;
    std::vector<std::pair<StringName, GDExtensionClassCallVirtual>> virtuals;
};

// In the order of registration: bases before what derives from them. The entries do not move.
std::vector<std::unique_ptr<OwnClass>> own_classes;

OwnClass* find_own(const StringName& name) {
    const auto found = std::find_if(own_classes.begin(), own_classes.end(),
                                    [&](const auto& entry) { return entry->name == name; });
    return found != own_classes.end() ? found->get() : nullptr;
}

GDExtensionClassCallVirtual get_virtual(void* userdata, GDExtensionConstStringNamePtr name, uint32_t) {
    const StringName& wanted = *static_cast<const StringName*>(name);
    for (const OwnClass* entry = static_cast<OwnClass*>(userdata); entry != nullptr;
         entry = find_own(entry->parent)) {
        for (const auto& [method, call] : entry->virtuals) {
            if (method == wanted) {
                return call;
            }
        }
    }
    return nullptr;
}

bool reject(GDExtensionCallError* error, GDExtensionCallErrorType type, int32_t argument, int32_t expected) {
    *error = {type, argument, expected};
    return false;
}

// Fills in defaults and checks types, as the engine does for its own methods.
bool prepare(const MethodBind& bind, const GDExtensionConstVariantPtr* given, GDExtensionInt count,
             const Variant** arguments, GDExtensionCallError* error) {
    const size_t wanted = bind.argument_list.size();
    if (static_cast<size_t>(count) > wanted) {
        return reject(error, GDEXTENSION_CALL_ERROR_TOO_MANY_ARGUMENTS, 0, static_cast<int32_t>(wanted));
    }
    const size_t missing = wanted - static_cast<size_t>(count);
    if (missing > bind.defaults.size()) {
        return reject(error, GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS, 0,
                      static_cast<int32_t>(wanted - bind.defaults.size()));
    }
    for (size_t i = 0; i < wanted; ++i) {
        arguments[i] = i < static_cast<size_t>(count) ? static_cast<const Variant*>(given[i])
                                                      : &bind.defaults[bind.defaults.size() - (wanted - i)];
        const Variant::Type type = bind.argument_list[i].info.type;
        if (type != Variant::NIL && !Variant::can_convert_strict(arguments[i]->get_type(), type)) {
            return reject(error, GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT, static_cast<int32_t>(i), type);
        }
    }
    return true;
}

void call(void* userdata, GDExtensionClassInstancePtr instance, const GDExtensionConstVariantPtr* given,
          GDExtensionInt count, GDExtensionVariantPtr result, GDExtensionCallError* error) {
    call_checked(*static_cast<const MethodBind*>(userdata), static_cast<Wrapped*>(instance), given, count,
                 result, error);
}

void ptrcall(void* userdata, GDExtensionClassInstancePtr instance, const GDExtensionConstTypePtr* arguments,
             GDExtensionTypePtr result) {
    static_cast<const MethodBind*>(userdata)->ptrcall(static_cast<Wrapped*>(instance), arguments, result);
}

uint32_t flags_of(const MethodBind& bind) {
    uint32_t flags = GDEXTENSION_METHOD_FLAGS_DEFAULT;
    flags |= bind.is_const ? GDEXTENSION_METHOD_FLAG_CONST : 0;
    flags |= bind.is_static ? GDEXTENSION_METHOD_FLAG_STATIC : 0;
    return flags;
}

void announce(const StringName& class_name, MethodBind& bind) {
    std::vector<GDExtensionPropertyInfo> infos;
    std::vector<GDExtensionClassMethodArgumentMetadata> metadata;
    for (MethodBind::Argument& argument : bind.argument_list) {
        infos.push_back(argument.info.view());
        metadata.push_back(argument.metadata);
    }
    std::vector<GDExtensionVariantPtr> defaults;
    for (const Variant& value : bind.defaults) {
        defaults.push_back(value._native_ptr());
    }
    GDExtensionPropertyInfo result = bind.answer.info.view();
    const GDExtensionClassMethodInfo info = {
        bind.name._native_ptr(),
        &bind,
        &call,
        &ptrcall,
        flags_of(bind),
        bind.has_result,
        bind.has_result ? &result : nullptr,
        bind.has_result ? bind.answer.metadata : GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE,
        static_cast<uint32_t>(infos.size()),
        infos.data(),
        metadata.data(),
        static_cast<uint32_t>(defaults.size()),
        defaults.data(),
    };
    interface.classdb_register_extension_class_method(library, class_name._native_ptr(), &info);
}

}  // namespace

void call_checked(const MethodBind& bind, Wrapped* instance, const GDExtensionConstVariantPtr* given,
                  GDExtensionInt count, GDExtensionVariantPtr result, GDExtensionCallError* error) {
    constexpr size_t usual = 16;
    const Variant* few[usual];
    std::vector<const Variant*> many(bind.argument_list.size() > usual ? bind.argument_list.size() : 0);
    const Variant** arguments = many.empty() ? few : many.data();
    error->error = GDEXTENSION_CALL_OK;
    if (prepare(bind, given, count, arguments, error)) {
        bind.call(instance, arguments, static_cast<Variant*>(result));
    }
}

void bind_virtual_call(const StringName& class_name, const char* method, GDExtensionClassCallVirtual call) {
    ClassDB::bind_virtual_method(class_name, method, call);
}

StringName parent_class(const StringName& class_name) {
    return ClassDBSingleton::get_singleton()->get_parent_class(class_name);
}

StringName enum_class_name(const char* qualified_name) {
    const PackedStringArray parts = String(qualified_name).split("::");
    const int64_t count = parts.size();
    return count < 2 ? parts[0] : parts[count - 2] + String(".") + parts[count - 1];
}

void release_classes(int level) {
    while (!own_classes.empty() && own_classes.back()->level >= level) {
        interface.classdb_unregister_extension_class(library, own_classes.back()->name._native_ptr());
        own_classes.pop_back();
    }
}

}  // namespace internal

void ClassDB::begin_class(const StringName& name, const StringName& parent,
                          GDExtensionClassCreationInfo4& info) {
    ERR_FAIL_COND_MSG(internal::find_own(name) != nullptr, String(name) + " is registered twice.");
    internal::own_classes.push_back(std::make_unique<internal::OwnClass>());
    internal::OwnClass* entry = internal::own_classes.back().get();
    entry->name = name;
    entry->parent = parent;
    entry->level = internal::current_level;
    info.get_virtual_func = &internal::get_virtual;
    info.class_userdata = entry;
    internal::interface.classdb_register_extension_class4(internal::library, name._native_ptr(),
                                                          parent._native_ptr(), &info);
}

MethodBind* ClassDB::add_method(const StringName& class_name, const MethodDefinition& definition,
                                MethodBind* bind, std::vector<Variant> defaults) {
    internal::OwnClass* entry = internal::find_own(class_name);
    std::unique_ptr<MethodBind> owned(bind);
    ERR_FAIL_NULL_V_MSG(entry, nullptr, String(class_name) + " is not registered.");
    ERR_FAIL_COND_V_MSG(definition.args.size() > bind->argument_list.size(), nullptr,
                        String(class_name) + "." + definition.name + ": D_METHOD names too many arguments.");
    ERR_FAIL_COND_V_MSG(defaults.size() > bind->argument_list.size(), nullptr,
                        String(class_name) + "." + definition.name + ": more defaults than arguments.");
    bind->name = definition.name;
    bind->defaults = std::move(defaults);
    for (size_t i = 0; i < bind->argument_list.size(); ++i) {
        bind->argument_list[i].info.name = i < definition.args.size()
                                               ? definition.args[i]
                                               : StringName("arg" + itos(static_cast<int64_t>(i)));
    }
    internal::announce(class_name, *bind);
    entry->methods.push_back(std::move(owned));
    return bind;
}

void ClassDB::add_property_group(const StringName& class_name, const String& name, const String& prefix) {
    internal::interface.classdb_register_extension_class_property_group(
        internal::library, class_name._native_ptr(), name._native_ptr(), prefix._native_ptr());
}

void ClassDB::add_property_subgroup(const StringName& class_name, const String& name, const String& prefix) {
    internal::interface.classdb_register_extension_class_property_subgroup(
        internal::library, class_name._native_ptr(), name._native_ptr(), prefix._native_ptr());
}

void ClassDB::add_property(const StringName& class_name, const PropertyInfo& property,
                           const StringName& setter, const StringName& getter, int index) {
    PropertyInfo copy = property;
    const GDExtensionPropertyInfo info = copy.view();
    internal::interface.classdb_register_extension_class_property_indexed(
        internal::library, class_name._native_ptr(), &info, setter._native_ptr(), getter._native_ptr(),
        index);
}

void ClassDB::add_signal(const StringName& class_name, const MethodInfo& signal) {
    std::vector<PropertyInfo> arguments = signal.arguments;
    std::vector<GDExtensionPropertyInfo> infos;
    for (PropertyInfo& argument : arguments) {
        infos.push_back(argument.view());
    }
    internal::interface.classdb_register_extension_class_signal(internal::library, class_name._native_ptr(),
                                                                signal.name._native_ptr(), infos.data(),
                                                                static_cast<GDExtensionInt>(infos.size()));
}

void ClassDB::bind_integer_constant(const StringName& class_name, const StringName& enum_name,
                                    const StringName& constant_name, int64_t value, bool is_bitfield) {
    internal::interface.classdb_register_extension_class_integer_constant(
        internal::library, class_name._native_ptr(), enum_name._native_ptr(), constant_name._native_ptr(),
        value, is_bitfield);
}

void ClassDB::bind_virtual_method(const StringName& class_name, const StringName& method,
                                  GDExtensionClassCallVirtual call) {
    internal::OwnClass* entry = internal::find_own(class_name);
    ERR_FAIL_NULL_MSG(entry, String(class_name) + " is not registered.");
    entry->virtuals.emplace_back(method, call);
}

}  // namespace godot
