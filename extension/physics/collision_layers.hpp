// Godot's 32 layers and masks in Jolt's terms.
//
// Jolt asks whether two object layers collide. An object layer here is the index of a (layer, mask) pair in a
// table, times four, plus the tree of the broad phase that the body is kept in. Pairs are shared and counted.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body_description.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseLayer.h>
#include <Jolt/Physics/Collision/ObjectLayer.h>

namespace tactus {

// Four trees, because Jolt rebuilds what surrounds a body that moves: those awake must not make the trees of
// thousands that rest, can never move, or move seldom (far_islands.hpp), stale.
enum class Tree : std::uint8_t { Still = 0, Awake = 1, Resting = 2, Slowed = 3 };
constexpr JPH::uint tree_count = 4;

constexpr JPH::BroadPhaseLayer broad_phase_layer(Tree tree) {
    return JPH::BroadPhaseLayer(static_cast<JPH::BroadPhaseLayer::Type>(tree));
}

constexpr JPH::ObjectLayer object_layer(std::size_t pair, Tree tree) {
    return static_cast<JPH::ObjectLayer>(pair * 4 + static_cast<std::size_t>(tree));
}
constexpr Tree tree_of(JPH::ObjectLayer layer) {
    return static_cast<Tree>(layer & 3);
}
constexpr std::size_t pair_of(JPH::ObjectLayer layer) {
    return layer >> 2;
}

// What 16 bits of object layer leave room for; the last one means "none" to Jolt.
constexpr std::size_t max_table_pairs = 16383;

class LayerInterface final : public JPH::BroadPhaseLayerInterface {
public:
    JPH::uint GetNumBroadPhaseLayers() const override { return tree_count; }
    JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
        return broad_phase_layer(tree_of(layer));
    }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
    const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "tree"; }
#endif
};

class BroadPhaseFilter final : public JPH::ObjectVsBroadPhaseLayerFilter {
public:
    bool ShouldCollide(JPH::ObjectLayer layer, JPH::BroadPhaseLayer tree) const override {
        return tree_of(layer) != Tree::Still || tree != broad_phase_layer(Tree::Still);
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
        return (entries_[pair_of(a)].pair.mask & entries_[pair_of(b)].pair.layer) != 0;
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
