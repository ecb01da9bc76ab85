// What a side's hands are, as the other side has to know (network/terms.hpp).
#pragma once

#include "network/terms.hpp"
#include "session/session_loop.hpp"
#include "session/tool_slot.hpp"

namespace tactus {

static_assert(Terms::max_hands == max_proxies + max_tools);

inline HandTerms hand_terms(const SessionLoop::ProxySlot& slot) {
    return slot.present() ? HandTerms{HandTerms::Kind::fingertip, slot.description.settings.radius, 0}
                          : HandTerms{};
}
// Null: there is none.
inline HandTerms hand_terms(const ToolSlot* slot) {
    return slot != nullptr && slot->use.enabled ? HandTerms{HandTerms::Kind::tool, 0.0, slot->shape_number}
                                                : HandTerms{};
}
// All of them, by their handles.
inline void note_hands(SessionLoop& loop, Terms& terms) {
    for (std::size_t i = 0; i < max_proxies; ++i) {
        terms.hands[i] = hand_terms(loop.proxy(i));
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        terms.hands[first_tool + i] = hand_terms(loop.tool(i));
    }
}

}  // namespace tactus
