// Recordings that somebody else has made, cut, mended or damaged: of a session's inputs, as bytes of a file
// and as whole pieces of which the hashes are right, and of a device.
#include <cstdio>
#include <functional>
#include <memory>

#include "devices/device_recording.hpp"
#include "fuzz_target.hpp"
#include "network/memory_link.hpp"
#include "session/environment_teller.hpp"
#include "session/input_recorder.hpp"
#include "session/input_replay.hpp"
#include "session/model_builder.hpp"
#include "session/side_plan.hpp"
#include "shared/endpoints.hpp"
#include "shared/meshes.hpp"
#include "small_session.hpp"

namespace tactus::fuzz {
namespace {

enum Kind : std::uint8_t { file, pieces, device, count };

constexpr std::uint64_t most_ticks = 64;

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using MemoryFile = std::unique_ptr<std::FILE, CloseFile>;

MemoryFile reading(std::span<const std::byte> bytes) {
    // It reads only; of nothing there is no file.
    return MemoryFile(bytes.empty() ? std::tmpfile()
                                    : fmemopen(const_cast<std::byte*>(bytes.data()), bytes.size(), "rb"));
}

void play_file(std::span<const std::byte> bytes) {
    const MemoryFile memory = reading(bytes);
    InputReplay replay(memory.get());
    const bool goes_on = replay.play(most_ticks);
    must(replay.report().ticks <= most_ticks, "no more is played than was asked for");
    must(goes_on == (replay.report().ticks == most_ticks), "it says when it is over");
}

using Write = std::function<void(std::FILE*)>;
Bytes written_by(const Write& write) {
    char* text = nullptr;
    std::size_t size = 0;
    write(MemoryFile(open_memstream(&text, &size)).get());
    const auto* const begin = reinterpret_cast<const std::byte*>(text);
    Bytes bytes(begin, begin + size);
    std::free(text);
    return bytes;
}

// Kind, length in two bytes, content: as if each had been sealed by who knows how.
Bytes file_of(Numbers numbers) {
    return written_by([&numbers](std::FILE* memory) {
        write_input_head(memory);
        while (!numbers.is_over()) {
            const auto kind = static_cast<InputPiece>(numbers.byte());
            write_input_piece(memory, kind, numbers.bytes(numbers.integer<std::uint16_t>()));
        }
    });
}

void read_device(std::span<const std::byte> bytes) {
    const MemoryFile memory = reading(bytes);
    const DeviceRecording read = read_device_recording(memory.get());
    must(read.error.empty() || read.samples.empty(), "what is not understood gives no samples");
}

}  // namespace

void play(std::span<const std::byte> input) {
    Numbers numbers(input);
    switch (numbers.byte() % Kind::count) {
        case file:
            return play_file(numbers.rest());
        case pieces:
            return play_file(file_of(numbers));
        default:
            return read_device(numbers.rest());
    }
}

// --- recordings to begin with

namespace {

constexpr Nanoseconds period = 1'000'000;

class HeldDevice final : public Device {
public:
    DeviceSample read(Nanoseconds) override { return {position, {1.0, 0.0, 0.0, 0.0}, Vec3(0.0), 0, true}; }
    void write(Nanoseconds, const Vec3&) override {}
    Vec3 position{0.0, 0.2, 0.0};
};

BodyAddition body(const Shape& shape, const Vec3& place, Motion motion) {
    BodyAddition addition;
    addition.description.shapes = {PlacedShape{shape, Pose{}}};
    addition.description.pose.position = place;
    addition.description.motion = motion;
    return addition;
}

// A place whose inputs are recorded, in both forms.
struct Recorded {
    Recorded() {
        ByteSink sink;
        ValueWriter writer(sink);
        const SessionSettings settings = small_session(16, 32);
        pass(writer, settings);
        put(InputPiece::settings, sink.bytes());
    }
    void add_hand() {
        Workspace workspace;
        workspace.force_limit = 10.0;
        ProxyDescription pointer;
        pointer.device = session.add_device(device, workspace).handle;
        session.add_proxy(pointer);
    }
    void tick() {
        session.tick(now += period);
        session.collect();
        session.refresh();
        port->statistics.refresh();
    }
    void put(InputPiece kind, const std::vector<std::byte>& content) {
        written.push_back(static_cast<std::byte>(kind));
        written.push_back(static_cast<std::byte>(content.size()));
        written.push_back(static_cast<std::byte>(content.size() >> 8u));
        written.insert(written.end(), content.begin(), content.end());
    }
    void drain() {
        std::vector<std::byte> calls, ticks;
        recorder.drain(calls, ticks);
        put(InputPiece::calls, calls);
        put(InputPiece::ticks, ticks);
    }
    Bytes end() {
        drain();
        put(InputPiece::end, std::vector<std::byte>(8));
        return written;
    }

    HeldDevice device;
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    InputRecorder recorder{1 << 20};
    Session session{small_session(16, 32), &recorder};
    Nanoseconds now = 0;
    Bytes written;
};

Bytes touch() {
    Recorded place;
    place.add_hand();
    place.session.add_body(body(PlaneShape{}, Vec3(0.0), Motion::Static));
    const auto box =
        place.session.add_body(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic)).handle;
    const auto ball = std::make_shared<const TriangleMesh>(shared::icosphere(0, 0.05));
    place.session.add_body(body(MeshShape{ball}, {0.2, 0.05, 0.0}, Motion::Dynamic));
    place.session.add_joint({}, box, no_handle);
    for (int i = 0; i < 8; ++i) {
        place.device.position.y -= 0.012;
        place.tick();
    }
    place.session.teleport_body(box, {{0.1, 0.3, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    place.tick();
    return place.end();
}

// The two sides of a link that has just met.
std::vector<Bytes> linked() {
    MemoryLinkPair wire(64);
    Recorded near, far;
    OperatorRoom room;
    room.max_tracked = 8;
    room.samples = 64;
    room.memento_bytes = 1 << 14;
    near.session.attach(
        {{{SidePlan::Kind::operator_side, {}, shared::endpoint(Side::operator_side, 1), room, {}},
          &wire.first(),
          near.port}});
    far.session.attach(
        {{{SidePlan::Kind::environment, {}, shared::endpoint(Side::teleoperator_side, 2), {}, {}},
          &wire.second(),
          far.port}});
    near.add_hand();
    far.add_hand();
    const BodyAddition box = body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic);
    EnvironmentTeller teller(far.port);
    teller.tell(far.session.add_body(box).handle, "Box", box);
    ModelBuilder builder(near.session, near.port);
    for (int i = 0; i < 24; ++i) {
        near.tick();
        far.tick();
        builder.update(near.now, near.port->statistics.front().link);
        teller.update(far.session.snapshot(), far.port->statistics.front().link.peer_epoch);
    }
    return {near.end(), far.end()};
}

}  // namespace

std::vector<Bytes> seeds() {
    constexpr DeviceSample samples[] = {{Vec3(0.1), {1.0, 0.0, 0.0, 0.0}, Vec3(0.2), 3, true}, {}};
    std::vector<Bytes> all{
        of_kind(device, written_by([&](std::FILE* memory) { write_device_recording(memory, samples); }))};
    std::vector<Bytes> recorded = linked();
    recorded.push_back(touch());
    for (const Bytes& one : recorded) {
        all.push_back(of_kind(pieces, one));
        all.push_back(of_kind(file, file_of(Numbers(one))));
    }
    return all;
}

}  // namespace tactus::fuzz
