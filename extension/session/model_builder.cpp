#include "session/model_builder.hpp"

#include <algorithm>

#include "core/teleop/body_motion.hpp"

namespace tactus {

namespace {

BodyAddition addition_of(const ObjectDescription& description, const Pose& frame) {
    BodyAddition addition;
    addition.description = description.body;
    const BodyMotion motion =
        to_parent(frame, BodyMotion{description.body.pose, description.body.linear_velocity,
                                    description.body.angular_velocity});
    addition.description.pose = motion.pose;
    addition.description.linear_velocity = motion.linear_velocity;
    addition.description.angular_velocity = motion.angular_velocity;
    addition.touch_shapes = description.touch_shapes;
    addition.touch_material = description.touch;
    addition.texture = description.texture;
    return addition;
}

}  // namespace

bool ModelBuilder::update(Nanoseconds now, const LinkStatistics& link) {
    if (link.peer_epoch != 0 && (!gravity_known_ || link.peer_hello.gravity != gravity_)) {
        gravity_known_ = true;
        gravity_ = link.peer_hello.gravity;
        session_.set_gravity(direction_to_parent(frame_, gravity_));
    }
    bool changed = false;
    for (int built = 0; built < most_built_at_once; ++built) {
        std::optional<DiscoveryEvent> event = port_->discovery.next(now);
        if (!event) {
            break;
        }
        changed = true;
        switch (event->kind) {
            case DiscoveryEvent::Kind::described:
                build(event->description);
                break;
            case DiscoveryEvent::Kind::removed:
                remove(event->object);
                break;
            case DiscoveryEvent::Kind::restarted:
                outdate(now);
                break;
        }
    }
    if (any_outdated_ && (now - outdated_at_ >= patience || all_described(now, link))) {
        remove_outdated();
        changed = true;
    }
    send_on();
    return changed;
}

void ModelBuilder::outdate(Nanoseconds now) {
    for (ModelObject& object : objects_) {
        bind(object.object, no_handle);
        object.outdated = true;
    }
    any_outdated_ = !objects_.empty();
    outdated_at_ = now;
}

// As many as the far side says that it has, and no more have come lately.
bool ModelBuilder::all_described(Nanoseconds now, const LinkStatistics& link) const {
    const auto current = std::ranges::count(objects_, false, &ModelObject::outdated);
    return now - outdated_at_ >= settling && link.peer_hello.object_count > 0 &&
           static_cast<std::uint64_t>(current) >= link.peer_hello.object_count;
}

void ModelBuilder::remove_outdated() {
    for (const ModelObject& object : objects_) {
        if (object.outdated) {
            take_out(object);
        }
    }
    std::erase_if(objects_, [](const ModelObject& object) { return object.outdated; });
    any_outdated_ = false;
}

void ModelBuilder::build(ObjectDescription& description) {
    if (distortion_) {
        distortion_(description);
    }
    ModelObject made{description.object, description.name, no_handle, {}};
    const auto before = find_before(description);
    AddResult added = session_.add_body(addition_of(description, frame_));
    made.body = added.handle;
    made.problem = std::move(added.error);
    port_->discovery.answer(description.object,
                            made.body == no_handle ? DiscoveryVerdict::refused : DiscoveryVerdict::known);
    if (before == objects_.end()) {
        objects_.push_back(std::move(made));
    } else {
        take_out(*before);
        *before = std::move(made);
    }
    bind(description.object, find(description.object)->body);
}

void ModelBuilder::remove(ObjectId object) {
    if (const auto found = find(object); found != objects_.end()) {
        bind(object, no_handle);
        take_out(*found);
        objects_.erase(found);
    }
}

void ModelBuilder::clear() {
    for (const ModelObject& object : objects_) {
        bind(object.object, no_handle);
        take_out(object);
    }
    objects_.clear();
    send_on();
}

void ModelBuilder::take_out(const ModelObject& object) {
    if (object.body != no_handle) {
        session_.remove_body(object.body);
    }
}

void ModelBuilder::bind(ObjectId object, SessionHandle body) {
    waiting_.push_back({object, body});
}

void ModelBuilder::send_on() {
    while (!waiting_.empty() && port_->bindings.try_push(waiting_.front())) {
        waiting_.pop_front();
    }
}

std::vector<ModelObject>::iterator ModelBuilder::find(ObjectId object) {
    return std::ranges::find_if(
        objects_, [object](const ModelObject& one) { return one.object == object && !one.outdated; });
}

// What the described object takes the place of: itself, or what had its name before the far side started
// anew.
std::vector<ModelObject>::iterator ModelBuilder::find_before(const ObjectDescription& description) {
    const auto itself = find(description.object);
    return itself != objects_.end() ? itself
                                    : std::ranges::find_if(objects_, [&description](const ModelObject& one) {
                                          return one.outdated && one.name == description.name;
                                      });
}

}  // namespace tactus
