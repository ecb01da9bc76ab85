#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace godot {

// Characters outside the engine, ended by a zero that length() does not count.
template <class T>
class CharStringT {
public:
    CharStringT() : characters_(1) {}
    explicit CharStringT(int64_t length) : characters_(static_cast<size_t>(length) + 1) {}

    int64_t length() const { return static_cast<int64_t>(characters_.size()) - 1; }
    int64_t size() const { return static_cast<int64_t>(characters_.size()); }
    const T* get_data() const { return characters_.data(); }
    const T* ptr() const { return characters_.data(); }
    T* ptrw() { return characters_.data(); }

private:
    std::vector<T> characters_;
};

using CharString = CharStringT<char>;
using Char16String = CharStringT<char16_t>;
using Char32String = CharStringT<char32_t>;

}  // namespace godot
