// Godot's 32 layers and masks in Jolt's terms.
//
// Jolt asks whether two object layers collide. An object layer here is the index of a (layer, mask) pair in a
// table, times two, plus one for bodies that can move. Pairs are shared and counted.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body_description.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseLayer.h>
#include <Jolt/Physics/Collision/ObjectLayer.h>

namespace tactus {

// Still and moving bodies live in two trees, so that what moves does not make the still ones' tree stale.
constexpr JPH::BroadPhaseLayer still_layer{0};
constexpr JPH::BroadPhaseLayer moving_layer{1};

constexpr JPH::ObjectLayer object_layer(std::size_t pair, bool can_move) {
    return static_cast<JPH::ObjectLayer>(pair * 2 + (can_move ? 1 : 0));
}

// What 16 bits of object layer leave room for; the last one means "none" to Jolt.
constexpr std::size_t most_pairs = 32767;

constexpr bool can_move(JPH::ObjectLayer layer) {
    return (layer & 1) != 0;
}

class LayerInterface final : public JPH::BroadPhaseLayerInterface {
public:
    JPH::uint GetNumBroadPhaseLayers() const override { return 2; }
    JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
        return can_move(layer) ? moving_layer : still_layer;
    }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
    const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer layer) const override {
        return layer == moving_layer ? "moving" : "still";
    }
#endif
};

class BroadPhaseFilter final : public JPH::ObjectVsBroadPhaseLayerFilter {
public:
    bool ShouldCollide(JPH::ObjectLayer layer, JPH::BroadPhaseLayer tree) const override {
        return can_move(layer) || tree == moving_layer;
    }
};

class CollisionTable final : public JPH::ObjectLayerPairFilter {
public:
    explicit CollisionTable(std::size_t max_pairs);

    // The index of this pair, for one more body; no_pair when there are too many different ones.
    static constexpr std::size_t no_pair = ~std::size_t{0};
    std::size_t take(const CollisionLayers& pair);
    void give_back(std::size_t index);

    bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
        return notices(a, b) || notices(b, a);
    }

    // Whether a body of `a` is pushed by one of `b`.
    bool notices(JPH::ObjectLayer a, JPH::ObjectLayer b) const {
        return (entries_[a >> 1].pair.mask & entries_[b >> 1].pair.layer) != 0;
    }

    // Some pair in use might push another without being pushed.
    bool any_one_sided() const { return one_sided_; }

private:
    struct Entry {
        CollisionLayers pair{0, 0};
        std::uint32_t bodies = 0;
    };

    bool find_one_sided() const;

    std::vector<Entry> entries_;
    std::size_t used_ = 0;  // entries from here on were never taken
    bool one_sided_ = false;
};

}  // namespace tactus
