#include "nodes/world_run.hpp"

#include <algorithm>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/core/object.hpp>
#include <unordered_set>

#include "nodes/conversions.hpp"
#include "nodes/haptic_device.hpp"
#include "nodes/haptic_recorder.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mmt_link.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/roll.hpp"
#include "realtime/clock.hpp"

namespace tactus {

using namespace godot;

namespace {

// Ticks between two drains of the recorder's rings in stepped time: well below what the rings hold.
constexpr std::int64_t ticks_at_once = 1000;

constexpr std::size_t trace_capacity = 4096;  // ticks between two drains: four seconds at 1 kHz

Nanoseconds wall_clock_now() {
    timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return static_cast<Nanoseconds>(now.tv_sec) * nanoseconds_per_second + now.tv_nsec;
}

double project_number(const char* name, double otherwise) {
    return ProjectSettings::get_singleton()->get_setting(name, otherwise);
}

// Where another hand is put in the place of the device's own.
class StandInDevice final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        DeviceSample sample;
        sample.connected = true;
        return sample;
    }
    void write(Nanoseconds, const Vec3&) override {}
};

// Marks a time in which the same is not to be begun again.
class Busy {
public:
    explicit Busy(bool& flag) : flag_(flag), before_(std::exchange(flag, true)) {}
    ~Busy() { flag_ = before_; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

private:
    bool& flag_;
    bool before_;
};

bool same(const Workspace& a, const Workspace& b) {
    return a.pose.position == b.pose.position && a.pose.rotation == b.pose.rotation && a.scale == b.scale &&
           a.force_limit == b.force_limit && a.clutch == b.clutch;
}

bool same(const ProxyDescription& a, const ProxyDescription& b) {
    return a.device == b.device && a.settings.radius == b.settings.radius &&
           a.settings.mask == b.settings.mask && a.force_law == b.force_law && a.enabled == b.enabled;
}

}  // namespace

WorldRun::WorldRun(HapticWorld& world, const RunSettings& settings)
    : world_(world),
      settings_(settings),
      session_(settings.session),
      epoch_of_monotonic_clock_(wall_clock_now() - monotonic_now()) {
    defaults_.linear_damping = project_number("physics/3d/default_linear_damp", 0.1);
    defaults_.angular_damping = project_number("physics/3d/default_angular_damp", 0.1);
    mirror_by_handle_.resize(settings.session.most_bodies);
    if (settings_.link != nullptr) {
        link_ = std::make_unique<LinkRun>(*settings_.link, world_, session_,
                                          settings_.real_time ? &clock_offset_ : nullptr);
        stand_in_ = std::make_shared<StandInDevice>();
    }
}

WorldRun::~WorldRun() {
    end();
}

void WorldRun::end() {
    if (std::exchange(is_over_, true)) {
        return;
    }
    stop_loop();
    if (link_ != nullptr) {
        link_->leave();
        tick(next_time_);
    }
    session_.rest();
    for (const auto& mirror : mirrors_) {
        mirror->release(session_);
    }
    if (link_ != nullptr && link_->is_operator()) {
        link_->view()->release();
    }
    for (const DeviceLink& link : devices_) {
        link.node->clear_state();
    }
    for (const ProxyLink& link : proxies_) {
        link.node->clear_state();
    }
}

// --- time
// ------------------------------------------------------------------------------------------------------------

std::string WorldRun::start_loop(const TickLoopSettings& settings, bool baseline) {
    loop_is_new_ = true;
    loop_settings_ = settings;
    baseline_ = baseline ? std::make_unique<BaselineLoop>() : nullptr;
    std::string error = loop_.start(settings, &WorldRun::tick_loop_function, this, trace_.get());
    if (error.empty() && baseline_ != nullptr) {
        error = baseline_->start(settings);
    }
    return error;
}

void WorldRun::stop_loop() {
    if (baseline_ != nullptr) {
        baseline_->stop();
    }
    loop_.stop();
    drain();
}

void WorldRun::pause() {
    stop_loop();
    session_.rest();
    session_.refresh();
    show_devices(session_.snapshot());
    for (const ProxyLink& link : proxies_) {
        link.node->clear_force();
    }
}

TickStatus WorldRun::tick_loop_function(void* self, Nanoseconds scheduled) {
    WorldRun& run = *static_cast<WorldRun*>(self);
    if (run.loop_is_new_) {
        run.loop_is_new_ = false;
        run.clock_offset_.store(scheduled - run.next_time_, std::memory_order_relaxed);
    }
    return run.tick(scheduled - run.clock_offset_.load(std::memory_order_relaxed));
}

TickStatus WorldRun::tick(Nanoseconds now) {
    const TickStatus status = session_.tick(now, trace_.get());
    next_time_ = now + settings_.session.period;
    ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    return status;
}

void WorldRun::advance(std::int64_t ticks) {
    for (std::int64_t done = 0; done < ticks; ++done) {
        const Nanoseconds now = next_time_;
        if (trace_ != nullptr) {
            trace_->begin_tick(now, monotonic_now());
        }
        const TickStatus status = tick(now);
        stepped_status_ |= status;
        if (trace_ != nullptr) {
            trace_->end_tick(monotonic_now(), status);
        }
        if (done % ticks_at_once == ticks_at_once - 1) {
            session_.collect();
            drain();
        }
    }
}

TickStatus WorldRun::take_status() {
    return settings_.real_time ? loop_.take_status() : std::exchange(stepped_status_, 0u);
}

// --- from Godot to the session
// ---------------------------------------------------------------------------------------

void WorldRun::synchronise(double seconds) {
    const Busy busy(is_busy_);
    session_.collect();  // trees that the loop has let go of can be refitted
    synchronise_link();
    synchronise_bodies(seconds);
    synchronise_joints();
    synchronise_devices();
    synchronise_proxies();
    synchronise_recorder();
    if (!session_.collect()) {
        retired_.clear();
    }
}

void WorldRun::collect_nodes(Node* node, std::vector<CollisionObject3D*>& bodies,
                             std::vector<Joint3D*>& joints) const {
    for (int i = 0; i < node->get_child_count(); ++i) {
        Node* child = node->get_child(i);
        if (is_solid_body(child)) {
            bodies.push_back(Object::cast_to<CollisionObject3D>(child));
        } else if (auto* joint = Object::cast_to<Joint3D>(child)) {
            joints.push_back(joint);
        }
        collect_nodes(child, bodies, joints);
    }
}

// Mirrors of what has come; those of what has gone are let go.
template <class Mirror, class NodeType>
void WorldRun::match(std::vector<std::unique_ptr<Mirror>>& mirrors, const std::vector<NodeType*>& found) {
    std::unordered_set<std::uint64_t> there;
    for (const NodeType* node : found) {
        there.insert(node->get_instance_id());
    }
    std::erase_if(mirrors, [&](const auto& mirror) {
        const bool gone = !there.contains(mirror->id());
        if (gone) {
            mirror->release(session_);
        }
        return gone;
    });
    for (const auto& mirror : mirrors) {
        there.erase(mirror->id());
    }
    for (NodeType* node : found) {
        if (there.contains(node->get_instance_id())) {
            mirrors.push_back(std::make_unique<Mirror>(*node));
        }
    }
}

void WorldRun::find_nodes() {
    std::vector<CollisionObject3D*> bodies;
    std::vector<Joint3D*> joints;
    collect_nodes(&world_, bodies, joints);
    if (link_ != nullptr && link_->is_operator()) {
        link_->view()->hold_still(bodies);
        return;
    }
    match(joints_, joints);
    match(mirrors_, bodies);
    mirror_by_id_.clear();
    for (const auto& mirror : mirrors_) {
        mirror_by_id_[mirror->id()] = mirror.get();
    }
}

void WorldRun::synchronise_joints() {
    const FindMirror find = [this](const Node* node) {
        return node != nullptr ? mirror_of(node->get_instance_id()) : nullptr;
    };
    for (const auto& joint : joints_) {
        joint->synchronise(session_, find);
        if (joint->node() != nullptr && !joint->problem().empty()) {
            complaints_.say(*joint->node(), to_godot(joint->problem()));
        }
    }
}

