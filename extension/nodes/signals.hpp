// Every signal of these nodes leaves through here, at a moment when nothing of any of them is in use: a
// handler may free, remove, restart or change whatever it likes. Main thread only.
//
// What is posted is sent when Godot's frame has come to its end, or earlier by deliver_signals(), in the
// order of posting. What is gone by then sends nothing, and nothing is sent about nodes that are gone.
#pragma once

#include <array>
#include <cstdint>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace tactus {

// An object that may be gone by the time the signal is sent.
struct NodeId {
    std::uint64_t id = 0;
};

struct SignalArgument {
    SignalArgument() = default;
    SignalArgument(NodeId object) : is_object(true), object_id(object.id) {}
    template <class Value>
    SignalArgument(const Value& plain) : is_value(true), value(plain) {}

    bool is_value = false;
    bool is_object = false;
    std::uint64_t object_id = 0;
    godot::Variant value;
};

constexpr std::size_t max_signal_arguments = 2;

void post_signal(const godot::Object& from, const char* name,
                 const std::array<SignalArgument, max_signal_arguments>& arguments = {});

// At the end of what a script has called: nothing may be used after it that a handler could free.
void deliver_signals();

// Before the engine goes.
void forget_signals();

}  // namespace tactus
