// Every tick of one proxy, written to files: rows as CSV, and what each tick spent its time on as trace
// events. The loop puts rows into a ring; the owner drains it.
//
// Threads: all belongs to the session's owner, but for the ring, which says itself who calls what.
#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "realtime/recorder_ring.hpp"
#include "realtime/tick_trace.hpp"
#include "session/session_types.hpp"
#include "world/written_file.hpp"

namespace tactus {

struct RecordingFiles {
    std::string csv;    // path; empty: none
    std::string trace;  // likewise
    double trace_seconds = 15.0;
};

class Recording {
public:
    // Hears what goes wrong, each with what to do.
    using Say = std::function<void(const std::string&)>;
    using Ring = RecorderRing<SessionRecord>;

    // Makes the folders. Null where neither file can be written.
    static std::unique_ptr<Recording> open(const RecordingFiles& files, const Say& say);
    ~Recording() { close(); }
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    bool has_trace() const { return static_cast<bool>(trace_); }
    // The loop may still be writing into it when the recording has ended.
    const std::shared_ptr<Ring>& ring() const { return ring_; }

    // The trace is written, and files get nothing more.
    void close();
    bool is_open() const { return is_open_; }

    // `epoch`: the zero of the session's clock, on the clock whose microseconds the file shows.
    void drain(Nanoseconds epoch);
    void drain(TickTrace& trace);

    // Why a file is not whole; empty where all that was to be written is there.
    const std::string& problem() const { return problem_; }

    std::uint64_t rows() const { return rows_; }
    std::uint64_t lost() const { return lost_; }

private:
    Recording(const RecordingFiles& files, const Say& say);
    void complain(const std::string& what);  // empty: nothing

    double trace_seconds_;
    Say say_;
    std::shared_ptr<Ring> ring_;
    WrittenFile csv_;
    WrittenFile trace_;
    std::string text_;
    std::vector<TickRecord> ticks_;
    std::string problem_;
    bool is_open_ = true;
    std::uint64_t rows_ = 0;
    std::uint64_t lost_ = 0;
};

}  // namespace tactus
