#include "nodes/body_watch.hpp"

#include <godot_cpp/core/class_db.hpp>
#include <utility>

namespace tactus {

using namespace godot;

BodyWatch* BodyWatch::put_into(Node& body, Listener& listener) {
    auto* watch = memnew(BodyWatch);
    body.add_child(watch, false, INTERNAL_MODE_BACK);
    if (watch->get_parent() == nullptr) {
        memdelete(watch);
        return nullptr;
    }
    watch->listener_ = &listener;
    watch->set_notify_transform(true);
    listener.is_in_tree(watch->is_inside_tree());
    return watch;
}

BodyWatch::~BodyWatch() {
    go();
}

void BodyWatch::take_out() {
    listener_ = nullptr;
    listen_to({});
    queue_free();
}

void BodyWatch::tell_of_moves(bool tell) {
    set_notify_transform(false);
    set_as_top_level(!tell);
    set_notify_transform(tell);
}

void BodyWatch::listen_to(std::vector<Ref<Resource>> resources) {
    if (resources_ == resources) {
        return;
    }
    const Callable on_change(this, "_resource_changed");
    for (const Ref<Resource>& before : std::exchange(resources_, std::move(resources))) {
        if (before->is_connected("changed", on_change)) {
            before->disconnect("changed", on_change);
        }
    }
    for (const Ref<Resource>& now : resources_) {
        if (!now->is_connected("changed", on_change)) {
            now->connect("changed", on_change);
        }
    }
}

void BodyWatch::resource_changed() {
    if (listener_ != nullptr) {
        listener_->has_changed();
    }
}

void BodyWatch::go() {
    if (listener_ != nullptr) {
        std::exchange(listener_, nullptr)->watch_has_gone();
    }
}

void BodyWatch::_notification(int what) {
    if (listener_ == nullptr) {
        return;
    }
    switch (what) {
        case NOTIFICATION_TRANSFORM_CHANGED:
            listener_->has_moved();
            break;
        case NOTIFICATION_ENTER_TREE:
        case NOTIFICATION_EXIT_TREE:
            listener_->is_in_tree(what == NOTIFICATION_ENTER_TREE);
            break;
        case NOTIFICATION_DISABLED:
        case NOTIFICATION_ENABLED:
        case NOTIFICATION_PAUSED:
        case NOTIFICATION_UNPAUSED:
            listener_->has_changed();
            break;
        case NOTIFICATION_UNPARENTED:
            go();
            break;
        default:
            break;
    }
}

void BodyWatch::_bind_methods() {
    ClassDB::bind_method(D_METHOD("_resource_changed"), &BodyWatch::resource_changed);
}

}  // namespace tactus
