#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/core/print_string.hpp>
#include <godot_cpp/private/interface.hpp>
#include <godot_cpp/variant/utility_functions.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace godot {

void _err_print_error(const char* function, const char* file, int line, const char* error,
                      const char* message, bool editor_notify, bool is_warning) {
    const bool plain = message == nullptr || message[0] == '\0';
    if (is_warning && plain) {
        internal::interface.print_warning(error, function, file, line, editor_notify);
    } else if (is_warning) {
        internal::interface.print_warning_with_message(error, message, function, file, line, editor_notify);
    } else if (plain) {
        internal::interface.print_error(error, function, file, line, editor_notify);
    } else {
        internal::interface.print_error_with_message(error, message, function, file, line, editor_notify);
    }
}

void _err_print_error(const char* function, const char* file, int line, const char* error,
                      const String& message, bool editor_notify, bool is_warning) {
    _err_print_error(function, file, line, error, message.utf8().get_data(), editor_notify, is_warning);
}

void _err_print_error(const char* function, const char* file, int line, const String& error,
                      const char* message, bool editor_notify, bool is_warning) {
    _err_print_error(function, file, line, error.utf8().get_data(), message, editor_notify, is_warning);
}

void _err_print_index_error(const char* function, const char* file, int line, int64_t index, int64_t size,
                            const char* index_text, const char* size_text) {
    const String text = String("Index ") + index_text + " = " + itos(index) + " is out of bounds (" +
                        size_text + " = " + itos(size) + ").";
    _err_print_error(function, file, line, text);
}

void print_line(const Variant& value) {
    UtilityFunctions::print(value);
}

void print_error(const String& text) {
    UtilityFunctions::printerr(text);
}

void print_verbose(const String& text) {
    UtilityFunctions::print_verbose(text);
}

}  // namespace godot
