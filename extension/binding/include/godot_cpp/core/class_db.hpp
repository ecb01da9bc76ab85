#pragma once

// Registration of our own classes with Godot. Call from the initializer of the scene (or editor) level.

#include <gdextension_interface.h>

#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/core/method_bind.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/private/class_access.hpp>
#include <string>
#include <vector>

namespace godot {

struct MethodDefinition {
    StringName name;
    std::vector<StringName> args;
    MethodDefinition() = default;
    MethodDefinition(const char* p_name) : name(p_name) {}
    MethodDefinition(const StringName& p_name) : name(p_name) {}
};

template <class... A>
MethodDefinition D_METHOD(const char* name, const A&... argument_names) {
    MethodDefinition definition(name);
    (definition.args.push_back(StringName(argument_names)), ...);
    return definition;
}

#define DEFVAL(m_default) (m_default)

class ClassDB {
public:
    template <class T>
    static void register_class(bool p_virtual = false) {
        register_with<T>(p_virtual, false, true, false);
    }
    template <class T>
    static void register_abstract_class() {
        register_with<T>(false, true, true, false);
    }
    template <class T>
    static void register_internal_class() {
        register_with<T>(false, false, false, false);
    }
    // In the editor such a class is only a placeholder with the same properties: its code runs in the game
    // alone.
    template <class T>
    static void register_runtime_class() {
        register_with<T>(false, false, true, true);
    }

    template <class M, class... Defaults>
    static MethodBind* bind_method(const MethodDefinition& definition, M method,
                                   const Defaults&... defaults) {
        using Class = typename internal::MethodPointer<M>::Class;
        static_assert(
            internal::is_own_method<M>,
            "a method of an engine class cannot be bound anew: bind one of the class's own that calls it");
        return add_method(Class::get_class_static(), definition, create_method_bind(method),
                          {Variant(defaults)...});
    }

    template <class M, class... Defaults>
    static MethodBind* bind_static_method(const StringName& class_name, const MethodDefinition& definition,
                                          M function, const Defaults&... defaults) {
        return add_method(class_name, definition, create_static_method_bind(function),
                          {Variant(defaults)...});
    }

    static void add_property_group(const StringName& class_name, const String& name, const String& prefix);
    static void add_property_subgroup(const StringName& class_name, const String& name, const String& prefix);
    static void add_property(const StringName& class_name, const PropertyInfo& property,
                             const StringName& setter, const StringName& getter, int index = -1);
    static void add_signal(const StringName& class_name, const MethodInfo& signal);
    static void bind_integer_constant(const StringName& class_name, const StringName& enum_name,
                                      const StringName& constant_name, int64_t value,
                                      bool is_bitfield = false);
    static void bind_virtual_method(const StringName& class_name, const StringName& method,
                                    GDExtensionClassCallVirtual call);

private:
    template <class T>
    static void register_with(bool is_virtual, bool is_abstract, bool is_exposed, bool is_runtime) {
        GDExtensionClassCreationInfo4 info = internal::ClassAccess::creation_info<T>();
        info.is_virtual = is_virtual;
        info.is_abstract = is_abstract || std::is_abstract_v<T>;
        info.is_exposed = is_exposed;
        info.is_runtime = is_runtime;
        begin_class(T::get_class_static(), T::get_parent_class_static(), info);
        internal::ClassAccess::bind_methods<T>();
        internal::ClassAccess::register_virtuals<T>();
    }

    static void begin_class(const StringName& name, const StringName& parent,
                            GDExtensionClassCreationInfo4& info);
    static MethodBind* add_method(const StringName& class_name, const MethodDefinition& definition,
                                  MethodBind* bind, std::vector<Variant> defaults);
};

}  // namespace godot

#define GDREGISTER_CLASS(m_class) ::godot::ClassDB::register_class<m_class>();
#define GDREGISTER_VIRTUAL_CLASS(m_class) ::godot::ClassDB::register_class<m_class>(true);
#define GDREGISTER_ABSTRACT_CLASS(m_class) ::godot::ClassDB::register_abstract_class<m_class>();
#define GDREGISTER_INTERNAL_CLASS(m_class) ::godot::ClassDB::register_internal_class<m_class>();
#define GDREGISTER_RUNTIME_CLASS(m_class) ::godot::ClassDB::register_runtime_class<m_class>();

#define ADD_GROUP(m_name, m_prefix) ::godot::ClassDB::add_property_group(get_class_static(), m_name, m_prefix)
#define ADD_SUBGROUP(m_name, m_prefix) \
    ::godot::ClassDB::add_property_subgroup(get_class_static(), m_name, m_prefix)
#define ADD_PROPERTY(m_property, m_setter, m_getter) \
    ::godot::ClassDB::add_property(get_class_static(), m_property, m_setter, m_getter)
#define ADD_PROPERTYI(m_property, m_setter, m_getter, m_index) \
    ::godot::ClassDB::add_property(get_class_static(), m_property, m_setter, m_getter, m_index)
#define ADD_SIGNAL(m_signal) ::godot::ClassDB::add_signal(get_class_static(), m_signal)

#define BIND_CONSTANT(m_constant) \
    ::godot::ClassDB::bind_integer_constant(get_class_static(), "", #m_constant, m_constant);
#define BIND_ENUM_CONSTANT(m_constant)                                                                     \
    ::godot::ClassDB::bind_integer_constant(get_class_static(),                                            \
                                            ::godot::_gde_constant_get_enum_name(m_constant, #m_constant), \
                                            #m_constant, m_constant);
#define BIND_BITFIELD_FLAG(m_constant)                                                                     \
    ::godot::ClassDB::bind_integer_constant(get_class_static(),                                            \
                                            ::godot::_gde_constant_get_enum_name(m_constant, #m_constant), \
                                            #m_constant, m_constant, true);
