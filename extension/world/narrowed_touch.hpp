// What fingertips can touch at all of the meshes of a scene (core/geometry/touchable.hpp), found out by the
// workers while they are touched already: once for all bodies of one tree. Owner's thread only.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/geometry/touch_shape.hpp"
#include "realtime/workers.hpp"

namespace tactus {

// Of one tree, for spheres of one radius and larger ones. Shared with the thread that makes it.
struct NarrowedTree {
    TouchShape whole;                                     // one part, of that tree
    double radius = 0.0;                                  // (unit: meters)
    std::shared_ptr<const TouchableTriangles> touchable;  // null: of no use
    std::atomic<bool> done{false};
};

class NarrowedTrees {
public:
    // Has it made, unless somebody has it. `part`: of a mesh.
    std::shared_ptr<const NarrowedTree> get(const TouchPart& part, double radius, Workers& workers);

private:
    // Who holds one holds its tree: an address means the same tree as long.
    std::map<std::pair<const TriangleTree*, double>, std::weak_ptr<NarrowedTree>> all_;
};

// That of one body.
class NarrowedTouch {
public:
    // The radius that was asked for (unit: meters); 0: none.
    double radius() const { return radius_; }
    bool is_under_way() const { return is_under_way_; }

    void begin(const TouchShape& touch, double radius, NarrowedTrees& trees, Workers& workers);
    bool is_ready() const;
    // Once it is ready: what narrowed() makes of the shape that it was begun with.
    std::shared_ptr<const TouchShape> take(const TouchShape& touch);
    // Of the next shape nothing is known. What is may serve again where it has the same trees.
    void forget_body();

private:
    double radius_ = 0.0;
    bool is_under_way_ = false;
    std::vector<std::shared_ptr<const NarrowedTree>> trees_;  // of each part with a tree
};

}  // namespace tactus
