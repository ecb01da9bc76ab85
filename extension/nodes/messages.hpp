// How nodes say that something is wrong: every message names who, what, and what to do.
#pragma once

#include <cmath>
#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/utility_functions.hpp>
#include <unordered_set>

namespace tactus {

inline bool is_above_zero(double value) { return std::isfinite(value) && value > 0.0; }
inline bool is_at_least_zero(double value) { return std::isfinite(value) && value >= 0.0; }

// A setter keeps the old value and says why.
inline void refuse(const godot::String& who, const char* property, const godot::Variant& value, const char* wanted) {
    godot::UtilityFunctions::push_error(who, ": ", property, " = ", value, " was refused, the old value stays: it must be ",
                                        wanted, ".");
}

// The node's path where it has one, else its name.
inline godot::String name_of(const godot::Node& node) {
    return node.is_inside_tree() ? godot::String(node.get_path()) : godot::String(node.get_name());
}

// Says each text once.
class Complaints {
public:
    void say(const godot::Node& node, const godot::String& text) {
        const godot::String whole = name_of(node) + ": " + text;
        if (said_.insert(whole.hash()).second) {
            godot::UtilityFunctions::push_warning(whole);
        }
    }
    void forget() { said_.clear(); }

private:
    std::unordered_set<std::uint32_t> said_;
};

}  // namespace tactus
