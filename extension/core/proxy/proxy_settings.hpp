// How a proxy is set up, and what it reports of a tick: plain values, without what moves it.
#pragma once

#include <cstdint>

namespace tactus {

struct ProxySettings {
    double radius = 0.01;               // (unit: meters), > 0
    std::uint32_t mask = 0xffff'ffffu;  // layers it touches
    int max_steps = 64;                 // a tick; what is missing then is made up in the next
    std::int64_t max_work = 18'000;     // a tick (see WorkBudget): about 0.3 ms
};

enum ProxyStatus : std::uint32_t {
    proxy_absent = 1u << 0,      // the hand is inside a body since the start: no touch until it is out
    proxy_touching = 1u << 1,    // at least one contact holds it back
    proxy_sliding = 1u << 2,     // dynamic friction applies
    proxy_unfinished = 1u << 3,  // this tick's steps or work did not suffice: residual is not small
    proxy_squeezed = 1u << 4,    // moving bodies leave it no room
    // A body has come to stand where the proxy is, or has squeezed it: it is not touched until the proxy is
    // out of it.
    proxy_letting_out = 1u << 5,
};

}  // namespace tactus