void WorldRun::synchronise_bodies(double seconds) {
    if (std::exchange(bodies_changed_, false)) {
        find_nodes();
    }
    MirrorContext context;
    defaults_.touch = world_.default_touch();
    defaults_.texture = world_.default_texture();
    context.defaults = defaults_;
    context.on_shape_change = callable_mp(&world_, &HapticWorld::shape_changed);
    context.shapes_changed = std::exchange(shapes_changed_, false);
    // In real time a tick may be under way that has already taken its commands.
    context.takes_effect = ticks() + (settings_.real_time ? 2 : 1);
    context.workers = &workers_;
    for (const auto& mirror : mirrors_) {
        mirror->synchronise(session_, context, seconds);
    }
    if (!settings_.real_time) {
        finish_building(context);
    }
    std::fill(mirror_by_handle_.begin(), mirror_by_handle_.end(), nullptr);
    for (const auto& mirror : mirrors_) {
        if (mirror->handle() != no_handle) {
            mirror_by_handle_[mirror->handle()] = mirror.get();
        }
        const CollisionObject3D* body = mirror->body();
        for (const std::string& problem : mirror->problems()) {
            if (body != nullptr) {
                complaints_.say(*body, to_godot(problem));
            }
        }
    }
}

// Stepped time waits, so that every run has the same bodies in the same ticks.
void WorldRun::finish_building(const MirrorContext& context) {
    if (trees_building() == 0) {
        return;
    }
    workers_.wait();
    for (const auto& mirror : mirrors_) {
        mirror->take_ready(session_, context);
    }
}

std::size_t WorldRun::trees_building() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(mirrors_, [](const auto& mirror) { return mirror->is_building(); }));
}

void WorldRun::drop_device(DeviceLink& link) {
    if (link.handle != no_handle) {
        session_.remove_device(link.handle);
        retired_.push_back(link.port);
        link.node->clear_state();
    }
    link.handle = no_handle;
    link.port.reset();
}

void WorldRun::connect_device(DeviceLink& link) {
    // At the far side the hand is the operator's: what is plugged in here has no part in it.
    const bool stands_in = link_ != nullptr && !link_->is_operator();
    const std::shared_ptr<Device> port = stands_in ? stand_in_ : link.node->port();
    if (port != link.port) {
        drop_device(link);
        link.port = port;
    }
    if (port == nullptr) {
        complaints_.say(*link.node, link.node->get_state_text());
        return;
    }
    const Workspace workspace = link.node->workspace();
    if (link.handle == no_handle) {
        const AddResult added = session_.add_device(*port, workspace);
        link.handle = added.handle;
        if (link.handle == no_handle) {
            complaints_.say(*link.node, to_godot(added.error));
        }
    } else if (!same(workspace, link.sent)) {
        session_.set_workspace(link.handle, workspace);
    }
    link.sent = workspace;
}

void WorldRun::synchronise_devices() {
    for (HapticDevice* device : Roll<HapticDevice>::all()) {
        const bool is_known = std::any_of(devices_.begin(), devices_.end(),
                                          [device](const DeviceLink& link) { return link.node == device; });
        if (!is_known && HapticWorld::of(device) == &world_) {
            devices_.push_back({device, nullptr, no_handle, {}});
        }
    }
    for (DeviceLink& link : devices_) {
        connect_device(link);
    }
}

SessionHandle WorldRun::device_handle(const HapticDevice* node) const {
    const auto link = std::find_if(devices_.begin(), devices_.end(),
                                   [node](const DeviceLink& d) { return d.node == node; });
    return node != nullptr && link != devices_.end() ? link->handle : no_handle;
}

void WorldRun::synchronise_proxies() {
    for (ProxyPointer* proxy : Roll<ProxyPointer>::all()) {
        const bool is_known = std::any_of(proxies_.begin(), proxies_.end(),
                                          [proxy](const ProxyLink& link) { return link.node == proxy; });
        if (!is_known && HapticWorld::of(proxy) == &world_) {
            proxies_.push_back({proxy, no_handle, {}});
        }
    }
    for (ProxyLink& link : proxies_) {
        const HapticDevice* device = link.node->device_node();
        if (const String wrong = link.node->problem(); !wrong.is_empty()) {
            complaints_.say(*link.node, wrong);
        }
        const ProxyDescription description = link.node->description(device_handle(device));
        if (link.handle == no_handle) {
            const AddResult added = session_.add_proxy(description);
            link.handle = added.handle;
            if (link.handle == no_handle) {
                complaints_.say(*link.node, to_godot(added.error));
            }
        } else if (!same(description, link.sent)) {
            session_.set_proxy(link.handle, description);
        }
        link.sent = description;
    }
}

