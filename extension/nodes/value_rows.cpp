#include "nodes/value_rows.hpp"

#include <cmath>
#include <string>

#include "nodes/conversions.hpp"
#include "nodes/messages.hpp"

namespace tactus {

using namespace godot;

bool accepts_value(const Object& who, const char* property, Variant::Type type, double min, double max,
                   const Variant& value) {
    const bool is_number = value.get_type() == Variant::INT || value.get_type() == Variant::FLOAT ||
                           value.get_type() == Variant::BOOL;
    const double number = is_number ? static_cast<double>(value) : NAN;
    const bool is_whole = type == Variant::FLOAT || number == std::floor(number);
    if (number >= min && number <= max && is_whole) {
        return true;
    }
    const std::string wanted = std::string(type == Variant::FLOAT ? "a number" : "a whole number") +
                               " between " + from_godot(String::num(min)) + " and " +
                               from_godot(String::num(max));
    refuse(who, property, value, wanted.c_str());
    return false;
}

}  // namespace tactus
