// The folder that OpenNI2 is loaded from.
#pragma once

#include <filesystem>
#include <string>

namespace tactus {

// Where the system keeps libOpenNI2 itself; empty: nowhere. Makers' packages name their own in
// OPENNI2_REDIST64 or OPENNI2_REDIST.
std::filesystem::path find_openni();

// Links to the library and to the drivers beside it, in a folder of this user alone that is there while
// OpenNI2 starts. Its name is the same in the whole program: a library that was loaded once looks there
// again.
class Stage {
public:
    // Throws std::filesystem::filesystem_error. One at a time.
    Stage(const std::filesystem::path& library, const std::filesystem::path& own_driver);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    std::filesystem::path library() const;

private:
    static const std::filesystem::path& name();

    std::filesystem::path folder_;
};

}  // namespace tactus
