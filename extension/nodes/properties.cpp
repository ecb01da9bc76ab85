#include "nodes/properties.hpp"

#include <algorithm>
#include <cmath>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/variant/callable.hpp>
#include <mutex>
#include <unordered_set>

#include "nodes/messages.hpp"

namespace tactus {

using namespace godot;

namespace {

bool is_within(const PropertyLimits& limits, const Variant& value) {
    if (value.get_type() != Variant::INT && value.get_type() != Variant::FLOAT &&
        value.get_type() != Variant::BOOL) {
        return false;
    }
    const auto number = static_cast<double>(value);
    const bool is_whole = limits.type == Variant::FLOAT || number == std::floor(number);
    if (!(number >= limits.min && number <= limits.max) || !is_whole) {
        return false;
    }
    return limits.one_of == 0 || (limits.one_of >> static_cast<std::uint64_t>(number) & 1u) != 0;
}

// What a packed array is made of; NIL: it is no packed array.
Variant::Type element_of(Variant::Type packed) {
    switch (packed) {
        case Variant::PACKED_VECTOR3_ARRAY:
            return Variant::VECTOR3;
        case Variant::PACKED_STRING_ARRAY:
            return Variant::STRING;
        case Variant::PACKED_INT32_ARRAY:
            return Variant::INT;
        case Variant::PACKED_FLOAT32_ARRAY:
        case Variant::PACKED_FLOAT64_ARRAY:
            return Variant::FLOAT;
        default:
            return Variant::NIL;
    }
}

// Godot puts 0 in place of an element of another kind.
bool is_array_of(Variant::Type element, const Array& array) {
    for (int64_t i = 0; i < array.size(); ++i) {
        const Variant::Type type = array[i].get_type();
        if (type != element && !(element == Variant::FLOAT && type == Variant::INT)) {
            return false;
        }
    }
    return true;
}

bool is_allowed(const PropertyLimits& limits, const Variant& value) {
    switch (limits.type) {
        case Variant::BOOL:
        case Variant::INT:
        case Variant::FLOAT:
            return is_within(limits, value);
        case Variant::VECTOR3:
            return value.get_type() == Variant::VECTOR3 &&
                   static_cast<double>(static_cast<Vector3>(value).length()) <= limits.max;
        case Variant::OBJECT: {
            const Object* object = value.get_validated_object();
            return object != nullptr ? object->is_class(limits.class_name)
                                     : problem_of_object(value) == String("is null");
        }
        case Variant::STRING:
        case Variant::NODE_PATH:
            return value.get_type() == Variant::STRING || value.get_type() == Variant::STRING_NAME ||
                   value.get_type() == Variant::NODE_PATH;
        default:
            return value.get_type() == limits.type ||
                   (element_of(limits.type) != Variant::NIL && value.get_type() == Variant::ARRAY &&
                    is_array_of(element_of(limits.type), static_cast<Array>(value)));
    }
}

// use(name) for each of those that are separated by spaces.
template <class Use>
void for_each_name(std::string_view names, const Use& use) {
    while (!names.empty()) {
        const std::size_t end = std::min(names.find(' '), names.size());
        use(names.substr(0, end));
        names.remove_prefix(std::min(end + 1, names.size()));
    }
}

}  // namespace

bool accepts(const Object& who, const char* property, const PropertyLimits& limits, const Variant& value) {
    const bool allowed = is_allowed(limits, value);
    if (!allowed) {
        refuse(who, property, value, limits.wanted);
    }
    return allowed;
}

std::optional<NodePath> path_to(const Node& from, const char* property, const char* class_name,
                                const Variant& value) {
    const std::string name = std::string(property) + "_node";
    const std::string wanted = std::string("a ") + class_name + ", or null";
    if (!accepts(from, name.c_str(),
                 {.type = Variant::OBJECT, .class_name = class_name, .wanted = wanted.c_str()}, value)) {
        return std::nullopt;
    }
    Node* const to = Object::cast_to<Node>(value.get_validated_object());
    if (to == nullptr) {
        return NodePath();
    }
    const auto topmost = [](const Node* node) {
        while (node->get_parent() != nullptr) {
            node = node->get_parent();
        }
        return node;
    };
    if (topmost(&from) != topmost(to)) {
        refuse(from, name.c_str(), value,
               "in the same scene tree: add both nodes to it, or to one node, before this is set");
        return std::nullopt;
    }
    return from.get_path_to(to);
}

void follow_changes(Object& who, const char* method, const Variant& before, const Variant& now) {
    const Callable on_change(&who, method);
    if (auto* left = Object::cast_to<Resource>(before.get_validated_object());
        left != nullptr && left->is_connected("changed", on_change)) {
        left->disconnect("changed", on_change);
    }
    if (auto* taken = Object::cast_to<Resource>(now.get_validated_object())) {
        taken->connect("changed", on_change);
    }
}

void warn_of_rename(const std::string& old, const std::string& now) {
    static std::mutex lock;
    static std::unordered_set<std::string> said;
    const std::scoped_lock held(lock);
    if (said.insert(old).second) {
        UtilityFunctions::push_warning(to_godot(old), " is ", to_godot(now),
                                       " now. The old name still works: write the new one in scenes and "
                                       "scripts before it is dropped, see CHANGELOG.md.");
    }
}

void warn_of_former_name(const StringName& class_name, std::string_view was, const char* now) {
    const std::string of = from_godot(String(class_name)) + ".";
    for_each_name(was, [&](std::string_view name) {
        if (name.find('.') == std::string_view::npos) {
            warn_of_rename(of + std::string(name), of + now);
        }
    });
}

bool has_name(std::string_view names, std::string_view name) {
    bool is_there = false;
    for_each_name(names, [&](std::string_view one) { is_there = is_there || one == name; });
    return is_there;
}

}  // namespace tactus
