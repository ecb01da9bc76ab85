// What Godot tells of a body, so that nobody has to ask in every frame: that it was moved, and that a
// resource it is made of has changed. Main thread only.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <memory>
#include <vector>

namespace tactus {

// Ids of bodies, each as often as it was told of; whoever reads them empties them.
struct BodyNews {
    std::vector<std::uint64_t> moved;
    std::vector<std::uint64_t> changed;
};

// A child of the body that the scene does not see: Godot tells a node alone that its place has changed, and
// the body itself is not ours.
class BodyWatch : public godot::Node3D {
    GDCLASS(BodyWatch, godot::Node3D)

public:
    // Puts one into the body, which does not have to be in the scene tree. Returns its id; 0 where Godot
    // takes no child at the moment. `known`: where the body was put or found last, which is no news; it lives
    // until take_out().
    static std::uint64_t put_into(godot::Node& body, const std::shared_ptr<BodyNews>& news,
                                  const godot::Transform3D& known);
    // Takes it out; nothing where it has gone with its body.
    static void take_out(std::uint64_t watch);
    // Whether it tells that the body was moved; it does at first.
    static void tell_of_places(std::uint64_t watch, bool tell);
    // These are what the body is made of now.
    static void listen_to(std::uint64_t watch, const std::vector<godot::Ref<godot::Resource>>& resources);

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    void resource_changed();

    std::shared_ptr<BodyNews> news_;  // null: nobody listens any more
    std::uint64_t body_ = 0;
    const godot::Transform3D* known_ = nullptr;  // while there is news_
    std::vector<godot::Ref<godot::Resource>> resources_;
};

}  // namespace tactus
