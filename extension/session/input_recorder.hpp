// Keeps all that enters a session, so that it can be played again to the same bits (input_replay.hpp).
//
// Threads: the owner's half belongs to the session's owner, the loop's half to who ticks. What the loop hears
// goes into a ring; a tick that finds no room in it is lost, and with it all that follow, since they depend
// on it: they are counted. The loop allocates nothing and waits for nobody.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "realtime/byte_ring.hpp"
#include "session/input_records.hpp"

namespace tactus {

class InputRecorder {
public:
    // Of the ring: many seconds of what a hand and a link say (unit: bytes).
    static constexpr std::size_t usual_room = std::size_t{16} << 20;

    explicit InputRecorder(std::size_t room = usual_room);
    ~InputRecorder();
    InputRecorder(const InputRecorder&) = delete;
    InputRecorder& operator=(const InputRecorder&) = delete;

    // --- owner

    void note(const InputCall& call);
    // What the session is told through these ends is heard from now on: a side has to be made of what comes
    // back, which belongs to the recorder.
    std::vector<LinkEnd> tap(const std::vector<LinkEnd>& ends);
    std::uint32_t number_of(const void* ring);

    // Moves what has been noted since the last time to the end of both. Whatever these ticks have taken is in
    // the calls of this time or an earlier one.
    void drain(std::vector<std::byte>& calls, std::vector<std::byte>& ticks);
    // Ticks that found no room, and all after them.
    std::uint64_t lost_ticks() const { return lost_.load(std::memory_order_relaxed); }

    // --- loop

    void begin_tick(const heard::Tick& tick);
    void note_reading(SessionHandle device, const DeviceSample& sample,
                      const DeviceCapabilities& capabilities);
    void end_tick(std::uint64_t outcome);
    void note_between_ticks(const HeardInput& input);

private:
    class LinkTap;

    template <typename Heard>
    void put(const Heard& heard);
    void append(const void* from, std::size_t size) { fits_ = fits_ && ring_.append(from, size); }
    void close();

    ByteSink calls_;
    std::vector<const void*> rings_;
    std::vector<std::unique_ptr<LinkTap>> taps_;

    ByteRing ring_;
    bool fits_ = true;
    std::array<DeviceCapabilities, max_devices> capabilities_{};
    std::atomic<std::uint64_t> lost_{0};
};

}  // namespace tactus
