#include "session/session.hpp"

#include <algorithm>
#include <cassert>
#include <type_traits>
#include <variant>

#include "realtime/thread_role.hpp"
#include "session/session_impl.hpp"

namespace tactus {

namespace {

constexpr std::size_t ring_capacity = 1024;

SessionSnapshot empty_snapshot(std::size_t max_bodies) {
    SessionSnapshot snapshot;
    snapshot.bodies.resize(max_bodies);
    return snapshot;
}

template <typename Command, typename... Calls>
constexpr bool is_one_of(const std::variant<Calls...>*) {
    return (std::is_same_v<Command, Calls> || ...);
}

// Commands that are not plain values.
using NotedByTheirSenders = std::variant<command::AddBody, command::DeformBody, command::NarrowTouch,
                                         command::AddDevice, command::AddProxy, command::AddTool,
                                         command::Record, command::EndRecording, command::Attach>;

// In commands of the least kind (SessionSettings::commands_per_tick).
std::uint32_t share_of_tick(const Command& command) {
    const auto* const body = std::get_if<command::AddBody>(&command);
    return body && body->motion == Motion::Dynamic ? 4 : 1;
}

}  // namespace

Session::Impl::Impl(const SessionSettings& s, InputRecorder* input_recorder)
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

// A command that is plain values is noted as it is, any other one by who sends it.
void Session::Impl::note_plain(const Command& command) {
    std::visit(
        [this](const auto& c) {
            using Asked = std::remove_cvref_t<decltype(c)>;
            if constexpr (is_one_of<Asked>(static_cast<const InputCall*>(nullptr))) {
                recorder->note(c);
            } else {
                static_assert(is_one_of<Asked>(static_cast<const NotedByTheirSenders*>(nullptr)),
                              "a recording would miss it: make it an InputCall, or note it where it is sent");
            }
        },
        command);
}

void Session::Impl::send(Command&& command) {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    if (recorder) {
        note_plain(command);
    }
    send_backlog();
    if (!backlog.empty() || !commands.try_push(std::move(command))) {
        backlog.push_back(std::move(command));
    }
}

void Session::Impl::send_backlog() {
    while (!backlog.empty() && commands.try_push(std::move(backlog.front()))) {
        backlog.pop_front();
    }
}

void Session::Impl::make_second(ReadyBody& ready) const {
    if (ready.body.ready() && has_twin) {
        ready.same_body = duplicate(ready.body);
    }
}

void Session::Impl::give_back(const Retired& remains) {
    switch (remains.kind) {
        case Retired::Kind::body:
            return bodies.give_back(remains.handle);
        case Retired::Kind::device:
            return devices.give_back(remains.handle);
        case Retired::Kind::proxy:
            return proxies.give_back(remains.handle);
        case Retired::Kind::tool:
            return tools.give_back(remains.handle);
        case Retired::Kind::joint:
            return joints.give_back(remains.handle);
        case Retired::Kind::form:
        case Retired::Kind::detail:
        case Retired::Kind::side:
            return;
    }
}

// Null: there is none, or what it leaves behind might find no room.
Command* Session::Impl::next_command() {
    return retired.size() + 1 < retired.capacity() ? commands.front() : nullptr;
}

void Session::Impl::carry_out(Command& command) {
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

void Session::Impl::keep_ways(const HandAids& aids) {
    for (std::size_t i = 0; i < aids.guide_count; ++i) {
        if (const auto& way = aids.guides[i].way; way && std::ranges::find(ways, way) == ways.end()) {
            ways.push_back(way);
        }
    }
}

// Where nothing else has it, nothing else can come to have it.
void Session::Impl::forget_ways() {
    std::erase_if(ways, [](const auto& way) { return way.use_count() == 1; });
}

Session::Impl::Taken Session::Impl::take_commands(std::uint32_t most) {
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

Session::Session(const SessionSettings& settings, InputRecorder* recorder)
    : impl_(std::make_unique<Impl>(settings, recorder)) {}
Session::~Session() = default;

const SessionSettings& Session::settings() const {
    return impl_->settings;
}

bool Session::record(RecorderRing<SessionRecord>& ring, SessionHandle hand, SessionHandle object) {
    if (std::ranges::find(impl_->recorded, &ring) == impl_->recorded.end()) {
        if (impl_->recorded.size() == max_recordings) {
            return false;
        }
        impl_->recorded.push_back(&ring);
    }
    if (impl_->recorder) {
        impl_->note(call::Record{impl_->recorder->number_of(&ring), hand, object});
    }
    impl_->send(command::Record{&ring, hand, object});
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
    assert((!impl_->has_twin || is_empty()) && "attach a side that replays before anything is added");
    impl_->hears_tools = side && side->hears_tools();
    impl_->send(command::Attach{std::move(side)});
}

void Session::attach(const std::vector<LinkEnd>& ends) {
    attach(make_side(settings(), impl_->recorder ? impl_->recorder->tap(ends) : ends));
}

bool Session::is_empty() const {
    const Impl& s = *impl_;
    return !s.bodies.any() && !s.devices.any() && !s.proxies.any() && !s.tools.any() && !s.joints.any();
}

bool Session::collect() {
    TACTUS_ASSERT_NOT_HAPTIC_THREAD();
    Retired remains;
    while (impl_->retired.try_pop(remains)) {
        impl_->give_back(remains);
        remains = {};
    }
    impl_->send_backlog();
    impl_->forget_ways();
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

TickStatus Session::tick(Nanoseconds now, TickTrace* trace, Nanoseconds late) {
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
            impl_->recorder->begin_tick({now, taken.commands, late});
        }
    }
    status |= impl_->loop.tick(now, trace, late);
    if (impl_->recorder) {
        impl_->recorder->end_tick(impl_->loop.outcome());
    }
    return status;
}

}  // namespace tactus
