// The key comes from a file that nobody else may read, or from the environment.
#include "network/key_source.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/file_access.hpp"
#include "support/process.hpp"

namespace tactus::key_source_test {
namespace {

class KeyFile : public ::testing::Test {
protected:
    KeyFile() { testing::set_environment(key_variable, nullptr); }
    ~KeyFile() override {
        testing::set_environment(key_variable, nullptr);
        std::filesystem::remove(path);
    }
    void write(const std::string& text, bool open_to_others = false) {
        std::ofstream(path, std::ios::binary) << text;
        EXPECT_TRUE(testing::set_access(path, open_to_others));
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
    write("correct horse battery", true);
    EXPECT_NE(read_key(path).error.find("is open to others on this machine: "), std::string::npos);
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
    testing::set_environment(key_variable, "from the environment");
    EXPECT_EQ(read_key("").text, "from the environment");
    write("correct horse battery");
    EXPECT_EQ(read_key(path).text, "correct horse battery");
    testing::set_environment(key_variable, "short");
    EXPECT_NE(read_key("").error.find(key_variable), std::string::npos);
}

}  // namespace
}  // namespace tactus::key_source_test
