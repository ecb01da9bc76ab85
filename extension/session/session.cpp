#include "session/session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>

#include "physics/limits.hpp"
#include "realtime/spsc_ring.hpp"
#include "realtime/thread_role.hpp"
#include "realtime/triple_buffer.hpp"
#include "session/handle_pool.hpp"
#include "session/input_recorder.hpp"
#include "session/request_checks.hpp"
#include "session/session_loop.hpp"

namespace tactus {

namespace {

constexpr std::size_t ring_capacity = 1024;

// The longest way that a body can be told (unit: seconds).
constexpr double max_seconds = 1e5;

SessionSnapshot empty_snapshot(std::size_t max_bodies) {
    SessionSnapshot snapshot;
    snapshot.bodies.resize(max_bodies);
    return snapshot;
}

TouchMaterial with_detail(TouchMaterial material, const TouchDetail* detail) {
    material.detail = detail;
    return material;
}

template <typename Command, typename... Calls>
constexpr bool is_one_of(const std::variant<Calls...>*) {
    return (std::is_same_v<Command, Calls> || ...);
}

// In commands of the least kind (SessionSettings::commands_per_tick).
std::uint32_t share_of_tick(const Command& command) {
    const auto* const body = std::get_if<command::AddBody>(&command);
    return body && body->motion == Motion::Dynamic ? 4 : 1;
}

}  // namespace

struct Session::Impl {
    Impl(const SessionSettings& s, InputRecorder* input_recorder)
        : settings(s),
          recorder(input_recorder),
          snapshots(empty_snapshot(s.max_bodies)),
          commands(ring_capacity),
          retired(ring_capacity),
          loop(s, snapshots, input_recorder),
          bodies(s.max_bodies),
          devices(max_devices),
          proxies(max_proxies),
          tools(max_tools),
          joints(s.physics.max_joints) {}

    SessionHandle take_from(HandlePool& pool) { return pool.take(std::exchange(next_handle, no_handle)); }

    void note(const InputCall& call) {
        if (recorder) {
            recorder->note(call);
        }
    }
    // A command that is plain values is noted as it is, any other one by who sends it.
    using NotedByTheirSenders = std::variant<command::AddBody, command::DeformBody, command::NarrowTouch,
                                             command::AddDevice, command::AddProxy, command::AddTool,
                                             command::Record, command::EndRecording, command::Attach>;
    void note_plain(const Command& command) {
        std::visit(
            [this](const auto& c) {
                using Asked = std::remove_cvref_t<decltype(c)>;
                if constexpr (is_one_of<Asked>(static_cast<const InputCall*>(nullptr))) {
                    recorder->note(c);
                } else {
                    static_assert(
                        is_one_of<Asked>(static_cast<const NotedByTheirSenders*>(nullptr)),
                        "a recording would miss it: make it an InputCall, or note it where it is sent");
                }
            },
            command);
    }

    void send(Command&& command) {
        TACTUS_ASSERT_NOT_HAPTIC_THREAD();
        if (recorder) {
            note_plain(command);
        }
        send_backlog();
        if (!backlog.empty() || !commands.try_push(std::move(command))) {
            backlog.push_back(std::move(command));
        }
    }

    void send_backlog() {
        while (!backlog.empty() && commands.try_push(std::move(backlog.front()))) {
            backlog.pop_front();
        }
    }

    // For a twin. Not where the body was prepared, on some other thread: a side may have been attached since.
    void make_second(ReadyBody& ready) const {
        if (ready.body.ready() && has_twin) {
            ready.same_body = duplicate(ready.body);
        }
    }

    // Loop side. The next command; null: there is none, or what it leaves behind might find no room.
    Command* next_command() { return retired.size() + 1 < retired.capacity() ? commands.front() : nullptr; }

    void carry_out(Command& command) {
        Retired remains;
        if (SessionLoop* const twin = loop.twin()) {
            Command same;
            twin->follow(loop, command);
            if (duplicate(command, same) && twin->take(same, remains)) {
                remains.handle = no_handle;  // given back once, by the loop itself
                retired.try_push(std::move(remains));
                remains = {};
            }
        }
        if (loop.take(command, remains)) {
            retired.try_push(std::move(remains));
        }
        commands.pop();
    }

