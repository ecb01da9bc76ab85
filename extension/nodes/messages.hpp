// How nodes say that something is wrong: every message names who, what, and what to do.
#pragma once

#include <cmath>
#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/utility_functions.hpp>
#include <string>
#include <unordered_set>

#include "nodes/conversions.hpp"

namespace tactus {

inline bool is_at_least_zero(double value) {
    return std::isfinite(value) && value >= 0.0;
}

// The node's path where it has one, else its name, else its class; a resource's file or class.
inline godot::String name_of(const godot::Object& object) {
    if (const auto* node = godot::Object::cast_to<godot::Node>(&object)) {
        const godot::String name =
            node->is_inside_tree() ? godot::String(node->get_path()) : godot::String(node->get_name());
        return name.is_empty() ? node->get_class() : name;
    }
    const auto* resource = godot::Object::cast_to<godot::Resource>(&object);
    return resource != nullptr && !resource->get_path().is_empty() ? resource->get_path()
                                                                   : object.get_class();
}

// A setter keeps the old value and says why.
inline void refuse(const godot::Object& who, const char* property, const godot::Variant& value,
                   const char* wanted) {
    godot::UtilityFunctions::push_error(name_of(who), ": ", property, " = ", value,
                                        " was refused, the old value stays: it must be ",
                                        godot::String::utf8(wanted), ".");
}

// What is wrong with a value that should hold an object; empty: it holds one that is alive.
inline godot::String problem_of_object(const godot::Variant& value) {
    if (value.get_type() != godot::Variant::OBJECT) {
        return value.get_type() == godot::Variant::NIL ? "is null" : "is no object";
    }
    if (value.get_validated_object() != nullptr) {
        return godot::String();
    }
    const bool was_one = static_cast<std::uint64_t>(static_cast<godot::ObjectID>(value)) != 0;
    return was_one ? "has been freed" : "is null";
}

// A node's warning in the editor: what follows from a problem, and the problem, which says what to do. An
// empty one warns of nothing.
inline void warn(godot::PackedStringArray& warnings, const godot::String& effect,
                 const godot::String& problem) {
    if (!problem.is_empty()) {
        warnings.push_back(effect + godot::String(": ") + problem + godot::String("."));
    }
}

// One problem as a list: empty where there is none.
inline godot::PackedStringArray list_of(const godot::String& problem) {
    godot::PackedStringArray problems;
    if (!problem.is_empty()) {
        problems.push_back(problem);
    }
    return problems;
}

// What to say of a path that leads to nothing of the kind.
inline godot::String wrong_path(const char* property, const godot::NodePath& path, const char* kind) {
    return godot::String("its ") + property + " '" + godot::String(path) + "' is not " + kind +
           " of the scene: set '" + property + "' anew";
}

// Says each text once; an empty one says nothing.
class Complaints {
public:
    // Nothing is said for as long as that holds; what goes on being wrong is said afterwards.
    void mute(bool is_muted) { is_muted_ = is_muted; }

    void say(const godot::Node& node, const godot::String& text) {
        if (text.is_empty() || is_muted_) {
            return;
        }
        const godot::String whole = name_of(node) + ": " + text;
        if (said_.insert(from_godot(whole)).second) {
            godot::UtilityFunctions::push_warning(whole);
        }
    }
    void say(const godot::Node& node, const std::string& text) { say(node, to_godot(text)); }
    void say(const godot::Node& node, const char* text) { say(node, godot::String::utf8(text)); }

private:
    std::unordered_set<std::string> said_;
    bool is_muted_ = false;
};

}  // namespace tactus
