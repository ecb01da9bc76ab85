#pragma once

// How a C++ object and an engine object belong together.
//
// * An engine object seen from here (a Camera3D in the scene) gets one C++ wrapper, kept by the engine as the
//   object's "instance binding" and freed with it.
// * An object of one of our own classes has its C++ half as "extension instance"; the same pointer is its
// binding.
//
// A wrapper never owns the engine object. Threads: as for the engine object itself.

#include <gdextension_interface.h>

#include <godot_cpp/core/defs.hpp>
#include <godot_cpp/core/property_info.hpp>
#include <godot_cpp/private/names.hpp>
#include <godot_cpp/templates/list.hpp>
#include <godot_cpp/variant/string_name.hpp>
#include <type_traits>

namespace godot {

class ClassDB;
class Variant;

namespace internal {

// What the Wrapped constructor has to know about the class that is being made, which a base cannot see.
struct Construction {
    const StringName* extension_class = nullptr;  // null for engine classes
    const GDExtensionInstanceBindingCallbacks* callbacks = nullptr;
    GodotObject* existing_object = nullptr;  // set when an extension is reloaded under a living object
};

// Announces a Construction to the next Wrapped constructor of this thread; the one before it comes back in
// finish().
class ConstructionScope {
public:
    explicit ConstructionScope(const Construction& construction);
    void finish();

private:
    Construction outer_;
};

struct ClassAccess;

}  // namespace internal

class Wrapped {
    friend struct internal::ClassAccess;

public:
    Wrapped(const Wrapped&) = delete;
    Wrapped& operator=(const Wrapped&) = delete;

    static const StringName& get_class_static() {
        static const internal::InternedName name("Wrapped");
        return name.get();
    }

    GodotObject* _owner = nullptr;

protected:
    // Makes the engine object of a class that exists in the engine.
    explicit Wrapped(const StringName& engine_class);
    // Wraps an engine object that exists already.
    explicit Wrapped(GodotObject* object) : _owner(object) {}
    virtual ~Wrapped() = default;

    static void _bind_methods() {}
    void _notification(int) {}
    bool _set(const StringName&, const Variant&) { return false; }
    bool _get(const StringName&, Variant&) const { return false; }
    void _get_property_list(List<PropertyInfo>*) const {}
    bool _property_can_revert(const StringName&) const { return false; }
    bool _property_get_revert(const StringName&, Variant&) const { return false; }
    void _validate_property(PropertyInfo&) const {}
    String _to_string() const;

    template <class T, class B>
    static void register_virtuals() {}
};

}  // namespace godot

// Stands first in every class that is registered with Godot.
#define GDCLASS(m_class, m_inherits)                                 \
private:                                                             \
    friend class ::godot::ClassDB;                                   \
    friend struct ::godot::internal::ClassAccess;                    \
                                                                     \
public:                                                              \
    using self_type = m_class;                                       \
    using parent_type = m_inherits;                                  \
    static constexpr bool is_engine_class = false;                   \
    static const ::godot::StringName& get_class_static() {           \
        static const ::godot::internal::InternedName name(#m_class); \
        return name.get();                                           \
    }                                                                \
    static const ::godot::StringName& get_parent_class_static() {    \
        return m_inherits::get_class_static();                       \
    }                                                                \
                                                                     \
protected:                                                           \
    template <class T, class B>                                      \
    static void register_virtuals() {                                \
        m_inherits::template register_virtuals<T, B>();              \
    }                                                                \
                                                                     \
private:

// The same for the generated wrappers of engine classes.
#define GDEXTENSION_CLASS(m_class, m_inherits)                                              \
public:                                                                                     \
    using self_type = m_class;                                                              \
    using parent_type = m_inherits;                                                         \
    static constexpr bool is_engine_class = true;                                           \
    static const ::godot::StringName& get_class_static() {                                  \
        static const ::godot::internal::InternedName name(#m_class);                        \
        return name.get();                                                                  \
    }                                                                                       \
    static const ::godot::StringName& get_parent_class_static() {                           \
        return m_inherits::get_class_static();                                              \
    }                                                                                       \
    m_class() : m_inherits(get_class_static()) {}                                           \
    explicit m_class(::godot::GodotObject* object) : m_inherits(object) {}                  \
                                                                                            \
protected:                                                                                  \
    friend struct ::godot::internal::ClassAccess;                                           \
    explicit m_class(const ::godot::StringName& engine_class) : m_inherits(engine_class) {} \
                                                                                            \
private:
