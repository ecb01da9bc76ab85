#include "session/model_builder.hpp"

#include <algorithm>

namespace tactus {

namespace {

BodyAddition addition_of(const ObjectDescription& description) {
    BodyAddition addition;
    addition.description = description.body;
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
        session_.set_gravity(gravity_);
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
                clear();
                break;
        }
    }
    send_on();
    return changed;
}

void ModelBuilder::build(ObjectDescription& description) {
    if (distortion_) {
        distortion_(description);
    }
    ModelObject made{description.object, description.name, no_handle, {}};
    const auto before = find(description.object);
    AddResult added = session_.add_body(addition_of(description));
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
    return std::ranges::find(objects_, object, &ModelObject::object);
}

}  // namespace tactus
