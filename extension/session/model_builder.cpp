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

void ModelBuilder::set_run(DiscoveryReceiver::Run run) {
    port_->discovery.set_run(run);
    run_ = std::move(run);
}

bool ModelBuilder::update(const LinkStatistics& link) {
    if (link.peer_epoch != 0 && (!gravity_known_ || link.peer_hello.gravity != gravity_)) {
        gravity_known_ = true;
        gravity_ = link.peer_hello.gravity;
        session_.set_gravity(gravity_);
    }
    bool changed = add_prepared();
    for (std::size_t taken = 0; taken < most_built_at_once && preparing_.size() < most_built_at_once;
         ++taken) {
        std::optional<DiscoveryEvent> event = port_->discovery.next();
        if (!event) {
            break;
        }
        take(*event);
        changed = true;
        add_prepared();
    }
    send_on();
    return changed;
}

void ModelBuilder::take(DiscoveryEvent& event) {
    switch (event.kind) {
        case DiscoveryEvent::Kind::described:
            prepare(event.description);
            break;
        case DiscoveryEvent::Kind::removed:
            remove(event.object);
            break;
        case DiscoveryEvent::Kind::restarted:
            clear();
            break;
    }
}

void ModelBuilder::prepare(ObjectDescription& description) {
    if (distortion_) {
        distortion_(description);
    }
    forget_prepared(description.object);
    auto preparing = std::make_shared<Preparing>();
    preparing->object = description.object;
    preparing->name = description.name;
    preparing->addition = addition_of(description);
    preparing_.push_back(preparing);
    const auto job = [preparing, session = &session_] {
        preparing->ready = session->prepare_body(preparing->addition);
        preparing->done.store(true, std::memory_order_release);
    };
    run_ ? run_(job) : job();
}

// In the order in which they were described.
bool ModelBuilder::add_prepared() {
    bool added = false;
    while (!preparing_.empty() && preparing_.front()->done.load(std::memory_order_acquire)) {
        const std::shared_ptr<Preparing> prepared = std::move(preparing_.front());
        preparing_.pop_front();
        add(*prepared);
        added = true;
    }
    return added;
}

void ModelBuilder::add(Preparing& prepared) {
    ModelObject made{prepared.object, prepared.name, no_handle, {}};
    const auto before = find(prepared.object);
    AddResult added = session_.add_body(std::move(prepared.ready));
    made.body = added.handle;
    made.problem = std::move(added.error);
    port_->discovery.answer(prepared.object,
                            made.body == no_handle ? DiscoveryVerdict::refused : DiscoveryVerdict::known);
    if (before == objects_.end()) {
        objects_.push_back(std::move(made));
    } else {
        take_out(*before);
        *before = std::move(made);
    }
    bind(prepared.object, find(prepared.object)->body);
}

// What is still being prepared of an object is not wanted any more.
void ModelBuilder::forget_prepared(ObjectId object) {
    std::erase_if(preparing_, [object](const auto& preparing) { return preparing->object == object; });
}

void ModelBuilder::remove(ObjectId object) {
    forget_prepared(object);
    if (const auto found = find(object); found != objects_.end()) {
        bind(object, no_handle);
        take_out(*found);
        objects_.erase(found);
    }
}

void ModelBuilder::clear() {
    preparing_.clear();
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
