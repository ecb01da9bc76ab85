#include "session/touch_events.hpp"

#include <algorithm>

namespace tactus {

ImpactWatch::Known* ImpactWatch::known(std::uint32_t body) {
    const auto end = known_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto found = std::find_if(known_.begin(), end, [=](const Known& k) { return k.body == body; });
    return found != end ? &*found : nullptr;
}

void ImpactWatch::tick(std::span<const ImpactContact> contacts, double seconds, TouchEvents& events) {
    for (Known& one : known_) {
        one.is_touched = false;
    }
    for (const ImpactContact& contact : contacts) {
        Known* one = known(contact.body);
        if (one == nullptr && count_ < most) {
            one = &known_[count_++];
            *one = {contact.body, std::max(0.0, contact.approach)};
        }
        if (one != nullptr) {
            one->impulse += std::max(0.0, contact.force) * seconds;
            one->is_touched = true;
        }
    }
    for (std::size_t i = 0; i < count_;) {
        Known& one = known_[i];
        one.seconds += seconds;
        // Half a tick more or less is rounding of a sum.
        const bool is_over = !one.is_touched || one.seconds > impact_window - 0.5 * seconds;
        if (is_over && !one.is_told) {
            events.add({TouchEvent::Kind::impact, one.body, one.speed, one.impulse, 0.0});
            one.is_told = true;
        }
        if (one.is_touched) {
            ++i;
        } else {
            one = known_[--count_];
        }
    }
}

void BreakWatch::tick(std::span<const Broken> broken, TouchEvents& events) {
    const auto has = [](std::span<const Broken> list, std::uint32_t body) {
        return std::ranges::find(list, body, &Broken::body) != list.end();
    };
    const std::span<const Broken> known = std::span(known_).first(count_);
    for (const Broken& one : known) {
        if (!has(broken, one.body)) {
            events.add({TouchEvent::Kind::left, one.body});
        }
    }
    for (const Broken& one : broken) {
        if (!has(known, one.body)) {
            events.add({TouchEvent::Kind::broken, one.body, 0.0, 0.0, one.force});
        }
    }
    count_ = std::min(broken.size(), most);
    std::copy_n(broken.begin(), count_, known_.begin());
}

}  // namespace tactus
