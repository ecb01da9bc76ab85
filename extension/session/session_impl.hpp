// What a session is made of: the owner's side, which hands out handles and sends commands, and the loop's,
// which carries them out.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "realtime/spsc_ring.hpp"
#include "realtime/triple_buffer.hpp"
#include "session/handle_pool.hpp"
#include "session/input_recorder.hpp"
#include "session/session.hpp"
#include "session/session_loop.hpp"

namespace tactus {

struct Session::Impl {
    Impl(const SessionSettings& s, InputRecorder* input_recorder);

    SessionHandle take_from(HandlePool& pool) { return pool.take(std::exchange(next_handle, no_handle)); }
    void note(const InputCall& call) {
        if (recorder) {
            recorder->note(call);
        }
    }
    void send(Command&& command);
    void send_backlog();
    bool is_hand(SessionHandle hand) const {
        return hand < max_proxies ? proxies.in_use(hand)
                                  : tools.in_use(static_cast<SessionHandle>(hand - max_proxies));
    }
    // The loop may let go of a guide's way, which frees nothing there: the owner has it until only it has.
    void keep_ways(const HandAids& aids);
    void forget_ways();
    // For a twin. Not where the body was prepared, on some other thread: a side may have been attached since.
    void make_second(ReadyBody& ready) const;
    void give_back(const Retired& remains);

    // Loop side. No more than a share of `most`, or exactly as many as were asked for.
    struct Taken {
        std::uint32_t commands = 0;
        bool all_it_may = false;
    };
    Taken take_commands(std::uint32_t most);

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
    std::vector<std::shared_ptr<const GuideWay>> ways;

    SessionHandle next_handle = no_handle;  // see Session::use_handle
    std::optional<std::uint32_t> exactly;   // see Session::take_exactly

private:
    void note_plain(const Command& command);
    Command* next_command();
    void carry_out(Command& command);
};

}  // namespace tactus
