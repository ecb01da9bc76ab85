// Ends of a link, in the words of tests.
#pragma once

#include "network/endpoint.hpp"

namespace tactus::shared {

inline EndpointSettings endpoint(Side side, std::uint64_t epoch) {
    EndpointSettings settings;
    settings.side = side;
    settings.epoch = epoch;
    return settings;
}

}  // namespace tactus::shared
