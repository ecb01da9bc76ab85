#include "network/udp_link.hpp"

#include <cstring>

#include "platform/clock.hpp"
#include "platform/realtime_thread.hpp"

namespace tactus {

namespace {

constexpr Nanoseconds publish_every = 20'000'000;
constexpr Nanoseconds try_others_every = nanoseconds_per_second;

// More than these at once come from no honest side: the next ones may wait until `look_out` is over.
constexpr std::size_t a_flood = 8;

// Batches of one round: what the system holds, and then what is to be sent is looked at again.
constexpr int max_batches = 16;

// Counts up what one thread writes and others read.
void count(std::atomic<std::uint64_t>& counter) {
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace

// --- the owner

UdpLink::UdpLink() = default;
UdpLink::~UdpLink() {
    close();
}

std::string UdpLink::open(const UdpSettings& settings) {
    close();
    UdpSockets opened = open_udp_sockets({settings.local_address, settings.local_port},
                                         {settings.remote_address, settings.remote_port}, !settings.secret);
    if (opened.sockets.empty()) {
        return opened.error;
    }
    sockets_ = std::move(opened);
    settings_ = settings;
    outgoing_ = std::make_unique<DatagramRing>(settings.capacity);
    incoming_ = std::make_unique<DatagramRing>(settings.capacity);
    if (settings.secret) {
        jobs_ = std::make_unique<JobThread>();
        secure_ = std::make_unique<SecureSession>(
            *settings.secret, random_identity(),
            [jobs = jobs_.get()](std::function<void()> job) { jobs->add(std::move(job)); });
    }
    overhead_.store(udp_overhead(sockets_.sockets.front().family) + (secure_ ? SecureSession::overhead : 0));
    limit_ = RateLimit(one_every, burst);
    admitted_.reset();
    chosen_ = sockets_.sockets.size() == 1 && sockets_.sockets[0].remotes.size() == 1 ? 0 : undecided;
    next_try_ = monotonic_now() + try_others_every;
    next_publish_ = 0;
    for (std::size_t i = 0; i < sockets_.sockets.size(); ++i) {
        doormen_[i].open(sockets_.sockets[i].handle, sockets_.sockets[i].family);
    }
    wait_ = std::make_unique<SocketWait>();
    stop_requested_.store(false);
    state_.store(UdpState::open);
    std::string refused = wait_->error();
    if (refused.empty()) {
        refused =
            thread_.start("tactus-network", [](void* link) { static_cast<UdpLink*>(link)->run(); }, this);
    }
    if (!refused.empty()) {
        close();
        return "the network thread could not be created: " + refused;
    }
    return {};
}

void UdpLink::close() {
    if (wait_) {
        stop_requested_.store(true);
        wait_->wake();
        thread_.join();
        wait_.reset();
    }
    for (const UdpSocket& socket : sockets_.sockets) {
        close_udp(socket.handle);
    }
    for (Doorman& doorman : doormen_) {
        doorman.close();
    }
    sockets_ = {};
    jobs_.reset();
    secure_.reset();
    state_.store(UdpState::closed);
}

UdpFigures UdpLink::figures() {
    const auto read = [](const std::atomic<std::uint64_t>& counter) {
        return counter.load(std::memory_order_relaxed);
    };
    secure_figures_.refresh();
    const SecureFigures& secure = secure_figures_.front();
    return {state_.load(std::memory_order_relaxed),
            read(sent_),
            read(received_),
            read(no_room_to_send_),
            read(no_room_to_take_),
            read(oversized_),
            read(unreachable_),
            read(too_many_),
            read(refused_),
            secure.dropped_by_system,
            settings_.secret.has_value(),
            secure.met,
            secure.counts};
}

// --- the haptic thread

bool UdpLink::send(std::span<const std::byte> datagram, Nanoseconds now) {
    if (outgoing_ == nullptr || !put_newest(*outgoing_, datagram, now)) {
        no_room_to_send_.fetch_add(1, std::memory_order_relaxed);
        return false;
    }
    return true;
}

ReceivedDatagram UdpLink::receive(std::span<std::byte> into, Nanoseconds) {
    if (incoming_ == nullptr) {
        return {};
    }
    std::uint64_t oversized = 0;
    const ReceivedDatagram received = take_oldest(*incoming_, into, oversized);
    if (oversized > 0) {
        oversized_.fetch_add(oversized, std::memory_order_relaxed);
    }
    return received;
}

// --- the network thread

void UdpLink::run() {
    RealtimeRequest request;
    request.fifo_priority = settings_.fifo_priority;
    request.cpu = any_processor;
    request.lock_memory = false;
    const RealtimeReport report = make_thread_realtime(request);
    while (!stop_requested_.load(std::memory_order_relaxed)) {
        send_waiting();
        say_what_is_due();
        wait_for_work(receive_waiting());
    }
    send_waiting();  // a bye that was said just before
    release_realtime(report);
}

void UdpLink::send_waiting() {
    while (const Datagram* oldest = outgoing_->front()) {
        const std::span<const std::byte> plain = std::span(oldest->bytes).first(oldest->size);
        if (!secure_) {
            send_to_far_side(plain);
        } else if (const std::size_t size = secure_->seal(plain, sealed_); size > 0) {
            send_to_far_side(std::span(sealed_).first(size));
        }
        outgoing_->pop();
    }
}

void UdpLink::say_what_is_due() {
    const Nanoseconds now = monotonic_now();
    if (secure_) {
        for (int i = 0; i < 3; ++i) {
            if (const std::size_t size = secure_->due(sealed_, now); size > 0) {
                send_to_far_side(std::span(sealed_).first(size));
            }
        }
        filter(now);
    }
    for (Doorman& doorman : doormen_) {
        doorman.answer(now);
    }
    try_other_addresses(now);
    publish(now);
}

// Until it is known where the far side is, everywhere it may be.
void UdpLink::send_to_far_side(std::span<const std::byte> datagram) {
    for (std::size_t i = 0; i < sockets_.sockets.size(); ++i) {
        if (chosen_ != undecided && chosen_ != i) {
            continue;
        }
        const SocketError error = send_udp(sockets_.sockets[i].handle, datagram);
        if (!error) {
            count(sent_);
        } else if (error.trouble == SocketTrouble::not_now) {
            no_room_to_send_.fetch_add(1, std::memory_order_relaxed);
        } else {
            note_error(error);
        }
    }
}

std::size_t UdpLink::receive_waiting() {
    std::size_t received = 0;
    for (std::size_t i = 0; i < sockets_.sockets.size(); ++i) {
        for (int batch = 0; batch < max_batches; ++batch) {
            const std::size_t came = receive_from(i);
            received += came;
            if (came < DatagramBatch::capacity) {
                break;
            }
        }
    }
    return received;
}

std::size_t UdpLink::receive_from(std::size_t which) {
    if (const SocketError error = batch_.receive(sockets_.sockets[which].handle)) {
        if (error.trouble != SocketTrouble::not_now) {
            note_error(error);
        }
        return 0;
    }
    const Nanoseconds arrived = monotonic_now();
    for (std::size_t i = 0; i < batch_.size(); ++i) {
        const std::span<const std::byte> datagram = batch_[i];
        if (datagram.size() > max_datagram_bytes) {
            oversized_.fetch_add(1, std::memory_order_relaxed);
        } else if (!datagram.empty()) {
            take(which, datagram, arrived);
        }
    }
    return batch_.size();
}

void UdpLink::take(std::size_t which, std::span<const std::byte> datagram, Nanoseconds arrived) {
    if (is_refused(datagram, arrived)) {
        return;
    }
    // What names another session is dropped unopened; the rest has to keep to the rate.
    if (secure_ && !secure_->concerns(datagram, arrived)) {
        return;
    }
    if (!limit_.pass(arrived)) {
        count(too_many_);
        return;
    }
    Datagram opened;
    opened.arrived = arrived;
    if (secure_) {
        const std::uint64_t believed = secure_->counts().opened;
        opened.size = secure_->take(datagram, opened.bytes, arrived);
        if (secure_->counts().opened > believed) {
            decide_for(which);
        }
    } else {
        opened.size = datagram.size();
        std::memcpy(opened.bytes.data(), datagram.data(), datagram.size());
        decide_for(which);
    }
    if (opened.size == 0) {
        return;
    }
    if (incoming_->try_push(opened)) {
        count(received_);
    } else {
        count(no_room_to_take_);
    }
}

// It is only noted: who is refused goes on asking.
bool UdpLink::is_refused(std::span<const std::byte> datagram, Nanoseconds now) {
    const std::optional<std::uint64_t> number = number_of_refusal(datagram);
    if (number && (!secure_ || secure_->may_be_refused(*number, now))) {
        count(refused_);
    }
    return number.has_value();
}

void UdpLink::decide_for(std::size_t which) {
    state_.store(UdpState::open, std::memory_order_relaxed);
    if (chosen_ == undecided) {
        chosen_ = which;
        overhead_.store(
            udp_overhead(sockets_.sockets[which].family) + (secure_ ? SecureSession::overhead : 0),
            std::memory_order_relaxed);
    }
}

// Where the system cannot, concerns() does the same for more.
void UdpLink::filter(Nanoseconds now) {
    const Admission admission = secure_->admission(now);
    if (admitted_ == admission) {
        return;
    }
    admitted_ = admission;
    for (const UdpSocket& socket : sockets_.sockets) {
        attach_filter(socket.handle, admission);
    }
}

void UdpLink::try_other_addresses(Nanoseconds now) {
    if (chosen_ != undecided || now < next_try_) {
        return;
    }
    next_try_ = now + try_others_every;
    for (UdpSocket& socket : sockets_.sockets) {
        try_next_remote(socket);
    }
}

void UdpLink::publish(Nanoseconds now) {
    if (!secure_ || now < next_publish_) {
        return;
    }
    next_publish_ = now + publish_every;
    SecureFigures figures{secure_->met(), secure_->counts(), 0};
    for (const UdpSocket& socket : sockets_.sockets) {
        figures.dropped_by_system += dropped_by_system(socket.handle);
    }
    secure_figures_.publish(figures);
}

// An unreachable far side is asked on: it may be about to start.
void UdpLink::note_error(SocketError error) {
    if (error.trouble == SocketTrouble::unreachable) {
        count(unreachable_);
        state_.store(UdpState::unreachable, std::memory_order_relaxed);
    } else {
        state_.store(UdpState::failed, std::memory_order_relaxed);
    }
}

void UdpLink::wait_for_work(std::size_t received) {
    // Nothing to wait for where a socket has failed, and too much where there is a flood: do not spin.
    const bool waits_for_sockets =
        received < a_flood && state_.load(std::memory_order_relaxed) != UdpState::failed;
    std::array<SocketHandle, SocketWait::max_sockets> handles;
    std::size_t watched = 0;
    for (std::size_t i = 0; waits_for_sockets && i < sockets_.sockets.size(); ++i) {
        handles[watched++] = sockets_.sockets[i].handle;
    }
    wait_->wait(std::span(handles).first(watched), settings_.look_out);
}

}  // namespace tactus
