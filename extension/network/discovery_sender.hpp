// Tells the far side which objects there are: each described once, in pieces, and again until it is
// acknowledged by the hash of its content (thesis 4.4.5).
//
// Belongs to whoever ticks. All memory is taken in the constructor; contents are prepared and destroyed off
// the loop.
#pragma once

#include <memory>
#include <vector>

#include "network/messages.hpp"

namespace tactus {

// The bytes of a description, ready to be sent. Made off the loop.
struct PreparedDiscovery {
    ObjectId object = no_object;
    ContentHash hash{};
    std::shared_ptr<const std::vector<std::byte>> content;  // null: nothing prepared

    explicit operator bool() const { return content != nullptr; }
};

// Off the loop. Empty where the description breaks a range.
PreparedDiscovery prepare_discovery(const ObjectDescription& description);
PreparedDiscovery prepare_discovery(const ObjectJoint& joint);

struct DiscoveryCounts {
    std::uint32_t waiting = 0;  // objects that are not acknowledged yet, and removals
    std::uint32_t known = 0;
    std::uint32_t refused = 0;  // the far side cannot build them
    std::uint32_t no_room = 0;  // the far side has no room for them
    // Objects that were there when the far side started, and of which it has acknowledged no description yet.
    std::uint32_t unanswered = 0;
    std::uint64_t pieces_sent = 0;  // repetitions included
};

class DiscoverySender {
public:
    explicit DiscoverySender(std::size_t max_objects = 4096) { entries_.reserve(max_objects); }

    // Describes a new object, or a known one anew. `prepared` comes back with what is to be destroyed off the
    // loop. False where there is no room. An id that was withdrawn may be described again: another object.
    bool announce(PreparedDiscovery& prepared);

    // The object is gone. What is to be destroyed off the loop is left in `released`.
    void withdraw(ObjectId object, std::shared_ptr<const std::vector<std::byte>>& released);

    // The far side has started anew and knows nothing.
    void restart();

    // True where the far side knows the object now as it was described last, and did not before.
    bool take(const DiscoveryAcknowledgement& acknowledgement);

    // How long after the last piece of an object it is sent again (unit: nanoseconds): longer than an answer
    // takes.
    void set_repeat_after(Nanoseconds span) { repeat_after_ = span; }

    // The next message that is due; false where none is. Points into a content. Call it a few times a tick.
    bool next(Nanoseconds now, Message& message);

    // Whether anything is to be told, now or after a while.
    bool has_more() const { return counts_.waiting + counts_.no_room > 0; }

    const DiscoveryCounts& counts() const { return counts_; }

private:
    enum class Progress : std::uint8_t { waiting, known, refused, no_room, removing };

    // Descriptions that are told at the same time: so few that the far side need not hold many incomplete
    // ones (unit: bytes).
    static constexpr std::size_t max_under_way = 4 << 20;

    struct Entry {
        PreparedDiscovery prepared;
        std::uint32_t revision = 0;
        Progress progress = Progress::waiting;
        std::uint32_t offset = 0;  // of the next piece
        Nanoseconds due = 0;
        std::size_t under_way = 0;  // its bytes while it is being told
        bool unanswered = false;    // see DiscoveryCounts
    };

    static bool waits(Progress progress) {
        return progress == Progress::waiting || progress == Progress::removing;
    }
    Entry* find(ObjectId object);
    bool may_be_told(const Entry& entry, Nanoseconds now) const;
    void stop_telling(Entry& entry);
    void note_answer(Entry& entry);
    void set_progress(Entry& entry, Progress progress);
    std::uint32_t& count_of(Progress progress);
    void drop(Entry& entry);
    void fill(Entry& entry, Nanoseconds now, Message& message);

    std::vector<Entry> entries_;
    std::size_t cursor_ = 0;
    std::uint32_t revision_ = 0;  // given last, of all objects
    Nanoseconds repeat_after_ = 200'000'000;
    std::size_t under_way_ = 0;  // of all entries
    DiscoveryCounts counts_;
};

}  // namespace tactus
