// Values to bytes and back, every bit of them: little-endian, packed without gaps. One list of what there is
// serves both ways (wire_stream.hpp does the same for what crosses a network, with ranges).
//
// An aggregate says in `members` how many members it has. A wrong number does not compile, so nobody can add
// a member and forget it here.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

static_assert(std::endian::native == std::endian::little, "the copies below would have to turn the bytes");

// Of an aggregate.
template <typename Aggregate>
inline constexpr int members = -1;
// Of an enumeration that begins at zero: its last value.
template <typename Enum>
struct LastOf;

// Writes to anything with append(from, size).
template <typename Sink>
class ValueWriter {
public:
    static constexpr bool reads = false;
    explicit ValueWriter(Sink& sink) : sink_(sink) {}
    void bytes(const void* from, std::size_t size) { good_ = good_ && sink_.append(from, size); }
    bool good() const { return good_; }

private:
    Sink& sink_;
    bool good_ = true;
};

class ValueReader {
public:
    static constexpr bool reads = true;
    explicit ValueReader(std::span<const std::byte> from) : from_(from) {}
    void bytes(void* into, std::size_t size) {
        good_ = good_ && size <= from_.size();
        if (good_ && size > 0) {
            std::memcpy(into, from_.data(), size);
            from_ = from_.subspan(size);
        }
    }
    void require(bool condition) { good_ = good_ && condition; }
    bool good() const { return good_; }
    std::size_t remaining() const { return from_.size(); }

private:
    std::span<const std::byte> from_;
    bool good_ = true;
};

// A sink that grows. Not for the haptic thread.
class ByteSink {
public:
    bool append(const void* from, std::size_t size) {
        const std::size_t before = bytes_.size();
        bytes_.resize(before + size);
        if (size > 0) {
            std::memcpy(bytes_.data() + before, from, size);
        }
        return true;
    }
    std::vector<std::byte>& bytes() { return bytes_; }

private:
    std::vector<std::byte> bytes_;
};

namespace value_stream {

// Has no bits but those of its numbers, and any of them make sense.
template <typename Value>
inline constexpr bool is_plain =
    (std::is_arithmetic_v<Value> && !std::same_as<Value, bool>) || std::same_as<Value, std::byte> ||
    std::same_as<Value, Vec3> || std::same_as<Value, Quat> || std::same_as<Value, Mat3>;
template <typename Value, std::size_t Size>
inline constexpr bool is_plain<std::array<Value, Size>> = is_plain<Value>;
static_assert(sizeof(Vec3) == 24 && sizeof(Quat) == 32 && sizeof(Mat3) == 72);

template <typename Value, template <typename...> typename Template>
inline constexpr bool is_made_of = false;
template <template <typename...> typename Template, typename... Parts>
inline constexpr bool is_made_of<Template<Parts...>, Template> = true;
template <typename Value>
inline constexpr bool is_list = std::is_array_v<Value>;
template <typename Value, std::size_t Size>
inline constexpr bool is_list<std::array<Value, Size>> = true;

template <typename Aggregate, typename Take>
void decompose(Aggregate& value, Take&& take) {
    constexpr int count = members<std::remove_const_t<Aggregate>>;
    static_assert(count >= 0, "say in `members` how many members it has");
    if constexpr (count == 0) {
        take();
    } else if constexpr (count == 1) {
        auto& [a] = value;
        take(a);
    } else if constexpr (count == 2) {
        auto& [a, b] = value;
        take(a, b);
    } else if constexpr (count == 3) {
        auto& [a, b, c] = value;
        take(a, b, c);
    } else if constexpr (count == 4) {
        auto& [a, b, c, d] = value;
        take(a, b, c, d);
    } else if constexpr (count == 5) {
        auto& [a, b, c, d, e] = value;
        take(a, b, c, d, e);
    } else if constexpr (count == 6) {
        auto& [a, b, c, d, e, f] = value;
        take(a, b, c, d, e, f);
    } else if constexpr (count == 7) {
        auto& [a, b, c, d, e, f, g] = value;
        take(a, b, c, d, e, f, g);
    } else if constexpr (count == 8) {
        auto& [a, b, c, d, e, f, g, h] = value;
        take(a, b, c, d, e, f, g, h);
    } else if constexpr (count == 9) {
        auto& [a, b, c, d, e, f, g, h, i] = value;
        take(a, b, c, d, e, f, g, h, i);
    } else if constexpr (count == 10) {
        auto& [a, b, c, d, e, f, g, h, i, j] = value;
        take(a, b, c, d, e, f, g, h, i, j);
    } else if constexpr (count == 11) {
        auto& [a, b, c, d, e, f, g, h, i, j, k] = value;
        take(a, b, c, d, e, f, g, h, i, j, k);
    } else if constexpr (count == 12) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l] = value;
        take(a, b, c, d, e, f, g, h, i, j, k, l);
    } else if constexpr (count == 18) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r] = value;
        take(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r);
    } else if constexpr (count == 22) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v] = value;
        take(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v);
    } else if constexpr (count == 23) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w] = value;
        take(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w);
    } else if constexpr (count == 19) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s] = value;
        take(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s);
    } else if constexpr (count == 20) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t] = value;
        take(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t);
    } else if constexpr (count == 28) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z, aa, bb] = value;
        take(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z, aa, bb);
    } else {
        static_assert(count < 0, "write a case for so many members");
    }
}

