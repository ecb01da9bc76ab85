#pragma once

#include <godot_cpp/core/defs.hpp>

namespace godot {

class String;

// Reports to Godot's log, and to the editor's debugger, where it happened. Empty messages are allowed.
void _err_print_error(const char* function, const char* file, int line, const char* error,
                      const char* message = "", bool editor_notify = false, bool is_warning = false);
void _err_print_error(const char* function, const char* file, int line, const char* error,
                      const String& message, bool editor_notify = false, bool is_warning = false);
void _err_print_error(const char* function, const char* file, int line, const String& error,
                      const char* message = "", bool editor_notify = false, bool is_warning = false);
void _err_print_index_error(const char* function, const char* file, int line, int64_t index, int64_t size,
                            const char* index_text, const char* size_text);

namespace internal {
constexpr bool out_of_range(int64_t index, int64_t size) {
    return index < 0 || index >= size;
}
}  // namespace internal

}  // namespace godot

#define GODOT_BINDING_REPORT(...) ::godot::_err_print_error(__FUNCTION__, __FILE__, __LINE__, __VA_ARGS__)

#define ERR_PRINT(message) GODOT_BINDING_REPORT(message)
#define WARN_PRINT(message) GODOT_BINDING_REPORT(message, "", false, true)
#define ERR_PRINT_ED(message) GODOT_BINDING_REPORT(message, "", true, false)
#define WARN_PRINT_ED(message) GODOT_BINDING_REPORT(message, "", true, true)

// Every ERR_FAIL macro is one shape: if the condition holds, say so and leave the function.
#define GODOT_BINDING_FAIL_IF(condition, description, message, result) \
    if (unlikely(condition)) {                                         \
        GODOT_BINDING_REPORT(description, message);                    \
        return result;                                                 \
    } else                                                             \
        ((void)0)

#define ERR_FAIL_COND(condition) \
    GODOT_BINDING_FAIL_IF(condition, "Condition \"" #condition "\" is true.", "", )
#define ERR_FAIL_COND_MSG(condition, message) \
    GODOT_BINDING_FAIL_IF(condition, "Condition \"" #condition "\" is true.", message, )
#define ERR_FAIL_COND_V(condition, result) \
    GODOT_BINDING_FAIL_IF(condition, "Condition \"" #condition "\" is true. Returning: " #result, "", result)
#define ERR_FAIL_COND_V_MSG(condition, result, message)                                                    \
    GODOT_BINDING_FAIL_IF(condition, "Condition \"" #condition "\" is true. Returning: " #result, message, \
                          result)

#define ERR_FAIL_NULL(pointer) \
    GODOT_BINDING_FAIL_IF((pointer) == nullptr, "Parameter \"" #pointer "\" is null.", "", )
#define ERR_FAIL_NULL_MSG(pointer, message) \
    GODOT_BINDING_FAIL_IF((pointer) == nullptr, "Parameter \"" #pointer "\" is null.", message, )
#define ERR_FAIL_NULL_V(pointer, result) \
    GODOT_BINDING_FAIL_IF((pointer) == nullptr, "Parameter \"" #pointer "\" is null.", "", result)
#define ERR_FAIL_NULL_V_MSG(pointer, result, message) \
    GODOT_BINDING_FAIL_IF((pointer) == nullptr, "Parameter \"" #pointer "\" is null.", message, result)

#define GODOT_BINDING_FAIL_INDEX(index, size, result)                                                    \
    if (unlikely(                                                                                        \
            ::godot::internal::out_of_range(static_cast<int64_t>(index), static_cast<int64_t>(size)))) { \
        ::godot::_err_print_index_error(__FUNCTION__, __FILE__, __LINE__, static_cast<int64_t>(index),   \
                                        static_cast<int64_t>(size), #index, #size);                      \
        return result;                                                                                   \
    } else                                                                                               \
        ((void)0)

#define ERR_FAIL_INDEX(index, size) GODOT_BINDING_FAIL_INDEX(index, size, )
#define ERR_FAIL_INDEX_V(index, size, result) GODOT_BINDING_FAIL_INDEX(index, size, result)

#define GODOT_BINDING_FAIL(description, message, result) \
    if (true) {                                          \
        GODOT_BINDING_REPORT(description, message);      \
        return result;                                   \
    } else                                               \
        ((void)0)

#define ERR_FAIL() GODOT_BINDING_FAIL("Method/function failed.", "", )
#define ERR_FAIL_MSG(message) GODOT_BINDING_FAIL("Method/function failed.", message, )
#define ERR_FAIL_V(result) GODOT_BINDING_FAIL("Method/function failed. Returning: " #result, "", result)
#define ERR_FAIL_V_MSG(result, message) \
    GODOT_BINDING_FAIL("Method/function failed. Returning: " #result, message, result)

#define GODOT_BINDING_LOOP_IF(condition, message, leave)                                \
    if (unlikely(condition)) {                                                          \
        GODOT_BINDING_REPORT("Condition \"" #condition "\" is true. " #leave, message); \
        leave;                                                                          \
    } else                                                                              \
        ((void)0)

#define ERR_CONTINUE(condition) GODOT_BINDING_LOOP_IF(condition, "", continue)
#define ERR_CONTINUE_MSG(condition, message) GODOT_BINDING_LOOP_IF(condition, message, continue)
#define ERR_BREAK(condition) GODOT_BINDING_LOOP_IF(condition, "", break)
#define ERR_BREAK_MSG(condition, message) GODOT_BINDING_LOOP_IF(condition, message, break)

#define ERR_PRINT_ONCE(message)           \
    if (true) {                           \
        static bool already_said = false; \
        if (unlikely(!already_said)) {    \
            already_said = true;          \
            ERR_PRINT(message);           \
        }                                 \
    } else                                \
        ((void)0)
#define WARN_PRINT_ONCE(message)          \
    if (true) {                           \
        static bool already_said = false; \
        if (unlikely(!already_said)) {    \
            already_said = true;          \
            WARN_PRINT(message);          \
        }                                 \
    } else                                \
        ((void)0)
