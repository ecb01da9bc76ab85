// What a depth sensor sees, for whoever shows it and tells of it: what has come and gone since the last time,
// where things are by now, where the camera must be. Owner's thread only.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "core/ports/depth_sensing.hpp"

namespace tactus {

// "found", "tracked", "cut", "hidden", "lost".
const char* word_of(SightState state);

// Of all objects that are there, 0 to 1; 0 where there are none.
double lowest_confidence(const Sight& sight);

// Null where no such object is there.
const SightedObject* object_of(const Sight& sight, std::uint64_t id);

bool moves(const SightedObject& object);
// Where it is after `seconds` if it goes on as it moves.
Pose pose_after(const SightedObject& object, double seconds);

// Whether the support is seen so far from `before` that it is not the camera's noise.
bool is_elsewhere(const SupportPlane& plane, const SupportPlane& before);
// Where a slab of that thickness lies whose upper side, along its y, is the plane (unit: meters).
Pose slab_under(const SupportPlane& plane, double thickness);

// Where the camera is if the plane lies level at a height: turned about itself by as little as that needs,
// and lifted. None: no plane is seen.
std::optional<Pose> camera_over_plane(const Sight& sight, double height);
// Where it is if a known object stands at `place`. None: it is not seen.
std::optional<Pose> camera_by_object(const Sight& sight, std::uint64_t id, const Pose& place);

struct SightChange {
    enum class Kind : std::uint8_t { found, updated, lost } kind = Kind::found;
    std::uint64_t id = 0;
    std::int32_t mesh = -1;  // in the library; -1: none of it, or nothing is known of it any more
    Pose pose;
};

// What has become of which object, from one sight to the next.
class SightChanges {
public:
    std::vector<SightChange> since_last(const Sight& sight);
    void forget() { known_.clear(); }

private:
    std::map<std::uint64_t, SightState> known_;
};

// Which node shows which object: made when it comes or looks otherwise, gone when it is lost.
class SightRoll {
public:
    using Show = std::function<std::uint64_t(const SightedObject& object)>;  // the node; 0: none
    using Hide = std::function<void(std::uint64_t node)>;

    void update(const Sight& sight, const Show& show, const Hide& hide);
    void hide_all(const Hide& hide);
    std::uint64_t node_of(std::uint64_t object) const;  // 0: none

private:
    struct Shown {
        std::uint64_t node = 0;
        std::int32_t mesh = -1;
        std::size_t hull_corners = 0;
        bool is_there = true;
    };
    std::map<std::uint64_t, Shown> shown_;  // by object
};

}  // namespace tactus