template <typename Stream, typename Value>
void pass_flag(Stream& s, Value& value) {
    auto byte = static_cast<std::uint8_t>(value);
    s.bytes(&byte, sizeof byte);
    if constexpr (Stream::reads) {
        s.require(byte <= 1);
        value = byte == 1;
    }
}

template <typename Stream, typename Value>
void pass_choice(Stream& s, Value& value) {
    using Enum = std::remove_const_t<Value>;
    auto number = static_cast<std::uint8_t>(value);
    s.bytes(&number, sizeof number);
    if constexpr (Stream::reads) {
        s.require(number <= static_cast<std::uint8_t>(LastOf<Enum>::value));
        value = s.good() ? static_cast<Enum>(number) : Enum{};
    }
}

// A damaged number of elements takes no more memory than bytes are there for.
template <typename Stream, typename Value>
void pass_vector(Stream& s, Value& list) {
    using Element = typename std::remove_const_t<Value>::value_type;
    auto count = static_cast<std::uint32_t>(list.size());
    s.bytes(&count, sizeof count);
    if constexpr (is_plain<Element>) {
        if constexpr (Stream::reads) {
            s.require(count <= s.remaining() / sizeof(Element));
            list.resize(s.good() ? count : 0);
        }
        s.bytes(list.data(), list.size() * sizeof(Element));
    } else if constexpr (Stream::reads) {
        list.clear();
        for (std::uint32_t i = 0; i < count && s.good() && s.remaining() > 0; ++i) {
            pass(s, list.emplace_back());
        }
        s.require(list.size() == count);
    } else {
        for (auto& element : list) {
            pass(s, element);
        }
    }
}

// Of an optional, or of a pointer to what is shared and never altered.
template <typename Stream, typename Value>
void pass_if_there(Stream& s, Value& value) {
    bool is_there = static_cast<bool>(value);
    pass_flag(s, is_there);
    if constexpr (Stream::reads) {
        if constexpr (is_made_of<Value, std::optional>) {
            typename Value::value_type fresh{};
            if (is_there) {
                pass(s, fresh);
                value = fresh;
            }
        } else if (is_there) {
            auto fresh = std::make_shared<std::remove_const_t<typename Value::element_type>>();
            pass(s, *fresh);
            value = std::move(fresh);
        }
    } else if (is_there) {
        pass(s, *value);
    }
}

template <typename Variant, std::size_t... Kinds>
bool begin_kind(Variant& value, std::size_t kind, std::index_sequence<Kinds...>) {
    return ((kind == Kinds && (value.template emplace<Kinds>(), true)) || ...);
}

template <typename Stream, typename Value>
void pass_variant(Stream& s, Value& value) {
    using Variant = std::remove_const_t<Value>;
    auto kind = static_cast<std::uint8_t>(value.index());
    s.bytes(&kind, sizeof kind);
    if constexpr (Stream::reads) {
        s.require(begin_kind(value, kind, std::make_index_sequence<std::variant_size_v<Variant>>()));
    }
    if (s.good()) {
        std::visit([&s](auto& held) { pass(s, held); }, value);
    }
}

}  // namespace value_stream

template <typename Stream, typename Value>
void pass(Stream& s, Value& value) {
    using namespace value_stream;
    using Plain = std::remove_const_t<Value>;
    if constexpr (is_plain<Plain>) {
        s.bytes(&value, sizeof value);
    } else if constexpr (std::same_as<Plain, bool>) {
        pass_flag(s, value);
    } else if constexpr (std::is_pointer_v<Plain>) {
        // What it points to belongs to something else and comes with that.
        if constexpr (Stream::reads) {
            value = nullptr;
        }
    } else if constexpr (std::is_enum_v<Plain>) {
        pass_choice(s, value);
    } else if constexpr (is_made_of<Plain, std::vector>) {
        pass_vector(s, value);
    } else if constexpr (is_made_of<Plain, std::optional> || is_made_of<Plain, std::shared_ptr>) {
        pass_if_there(s, value);
    } else if constexpr (is_made_of<Plain, std::variant>) {
        pass_variant(s, value);
    } else if constexpr (is_list<Plain>) {
        for (auto& element : value) {
            pass(s, element);
        }
    } else {
        decompose(value, [&s](auto&... parts) { (pass(s, parts), ...); });
    }
}

}  // namespace tactus
