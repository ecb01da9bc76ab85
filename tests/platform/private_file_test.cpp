#include "platform/private_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/file_access.hpp"

namespace tactus {
namespace {

class APrivateFile : public ::testing::Test {
protected:
    void write(const std::string& text, bool open_to_others = false) {
        std::ofstream(path, std::ios::binary) << text;
        ASSERT_TRUE(testing::set_access(path, open_to_others));
    }
    ~APrivateFile() override { std::filesystem::remove(path); }
    const std::filesystem::path path =
        std::filesystem::path(::testing::TempDir()) / u8"tactus_geheimnis_\u00df";
};

TEST_F(APrivateFile, IsRead) {
    write("some\nbytes");
    const PrivateFile file = read_private_file(path, 100);
    EXPECT_EQ(file.trouble, FileTrouble::none) << file.system_text;
    EXPECT_EQ(file.bytes, "some\nbytes");
}

TEST_F(APrivateFile, ThatOthersMayReadIsRefusedWithTheWayOut) {
    write("secret", true);
    const PrivateFile file = read_private_file(path, 100);
    EXPECT_EQ(file.trouble, FileTrouble::open_to_others);
    EXPECT_NE(file.way_out.find(path.string()), std::string::npos);
    EXPECT_EQ(file.bytes, "");
}

TEST_F(APrivateFile, ThatIsTooLongOrNoneIsRefused) {
    write(std::string(100, 'a'));
    EXPECT_EQ(read_private_file(path, 100).trouble, FileTrouble::none);
    EXPECT_EQ(read_private_file(path, 99).trouble, FileTrouble::too_long);
    EXPECT_EQ(read_private_file(::testing::TempDir(), 100).trouble, FileTrouble::not_ordinary);
    std::filesystem::remove(path);
    const PrivateFile gone = read_private_file(path, 100);
    EXPECT_EQ(gone.trouble, FileTrouble::unreadable);
    EXPECT_NE(gone.system_text, "");
}

}  // namespace
}  // namespace tactus
