// What Godot tells of a body, so that nobody has to ask in every frame: that it was moved, that a resource it
// is made of has changed, that it comes and goes. Main thread only.
#pragma once

#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <vector>

namespace tactus {

// A child of the body that the scene does not see: Godot tells a node alone that its place has changed, and
// the body itself is not ours.
class BodyWatch : public godot::Node3D {
    GDCLASS(BodyWatch, godot::Node3D)

public:
    class Listener {
    public:
        virtual void has_moved() = 0;
        virtual void has_changed() = 0;  // a resource of it, or whether it is processed
        virtual void is_in_tree(bool now) = 0;
        virtual void watch_has_gone() = 0;  // with its body, or because somebody took it out

    protected:
        ~Listener() = default;
    };

    ~BodyWatch() override;

    // Puts one into the body, which does not have to be in the scene tree. Null where Godot takes no child at
    // the moment. The listener is there until it has taken the watch out, or has heard that it has gone.
    static BodyWatch* put_into(godot::Node& body, Listener& listener);
    void take_out();

    // Whether has_moved() is called. Where it is not, Godot takes the watch along with its body no more,
    // which would cost as much for each body that moves.
    void tell_of_moves(bool tell);

    // These are what the body is made of now.
    void listen_to(std::vector<godot::Ref<godot::Resource>> resources);

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    void resource_changed();
    void go();

    Listener* listener_ = nullptr;  // null: nobody listens any more
    std::vector<godot::Ref<godot::Resource>> resources_;
};

}  // namespace tactus
