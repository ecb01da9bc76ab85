#include "platform/shared_library.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace tactus::shared_library_test {
namespace {

TEST(SharedLibrary, OneThatIsNotThereIsSaid) {
    std::string error;
    EXPECT_EQ(function_of_library("no_library_of_this_name", "any", error), nullptr);
    EXPECT_NE(error.find("no_library_of_this_name"), std::string::npos) << error;
}

// An engine that is too old to know any function but the one that complains.
std::string complaint;

void print_error(const char* text, const char*, const char*, std::int32_t, std::uint8_t) {
    complaint = text;
}

using AnyFunction = void (*)();

AnyFunction function_of_engine(const char* name) {
    return std::strcmp(name, "print_error") == 0 ? reinterpret_cast<AnyFunction>(&print_error) : nullptr;
}

// Loaded as the engine does it, and refused in words: all of the library's own start has run by then.
TEST(SharedLibrary, TheExtensionLoadsAndTellsAnEngineThatIsTooOld) {
    const char* const extension = std::getenv("TACTUS_EXTENSION");
    if (extension == nullptr) {
        GTEST_SKIP() << "the extension is not built for this platform: ./run addon --platform=NAME builds it";
    }
    std::string error;
    void* const found = function_of_library(extension, "tactus_library_init", error);
    ASSERT_NE(found, nullptr) << error;
    using Entry = std::uint8_t (*)(AnyFunction (*)(const char*), void*, void*);
    alignas(std::max_align_t) std::array<std::byte, 64> initialization{};
    EXPECT_EQ(reinterpret_cast<Entry>(found)(&function_of_engine, nullptr, initialization.data()), 0);
    EXPECT_EQ(complaint, "The extension needs Godot 4.4 or newer.");
}

}  // namespace
}  // namespace tactus::shared_library_test
