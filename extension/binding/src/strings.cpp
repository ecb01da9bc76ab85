#include <godot_cpp/private/interface.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace godot {

using internal::interface;

String::String(const char* latin1) {
    interface.string_new_with_latin1_chars(opaque_, latin1);
}

String::String(const char32_t* text) {
    interface.string_new_with_utf32_chars(opaque_, text);
}

String String::utf8(const char* text, int64_t length) {
    String result;
    result.~String();
    interface.string_new_with_utf8_chars_and_len(result.opaque_, text, length);
    return result;
}

CharString String::utf8() const {
    CharString result(interface.string_to_utf8_chars(opaque_, nullptr, 0));
    interface.string_to_utf8_chars(opaque_, result.ptrw(), result.length());
    return result;
}

CharString String::ascii() const {
    CharString result(interface.string_to_latin1_chars(opaque_, nullptr, 0));
    interface.string_to_latin1_chars(opaque_, result.ptrw(), result.length());
    return result;
}

Char32String String::utf32() const {
    Char32String result(interface.string_to_utf32_chars(opaque_, nullptr, 0));
    interface.string_to_utf32_chars(opaque_, result.ptrw(), result.length());
    return result;
}

const char32_t& String::operator[](int64_t index) const {
    return *interface.string_operator_index_const(opaque_, index);
}

char32_t& String::operator[](int64_t index) {
    return *interface.string_operator_index(opaque_, index);
}

String& String::operator+=(const String& other) {
    interface.string_operator_plus_eq_string(opaque_, other.opaque_);
    return *this;
}

String& String::operator+=(const char* other) {
    return *this += String(other);
}

String& String::operator+=(char32_t other) {
    interface.string_operator_plus_eq_char(opaque_, other);
    return *this;
}

String String::operator+(const char* other) {
    return *this + String(other);
}

String String::operator+(char32_t other) {
    String result(*this);
    result += other;
    return result;
}

bool String::operator==(const char* other) const {
    return *this == String(other);
}

bool String::operator!=(const char* other) const {
    return !(*this == other);
}

String operator+(const char* left, const String& right) {
    return String(left) + right;
}

bool operator==(const char* left, const String& right) {
    return right == left;
}

bool operator!=(const char* left, const String& right) {
    return right != left;
}

String itos(int64_t value) {
    return String::num_int64(value);
}

String rtos(double value) {
    return String::num(value);
}

String rtoss(double value) {
    return String::num_scientific(value);
}

StringName::StringName(const char* latin1) {
    interface.string_name_new_with_latin1_chars(opaque_, latin1, false);
}

bool StringName::operator==(const char* other) const {
    return *this == StringName(other);
}

bool StringName::operator!=(const char* other) const {
    return !(*this == other);
}

NodePath::NodePath(const char* latin1) : NodePath(String(latin1)) {}

}  // namespace godot
