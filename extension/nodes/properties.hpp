// Properties that are stored as they are set: one row each, written from the class reference
// (binding/bind_classes.py), and one way to read, check and set them all. A class says
// TACTUS_PROPERTIES(Class) among its public members and nothing more.
#pragma once

#include <algorithm>
#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "nodes/conversions.hpp"

namespace tactus {

// What is accepted.
struct PropertyLimits {
    godot::Variant::Type type = godot::Variant::NIL;  // NIL: the class keeps this one itself
    double min = 0.0, max = 0.0;                      // of a number; the second of a vector's length, too
    std::uint64_t one_of = 0;                         // of an enum: bit i for the value i
    const char* class_name = "";                      // of a resource
    const char* wanted = "";                          // all of it in words
};

template <class Owner>
struct Property {
    const char* name;
    // The names that it had, separated by spaces; "Class.name" where it was another class's.
    std::string_view was = {};
    PropertyLimits limits = {};
    godot::Variant (*read)(const Owner&) = nullptr;
    void (*write)(Owner&, const godot::Variant&) = nullptr;
    void (*changed)(Owner&) = nullptr;  // null: nobody has to know
    const char* follows = "";           // the method that hears of changes inside of the resource
    double was_scale = 1.0;             // a number under a former name times this is the number now
    const char* node = "";              // the class of the nodes that the path leads to
};

// A text as an argument of a template.
template <std::size_t size>
struct FixedText {
    consteval FixedText(const char (&from)[size]) { std::copy_n(from, size, text); }
    char text[size] = {};
};

// Whether the value may be set; says why not.
bool accepts(const godot::Object& who, const char* property, const PropertyLimits& limits,
             const godot::Variant& value);

// `method` of `who` is called when the resource says that it has changed; no longer for the one before.
void follow_changes(godot::Object& who, const char* method, const godot::Variant& before,
                    const godot::Variant& now);

// How a field of the class is seen from Godot.
template <class T>
godot::Variant stored(const T& field) {
    if constexpr (std::is_same_v<T, Vec3>) {
        return to_godot(field);
    } else if constexpr (std::is_same_v<T, bool>) {
        return field;
    } else if constexpr (std::is_floating_point_v<T>) {
        return static_cast<double>(field);
    } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
        return static_cast<int64_t>(field);
    } else if constexpr (std::is_same_v<T, std::string>) {
        return to_godot(field);
    } else if constexpr (requires { field.is_valid(), field.ptr(); }) {
        return field.ptr();  // a resource
    } else {
        return godot::Variant(field);
    }
}

template <class T>
void store(T& field, const godot::Variant& value) {
    if constexpr (std::is_same_v<T, Vec3>) {
        field = from_godot(static_cast<godot::Vector3>(value));
    } else if constexpr (std::is_same_v<T, bool>) {
        field = static_cast<bool>(value);
    } else if constexpr (std::is_floating_point_v<T>) {
        field = static_cast<double>(value);
    } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
        field = static_cast<T>(static_cast<int64_t>(value));
    } else if constexpr (std::is_same_v<T, std::string>) {
        field = from_godot(godot::VariantCaster<godot::String>::cast(value));
    } else {
        field = godot::VariantCaster<T>::cast(value);
    }
}

// A time: nanoseconds in the class, seconds in Godot.
inline godot::Variant stored_seconds(Nanoseconds field) {
    return to_seconds(field);
}
inline void store_seconds(Nanoseconds& field, const godot::Variant& value) {
    field = from_seconds(static_cast<double>(value));
}

template <class Owner>
const Property<Owner>* property_at(int64_t index) {
    const std::span<const Property<Owner>> all = Owner::properties();
    const bool is_one = index >= 0 && index < static_cast<int64_t>(all.size()) &&
                        all[static_cast<std::size_t>(index)].read != nullptr;
    return is_one ? &all[static_cast<std::size_t>(index)] : nullptr;
}

template <class Owner>
void set_property(Owner& owner, int64_t index, const godot::Variant& value) {
    const Property<Owner>* const property = property_at<Owner>(index);
    if (property == nullptr || !accepts(owner, property->name, property->limits, value)) {
        return;
    }
    const godot::Variant before = property->read(owner);
    property->write(owner, value);
    const godot::Variant now = property->read(owner);
    if (now == before) {
        return;
    }
    if (*property->follows != '\0') {
        follow_changes(owner, property->follows, before, now);
    }
    if (property->changed != nullptr) {
        property->changed(owner);
    }
}

template <class Owner>
godot::Variant get_property(const Owner& owner, int64_t index) {
    const Property<Owner>* const property = property_at<Owner>(index);
    return property != nullptr ? property->read(owner) : godot::Variant();
}

// The path from a node to the one in the Variant, empty for null. None where it is refused: it is no node of
// this class, or no node stands above both.
std::optional<godot::NodePath> path_to(const godot::Node& from, const char* property, const char* class_name,
                                       const godot::Variant& node);