// --- the far side
// ----------------------------------------------------------------------------------------------------

void WorldRun::synchronise_link() {
    if (link_ == nullptr) {
        return;
    }
    const auto now = static_cast<Nanoseconds>(ticks()) * settings_.session.period;
    link_->synchronise(workers_, {now, !loop_.running(), !settings_.real_time});
    if (!link_->is_operator()) {
        link_->tell(mirrors_, session_.snapshot(), now);
    }
}

// --- recording
// -------------------------------------------------------------------------------------------------------

void WorldRun::want_trace() {
    if (trace_ != nullptr) {
        return;
    }
    const bool running = loop_.running();
    stop_loop();
    trace_ = std::make_unique<TickTrace>(trace_capacity);
    if (running) {
        if (const std::string error = start_loop(loop_settings_, baseline_ != nullptr); !error.empty()) {
            complaints_.say(world_, to_godot(error));
        }
    }
}

void WorldRun::synchronise_recorder() {
    if (recorder_ != nullptr && !recorder_->is_recording()) {
        forget(recorder_);
    }
    for (HapticRecorder* recorder : Roll<HapticRecorder>::all()) {
        if (recorder == recorder_ || !recorder->is_recording() || HapticWorld::of(recorder) != &world_) {
            continue;
        }
        if (recorder_ != nullptr) {
            complaints_.say(*recorder, "another HapticRecorder, " + name_of(*recorder_) +
                                           ", records this world already: stop that one first");
            continue;
        }
        recorder_ = recorder;
        recorded_proxy_ = no_handle;
        if (recorder->wants_trace()) {
            want_trace();
        }
    }
    if (recorder_ == nullptr) {
        return;
    }
    const ProxyPointer* node = recorder_->proxy_node();
    const auto link = std::find_if(proxies_.begin(), proxies_.end(),
                                   [node](const ProxyLink& proxy) { return proxy.node == node; });
    const SessionHandle proxy = node != nullptr && link != proxies_.end() ? link->handle : no_handle;
    const Node* object_node = recorder_->object_node();
    const SessionHandle object = body_of(object_node);
    if (const String problem = recorder_->problem(); !problem.is_empty()) {
        complaints_.say(*recorder_, problem);
    }
    if (proxy != no_handle && (proxy != recorded_proxy_ || object != recorded_object_)) {
        recorded_proxy_ = proxy;
        recorded_object_ = object;
        session_.record(recorder_->ring().get(), proxy, object);
    }
}

void WorldRun::drain() {
    if (recorder_ == nullptr) {
        return;
    }
    const Nanoseconds zero_on_monotonic = clock_offset_.load(std::memory_order_relaxed);
    recorder_->drain(settings_.real_time ? zero_on_monotonic + epoch_of_monotonic_clock_ : 0);
    if (trace_ != nullptr) {
        recorder_->drain_trace(*trace_);
    }
}

// --- what leaves
// -----------------------------------------------------------------------------------------------------

void WorldRun::forget(HapticDevice* device) {
    for (DeviceLink& link : devices_) {
        if (link.node == device) {
            drop_device(link);
        }
    }
    std::erase_if(devices_, [device](const DeviceLink& link) { return link.node == device; });
}

void WorldRun::forget(ProxyPointer* proxy) {
    for (const ProxyLink& link : proxies_) {
        if (link.node == proxy && link.handle != no_handle) {
            session_.remove_proxy(link.handle);
        }
    }
    std::erase_if(proxies_, [proxy](const ProxyLink& link) { return link.node == proxy; });
}

void WorldRun::forget(HapticRecorder* recorder) {
    if (recorder_ == nullptr || recorder != recorder_) {
        return;
    }
    session_.record(nullptr, no_handle, no_handle);
    retired_.push_back(recorder_->ring());
    recorder_ = nullptr;
}

