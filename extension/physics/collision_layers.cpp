#include "physics/collision_layers.hpp"

#include <algorithm>

namespace tactus {

CollisionTable::CollisionTable(std::size_t max_pairs) : entries_(std::min(max_pairs, max_table_pairs)) {}

std::size_t CollisionTable::take(const CollisionLayers& pair) {
    std::size_t vacant = used_;
    for (std::size_t i = 0; i < used_; ++i) {
        Entry& entry = entries_[i];
        if (entry.bodies == 0) {
            vacant = i;
        } else if (entry.pair.layer == pair.layer && entry.pair.mask == pair.mask) {
            ++entry.bodies;
            return i;
        }
    }
    if (vacant == entries_.size())
        return no_pair;
    entries_[vacant] = {pair, 1};
    if (vacant == used_)
        ++used_;
    one_sided_ = find_one_sided();
    return vacant;
}

void CollisionTable::give_back(std::size_t index) {
    --entries_[index].bodies;
}

// Pairs are few however many bodies there are, and a new one is rare.
bool CollisionTable::find_one_sided() const {
    const auto notices_entry = [](const Entry& a, const Entry& b) {
        return (a.pair.mask & b.pair.layer) != 0;
    };
    for (std::size_t i = 0; i < used_; ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (notices_entry(entries_[i], entries_[j]) != notices_entry(entries_[j], entries_[i]))
                return true;
    return false;
}

}  // namespace tactus
