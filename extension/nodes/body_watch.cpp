#include "nodes/body_watch.hpp"

#include <algorithm>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/core/object.hpp>

namespace tactus {

using namespace godot;

std::uint64_t BodyWatch::put_into(Node& body, const std::shared_ptr<BodyNews>& news,
                                  const Transform3D& known) {
    auto* watch = memnew(BodyWatch);
    body.add_child(watch, false, INTERNAL_MODE_BACK);
    if (watch->get_parent() == nullptr) {
        memdelete(watch);
        return 0;
    }
    watch->news_ = news;
    watch->known_ = &known;
    watch->body_ = body.get_instance_id();
    watch->set_notify_transform(true);
    return watch->get_instance_id();
}

void BodyWatch::take_out(std::uint64_t id) {
    if (auto* watch = Object::cast_to<BodyWatch>(ObjectDB::get_instance(id))) {
        watch->news_.reset();
        listen_to(id, {});
        watch->queue_free();
    }
}

void BodyWatch::tell_of_places(std::uint64_t id, bool tell) {
    if (auto* watch = Object::cast_to<BodyWatch>(ObjectDB::get_instance(id))) {
        watch->set_notify_transform(tell);
    }
}

void BodyWatch::listen_to(std::uint64_t id, const std::vector<Ref<Resource>>& resources) {
    auto* watch = Object::cast_to<BodyWatch>(ObjectDB::get_instance(id));
    if (watch == nullptr || watch->resources_ == resources) {
        return;
    }
    const Callable on_change(watch, "_resource_changed");
    for (const Ref<Resource>& before : watch->resources_) {
        if (before->is_connected("changed", on_change)) {
            before->disconnect("changed", on_change);
        }
    }
    watch->resources_ = resources;
    for (const Ref<Resource>& now : watch->resources_) {
        if (!now->is_connected("changed", on_change)) {
            now->connect("changed", on_change);
        }
    }
}

void BodyWatch::resource_changed() {
    if (news_ != nullptr) {
        news_->changed.push_back(body_);
    }
}

// It stands where its body stands, to the bit.
void BodyWatch::_notification(int what) {
    if (what == NOTIFICATION_TRANSFORM_CHANGED && news_ != nullptr && !(get_global_transform() == *known_)) {
        news_->moved.push_back(body_);
    }
}

void BodyWatch::_bind_methods() {
    ClassDB::bind_method(D_METHOD("_resource_changed"), &BodyWatch::resource_changed);
}

}  // namespace tactus
