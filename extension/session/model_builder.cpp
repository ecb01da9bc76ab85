#include "session/model_builder.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "core/math/body_motion.hpp"

namespace tactus {

namespace {

// What moves and is told anew. Where it is said to be is one delay old; the model knows better, and a hand
// that pushes it may be there by now. A number that is given again may be another object's.
bool is_same(const ModelObject& before, const ModelObject& after) {
    return !before.outdated && before.object == after.object && before.name == after.name &&
           before.motion != Motion::Static && after.motion != Motion::Static;
}

// No farther than a hand moves things within the delay.
constexpr double hand_speed = 1.0;  // (unit: meters per second)
constexpr double nearby = 0.01;     // (unit: meters)

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
    addition.detail = description.detail;
    return addition;
}

}  // namespace

void ModelBuilder::set_run(DiscoveryReceiver::Run run) {
    port_->discovery.set_run(run);
    run_ = std::move(run);
}

bool ModelBuilder::update(Nanoseconds now, const LinkStatistics& link) {
    delay_ = 1e-9 * link.clock.mean_delay;
    object_count_ = link.peer_hello.object_count;
    counted_by_ = link.peer_hello_packet;
    if (link.peer_epoch != 0) {
        follow_gravity(now, link.peer_hello.gravity);
    }
    bool changed = add_prepared();
    for (std::size_t taken = 0; taken < max_built_at_once && preparing_.size() < max_built_at_once; ++taken) {
        std::optional<DiscoveryEvent> event = port_->discovery.next();
        if (!event) {
            break;
        }
        take(*event, now);
        changed = true;
        add_prepared();
    }
    if (any_outdated_ && (now - outdated_at_ >= patience || all_described(now, link))) {
        remove_outdated();
        changed = true;
    }
    if (changed) {
        news_at_ = now;
        join();
    }
    let_fall(now);
    send_on();
    return changed;
}

// At once before there is anything that falls. Later what is pushed or held gets heavier or lighter by it:
// half of what is just noticed of a weight (7 %) in 100 ms.
void ModelBuilder::follow_gravity(Nanoseconds now, const Vec3& wanted) {
    constexpr double max_share_a_second = 0.35;
    constexpr double least = 1.0;          // of which the share is (unit: meters per second squared)
    constexpr double longest_frame = 0.1;  // (unit: seconds)
    const double seconds = std::min(to_seconds(now - gravity_at_), longest_frame);
    const bool at_once = !gravity_known_ || objects_.empty();
    const Vec3 way = wanted - gravity_;
    const double distance = glm::length(way);
    const double max_change = max_share_a_second * std::max(least, glm::length(gravity_)) * seconds;
    gravity_at_ = now;
    if (!gravity_known_ || distance > 0.0) {
        const bool arrives = at_once || distance <= max_change;
        gravity_ = arrives ? wanted : gravity_ + way * (max_change / distance);
        gravity_known_ = true;
        session_.set_gravity(direction_to_parent(frame_, gravity_));
    }
}

void ModelBuilder::take(DiscoveryEvent& event, Nanoseconds now) {
    switch (event.kind) {
        case DiscoveryEvent::Kind::described:
            begin_first();
            if (is_joint(event.object)) {
                port_->discovery.answer(event.object, joints_.describe(event.joint));
            } else {
                prepare(event.description);
            }
            break;
        case DiscoveryEvent::Kind::removed:
            remove(event.object);
            break;
        case DiscoveryEvent::Kind::restarted:
            outdate(now);
            break;
    }
}

void ModelBuilder::outdate(Nanoseconds now) {
    preparing_.clear();
    for (ModelObject& object : objects_) {
        bind(object.object, no_handle);
        object.outdated = true;
    }
    joints_.outdate();
    any_outdated_ = !objects_.empty();
    outdated_at_ = now;
}

// As many as the far side says that it has, and no more have come lately.
bool ModelBuilder::all_described(Nanoseconds now, const LinkStatistics& link) const {
    const auto bodies = std::ranges::count(objects_, false, &ModelObject::outdated);
    return now - outdated_at_ >= settling && link.peer_hello.object_count > 0 &&
           static_cast<std::size_t>(bodies) + joints_.count() >= link.peer_hello.object_count;
}

// As the far side has counted them after it described the last of them: what comes together is described in
// any order, and its count may be lost or overtaken.
bool ModelBuilder::all_known() const {
    if (counted_by_ < port_->discovery.newest_packet()) {
        return false;
    }
    const auto bodies = std::ranges::count(objects_, false, &ModelObject::outdated);
    return static_cast<std::size_t>(bodies) + joints_.count() >= object_count_;
}

// Until it is whole no hand touches the model: the far side's would press what is not described yet.
void ModelBuilder::begin_first() {
    if (first_ == FirstDescription::awaited) {
        first_ = FirstDescription::begun;
        waiting_.push_back(description_begins);
    }
}

// What a body rests on may be described after it: nothing falls before all is.
void ModelBuilder::let_fall(Nanoseconds now) {
    if (!all_known() && now - news_at_ < floats_at_most) {
        return;
    }
    if (first_ == FirstDescription::begun) {
        first_ = FirstDescription::whole;
        waiting_.push_back(description_is_whole);
    }
    for (ModelObject& object : objects_) {
        if (std::exchange(object.floats, false) && object.body != no_handle) {
            session_.set_body_gravity_scale(object.body, object.gravity_scale);
        }
    }
}

void ModelBuilder::remove_outdated() {
    for (const ModelObject& object : objects_) {
        if (object.outdated) {
            take_out(object);
        }
    }
    std::erase_if(objects_, [](const ModelObject& object) { return object.outdated; });
    joints_.remove_outdated();
    any_outdated_ = false;
}

void ModelBuilder::prepare(ObjectDescription& description) {
    if (distortion_) {
        distortion_(description);
    }
    forget_prepared(description.object);
    auto preparing = std::make_shared<Preparing>();
    preparing->object = description.object;
    preparing->name = description.name;
    preparing->addition = addition_of(description, frame_);
    preparing->gravity_scale = description.body.gravity_scale;
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
    ModelObject made{prepared.object,       prepared.name,         no_handle, {}, false,
                     prepared.ready.motion, prepared.gravity_scale};
    const auto before = find_before(prepared.object, prepared.name);
    FormerBody former;
    if (before != objects_.end() && is_same(*before, made)) {
        former = {before->body, std::max(nearby, hand_speed * delay_)};
    }
    AddResult added = session_.add_body(std::move(prepared.ready), former);
    made.body = added.handle;
    made.problem = std::move(added.error);
    port_->discovery.answer(prepared.object,
                            made.body == no_handle ? DiscoveryVerdict::refused : DiscoveryVerdict::known);
    // What is described anew rests where it rested.
    made.floats = made.body != no_handle && made.motion == Motion::Dynamic &&
                  (former.body == no_handle || before->floats);
    if (made.floats) {
        session_.set_body_gravity_scale(made.body, 0.0);
    }
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

void ModelBuilder::join() {
    joints_.join([this](ObjectId object) {
        const auto found = find(object);
        return found != objects_.end() ? found->body : no_handle;
    });
}

void ModelBuilder::remove(ObjectId object) {
    joints_.remove(object);
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
    joints_.clear();
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
std::vector<ModelObject>::iterator ModelBuilder::find_before(ObjectId object, const std::string& name) {
    const auto itself = find(object);
    return itself != objects_.end() ? itself
                                    : std::ranges::find_if(objects_, [&name](const ModelObject& one) {
                                          return one.outdated && one.name == name;
                                      });
}

}  // namespace tactus
