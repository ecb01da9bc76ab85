#include "platform/mapped_file.hpp"

namespace tactus {

namespace {

constexpr const char* only_on_linux = "files are mapped into memory on Linux alone";

}  // namespace

std::string MappedFile::create(const std::string&, std::size_t) {
    return only_on_linux;
}

std::string MappedFile::open(const std::string& path) {
    path_ = path;
    return only_on_linux;
}

MappedFile::~MappedFile() = default;

}  // namespace tactus
