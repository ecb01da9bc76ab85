#pragma once

#include <cstdint>

namespace godot {

// The number of a living or dead object: never used twice while the program runs.
class ObjectID {
public:
    ObjectID() = default;
    explicit ObjectID(uint64_t id) : id_(id) {}
    explicit ObjectID(int64_t id) : id_(static_cast<uint64_t>(id)) {}

    bool is_valid() const { return id_ != 0; }
    bool is_null() const { return id_ == 0; }
    bool is_ref_counted() const { return (id_ >> 63) != 0; }
    operator uint64_t() const { return id_; }
    operator int64_t() const { return static_cast<int64_t>(id_); }

    bool operator==(const ObjectID& other) const { return id_ == other.id_; }
    bool operator!=(const ObjectID& other) const { return id_ != other.id_; }
    bool operator<(const ObjectID& other) const { return id_ < other.id_; }

private:
    uint64_t id_ = 0;
};

}  // namespace godot