    // Loop side. No more than a share of `most`, or exactly as many as were asked for.
    struct Taken {
        std::uint32_t commands = 0;
        bool all_it_may = false;
    };
    Taken take_commands(std::uint32_t most) {
        Taken taken;
        std::uint32_t share = 0;
        while (exactly ? taken.commands < *exactly : share < most) {
            Command* const command = next_command();
            if (!command) {
                break;
            }
            share += share_of_tick(*command);
            carry_out(*command);
            ++taken.commands;
        }
        taken.all_it_may = share >= most;
        return taken;
    }

    const SessionSettings settings;
    InputRecorder* const recorder;  // null: nobody records
    TripleBuffer<SessionSnapshot> snapshots;
    SpscRing<Command> commands;
    SpscRing<Retired> retired;
    SessionLoop loop;

    HandlePool bodies, devices, proxies, tools, joints;
    std::array<std::shared_ptr<const ToolShape>, max_tools> tool_shapes;  // by handle
    bool has_twin = false;     // the side that was attached last has one
    bool hears_tools = false;  // likewise, see TeleopSide
    std::vector<RecorderRing<SessionRecord>*> recorded;
    std::deque<Command> backlog;

    SessionHandle next_handle = no_handle;  // see Session::use_handle
    std::optional<std::uint32_t> exactly;   // see Session::take_exactly
};

Session::Session(const SessionSettings& settings, InputRecorder* recorder)
    : impl_(std::make_unique<Impl>(settings, recorder)) {}
Session::~Session() = default;

const SessionSettings& Session::settings() const {
    return impl_->settings;
}

ReadyBody Session::prepare_body(const BodyAddition& addition, const ParallelRunner& run) {
    ReadyBody ready;
    ready.error = check_feel(addition.touch_material, addition.detail.get());
    if (!ready.error.empty()) {
        return ready;
    }
    BodyDescription description = addition.description;
    if (addition.soft) {
        ready.soft =
            std::make_shared<SoftSlot>(addition.soft, addition.soft_view, description.collision.mask, run);
        ready.touch = {ready.soft, &ready.soft->form()};
        // The rigid world has it as a place alone.
        description.shapes = {{SphereShape{std::max(1e-3, 0.5 * addition.soft->size)}, {}}};
        description.collision = {0, 0};
        description.motion = Motion::Static;
        description.may_move = false;
    } else {
        ready.touch = addition.touch;
    }
    if (!ready.touch) {
        const auto& touched =
            addition.touch_shapes.empty() ? addition.description.shapes : addition.touch_shapes;
        TouchShapeResult touch = make_touch_shape(touched, run);
        ready.touch = std::move(touch.shape);
        ready.error = std::move(touch.error);
    }
    if (!ready.error.empty()) {
        return ready;
    }
    ready.body = prepare(description);
    ready.error = ready.body.error();
    ready.material = with_detail(addition.touch_material, addition.detail.get());
    ready.detail = addition.detail;
    ready.layer = addition.description.collision.layer;
    ready.pose = addition.description.pose;
    ready.motion = description.motion;
    ready.source = addition;
    return ready;
}

AddResult Session::add_body(ReadyBody&& body, const FormerBody& former) {
    if (!body.error.empty()) {
        return {no_handle, std::move(body.error)};
    }
    const double tick = to_seconds(impl_->settings.period);
    if (body.soft && std::abs(body.soft->body.model().design.seconds - tick) > 1e-6 * tick) {
        return {no_handle, "the body that gives was made for ticks of another length: make it anew"};
    }
    impl_->make_second(body);
    const SessionHandle handle = impl_->take_from(impl_->bodies);
    if (handle == no_handle) {
        return {no_handle, "the world already holds its limit of " +
                               std::to_string(impl_->settings.max_bodies) +
                               " bodies: raise the limit or remove some"};
    }
    if (impl_->recorder) {
        impl_->note(call::AddBody{handle, call::Form::of(body), former});
    }
    impl_->send(command::AddBody{handle, std::move(body.body), std::move(body.same_body),
                                 std::move(body.touch), body.material, std::move(body.detail), body.layer,
                                 body.pose, body.motion, former, std::move(body.soft)});
    return {handle, {}};
}

void Session::remove_body(SessionHandle body) {
    if (impl_->bodies.let_go(body)) {
        impl_->send(command::RemoveBody{body});
    }
}

std::string Session::deform_body(SessionHandle body, ReadyBody&& form) {
    if (form.error.empty() && impl_->bodies.in_use(body)) {
        impl_->make_second(form);
        if (impl_->recorder) {
            impl_->note(call::DeformBody{body, call::Form::of(form)});
        }
        impl_->send(command::DeformBody{body, std::move(form.body), std::move(form.same_body),
                                        std::move(form.touch)});
    }
    return std::move(form.error);
}

void Session::narrow_touch(SessionHandle body, std::shared_ptr<const TouchShape> shape, double radius) {
    if (shape && impl_->bodies.in_use(body) && is_proxy_radius(radius)) {
        impl_->note(call::NarrowTouch{body, radius});
        impl_->send(command::NarrowTouch{body, std::move(shape)});
    }
}

void Session::teleport_body(SessionHandle body, const Pose& pose) {
    if (limits::is_pose(pose)) {
        impl_->send(command::TeleportBody{body, pose});
    }
}

void Session::move_body(SessionHandle body, const Pose& pose, double seconds) {
    if (limits::is_pose(pose) && std::abs(seconds) <= max_seconds) {
        impl_->send(command::MoveBody{body, pose, seconds});
    }
}

void Session::set_body_velocity(SessionHandle body, const Vec3& linear, const Vec3& angular) {
    impl_->send(command::SetBodyVelocity{body, linear, angular});
}

void Session::set_touch_material(SessionHandle body, const TouchMaterial& material,
                                 std::shared_ptr<const TouchDetail> detail) {
    if (check_feel(material, detail.get()).empty()) {
        const TouchMaterial complete = with_detail(material, detail.get());
        impl_->send(command::SetTouchMaterial{body, complete, std::move(detail)});
    }
}

void Session::set_body_layers(SessionHandle body, const CollisionLayers& layers) {
    impl_->send(command::SetBodyLayers{body, layers});
}

void Session::set_body_motion(SessionHandle body, Motion motion) {
    impl_->send(command::SetBodyMotion{body, motion});
}

void Session::set_body_surface(SessionHandle body, const SurfaceMaterial& surface) {
    impl_->send(command::SetBodySurface{body, surface});
}

void Session::set_body_gravity_scale(SessionHandle body, double scale) {
    impl_->send(command::SetBodyGravityScale{body, scale});
}

void Session::set_body_damping(SessionHandle body, double linear, double angular) {
    impl_->send(command::SetBodyDamping{body, linear, angular});
}

void Session::set_body_push(SessionHandle body, const Vec3& force, const Vec3& torque) {
    if (limits::is_number(force) && limits::is_number(torque)) {
        impl_->send(command::SetBodyPush{body, force, torque});
    }
}

void Session::see_body(SessionHandle body, const BodySighting& sighting) {
    const BodyMotion& motion = sighting.motion;
    if (is_sound(sighting.doubt) && limits::is_pose(motion.pose) && sighting.age >= 0.0 &&
        limits::is_number(motion.linear_velocity) && limits::is_number(motion.angular_velocity)) {
        impl_->send(command::SeeBody{body, sighting});
    }
}

AddResult Session::add_joint(const JointDescription& joint, SessionHandle first, SessionHandle second) {
    if (std::string error = wrong_in(joint); !error.empty()) {
        return {no_handle, std::move(error)};
    }
    if (first == second) {
        return {no_handle, "the joint joins a body with itself, or nothing at all: name two different ones"};
    }
    const SessionHandle handle = impl_->take_from(impl_->joints);
    if (handle == no_handle) {
        return {no_handle, "a world takes at most " + std::to_string(impl_->settings.physics.max_joints) +
                               " joints: remove one"};
    }
    impl_->send(command::AddJoint{handle, joint, first, second});
    return {handle, {}};
}

void Session::remove_joint(SessionHandle joint) {
    if (impl_->joints.let_go(joint)) {
        impl_->send(command::RemoveJoint{joint});
    }
}

void Session::push_body(SessionHandle body, const BodyPush& push) {
    impl_->send(command::PushBody{body, push});
}
void Session::set_gravity(const Vec3& gravity) {
    impl_->send(command::SetGravity{gravity});
}

AddResult Session::add_device(Device& device, const Workspace& workspace) {
    if (std::string error = check_workspace(workspace); !error.empty()) {
        return {no_handle, std::move(error)};
    }
    const SessionHandle handle = impl_->take_from(impl_->devices);
    if (handle == no_handle) {
        return {no_handle, "a world takes at most " + std::to_string(max_devices) + " devices: remove one"};
    }
    impl_->note(call::AddDevice{handle, workspace});
    impl_->send(command::AddDevice{handle, &device, workspace});
    return {handle, {}};
}

void Session::set_workspace(SessionHandle device, const Workspace& workspace) {
    if (impl_->devices.in_use(device) && check_workspace(workspace).empty()) {
        impl_->send(command::SetWorkspace{device, workspace});
    }
}

void Session::remove_device(SessionHandle device) {
    if (impl_->devices.let_go(device)) {
        impl_->send(command::RemoveDevice{device});
    }
}

AddResult Session::add_proxy(const ProxyDescription& description) {
    if (std::string error = check_proxy(description); !error.empty()) {
        return {no_handle, std::move(error)};
    }
    const SessionHandle handle = impl_->take_from(impl_->proxies);
    if (handle == no_handle) {
        return {no_handle, "a world takes at most " + std::to_string(max_proxies) + " proxies: remove one"};
    }
    const auto make = [&] {
        return std::make_unique<Proxy>(impl_->settings.max_parts, description.settings);
    };
    impl_->note(call::AddProxy{handle, description});
    impl_->send(command::AddProxy{handle, make(), impl_->has_twin ? make() : nullptr, description});
    return {handle, {}};
}

void Session::set_proxy(SessionHandle proxy, const ProxyDescription& description) {
    if (impl_->proxies.in_use(proxy) && check_proxy(description).empty()) {
        impl_->send(command::SetProxy{proxy, description});
    }
}

void Session::set_hand_field(SessionHandle proxy, const FieldMoment& moment) {
    constexpr double strongest = 1e6;  // (unit: newtons)
    constexpr double steepest = 1e12;  // (units: newtons per meter, newton seconds per meter)
    const auto is_within = [](const Vec3& v, double most) { return glm::length(v) <= most; };
    const auto is_slope = [&](const Mat3& slope) {
        return is_within(slope[0], steepest) && is_within(slope[1], steepest) &&
               is_within(slope[2], steepest);
    };
    if (impl_->proxies.in_use(proxy) && limits::is_place(moment.place) &&
        is_within(moment.velocity, limits::fastest) && is_within(moment.force, strongest) &&
        is_slope(moment.by_place) && is_slope(moment.by_velocity)) {
        impl_->send(command::SetField{proxy, moment});
    }
}

void Session::remove_proxy(SessionHandle proxy) {
    if (impl_->proxies.let_go(proxy)) {
        impl_->send(command::RemoveProxy{proxy});
    }
}

AddResult Session::add_tool(std::shared_ptr<const ToolShape> shape, const ToolUse& use) {
    if (shape == nullptr) {
        return {no_handle, "the tool has no shape: give it a closed mesh"};
    }
    if (std::string error = check_tool(use); !error.empty()) {
        return {no_handle, std::move(error)};
    }
    const SessionHandle handle = impl_->take_from(impl_->tools);
    if (handle == no_handle) {
        return {no_handle, "a world takes at most " + std::to_string(max_tools) + " tools: remove one"};
    }
    impl_->note(call::AddTool{handle, shape, use});
    const auto make = [&] {
        auto slot = std::make_unique<ToolSlot>(shape, impl_->settings.max_parts, use);
        for (SessionHandle other = 0; other < max_tools; ++other) {
            if (other != handle && impl_->tools.in_use(other)) {
                slot->pairs[other] = ToolPair::make(impl_->tool_shapes[other], shape);
                if (slot->pairs[other] && !slot->group) {
                    slot->group = std::make_unique<ToolGroup>();
                }
            }
        }
        return slot;
    };
    command::AddTool add{handle, make(), impl_->has_twin ? make() : nullptr};
    if (impl_->hears_tools) {
        add.tool->heard = std::make_unique<JitterBuffer<OperatorSample>>();
    }
    impl_->send(std::move(add));
    impl_->tool_shapes[handle] = std::move(shape);
    return {handle, {}};
}

void Session::set_tool(SessionHandle tool, const ToolUse& use) {
    if (impl_->tools.in_use(tool) && check_tool(use).empty()) {
        impl_->send(command::SetTool{tool, use});
    }
}

void Session::remove_tool(SessionHandle tool) {
    if (impl_->tools.let_go(tool)) {
        impl_->tool_shapes[tool].reset();
        impl_->send(command::RemoveTool{tool});
    }
}

bool Session::record(RecorderRing<SessionRecord>& ring, SessionHandle proxy, SessionHandle object) {
    if (std::ranges::find(impl_->recorded, &ring) == impl_->recorded.end()) {
        if (impl_->recorded.size() == max_recordings) {
            return false;
        }
        impl_->recorded.push_back(&ring);
    }
    if (impl_->recorder) {
        impl_->note(call::Record{impl_->recorder->number_of(&ring), proxy, object});
    }
    impl_->send(command::Record{&ring, proxy, object});
    return true;
}

void Session::end_recording(RecorderRing<SessionRecord>& ring) {
    if (std::erase(impl_->recorded, &ring) > 0) {
        if (impl_->recorder) {
            impl_->note(call::EndRecording{impl_->recorder->number_of(&ring)});
        }
        impl_->send(command::EndRecording{&ring});
    }
}

void Session::attach(std::unique_ptr<TeleopSide> side) {
    impl_->has_twin = side && side->twin();
    impl_->hears_tools = side && side->hears_tools();
    impl_->send(command::Attach{std::move(side)});
}

void Session::attach(const std::vector<LinkEnd>& ends) {
    attach(make_side(settings(), impl_->recorder ? impl_->recorder->tap(ends) : ends));
}

bool Session::collect() {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    Retired remains;
    while (impl_->retired.try_pop(remains)) {
        switch (remains.kind) {
            case Retired::Kind::body:
                impl_->bodies.give_back(remains.handle);
                break;
            case Retired::Kind::device:
                impl_->devices.give_back(remains.handle);
                break;
            case Retired::Kind::proxy:
                impl_->proxies.give_back(remains.handle);
                break;
            case Retired::Kind::tool:
                impl_->tools.give_back(remains.handle);
                break;
            case Retired::Kind::joint:
                impl_->joints.give_back(remains.handle);
                break;
            case Retired::Kind::form:
            case Retired::Kind::detail:
            case Retired::Kind::side:
                break;
        }
        remains = {};
    }
    impl_->send_backlog();
    return !impl_->backlog.empty() || impl_->commands.size() > 0;
}

bool Session::refresh() {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    return impl_->snapshots.refresh();
}
const SessionSnapshot& Session::snapshot() const {
    return impl_->snapshots.front();
}
std::size_t Session::backlog() const {
    return impl_->backlog.size();
}

void Session::settle() {
    std::uint32_t taken = 0;
    const std::optional<std::uint32_t> wanted = impl_->exactly;
    bool has_more = true;
    while (has_more && !(wanted && taken == *wanted)) {
        {
            const HapticRole loop_side;
            impl_->exactly = wanted ? std::optional(*wanted - taken) : std::nullopt;
            taken += impl_->take_commands(0xffff'ffffu).commands;
        }
        has_more = collect();
    }
    impl_->exactly.reset();
    const HapticRole loop_side;
    impl_->loop.settle();
    if (impl_->recorder) {
        impl_->recorder->note_between_ticks(heard::Settle{taken});
    }
}

void Session::use_handle(SessionHandle handle) {
    impl_->next_handle = handle;
}

void Session::take_exactly(std::uint32_t commands) {
    impl_->exactly = commands;
}

std::uint64_t Session::outcome() const {
    return impl_->loop.outcome();
}

void Session::rest() {
    const HapticRole loop_side;
    impl_->loop.rest();
    if (impl_->recorder) {
        impl_->recorder->note_between_ticks(heard::Rest{});
    }
}

TickStatus Session::tick(Nanoseconds now, TickTrace* trace) {
    const HapticRole loop_side;
    TickStatus status = 0;
    {
        const TraceScope scope(trace, TickStage::take_commands);
        const Impl::Taken taken = impl_->take_commands(impl_->settings.commands_per_tick);
        impl_->exactly.reset();
        if (taken.all_it_may) {
            status |= session_commands_waiting;
        }
        if (impl_->recorder) {
            impl_->recorder->begin_tick(now, taken.commands);
        }
    }
    status |= impl_->loop.tick(now, trace);
    if (impl_->recorder) {
        impl_->recorder->end_tick(impl_->loop.outcome());
    }
    return status;
}

}  // namespace tactus
