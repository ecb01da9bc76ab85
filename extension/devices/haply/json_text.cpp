#include "devices/haply/json_text.hpp"

namespace tactus {

namespace {

enum Type : int { integer = 3, real = 4, yes = 5 };

bool is_number(int type) {
    return type == integer || type == real;
}

}  // namespace

std::string JsonReader::load() {
    if (delete_ != nullptr) {
        return {};
    }
    const bool there =
        library_.load({"libjansson.so.4", "libjansson.4.dylib", "libjansson-4.dll", "jansson.dll"},
                      "json_loadb") &&
        library_.find({
            {"json_loadb", load_text_},
            {"json_object_get", get_},
            {"json_array_get", at_},
            {"json_array_size", size_},
            {"json_number_value", number_},
            {"json_string_value", text_},
            {"json_delete", delete_},
        });
    return there ? "" : "jansson is not installed: install it (Debian: apt-get install libjansson4)";
}

JsonValue JsonReader::read(const std::string& text) {
    forget();
    root_ = load_text_(text.data(), text.size(), 0, nullptr);
    return {*this, root_};
}

// Nobody else holds the document.
void JsonReader::forget() {
    if (root_ != nullptr) {
        delete_(root_);
        root_ = nullptr;
    }
}

JsonValue JsonValue::operator[](const char* key) const {
    return {*reader_, value_ != nullptr ? reader_->get_(value_, key) : nullptr};
}
JsonValue JsonValue::operator[](std::size_t index) const {
    return {*reader_, value_ != nullptr ? reader_->at_(value_, index) : nullptr};
}
std::size_t JsonValue::size() const {
    return value_ != nullptr ? reader_->size_(value_) : 0;
}
double JsonValue::number() const {
    return has_number() ? reader_->number_(value_) : 0.0;
}
bool JsonValue::has_number() const {
    return value_ != nullptr && is_number(value_->type);
}
bool JsonValue::is_true() const {
    return value_ != nullptr && value_->type == yes;
}
std::string JsonValue::text() const {
    const char* const text = value_ != nullptr ? reader_->text_(value_) : nullptr;
    return text != nullptr ? text : "";
}

bool JsonValue::vector(Vec3& into) const {
    const JsonValue parts[] = {(*this)["x"], (*this)["y"], (*this)["z"]};
    for (int i = 0; i < 3; ++i) {
        if (!parts[i].has_number()) {
            return false;
        }
        into[i] = parts[i].number();
    }
    return true;
}

}  // namespace tactus
