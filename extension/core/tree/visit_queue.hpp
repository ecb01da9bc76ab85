// What a search of the triangle tree has yet to open.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus {

// A queue of nodes, least key first. What does not fit is left out, and its key remembered.
class VisitQueue {
public:
    struct Entry {
        float key;
        std::uint32_t node;
    };

    bool is_empty() const { return count_ == 0; }
    // Whether something comes before that key, and there is room to wait for it besides the nodes.
    bool can_wait(float key) const { return count_ > 0 && entries_[0].key < key && count_ < capacity / 2; }
    // False where there is no room.
    bool push(const Entry& entry) {
        if (count_ == capacity) {
            return false;
        }
        std::size_t at = count_++;
        for (; at > 0 && entry.key < entries_[(at - 1) / 2].key; at = (at - 1) / 2) {
            entries_[at] = entries_[(at - 1) / 2];
        }
        entries_[at] = entry;
        return true;
    }
    Entry pop() {
        const Entry top = entries_[0];
        const Entry last = entries_[--count_];
        std::size_t at = 0;
        for (std::size_t child = 1; child < count_; child = 2 * at + 1) {
            child += child + 1 < count_ && entries_[child + 1].key < entries_[child].key;
            if (!(entries_[child].key < last.key)) {
                break;
            }
            entries_[at] = entries_[child];
            at = child;
        }
        entries_[at] = last;
        return top;
    }

private:
    static constexpr std::size_t capacity = 1024;
    std::array<Entry, capacity> entries_;
    std::size_t count_ = 0;
};

}  // namespace tactus
