// Every signal of these nodes leaves through here, at a moment when nothing of any of them is in use: a
// handler may free, remove, restart or change whatever it likes. Main thread only.
//
// What is posted is sent when Godot's frame has come to its end, or earlier by deliver_signals(), in the
// order of posting. What is gone by then sends nothing, and nothing is sent about nodes that are gone: what
// is to be sent about one that goes is sent while it leaves the tree, as Area3D sends body_exited.
#pragma once

#include <cstdint>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <set>
#include <vector>

namespace tactus {

// A value, or an object that may be gone by the time the signal is sent.
class SignalArgument {
public:
    template <class Value>
    SignalArgument(const Value& value) : value_(value) {}
    static SignalArgument object(std::uint64_t id) {
        SignalArgument argument{godot::Variant()};
        argument.object_ = id;
        return argument;
    }

    bool is(std::uint64_t object) const { return object_ == object; }
    bool is_gone() const { return object_ != 0 && godot::ObjectDB::get_instance(object_) == nullptr; }
    godot::Variant value() const {
        return object_ != 0 ? godot::Variant(godot::ObjectDB::get_instance(object_)) : value_;
    }

private:
    godot::Variant value_;
    std::uint64_t object_ = 0;  // 0: it is a value
};

void post_signal(const godot::Object& from, const char* name,
                 const std::vector<SignalArgument>& arguments = {});

// "contact_ended" for each body (by its node's id) that is touched no more, then "contact_started" for each
// that is touched since.
void post_touch_changes(const godot::Object& from, const std::set<std::uint64_t>& before,
                        const std::set<std::uint64_t>& now);

// At the end of what a script has called: nothing may be used after it that a handler could free.
void deliver_signals();

// Those about one object, which is about to go: nothing could be sent about it later. As deliver_signals().
void deliver_signals_of(std::uint64_t object);

// Before the engine goes.
void forget_signals();

}  // namespace tactus