void WorldRun::forget(MMTLink* link) {
    if (link_ != nullptr && link_->is_of(link)) {
        link_->forget_node();
    }
}

void WorldRun::finish(HapticRecorder* recorder) {
    if (recorder == recorder_) {
        drain();
        forget(recorder);
    }
}

// --- from the session to Godot
// ---------------------------------------------------------------------------------------

BodyMirror* WorldRun::mirror_of(std::uint64_t id) {
    const auto found = mirror_by_id_.find(id);
    return found != mirror_by_id_.end() ? found->second : nullptr;
}

BodyMirror* WorldRun::mirror_of_handle(SessionHandle handle) {
    return handle < mirror_by_handle_.size() ? mirror_by_handle_[handle] : nullptr;
}

SessionHandle WorldRun::body_of(const Node* node) {
    if (node == nullptr) {
        return no_handle;
    }
    if (link_ != nullptr && link_->is_operator()) {
        return link_->view()->body_of(node->get_instance_id());
    }
    const BodyMirror* mirror = mirror_of(node->get_instance_id());
    return mirror != nullptr ? mirror->handle() : no_handle;
}

std::uint64_t WorldRun::node_of(SessionHandle body) {
    if (link_ != nullptr && link_->is_operator()) {
        return link_->view()->node_of(body);
    }
    const BodyMirror* mirror = mirror_of_handle(body);
    return mirror != nullptr ? mirror->id() : 0;
}

ProxyPointer::BodyIds WorldRun::body_ids(const ProxyState& state) {
    ProxyPointer::BodyIds ids{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(state.contact_count); ++i) {
        ids[i] = node_of(state.bodies[i]);
    }
    return ids;
}

void WorldRun::show() {
    const Busy busy(is_busy_);
    drain();
    const LinkRun::News news = link_ != nullptr ? link_->take_news() : LinkRun::News{};
    if (session_.refresh()) {
        const SessionSnapshot& snapshot = session_.snapshot();
        show_devices(snapshot);
        show_bodies(snapshot);
        show_proxies(snapshot);
    }
    news.deliver();
}

void WorldRun::show_bodies(const SessionSnapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.body_count && !is_over_; ++i) {
        if (link_ != nullptr && link_->is_operator()) {
            link_->view()->apply(snapshot.bodies[i]);
        } else if (BodyMirror* mirror = mirror_of_handle(snapshot.bodies[i].handle)) {
            mirror->apply(snapshot.bodies[i], snapshot.tick);
        }
    }
}

void WorldRun::show_devices(const SessionSnapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.device_count; ++i) {
        for (const DeviceLink& link : devices_) {
            if (link.handle == snapshot.devices[i].handle) {
                link.node->take_state(snapshot.devices[i]);
            }
        }
    }
}

// From copies: a node that is moved may call a script.
void WorldRun::show_proxies(const SessionSnapshot& snapshot) {
    struct News {
        std::uint64_t proxy;
        ProxyState state;
        ProxyPointer::BodyIds bodies;
    };
    std::vector<News> all;
    for (std::size_t i = 0; i < snapshot.proxy_count; ++i) {
        const ProxyState& state = snapshot.proxies[i];
        for (const ProxyLink& link : proxies_) {
            if (link.handle == state.handle) {
                all.push_back({link.node->get_instance_id(), state, body_ids(state)});
            }
        }
    }
    for (const News& news : all) {
        if (auto* proxy = Object::cast_to<ProxyPointer>(ObjectDB::get_instance(news.proxy))) {
            proxy->take_state(news.state, news.bodies);
        }
    }
}

std::vector<std::string> WorldRun::problems() const {
    std::vector<std::string> all = link_ != nullptr ? link_->problems() : std::vector<std::string>{};
    for (const auto& mirror : mirrors_) {
        const CollisionObject3D* body = mirror->body();
        for (const std::string& problem : mirror->problems()) {
            all.push_back((body != nullptr ? from_godot(name_of(*body)) : std::string("a body")) + ": " +
                          problem);
        }
    }
    for (const auto& joint : joints_) {
        if (joint->node() != nullptr && !joint->problem().empty()) {
            all.push_back(from_godot(name_of(*joint->node())) + ": " + joint->problem());
        }
    }
    return all;
}

}  // namespace tactus
