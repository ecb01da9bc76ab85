// Properties of a resource that are numbers in a plain struct: one row each, written from the class reference
// (binding/bind_classes.py), and one way to read and to set them all.
#pragma once

#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <span>
#include <type_traits>

#include "core/math/types.hpp"

namespace tactus {

// How a field of the struct is seen from Godot.
struct Plain {
    template <class T>
    static godot::Variant read(T field) {
        if constexpr (std::is_floating_point_v<T>) {
            return static_cast<double>(field);
        } else if constexpr (std::is_same_v<T, bool>) {
            return field;
        } else {
            return static_cast<int64_t>(field);
        }
    }
    template <class T>
    static void write(T& field, const godot::Variant& value) {
        if constexpr (std::is_floating_point_v<T>) {
            field = static_cast<double>(value);
        } else if constexpr (std::is_same_v<T, bool>) {
            field = static_cast<bool>(value);
        } else {
            field = static_cast<T>(static_cast<int64_t>(value));
        }
    }
};

// A time: nanoseconds in the struct, seconds in Godot.
struct Seconds {
    static godot::Variant read(Nanoseconds field) { return to_seconds(field); }
    static void write(Nanoseconds& field, const godot::Variant& value) {
        field = from_seconds(static_cast<double>(value));
    }
};

template <class Values>
struct ValueRow {
    const char* name;
    const char* was = "";                             // "Class.name" under which older scenes have stored it
    godot::Variant::Type type = godot::Variant::NIL;  // NIL: the class keeps this one itself
    double min = 0.0, max = 0.0;                      // what is accepted
    godot::Variant (*read)(const Values&) = nullptr;
    void (*write)(Values&, const godot::Variant&) = nullptr;
};

// Whether the value may be set; says why not.
bool accepts_value(const godot::Object& who, const char* property, godot::Variant::Type type, double min,
                   double max, const godot::Variant& value);

// Sets one of the rows; tells the resource's users where that has changed something.
template <class Values>
void set_value(godot::Resource& who, std::span<const ValueRow<Values>> rows, int64_t index, Values& values,
               const godot::Variant& value) {
    if (index < 0 || index >= static_cast<int64_t>(rows.size())) {
        return;
    }
    const ValueRow<Values>& row = rows[static_cast<std::size_t>(index)];
    if (row.write == nullptr || !accepts_value(who, row.name, row.type, row.min, row.max, value)) {
        return;
    }
    const godot::Variant before = row.read(values);
    row.write(values, value);
    if (row.read(values) != before) {
        who.emit_changed();
    }
}

template <class Values>
godot::Variant get_value(std::span<const ValueRow<Values>> rows, int64_t index, const Values& values) {
    const bool is_one = index >= 0 && index < static_cast<int64_t>(rows.size());
    const auto read = is_one ? rows[static_cast<std::size_t>(index)].read : nullptr;
    return read != nullptr ? read(values) : godot::Variant();
}

// What "Class.name" of an older scene is called here; null: nothing of this table.
template <class Values>
const char* new_name_of(std::span<const ValueRow<Values>> rows, const godot::String& old) {
    for (const ValueRow<Values>& row : rows) {
        if (old == godot::String(row.was)) {
            return row.name;
        }
    }
    return nullptr;
}

}  // namespace tactus
