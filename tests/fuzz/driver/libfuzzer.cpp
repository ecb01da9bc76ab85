// The door by which libFuzzer comes in.
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tactus::fuzz::play({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}
