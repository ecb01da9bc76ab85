// The packs of a tree. Meshes mostly come in single precision: where every corner is exactly that, packs are
// kept so, at half the memory, and widened when they are looked at. Nothing is lost: all answers are the
// same.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "core/tree/box_node.hpp"
#include "core/tree/triangle_pack.hpp"

namespace tactus {

class PackStore {
public:
    // Room for `count` packs, in single precision or not; what was kept is gone. Where it has just that room,
    // nothing is allocated.
    void reset(std::size_t count, bool single) {
        if (count == count_ && (single ? single_ != nullptr : exact_ != nullptr)) {
            return;
        }
        count_ = count;
        exact_.reset();
        single_.reset();
        if (single) {
            single_ = std::make_unique_for_overwrite<SinglePack[]>(count);
        } else {
            exact_ = std::make_unique_for_overwrite<TrianglePack[]>(count);
        }
    }

    // As it stands there, or widened into `room`: to copy it was a fortieth of the time of late ticks.
    const TrianglePack& at(std::size_t index, TrianglePack& room) const {
        if (single_) {
            room = widened(single_[index]);
            return room;
        }
        return exact_[index];
    }
    TriangleCorners corners(std::size_t index, std::uint32_t lane) const {
        return single_ ? corners_of(single_[index], lane) : corners_of(exact_[index], lane);
    }
    void set(std::size_t index, const TrianglePack& pack) {
        if (single_) {
            single_[index] = {narrowed(pack.a), narrowed(pack.b), narrowed(pack.c)};
        } else {
            exact_[index] = pack;
        }
    }
    void fetch(std::size_t index) const {
        single_ ? fetch_early(&single_[index], sizeof(SinglePack))
                : fetch_early(&exact_[index], sizeof(TrianglePack));
    }
    std::span<const std::byte> memory() const {
        return single_ ? std::as_bytes(std::span(single_.get(), count_))
                       : std::as_bytes(std::span(exact_.get(), count_));
    }
    std::size_t bytes_each() const { return single_ ? sizeof(SinglePack) : sizeof(TrianglePack); }

private:
    using SingleLanes = float __attribute__((vector_size(16)));
    struct SingleCorner {
        SingleLanes x, y, z;
    };
    struct SinglePack {
        SingleCorner a, b, c;
    };

    static LanesVec3 widened(const SingleCorner& corner) {
        return {__builtin_convertvector(corner.x, Lanes), __builtin_convertvector(corner.y, Lanes),
                __builtin_convertvector(corner.z, Lanes)};
    }
    static TrianglePack widened(const SinglePack& pack) {
        return {widened(pack.a), widened(pack.b), widened(pack.c)};
    }
    static SingleCorner narrowed(const LanesVec3& corner) {
        return {__builtin_convertvector(corner.x, SingleLanes),
                __builtin_convertvector(corner.y, SingleLanes),
                __builtin_convertvector(corner.z, SingleLanes)};
    }

    std::size_t count_ = 0;
    std::unique_ptr<TrianglePack[]> exact_;
    std::unique_ptr<SinglePack[]> single_;
};

}  // namespace tactus
