#include "network/discovery_receiver.hpp"

#include <algorithm>
#include <cstring>

namespace tactus {
namespace {

constexpr std::size_t most_removals_remembered = 65'536;

}  // namespace

DiscoveryReceiver::DiscoveryReceiver(const DiscoverySettings& settings)
    : settings_(settings), pieces_(settings.pieces_waiting), acknowledgements_(settings.pieces_waiting) {}

bool DiscoveryReceiver::put(const DiscoveryFragment& fragment) {
    Piece piece;
    piece.kind = Piece::Kind::fragment;
    piece.object = fragment.object;
    piece.revision = fragment.revision;
    piece.hash = fragment.hash;
    piece.total_bytes = fragment.total_bytes;
    piece.offset = fragment.offset;
    piece.size = static_cast<std::uint32_t>(fragment.bytes.size());
    std::memcpy(piece.bytes.data(), fragment.bytes.data(), fragment.bytes.size());
    return pieces_.try_push(piece);
}

bool DiscoveryReceiver::put(const ObjectRemoval& removal) {
    Piece piece;
    piece.kind = Piece::Kind::removal;
    piece.object = removal.object;
    piece.revision = removal.revision;
    piece.hash = removal.hash;
    return pieces_.try_push(piece);
}

bool DiscoveryReceiver::put_restart() {
    Piece piece;
    piece.kind = Piece::Kind::restart;
    return pieces_.try_push(piece);
}

bool DiscoveryReceiver::next_acknowledgement(DiscoveryAcknowledgement& acknowledgement) {
    return acknowledgements_.try_pop(acknowledgement);
}

std::optional<DiscoveryEvent> DiscoveryReceiver::next(Nanoseconds now) {
    while (const Piece* piece = pieces_.front()) {
        std::optional<DiscoveryEvent> event = take(*piece, now);
        pieces_.pop();
        if (event) {
            return event;
        }
    }
    return std::nullopt;
}

std::optional<DiscoveryEvent> DiscoveryReceiver::take(const Piece& piece, Nanoseconds now) {
    switch (piece.kind) {
        case Piece::Kind::fragment:
            ++counts_.pieces;
            return take_fragment(piece, now);
        case Piece::Kind::removal:
            return remove(piece);
        case Piece::Kind::restart:
            break;
    }
    objects_.clear();
    removed_.clear();
    incomplete_bytes_ = 0;
    return DiscoveryEvent{DiscoveryEvent::Kind::restarted, no_object, {}};
}

std::optional<DiscoveryEvent> DiscoveryReceiver::take_fragment(const Piece& piece, Nanoseconds now) {
    Object* object = object_for(piece, now);
    if (object == nullptr) {
        return std::nullopt;
    }
    if (object->is_complete()) {
        // Complete: its acknowledgement was lost. One answer for each time that it is told.
        ++counts_.repeated;
        if (object->verdict && piece.offset + piece.size == piece.total_bytes) {
            acknowledge(piece.object, object->hash, *object->verdict);
        }
        return std::nullopt;
    }
    Assembly& assembly = object->assembly;
    assembly.touched = now;
    const std::size_t number = piece.offset / most_fragment_bytes;
    if (assembly.have[number]) {
        ++counts_.repeated;
        return std::nullopt;
    }
    std::memcpy(assembly.bytes.data() + piece.offset, piece.bytes.data(), piece.size);
    assembly.have[number] = true;
    if (--assembly.missing > 0) {
        return std::nullopt;
    }
    return finish(piece.object, *object);
}

// The object that the piece describes, begun anew where it is the first piece of a new description. Null
// where the piece is of no use.
DiscoveryReceiver::Object* DiscoveryReceiver::object_for(const Piece& piece, Nanoseconds now) {
    const auto found = objects_.find(piece.object);
    bool known = found != objects_.end();
    if (is_outdated(piece)) {
        ++counts_.outdated;
        return nullptr;
    }
    if (known && found->second.revision == piece.revision) {
        Object& object = found->second;
        if (object.hash == piece.hash && object.total_bytes == piece.total_bytes) {
            return &object;
        }
        ++counts_.wrong_hash;
        if (object.is_complete()) {
            return nullptr;
        }
    }
    if (known && !found->second.is_complete()) {
        release(found->second);
        objects_.erase(found);
        known = false;
    }
    if ((!known && objects_.size() >= settings_.most_objects) || !make_room(piece.total_bytes, now)) {
        ++counts_.no_room;
        if (piece.offset + piece.size == piece.total_bytes) {
            acknowledge(piece.object, piece.hash, DiscoveryVerdict::no_room);
        }
        return nullptr;
    }
    Object& object = objects_[piece.object];
    begin(object, piece);
    return &object;
}

bool DiscoveryReceiver::make_room(std::size_t bytes, Nanoseconds now) {
    if (incomplete_bytes_ + bytes <= settings_.most_incomplete_bytes) {
        return true;
    }
    for (auto it = objects_.begin(); it != objects_.end();) {
        const Assembly& assembly = it->second.assembly;
        const bool stale = !it->second.is_complete() && now - assembly.touched > settings_.give_up_after;
        if (stale) {
            release(it->second);
            ++counts_.unfinished;
        }
        it = stale ? objects_.erase(it) : std::next(it);
    }
    return incomplete_bytes_ + bytes <= settings_.most_incomplete_bytes;
}

void DiscoveryReceiver::begin(Object& object, const Piece& piece) {
    object.revision = piece.revision;
    object.hash = piece.hash;
    object.total_bytes = piece.total_bytes;
    object.verdict.reset();
    Assembly& assembly = object.assembly;
    assembly.missing = (piece.total_bytes + most_fragment_bytes - 1) / most_fragment_bytes;
    assembly.bytes.assign(piece.total_bytes, std::byte{0});
    assembly.have.assign(assembly.missing, false);
    incomplete_bytes_ += piece.total_bytes;
}

// Forgets the pieces of what is incomplete.
void DiscoveryReceiver::release(Object& object) {
    incomplete_bytes_ -= object.assembly.bytes.size();
    object.assembly = {};
}

std::optional<DiscoveryEvent> DiscoveryReceiver::finish(ObjectId id, Object& object) {
    const std::vector<std::byte> bytes = std::move(object.assembly.bytes);
    object.assembly = {};
    incomplete_bytes_ -= bytes.size();
    if (content_hash(bytes) != object.hash) {
        ++counts_.wrong_hash;
        objects_.erase(id);  // the next telling begins it again
        return std::nullopt;
    }
    DiscoveryEvent event{DiscoveryEvent::Kind::described, id, {}};
    if (decode_description(bytes, event.description) != Refusal::none || event.description.object != id) {
        ++counts_.refused;
        answer(id, DiscoveryVerdict::refused);
        return std::nullopt;
    }
    return event;
}

std::optional<DiscoveryEvent> DiscoveryReceiver::remove(const Piece& piece) {
    acknowledge(piece.object, piece.hash, DiscoveryVerdict::removed);
    if (is_outdated(piece)) {
        return std::nullopt;
    }
    if (removed_.size() >= most_removals_remembered) {
        removed_.erase(removed_.begin());
    }
    removed_[piece.object] = piece.revision;
    const auto found = objects_.find(piece.object);
    if (found == objects_.end()) {
        return std::nullopt;
    }
    release(found->second);
    objects_.erase(found);
    return DiscoveryEvent{DiscoveryEvent::Kind::removed, piece.object, {}};
}

// Whether something newer is known of its object.
bool DiscoveryReceiver::is_outdated(const Piece& piece) const {
    const auto removed = removed_.find(piece.object);
    const auto known = objects_.find(piece.object);
    return (removed != removed_.end() && piece.revision <= removed->second) ||
           (known != objects_.end() && piece.revision < known->second.revision);
}

void DiscoveryReceiver::answer(ObjectId object, DiscoveryVerdict verdict) {
    const auto found = objects_.find(object);
    if (found != objects_.end() && found->second.is_complete()) {
        found->second.verdict = verdict;
        acknowledge(object, found->second.hash, verdict);
    }
}

// Where there is no room for it, the far side tells again and is answered then.
void DiscoveryReceiver::acknowledge(ObjectId object, const ContentHash& hash, DiscoveryVerdict verdict) {
    acknowledgements_.try_push(DiscoveryAcknowledgement{object, hash, verdict});
}

}  // namespace tactus
