#include "network/discovery_sender.hpp"

#include <algorithm>

namespace tactus {
namespace {

// The far side may find room later.
constexpr Nanoseconds ask_again_for_room = 5 * nanoseconds_per_second;

}  // namespace

namespace {

PreparedDiscovery prepared(ObjectId object, std::vector<std::byte>&& bytes) {
    if (bytes.empty()) {
        return {};
    }
    const ContentHash hash = content_hash(bytes);
    return {object, hash, std::make_shared<const std::vector<std::byte>>(std::move(bytes))};
}

}  // namespace

PreparedDiscovery prepare_discovery(const ObjectDescription& description) {
    return prepared(description.object, encode_description(description));
}

PreparedDiscovery prepare_discovery(const ObjectJoint& joint) {
    return prepared(joint.object, encode_joint(joint));
}

bool DiscoverySender::announce(PreparedDiscovery& prepared) {
    Entry* entry = find(prepared.object);
    if (entry == nullptr) {
        if (entries_.size() == entries_.capacity()) {
            return false;
        }
        entry = &entries_.emplace_back();
        ++counts_.waiting;
    } else if (entry->prepared.hash == prepared.hash && entry->progress != Progress::removing) {
        return true;
    } else {
        set_progress(*entry, Progress::waiting);
    }
    stop_telling(*entry);
    std::swap(entry->prepared, prepared);
    entry->revision = ++revision_;
    entry->offset = 0;
    entry->due = 0;
    return true;
}

void DiscoverySender::withdraw(ObjectId object, std::shared_ptr<const std::vector<std::byte>>& released) {
    Entry* const entry = find(object);
    if (entry != nullptr && entry->progress != Progress::removing) {
        released = std::move(entry->prepared.content);
        note_answer(*entry);
        set_progress(*entry, Progress::removing);
        entry->revision = ++revision_;
        entry->due = 0;
    }
}

// A removal is settled with that: who has just started has nothing to remove.
void DiscoverySender::restart() {
    for (std::size_t i = entries_.size(); i-- > 0;) {
        Entry& entry = entries_[i];
        if (entry.progress == Progress::removing) {
            drop(entry);
        } else {
            set_progress(entry, Progress::waiting);
            counts_.unanswered += entry.unanswered ? 0 : 1;
            entry.unanswered = true;
            entry.offset = 0;
            entry.due = 0;
        }
    }
}

bool DiscoverySender::take(const DiscoveryAcknowledgement& acknowledgement) {
    Entry* entry = find(acknowledgement.object);
    if (entry == nullptr) {
        return false;
    }
    const bool removed = acknowledgement.verdict == DiscoveryVerdict::removed;
    if (!removed) {
        note_answer(*entry);
    }
    if (entry->prepared.hash != acknowledgement.hash) {
        return false;  // of an earlier description
    }
    if (entry->progress == Progress::removing) {
        if (removed) {
            drop(*entry);
        }
        return false;
    }
    const bool was_known = entry->progress == Progress::known;
    switch (acknowledgement.verdict) {
        case DiscoveryVerdict::known:
            set_progress(*entry, Progress::known);
            break;
        case DiscoveryVerdict::refused:
            set_progress(*entry, Progress::refused);
            break;
        case DiscoveryVerdict::no_room:
            set_progress(*entry, Progress::no_room);
            break;
        case DiscoveryVerdict::removed:
            break;  // answers a removal that is not meant any more
    }
    return entry->progress == Progress::known && !was_known;
}

bool DiscoverySender::next(Nanoseconds now, Message& message) {
    if (!has_more()) {
        return false;
    }
    for (std::size_t looked = 0; looked < entries_.size(); ++looked) {
        cursor_ = (cursor_ + 1) % entries_.size();
        Entry& entry = entries_[cursor_];
        if (may_be_told(entry, now)) {
            fill(entry, now, message);
            ++counts_.pieces_sent;
            return true;
        }
    }
    return false;
}

// Removals always; of descriptions only so many at once.
bool DiscoverySender::may_be_told(const Entry& entry, Nanoseconds now) const {
    if ((!waits(entry.progress) && entry.progress != Progress::no_room) || now < entry.due) {
        return false;
    }
    return entry.progress == Progress::removing || entry.under_way > 0 || under_way_ == 0 ||
           under_way_ + entry.prepared.content->size() <= max_under_way;
}

void DiscoverySender::stop_telling(Entry& entry) {
    under_way_ -= entry.under_way;
    entry.under_way = 0;
}

void DiscoverySender::note_answer(Entry& entry) {
    counts_.unanswered -= entry.unanswered ? 1 : 0;
    entry.unanswered = false;
}

void DiscoverySender::fill(Entry& entry, Nanoseconds now, Message& message) {
    const PreparedDiscovery& prepared = entry.prepared;
    if (entry.progress == Progress::removing) {
        message = ObjectRemoval{prepared.object, entry.revision, prepared.hash};
        entry.due = now + repeat_after_;
        return;
    }
    stop_telling(entry);
    entry.under_way = prepared.content->size();
    under_way_ += entry.under_way;
    const auto total = static_cast<std::uint32_t>(prepared.content->size());
    const auto size = std::min(static_cast<std::uint32_t>(max_fragment_bytes), total - entry.offset);
    message = DiscoveryFragment{prepared.object, entry.revision,
                                prepared.hash,   total,
                                entry.offset,    std::span(*prepared.content).subspan(entry.offset, size)};
    entry.offset += size;
    if (entry.offset == total) {
        entry.offset = 0;
        entry.due = now + (entry.progress == Progress::no_room ? ask_again_for_room : repeat_after_);
    }
}

DiscoverySender::Entry* DiscoverySender::find(ObjectId object) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [object](const Entry& entry) { return entry.prepared.object == object; });
    return found == entries_.end() ? nullptr : &*found;
}

std::uint32_t& DiscoverySender::count_of(Progress progress) {
    switch (progress) {
        case Progress::known:
            return counts_.known;
        case Progress::refused:
            return counts_.refused;
        case Progress::no_room:
            return counts_.no_room;
        default:
            return counts_.waiting;
    }
}

void DiscoverySender::set_progress(Entry& entry, Progress progress) {
    stop_telling(entry);
    --count_of(entry.progress);
    entry.progress = progress;
    ++count_of(progress);
}

void DiscoverySender::drop(Entry& entry) {
    stop_telling(entry);
    note_answer(entry);
    --count_of(entry.progress);
    if (&entry != &entries_.back()) {
        std::swap(entry, entries_.back());
    }
    entries_.pop_back();
}

}  // namespace tactus
