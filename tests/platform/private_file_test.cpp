#include "platform/private_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/file_access.hpp"

namespace tactus::private_file_test {
namespace {

class APrivateFile : public ::testing::Test {
protected:
    void write(const std::string& text, bool open_to_others = false) {
        std::ofstream(file, std::ios::binary) << text;
        ASSERT_TRUE(testing::set_access(file, open_to_others));
    }
    ~APrivateFile() override { std::filesystem::remove(file); }
    // A name that no old Windows's letters spell.
    const std::string path = ::testing::TempDir() + "tactus_\xc3\x9f\xe8\xa7\xa6";
    const std::filesystem::path file = std::u8string(path.begin(), path.end());
};

TEST_F(APrivateFile, IsRead) {
    write("some\nbytes");
    const PrivateFile read = read_private_file(path, 100);
    EXPECT_EQ(read.trouble, FileTrouble::none) << read.system_text;
    EXPECT_EQ(read.bytes, "some\nbytes");
}

TEST_F(APrivateFile, ThatOthersMayReadIsRefusedWithTheWayOut) {
    write("secret", true);
    const PrivateFile read = read_private_file(path, 100);
    EXPECT_EQ(read.trouble, FileTrouble::open_to_others);
    EXPECT_NE(read.way_out.find(path), std::string::npos);
    EXPECT_EQ(read.bytes, "");
}

TEST_F(APrivateFile, ThatIsTooLongOrNoneIsRefused) {
    write(std::string(100, 'a'));
    EXPECT_EQ(read_private_file(path, 100).trouble, FileTrouble::none);
    EXPECT_EQ(read_private_file(path, 99).trouble, FileTrouble::too_long);
    EXPECT_EQ(read_private_file(::testing::TempDir(), 100).trouble, FileTrouble::not_ordinary);
    std::filesystem::remove(file);
    const PrivateFile gone = read_private_file(path, 100);
    EXPECT_EQ(gone.trouble, FileTrouble::unreadable);
    EXPECT_NE(gone.system_text, "");
}

}  // namespace
}  // namespace tactus::private_file_test
