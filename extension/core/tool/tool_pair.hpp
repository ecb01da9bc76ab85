// Two tools that may meet: the spheres of the one against the mesh of the other, in the other's frame. There
// the mesh stands still, and everything that a tool knows of bodies at rest holds for it
// (tool_surroundings.hpp); what is left is that the spheres' ways bend where both turn.
#pragma once

#include <cstdint>
#include <memory>

#include "core/haptics/touch_scene.hpp"
#include "core/tool/tool_surroundings.hpp"

namespace tactus {

class ToolProxy;

class ToolPair {
public:
    // Null where neither has a mesh that can be met. Of two that have, the one with fewer spheres brings
    // them, else the first. Off the loop.
    static std::unique_ptr<ToolPair> make(const std::shared_ptr<const ToolShape>& first,
                                          const std::shared_ptr<const ToolShape>& second);
    ToolPair(const ToolPair&) = delete;
    ToolPair& operator=(const ToolPair&) = delete;

    // From now on these are the tools. They outlive the pair or are parted before.
    void join(ToolProxy& first, ToolProxy& second);
    void part();
    bool is_joined() const { return spheres_ != nullptr; }

    ToolProxy& spheres() const { return *spheres_; }  // the tool whose spheres are meant
    ToolProxy& surface() const { return *surface_; }  // the tool whose mesh is meant
    ToolProxy& other_than(const ToolProxy& tool) const { return &tool == spheres_ ? *surface_ : *spheres_; }

    // Both are there, and each is in a layer of the other's mask.
    bool may_touch() const;
    // Whether each holds the other back: they may touch, and were apart since that is so.
    bool holds() const;
    bool sliding() const { return sliding_; }
    void set_sliding(bool sliding) { sliding_ = sliding; }
    // The lower one of both tools' values, as where bodies meet.
    double friction(bool sliding) const;
    // How far above the mesh the spheres rest (unit: meters).
    double skin() const { return around_.skin(); }

    // Once a tick, before either goes anywhere. Where they do not hold each other back yet, looks whether
    // they are apart.
    void begin_tick(WorkBudget& work);
    // Whether they fit where they are; from then on each holds the other back.
    bool try_apart(WorkBudget& work);
    // One of them was put elsewhere, and not swept there.
    void displaced() { displaced_ = true; }
    // Whether they would go on holding each other back where they are now, if they did before.
    bool fits_now(WorkBudget& work);
    // Whether they may meet while neither origin goes farther than this in all (unit: meters).
    bool is_near(double ways) const;

    // For motions of both within this tick.
    struct Motions {
        RigidMotion spheres, surface;
    };
    // Of that tool alone.
    Motions of_one(const ToolProxy& tool, const RigidMotion& motion) const;
    // In the world; `body` and `feature` mean nothing.
    void collect(const Motions& motions, double far, ToolContacts& contacts, WorkBudget& work);
    double straight_share(const Motions& motions);
    double free_share(const Motions& motions, WorkBudget& work);

private:
    ToolPair(std::shared_ptr<const ToolShape> spheres, std::shared_ptr<const TouchShape> surface,
             bool first_has_spheres);

    Pose relative() const;  // of the spheres, in the surface's frame
    void follow();
    bool cannot_meet(const Motions& motions) const;
    ToolWay way_of(const Motions& motions) const;

    std::shared_ptr<const TouchShape> shape_;
    bool first_has_spheres_;
    TouchScene scene_;  // the mesh, at its own origin
    ToolSurroundings around_;
    ToolProxy* spheres_ = nullptr;
    ToolProxy* surface_ = nullptr;
    Pose seen_;  // relative(), as around_ knows it
    bool apart_ = false;
    bool displaced_ = false;
    bool sliding_ = false;
};

}  // namespace tactus
