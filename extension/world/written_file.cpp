#include "world/written_file.hpp"

#include <filesystem>
#include <set>

namespace tactus {

namespace {

std::set<std::string>& files_being_written() {
    static std::set<std::string> files;
    return files;
}

// The same for the same file, however its path is written.
std::string name_of_file(const std::string& path) {
    std::error_code ignored;
    const std::u8string given(path.begin(), path.end());
    const std::filesystem::path whole = std::filesystem::weakly_canonical(given, ignored);
    const std::u8string name = ignored ? given : whole.u8string();
    return {name.begin(), name.end()};
}

}  // namespace

std::string WrittenFile::open(const std::string& path) {
    close();
    make_folder_of(path);
    if (!files_being_written().insert(name_of_file(path)).second) {
        return "'" + path + "' is being written by another recording: choose another path";
    }
    file_.reset(open_file(path, "wb"));
    if (file_ == nullptr) {
        files_being_written().erase(name_of_file(path));
        return "'" + path + "' cannot be written: choose a folder that exists and may be written to";
    }
    path_ = path;
    return "";
}

std::string WrittenFile::close() {
    if (file_ == nullptr) {
        return "";
    }
    files_being_written().erase(name_of_file(path_));
    return std::fclose(file_.release()) == 0 ? "" : cut_short();
}

std::string WrittenFile::cut_short() const {
    return "'" + path_ + "' could not be written to its end: is the disk full?";
}

bool is_same_file(const std::string& path, const std::string& other) {
    return name_of_file(path) == name_of_file(other);
}

}  // namespace tactus
