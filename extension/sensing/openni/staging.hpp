// The folder that OpenNI2 is loaded from.
#pragma once

#include <filesystem>
#include <string>

namespace tactus {

// Where the system keeps libOpenNI2 itself; empty: nowhere. Makers' packages name their own in
// OPENNI2_REDIST64 or OPENNI2_REDIST.
std::filesystem::path find_openni();

// Links to the library and to the drivers beside it, in a folder of this user alone that is there while
// OpenNI2 starts.
class Stage {
public:
    // `folder` is empty, and goes with this. Throws std::filesystem::filesystem_error.
    Stage(const std::filesystem::path& folder, const std::filesystem::path& library,
          const std::filesystem::path& own_driver);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    std::filesystem::path library() const;

private:
    std::filesystem::path folder_;
};

}  // namespace tactus
