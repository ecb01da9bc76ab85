// A second pointer that is carried along with an object when a correction moves it (thesis 3.1.4): the object
// is right at once, the force stays nearly what it was, and the way that the pointers were carried by fades.
#pragma once

#include "session/resimulator.hpp"
#include "session/session_loop.hpp"

namespace tactus {

class CarriedPointer {
public:
    void take_room(std::size_t max_parts) {
        slot_.proxy = std::make_unique<Proxy>(max_parts, ProxySettings{});
    }
    bool has_room() const { return slot_.proxy != nullptr; }

    // The one that is felt, apart from the one that presses.
    bool apart() const { return apart_; }
    const Vec3& offset() const { return offset_; }  // between the two hands (unit: meters)
    const SessionLoop::ProxySlot& slot() const { return slot_; }
    SessionLoop::ProxySlot& slot() { return slot_; }

    // `motion` takes the object to where it is put now. With `turns` the pointers turn with it, else they
    // only go its way. True where the pointer rests on it. Before the object is put there.
    bool carry(SessionLoop& loop, const SessionLoop::ProxySlot& pressing, const Resimulator::Target& target,
               const Pose& motion, bool turns, double longest);

    // One tick; the force is in slot().
    void touch(SessionLoop& loop, const SessionLoop::ProxySlot& pressing, Nanoseconds now);

    // The offset gets shorter by `way` (unit: meters). At zero the pointers are one again.
    void fade(double way);
    void forget();

private:
    SessionLoop::ProxySlot slot_;
    Vec3 offset_{0.0};
    bool apart_ = false;
};

}  // namespace tactus
