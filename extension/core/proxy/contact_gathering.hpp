// Contacts as a search finds them, up to a hundred at once, and how far from the centre it has to look. Their
// gaps stand side by side as well: which are as far as another one, and which is the farthest, is told
// without going through the list.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "core/haptics/contact.hpp"
#include "core/math/lanes.hpp"
#include "core/proxy/tolerances.hpp"

namespace tactus {

class ContactGathering {
public:
    // Into a list that is empty: what is within reach of rest, or of the nearest surface where that is up to
    // `beyond` above rest, and the few nearest of what is up to `ahead` farther (unit: meters).
    ContactGathering(ContactList& list, double rest, const Tolerances& tolerances, double beyond,
                     double ahead)
        : list_(list),
          rest_(rest),
          reach_(tolerances.reach),
          same_(tolerances.same),
          ahead_(ahead),
          within_(rest + tolerances.reach + beyond),
          limit_(within_ + ahead) {
        nearest_ahead_.fill(std::numeric_limits<double>::infinity());
    }

    const ContactList& list() const { return list_; }
    bool is_full() const { return list_.is_full(); }
    // What is farther from the centre does not count (unit: meters). A search sees it fall as it goes.
    const double& limit() const { return limit_; }
    // A surface is as near to the centre as that (unit: meters).
    void heed(double distance) {
        within_ = std::min(within_, std::max(rest_, distance) + reach_);
        limit_ = std::min(limit_, within_ + ahead_);
    }
    // Only those up to this one stay: the others will be found again.
    void shorten(int count) {
        for (int i = count; i < list_.count; ++i) {
            set_gap(i, std::numeric_limits<double>::infinity());
        }
        list_.count = count;
        nearest_ahead_.fill(std::numeric_limits<double>::infinity());
    }
    // Where there is no room the farthest goes. Sweeps still see it, and name it if it stops them. Once the
    // list is full, only what is nearer by more than rounding is let in: each time it is looked through.
    void add(const Contact& contact) {
        if (!is_full()) {
            if (list_.count % lane_count == 0) {
                gaps_[block_of(list_.count)] = splat(std::numeric_limits<double>::infinity());
            }
            put(list_.count++, contact);
        } else if (contact.gap < max_gap()) {
            put(farthest(), contact);
        }
        if (rest_ + contact.gap > within_ && contact.state != ContactState::covered) {
            add_ahead(rest_ + contact.gap);
        }
        if (is_full()) {
            limit_ = std::min(limit_, rest_ + max_gap() - same_);
        }
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
    static constexpr std::size_t few = 4;

    // Of a list that is full: no contact with a larger gap finds room (unit: meters).
    double max_gap() const {
        Lanes least = -gaps_[0];
        for (const Lanes& gaps : gaps_) {
            least = lanes_min(least, -gaps);
        }
        return -smallest(least);
    }
    void add_ahead(double distance) {
        nearest_ahead_.back() = std::min(nearest_ahead_.back(), distance);
        std::ranges::sort(nearest_ahead_);
        limit_ = std::min(limit_, std::max(within_, nearest_ahead_.back()));
    }
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
    double rest_;
    double reach_;
    double same_;
    double ahead_;
    double within_;
    double limit_;
    std::array<double, few> nearest_ahead_;  // from the centre, in order; infinite where there are fewer
    std::array<Lanes, ContactList::capacity / lane_count>
        gaps_;  // infinite beyond the list, in a block begun
};

}  // namespace tactus
