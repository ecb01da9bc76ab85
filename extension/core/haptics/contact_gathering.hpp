// Contacts as a search finds them, up to a hundred at once. Their gaps stand side by side as well: which are
// as far as another one, and which is the farthest, is told without going through the list.
#pragma once

#include <array>
#include <bit>
#include <limits>

#include "core/haptics/contact.hpp"
#include "core/math/lanes.hpp"

namespace tactus {

class ContactGathering {
public:
    // Into a list that is empty.
    explicit ContactGathering(ContactList& list) : list_(list) {}

    const ContactList& list() const { return list_; }
    bool is_full() const { return list_.is_full(); }
    // Only those up to this one stay.
    void shorten(int count) {
        for (int i = count; i < list_.count; ++i) {
            set_gap(i, std::numeric_limits<double>::infinity());
        }
        list_.count = count;
    }
    // Where there is no room the farthest goes. Sweeps still see it, and name it if it stops them.
    void add(const Contact& contact) {
        if (!is_full()) {
            if (list_.count % lane_count == 0) {
                gaps_[block_of(list_.count)] = splat(std::numeric_limits<double>::infinity());
            }
            put(list_.count++, contact);
        } else if (contact.gap < max_gap()) {
            put(farthest(), contact);
        }
    }
    // Of a list that is full: no contact with a larger gap finds room (unit: meters).
    double max_gap() const {
        Lanes least = -gaps_[0];
        for (const Lanes& gaps : gaps_) {
            least = lanes_min(least, -gaps);
        }
        return -smallest(least);
    }
    // Calls visit(contact) for those whose gap differs by at most `same` (unit: meters).
    template <class Visit>
    void visit_as_far(double gap, double same, Visit&& visit) const {
        for (int first = 0; first < list_.count; first += lane_count) {
            const Lanes apart = gaps_[block_of(first)] - splat(gap);
            for (unsigned bits = lane_bits((apart <= splat(same)) & (apart >= splat(-same))); bits != 0;
                 bits &= bits - 1) {
                visit(list_[first + std::countr_zero(bits)]);
            }
        }
    }

private:
    static constexpr std::size_t block_of(int index) { return static_cast<std::size_t>(index / lane_count); }
    void set_gap(int index, double gap) { gaps_[block_of(index)][index % lane_count] = gap; }
    void put(int index, const Contact& contact) {
        list_[index] = contact;
        set_gap(index, contact.gap);
    }
    int farthest() const {
        const Lanes wanted = splat(max_gap());
        int first = 0;
        while (!any(gaps_[block_of(first)] == wanted)) {
            first += lane_count;
        }
        return first + std::countr_zero(lane_bits(gaps_[block_of(first)] == wanted));
    }

    ContactList& list_;
    std::array<Lanes, ContactList::capacity / lane_count>
        gaps_;  // infinite beyond the list, in a block begun
};

}  // namespace tactus
