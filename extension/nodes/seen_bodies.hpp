// What a sensor has seen, put into the scene: each object as a body that can be touched, or as a picture, and
// the cloud of points. Main thread only.
#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <map>

#include "core/math/body_motion.hpp"
#include "nodes/touched_cloud.hpp"
#include "world/seen_library.hpp"
#include "world/sight_roll.hpp"

namespace tactus {

class HapticWorld;

enum class SeenAs : std::uint8_t {
    pictures,     // shown, not touched
    held_bodies,  // touched; only what the camera sees moves them
    free_bodies   // touched and pushed; what the camera sees corrects them
};

class SeenBodies {
public:
    struct Looks {
        SeenAs objects = SeenAs::pictures;
        bool show_objects = true;
        bool show_cloud = false;
        bool touch_cloud = false;  // in place of bodies of what nobody knows
    };

    // Below `sensor`, which outlives this. `age`: of the sight; what moves is where it must be by now (unit:
    // seconds). `since_last`: since the last update or go_on (unit: seconds).
    void update(godot::Node3D& sensor, const Sight& sight, const SeenLibrary& library, const Looks& looks,
                double age, double since_last);
    // The same sight, older by now: what moves has gone on.
    void go_on(const Sight& sight, double age);
    // Takes everything away.
    void clear();

    // The node of an object; null: none.
    godot::Node3D* node_of(std::uint64_t object) const;

private:
    godot::Node3D* make(const SeenForm& form) const;
    void place(HapticWorld* world, const SightedObject& object, double age, double since_last);
    void lead(const SightedObject& object, double age) const;
    void draw_cloud(godot::Node3D& sensor, const Sight& sight, bool is_wanted);
    void hold_support(godot::Node3D& sensor, HapticWorld* world, const SupportPlane& plane, bool is_wanted);

    Looks looks_;  // as of the last time
    SightRoll roll_;
    std::uint64_t cloud_ = 0;
    std::uint64_t support_ = 0;
    TouchedCloud touched_cloud_;
    std::map<std::uint64_t, BodyMotion> led_;  // by object: as it was seen last, and where its node was put
    SupportPlane support_plane_;               // as it was put there last
};

}  // namespace tactus
