// The encoded form of an ObjectDescription: docs/wire_format.md, "Description of an object".
#include <sodium.h>

#include <bit>
#include <limits>
#include <string_view>

#include "network/messages.hpp"
#include "network/wire_stream.hpp"

namespace tactus {
namespace {

constexpr double no_limit = 1e12;         // above every stiffness, mass and friction there is
constexpr std::size_t max_shapes = 4096;  // of one body
constexpr std::size_t least_bytes_per_shape = 57;
constexpr std::size_t bytes_per_corner = 24;
constexpr std::size_t bytes_per_triangle = 12;

void positive(auto& s, auto& value) {
    s.real(value, std::numeric_limits<double>::min(), no_limit);
}
void not_negative(auto& s, auto& value) {
    s.real(value, 0.0, no_limit);
}

// No byte is missing or left over (the shortest form, the range of Unicode and surrogates are not asked for).
bool is_utf8(std::string_view text) {
    int follow = 0;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool continues = (byte & 0xc0u) == 0x80u;
        if (continues != (follow > 0) || byte >= 0xf8u || byte == 0) {
            return false;
        }
        follow = continues ? follow - 1 : std::countl_one(byte) - (byte >= 0x80u ? 1 : 0);
    }
    return follow == 0;
}

template <typename Stream>
void texts(Stream& s, auto& text) {
    auto size = static_cast<std::uint16_t>(text.size());
    s.require(text.size() <= max_name_bytes);
    s.integer(size);
    s.require(size <= max_name_bytes);
    if constexpr (Stream::reads) {
        const std::span<const std::byte> bytes = s.bytes(s.good() ? size : 0);
        text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    } else {
        s.bytes(std::as_bytes(std::span(text)));
    }
    s.require(is_utf8(text));
}

// The number of what follows: at most `most`, and no more than the bytes that are there can hold, so that a
// damaged number cannot make the reader take gigabytes.
template <typename Stream>
std::size_t count(Stream& s, std::size_t actual, std::size_t most, [[maybe_unused]] std::size_t bytes_each) {
    s.require(actual <= most);
    auto number = static_cast<std::uint32_t>(actual);
    s.integer(number);
    s.require(number <= most);
    if constexpr (Stream::reads) {
        if (s.good() && number > s.remaining() / bytes_each) {
            s.refuse(Refusal::truncated);
        }
    }
    return s.good() ? number : 0;
}

// Reading: makes room for `size` elements. Writing: they are there.
template <typename Stream>
void make_room([[maybe_unused]] auto& list, [[maybe_unused]] std::size_t size) {
    if constexpr (Stream::reads) {
        list.resize(size);
    }
}

template <typename Stream>
void mesh_fields(Stream& s, auto& mesh) {
    const std::size_t corners = count(s, mesh.vertices.size(), max_description_bytes, bytes_per_corner);
    make_room<Stream>(mesh.vertices, corners);
    for (auto& corner : mesh.vertices) {
        s.vector(corner);
    }
    const std::size_t triangles = count(s, mesh.triangles.size(), max_description_bytes, bytes_per_triangle);
    make_room<Stream>(mesh.triangles, triangles);
    for (auto& triangle : mesh.triangles) {
        for (auto& index : triangle) {
            s.integer(index);
            s.require(index < corners);
        }
    }
}

// A value that is shared and never altered: read into a new one, written from where it is.
template <typename Stream, typename Value, typename Pass>
void shared(Stream& s, Value& pointer, Pass&& pass) {
    if constexpr (Stream::reads) {
        auto fresh = std::make_shared<std::remove_const_t<typename Value::element_type>>();
        pass(s, *fresh);
        pointer = std::move(fresh);
    } else {
        s.require(pointer != nullptr);
        if (s.good()) {
            pass(s, *pointer);
        }
    }
}

template <typename Stream>
void height_list(Stream& s, auto& heights, std::size_t size, float least, float most) {
    if constexpr (Stream::reads) {
        if (s.good() && size > s.remaining() / sizeof(float)) {
            s.refuse(Refusal::truncated);
        }
        heights.resize(s.good() ? size : 0);
    } else {
        s.require(heights.size() == size);
    }
    for (auto& height : heights) {
        s.real(height, least, most);
    }
}

template <typename Stream>
std::size_t grid_size(Stream& s, auto& columns, auto& rows, std::uint32_t least) {
    s.integer(columns);
    s.integer(rows);
    const std::uint64_t size = std::uint64_t{columns} * rows;
    s.require(columns >= least && rows >= least && size <= max_description_bytes);
    return s.good() ? static_cast<std::size_t>(size) : 0;
}

void shape_fields(auto& s, auto& shape, const SphereShape&) {
    positive(s, shape.radius);
}
void shape_fields(auto& s, auto& shape, const BoxShape&) {
    s.vector(shape.half_extents, std::numeric_limits<double>::min());
}
void shape_fields(auto& s, auto& shape, const CapsuleShape&) {
    positive(s, shape.radius);
    not_negative(s, shape.half_segment);
}
void shape_fields(auto& s, auto& shape, const CylinderShape&) {
    positive(s, shape.radius);
    positive(s, shape.half_height);
}
void shape_fields(auto& s, auto& shape, const PlaneShape&) {
    s.vector(shape.normal, -1.0 - quaternion_tolerance, 1.0 + quaternion_tolerance);
    s.require(std::abs(glm::length(shape.normal) - 1.0) < quaternion_tolerance);
    s.real(shape.offset, -max_wire_length, max_wire_length);
}
void shape_fields(auto& s, auto& shape, const ConvexHullShape&) {
    shared(s, shape.hull, [](auto& stream, auto& mesh) { mesh_fields(stream, mesh); });
}
void shape_fields(auto& s, auto& shape, const MeshShape&) {
    s.real(shape.smooth_below, 0.0, 3.2);
    s.flag(shape.one_sided);
    shared(s, shape.mesh, [](auto& stream, auto& mesh) { mesh_fields(stream, mesh); });
}
void shape_fields(auto& s, auto& shape, const HeightFieldShape&) {
    const std::size_t size = grid_size(s, shape.columns, shape.rows, 2);
    s.vector(shape.scale);
    constexpr auto most = static_cast<float>(max_wire_length);
    shared(s, shape.heights, [size](auto& stream, auto& heights) {
        height_list(stream, heights, size, -hole_height, hole_height);
        for (const float height : heights) {
            stream.require(height == hole_height || std::abs(height) <= most);
        }
    });
}

template <std::size_t... Kinds>
void read_shape(WireReader& s, std::uint8_t kind, Shape& shape, std::index_sequence<Kinds...>) {
    const bool known = ((kind == Kinds && (shape.emplace<Kinds>(), true)) || ...);
    s.require(known);
}

template <typename Stream>
void placed_shape(Stream& s, auto& placed) {
    auto kind = static_cast<std::uint8_t>(placed.shape.index());
    s.integer(kind);
    if constexpr (Stream::reads) {
        read_shape(s, kind, placed.shape, std::make_index_sequence<std::variant_size_v<Shape>>());
    }
    s.pose(placed.pose);
    if (s.good()) {
        std::visit([&s](auto& shape) { shape_fields(s, shape, shape); }, placed.shape);
    }
}

template <typename Stream>
void shape_list(Stream& s, auto& shapes) {
    make_room<Stream>(shapes, count(s, shapes.size(), max_shapes, least_bytes_per_shape));
    for (auto& shape : shapes) {
        if (s.good()) {
            placed_shape(s, shape);
        }
    }
}

template <typename Stream>
void optional_vector(Stream& s, auto& value, double least) {
    bool present = value.has_value();
    s.flag(present);
    if constexpr (Stream::reads) {
        if (present && s.good()) {
            value.emplace(0.0);
        }
    }
    if (value) {
        s.vector(*value, least);
    }
}

template <typename Stream>
void body_fields(Stream& s, auto& body) {
    s.choice(body.motion, Motion::Dynamic);
    s.flag(body.may_move);
    s.vector(body.pose.position, -plausible::max_position, plausible::max_position);
    s.rotation(body.pose.rotation);
    s.vector(body.linear_velocity, -plausible::max_speed, plausible::max_speed);
    s.vector(body.angular_velocity, -plausible::max_angular_speed, plausible::max_angular_speed);
    not_negative(s, body.mass);
    s.require(body.mass > 0.0 || body.motion == Motion::Static);
    optional_vector(s, body.center_of_mass, -max_wire_length);
    optional_vector(s, body.inertia, std::numeric_limits<double>::min());
    not_negative(s, body.material.friction);
    s.real(body.material.restitution, 0.0, 1.0);
    s.flag(body.material.rough);
    s.flag(body.material.absorbent);
    not_negative(s, body.linear_damping);
    not_negative(s, body.angular_damping);
    s.real(body.gravity_scale, -no_limit, no_limit);
    s.integer(body.collision.layer);
    s.integer(body.collision.mask);
    s.flag(body.continuous);
    s.flag(body.can_sleep);
    for (auto& locked : body.lock_linear) {
        s.flag(locked);
    }
    for (auto& locked : body.lock_angular) {
        s.flag(locked);
    }
    shape_list(s, body.shapes);
    s.require(!body.shapes.empty());
}

void touch_fields(auto& s, auto& touch) {
    not_negative(s, touch.stiffness);
    not_negative(s, touch.damping);
    not_negative(s, touch.static_friction);
    not_negative(s, touch.dynamic_friction);
    s.flag(touch.by_uv);
    positive(s, touch.texture_size);
    not_negative(s, touch.texture_depth);
    not_negative(s, touch.magnet_force);
    positive(s, touch.magnet_range);
    not_negative(s, touch.viscosity);
    not_negative(s, touch.stick_slip_stiffness);
    not_negative(s, touch.stick_slip_force);
    not_negative(s, touch.vibration_force);
    not_negative(s, touch.vibration_frequency);
    not_negative(s, touch.pop_through_force);
    not_negative(s, touch.impact_strength);
    not_negative(s, touch.impact_frequency);
    positive(s, touch.impact_decay);
    not_negative(s, touch.stribeck_speed);
    positive(s, touch.stiffening);
    positive(s, touch.stiffening_depth);
}

template <typename Stream>
void image_fields(Stream& s, auto& pointer) {
    bool present = pointer != nullptr;
    s.flag(present);
    if (!s.good() || !present) {
        return;
    }
    shared(s, pointer, [](auto& stream, auto& image) {
        const std::size_t size = grid_size(stream, image.columns, image.rows, 1);
        height_list(stream, image.values, size, 0.0f, 1.0f);
    });
}

// What surfaces of a mesh have of their own is not told: it is felt as the body is.
template <typename Stream>
void detail_fields(Stream& s, auto& detail) {
    TouchImages images;
    if (detail != nullptr) {
        images = detail->images;
    }
    image_fields(s, images.heights);
    image_fields(s, images.friction);
    if constexpr (Stream::reads) {
        if (images.heights || images.friction) {
            detail = std::make_shared<const TouchDetail>(TouchDetail{std::move(images), {}});
        }
    }
}

template <typename Stream>
void description_fields(Stream& s, auto& description) {
    s.integer(description.object);
    s.require(description.object < first_joint);
    texts(s, description.name);
    touch_fields(s, description.touch);
    detail_fields(s, description.detail);
    body_fields(s, description.body);
    shape_list(s, description.touch_shapes);
}

}  // namespace

std::vector<std::byte> encode_description(const ObjectDescription& description) {
    WireWriter measure = WireWriter::measuring(max_description_bytes);
    description_fields(measure, description);
    if (!measure.good()) {
        return {};
    }
    std::vector<std::byte> bytes(measure.written());
    WireWriter writer(bytes);
    description_fields(writer, description);
    return bytes;
}

Refusal decode_description(std::span<const std::byte> bytes, ObjectDescription& description) {
    if (bytes.size() > max_description_bytes) {
        return Refusal::oversized;
    }
    description = {};
    WireReader reader(bytes);
    description_fields(reader, description);
    if (reader.good() && reader.remaining() != 0) {
        return Refusal::oversized;
    }
    description.touch.detail = description.detail.get();
    return reader.refusal();
}

ContentHash content_hash(std::span<const std::byte> bytes) {
    static_assert(sizeof(ContentHash) >= crypto_generichash_BYTES_MIN);
    ContentHash hash;
    crypto_generichash(hash.data(), hash.size(), reinterpret_cast<const unsigned char*>(bytes.data()),
                       bytes.size(), nullptr, 0);
    return hash;
}

}  // namespace tactus
