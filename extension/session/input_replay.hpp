// Plays a recording of a session's inputs (input_recorder.hpp): another session hears the same in the same
// ticks, and what comes of each is held against what came of it then.
//
// Any one thread, but the haptic one.
#pragma once

#include <array>
#include <cstdio>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "session/input_file.hpp"
#include "session/input_records.hpp"
#include "session/plain_commands.hpp"

namespace tactus {

class InputReplay {
public:
    struct Report {
        std::uint64_t ticks = 0;            // played
        std::uint64_t first_different = 0;  // the first tick that ended otherwise, from 1; 0: none has
        std::uint64_t lost = 0;             // ticks that were not recorded, after all others
        std::uint64_t outcome = 0;          // of all ticks
        std::string problem;                // why it ends where it does; empty: it is whole

        std::string outcome_text() const;
    };
    // A row that was written down then, in the first recording of rows there was; `epoch` is the zero of the
    // session's clock, since 1970.
    using TakeRow = std::function<void(const SessionRecord& row, Nanoseconds epoch)>;

    // The file stays the caller's, and open.
    explicit InputReplay(std::FILE* file, TakeRow take_row = {});
    ~InputReplay();

    // The next ticks; false where there are no more of them.
    bool play(std::uint64_t ticks);
    const Report& report() const { return report_; }
    // Of the last tick, on the session's clock.
    Nanoseconds now() const { return tick_.now; }
    // Null where not even its settings could be read.
    Session* session() { return session_.get(); }

private:
    class PlayedDevice;
    class PlayedLink;
    struct End;

    bool play_tick();
    bool next(HeardInput& input);
    void take_settings();
    void take_calls();
    void give_up(const std::string& why);
    void check(bool sound);

    void carry_out(const call::AddBody& c);
    void carry_out(const call::DeformBody& c);
    void carry_out(const call::NarrowTouch& c);
    void carry_out(const call::AddDevice& c);
    void carry_out(const call::AddProxy& c);
    void carry_out(const call::AddTool& c);
    void carry_out(const call::Record& c);
    void carry_out(const call::EndRecording& c);
    void carry_out(const call::Attach& c);
    void carry_out(const call::Announce& c);
    void carry_out(const call::Epoch& c);
    void carry_out(const call::WriteRows& c);
    void carry_out(const call::RowsWritten& c);
    void drain_rows();
    void carry_out(const command::AddJoint& c);
    void carry_out(const command::RemoveBody& c);
    template <PlainCommand Command>
    void carry_out(const Command& c) {
        ask(*session_, c);
    }

    void hear(const heard::Tick& h);
    void hear(const heard::Settle& h);
    void hear(const heard::Rest&);
    void hear(const heard::Reading& h);
    void hear(const heard::Abilities& h);
    void hear(const heard::Arrival& h);
    void hear(const heard::NotSent& h);
    void hear(const heard::Overhead& h);
    void hear(const heard::Settings& h);
    void hear(const heard::Binding& h);
    void hear(const heard::Announced& h);
    void hear(const heard::Withdrawn& h);
    void hear(const heard::Acknowledged& h);
    void hear(const heard::Done& h);
    End* end_of(std::uint32_t link);

    std::shared_ptr<const TouchShape> touched(const call::Form& form);
    ReadyBody prepared(const call::Form& form);
    void take_tree(std::uint64_t lineage, const PlacedShape& placed, TouchPart& part);

    // The tree of that number, as it was last.
    struct Lineage {
        std::shared_ptr<const TriangleMesh> mesh;
        std::shared_ptr<const TriangleTree> tree;
    };

    InputFileReader file_;
    TakeRow take_row_;
    Report report_;
    ValueReader ticks_{{}};  // what is left of the piece of the file
    bool is_over_ = false;
    bool has_ticked_ = false;  // since it was asked last

    std::array<std::unique_ptr<PlayedDevice>, max_devices> devices_;
    std::vector<std::unique_ptr<End>> ends_;
    std::vector<std::unique_ptr<RecorderRing<SessionRecord>>> rings_;
    std::unordered_map<std::uint64_t, Lineage> lineages_;
    // By handle, of bodies that can be narrowed.
    std::unordered_map<SessionHandle, std::shared_ptr<const TouchShape>> forms_;
    struct Rows {
        std::uint32_t ring = 0;
        std::uint64_t most = ~std::uint64_t{0}, taken = 0;
    };
    std::optional<Rows> rows_;  // that are written down
    Nanoseconds epoch_ = 0;
    heard::Tick tick_;
    std::unique_ptr<Session> session_;  // below what it uses
};

}  // namespace tactus
