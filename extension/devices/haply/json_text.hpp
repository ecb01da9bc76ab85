// JSON as a service speaks it, read by jansson: C, its interface unchanged since version 2.0 of 2011, in
// every distribution. Loaded when a device needs it.
//
// Threads: one at a time.
#pragma once

#include <string>

#include "core/math/types.hpp"
#include "devices/runtime_library.hpp"

namespace tactus {

class JsonReader;

// A place in a document that is there for as long as its reader reads nothing else. A place that does not
// exist has nothing in it.
class JsonValue {
public:
    JsonValue operator[](const char* key) const;
    JsonValue operator[](std::size_t index) const;
    std::size_t size() const;  // of an array
    bool exists() const { return value_ != nullptr; }
    double number() const;  // 0 where it is none
    bool has_number() const;
    bool is_true() const;
    std::string text() const;
    // {"x":, "y":, "z":}; false where one of them is no number.
    bool vector(Vec3& into) const;

private:
    friend class JsonReader;
    struct Head {
        int type;
    };
    JsonValue(const JsonReader& reader, const Head* value) : reader_(&reader), value_(value) {}

    const JsonReader* reader_;
    const Head* value_;
};

class JsonReader {
public:
    JsonReader() = default;
    ~JsonReader() { forget(); }
    JsonReader(const JsonReader&) = delete;
    JsonReader& operator=(const JsonReader&) = delete;

    // Empty, or what to install.
    std::string load();
    // Nothing exists in a text that is no JSON.
    JsonValue read(const std::string& text);

private:
    friend class JsonValue;
    using Head = JsonValue::Head;
    void forget();

    RuntimeLibrary library_;
    Head* (*load_text_)(const char*, std::size_t, std::size_t, void*) = nullptr;
    Head* (*get_)(const Head*, const char*) = nullptr;
    Head* (*at_)(const Head*, std::size_t) = nullptr;
    std::size_t (*size_)(const Head*) = nullptr;
    double (*number_)(const Head*) = nullptr;
    const char* (*text_)(const Head*) = nullptr;
    void (*delete_)(Head*) = nullptr;
    Head* root_ = nullptr;
};

}  // namespace tactus
