#include "nodes/signals.hpp"

#include <algorithm>
#include <deque>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/callable.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>

namespace tactus {

using namespace godot;

namespace {

struct Posted {
    std::uint64_t from = 0;
    const char* name = "";
    std::vector<SignalArgument> arguments;
};

std::deque<Posted>& posted() {
    static std::deque<Posted> waiting;
    return waiting;
}

void send(const Posted& signal) {
    Object* from = ObjectDB::get_instance(signal.from);
    if (from == nullptr || std::ranges::any_of(signal.arguments, &SignalArgument::is_gone)) {
        return;
    }
    Array call;
    call.push_back(signal.name);
    for (const SignalArgument& argument : signal.arguments) {
        call.push_back(argument.value());
    }
    from->callv("emit_signal", call);
}

}  // namespace

void post_signal(const Object& from, const char* name, const std::vector<SignalArgument>& arguments) {
    if (posted().empty()) {
        callable_mp_static(&deliver_signals).call_deferred();
    }
    posted().push_back({from.get_instance_id(), name, arguments});
}

// A handler may post more, or deliver by itself: each signal is off the list before it is sent.
void post_touch_changes(const Object& from, const std::set<std::uint64_t>& before,
                        const std::set<std::uint64_t>& now) {
    const auto post_missing = [&from](const auto& in, const auto& among, const char* signal) {
        for (const std::uint64_t body : in) {
            if (!among.contains(body)) {
                post_signal(from, signal, {SignalArgument::object(body)});
            }
        }
    };
    post_missing(before, now, "contact_ended");
    post_missing(now, before, "contact_started");
}

void deliver_signals() {
    while (!posted().empty()) {
        const Posted next = std::move(posted().front());
        posted().pop_front();
        send(next);
    }
}

// In their order, and all others in theirs.
void deliver_signals_of(std::uint64_t object) {
    const auto is_of_it = [object](const Posted& signal) {
        return std::ranges::any_of(signal.arguments,
                                   [object](const SignalArgument& one) { return one.is(object); });
    };
    for (auto next = std::ranges::find_if(posted(), is_of_it); next != posted().end();
         next = std::ranges::find_if(posted(), is_of_it)) {
        const Posted signal = std::move(*next);
        posted().erase(next);
        send(signal);
    }
}

void forget_signals() {
    posted().clear();
}

}  // namespace tactus