// A property that is a path, by the node that it leads to.
template <class Owner>
void set_node_property(Owner& owner, int64_t index, const godot::Variant& node) {
    const Property<Owner>& property = *property_at<Owner>(index);
    if (const auto path = path_to(owner, property.name, property.node, node)) {
        set_property(owner, index, *path);
    }
}

// Null: it is empty, leads nowhere, or to another kind.
template <class NodeType, class Owner>
NodeType* get_node_property(const Owner& owner, int64_t index) {
    const auto path = static_cast<godot::NodePath>(get_property(owner, index));
    const bool can_follow = !path.is_empty() && (owner.is_inside_tree() || !path.is_absolute());
    return can_follow ? godot::Object::cast_to<NodeType>(owner.get_node_or_null(path)) : nullptr;
}

// A class or a property of an older scene or script was met under a former name. Warns once of each name,
// from any thread.
void warn_of_rename(const std::string& old, const std::string& now);
// The same of a property of this class, by the names that it had (see Property::was).
void warn_of_former_name(const godot::StringName& class_name, std::string_view was, const char* now);

// Whether it is one of the names (see Property::was).
bool has_name(std::string_view names, std::string_view name);

// The property that had this name, which may be "Class.name"; null: none of this class.
template <class Owner>
const char* new_name_of(std::string_view old) {
    for (const Property<Owner>& property : Owner::properties()) {
        if (has_name(property.was, old)) {
            return property.name;
        }
    }
    return nullptr;
}

// Times the factor, which is 1 for everything but numbers.
inline godot::Variant scaled(const godot::Variant& value, double factor) {
    const bool is_number =
        value.get_type() == godot::Variant::FLOAT || value.get_type() == godot::Variant::INT;
    return is_number && factor != 1.0 ? godot::Variant(static_cast<double>(value) * factor) : value;
}

}  // namespace tactus

// Under its former name, a method is a second one that warns.
#define TACTUS_FORMER_METHODS(Class)                                                                       \
    template <auto method, tactus::FixedText was, tactus::FixedText now, class Result, class... Arguments> \
    Result call_former(Arguments... arguments) {                                                           \
        tactus::warn_of_former_name(get_class_static(), was.text, now.text);                               \
        return (this->*method)(arguments...);                                                              \
    }                                                                                                      \
    template <auto method, tactus::FixedText was, tactus::FixedText now, class Result, class... Arguments> \
    Result call_const_former(Arguments... arguments) const {                                               \
        tactus::warn_of_former_name(get_class_static(), was.text, now.text);                               \
        return (this->*method)(arguments...);                                                              \
    }                                                                                                      \
    template <auto method, tactus::FixedText was, tactus::FixedText now, class Result, class... Arguments> \
    static constexpr auto former(Result (Class::*)(Arguments...)) {                                        \
        return &Class::template call_former<method, was, now, Result, Arguments...>;                       \
    }                                                                                                      \
    template <auto method, tactus::FixedText was, tactus::FixedText now, class Result, class... Arguments> \
    static constexpr auto former(Result (Class::*)(Arguments...) const) {                                  \
        return &Class::template call_const_former<method, was, now, Result, Arguments...>;                 \
    }

// By the number of its row. What is read is typed as the property is, and a typed script knows the property
// by that; what is set comes as it is, so that a value of another type is refused in words and not by Godot
// in silence. Under its former name, a property is a second one that warns.
#define TACTUS_PROPERTIES(Class)                                                                           \
    static std::span<const tactus::Property<Class>> properties();                                          \
    template <int64_t row>                                                                                 \
    void set_row(const godot::Variant& value) {                                                            \
        tactus::set_property(*this, row, value);                                                           \
    }                                                                                                      \
    template <int64_t row>                                                                                 \
    void row_changed() {                                                                                   \
        properties()[row].changed(*this);                                                                  \
    }                                                                                                      \
    template <int64_t row, class Value>                                                                    \
    Value get_row() const {                                                                                \
        return godot::VariantCaster<Value>::cast(tactus::get_property(*this, row));                        \
    }                                                                                                      \
    template <int64_t row>                                                                                 \
    void set_node_row(const godot::Variant& node) {                                                        \
        tactus::set_node_property(*this, row, node);                                                       \
    }                                                                                                      \
    template <int64_t row, class NodeType>                                                                 \
    NodeType* get_node_row() const {                                                                       \
        return tactus::get_node_property<NodeType>(*this, row);                                            \
    }                                                                                                      \
    template <int64_t row>                                                                                 \
    void set_renamed(const godot::Variant& value) {                                                        \
        tactus::warn_of_former_name(get_class_static(), properties()[row].was, properties()[row].name);    \
        set_row<row>(tactus::scaled(value, properties()[row].was_scale));                                  \
    }                                                                                                      \
    template <int64_t row, class Value>                                                                    \
    Value get_renamed() const {                                                                            \
        tactus::warn_of_former_name(get_class_static(), properties()[row].was, properties()[row].name);    \
        const double scale = 1.0 / properties()[row].was_scale;                                            \
        return godot::VariantCaster<Value>::cast(tactus::scaled(tactus::get_property(*this, row), scale)); \
    }                                                                                                      \
    TACTUS_FORMER_METHODS(Class)
