// What a synthetic camera is shown of a scene: every mesh that is drawn below a node, where it is now. Main
// thread only.
#pragma once

#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/variant/string.hpp>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "world/sensing_library.hpp"

namespace tactus {

class SyntheticView {
public:
    // Of all that is drawn at or below `root`, but not at or below `without`. Empty, or why there is nothing
    // to see.
    std::string begin(const DepthSensing& sensing, const SyntheticCamera& camera, godot::Node& root,
                      const godot::Node& without);
    void end();

    // Where all of it is now. True where something else is drawn by now: begin anew. What is gone shows at
    // once, what has come within a second.
    bool show(const Pose& camera);

    const char* uri() const { return scene_ != nullptr ? scene_->uri() : ""; }
    bool is_there() const { return scene_ != nullptr; }
    void set_plugged(bool is_plugged);

private:
    struct Shown {
        std::uint64_t node = 0;
        std::uint64_t mesh = 0;  // id of the resource
    };

    static void collect(godot::Node& root, const godot::Node* without,
                        std::vector<godot::MeshInstance3D*>& found);

    bool has_others() const;

    OwnedScene scene_;
    std::uint64_t root_ = 0, without_ = 0;  // nodes
    int shows_ = 0;
    std::vector<Shown> shown_;
    std::vector<ShownBody> bodies_;
};

}  // namespace tactus
