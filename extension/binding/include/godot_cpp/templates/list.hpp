#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace godot {

// Just enough of the engine's list for _get_property_list().
template <class T>
class List {
public:
    void push_back(const T& value) { items_.push_back(value); }
    void push_back(T&& value) { items_.push_back(std::move(value)); }
    void clear() { items_.clear(); }
    int size() const { return static_cast<int>(items_.size()); }
    bool is_empty() const { return items_.empty(); }

    auto begin() { return items_.begin(); }
    auto end() { return items_.end(); }
    auto begin() const { return items_.begin(); }
    auto end() const { return items_.end(); }

private:
    std::vector<T> items_;
};

}  // namespace godot
