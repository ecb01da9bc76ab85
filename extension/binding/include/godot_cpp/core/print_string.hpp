#pragma once

#include <godot_cpp/variant/variant.hpp>

namespace godot {

void print_line(const Variant& value);
void print_error(const String& text);
void print_verbose(const String& text);

template <class... A>
void print_line(const Variant& first, const Variant& second, const A&... rest) {
    print_line(Variant(first.stringify() + " " + second.stringify()), Variant(rest)...);
}

}  // namespace godot
