#pragma once

#include <godot_cpp/variant/string_name.hpp>

namespace godot::internal {

// A name that is looked up once and lives until the extension is closed: meant for function-local statics.
// Its destructor does nothing; release_names() frees all of them while the engine can still be called.
class InternedName {
public:
    explicit InternedName(const char* text);
    InternedName(const InternedName&) = delete;
    InternedName& operator=(const InternedName&) = delete;

    const StringName& get() const { return *reinterpret_cast<const StringName*>(storage_); }

private:
    friend void release_names();

    alignas(StringName) unsigned char storage_[sizeof(StringName)];
    InternedName* next_;
};

void release_names();

// The base of any class the engine knows; empty for Object and unknown names.
StringName parent_class(const StringName& class_name);

}  // namespace godot::internal
