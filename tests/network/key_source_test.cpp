// The key comes from a file that nobody else may read, or from the environment.
#include "network/key_source.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace tactus {
namespace {

class KeyFile : public ::testing::Test {
protected:
    KeyFile() { unsetenv(key_variable); }
    ~KeyFile() override {
        unsetenv(key_variable);
        std::filesystem::remove(path);
    }
    void write(const std::string& text, mode_t mode = 0600) {
        std::ofstream(path) << text;
        chmod(path.c_str(), mode);
    }
    const std::string path = ::testing::TempDir() + "tactus_key_test";
};

TEST_F(KeyFile, IsReadWhereItIsNamed) {
    write("correct horse battery\n");
    const KeySource key = read_key(path);
    EXPECT_EQ(key.error, "");
    EXPECT_EQ(key.text, "correct horse battery\n");
}

TEST_F(KeyFile, WhatIsWrongIsSaid) {
    EXPECT_NE(read_key(path).error.find("cannot be read"), std::string::npos);
    EXPECT_NE(read_key(::testing::TempDir()).error.find("no ordinary file"), std::string::npos);
    write("short");
    EXPECT_NE(read_key(path).error.find("holds no key"), std::string::npos);
    write("correct horse battery", 0644);
    EXPECT_NE(read_key(path).error.find("chmod 600"), std::string::npos);
    write(std::string(5000, 'a'));
    EXPECT_NE(read_key(path).error.find("longer"), std::string::npos);
    for (const char* bad : {"short", "correct"}) {
        write(bad);
        EXPECT_EQ(read_key(path).text, "");
    }
}

TEST_F(KeyFile, TheEnvironmentIsAskedOnlyWhereNoFileIsNamed) {
    EXPECT_EQ(read_key("").text, "");
    EXPECT_EQ(read_key("").error, "");
    setenv(key_variable, "from the environment", 1);
    EXPECT_EQ(read_key("").text, "from the environment");
    write("correct horse battery");
    EXPECT_EQ(read_key(path).text, "correct horse battery");
    setenv(key_variable, "short", 1);
    EXPECT_NE(read_key("").error.find(key_variable), std::string::npos);
}

}  // namespace
}  // namespace tactus
