// Every test of this program runs below umockdev.
#include <gtest/gtest.h>

#include <cstdio>

#include "played/played_usb.hpp"

int main(int count, char** arguments) {
    if (!tactus::shared::run_below_umockdev(arguments)) {
        std::fputs("umockdev's library cannot be loaded: install libumockdev0\n", stderr);
        return 1;
    }
    testing::InitGoogleTest(&count, arguments);
    return RUN_ALL_TESTS();
}
