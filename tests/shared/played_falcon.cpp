#include "shared/played_falcon.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus::shared {

namespace {

constexpr Nanoseconds packet_time = 1'000'000;  // of its firmware: one exchange a millisecond
constexpr Nanoseconds step_time = 250'000;
constexpr std::size_t firmware_size = 6'000;
constexpr double out_angle = 55.0 * delta_degrees;  // the mark of a leg lies between these
constexpr double in_angle = 20.0 * delta_degrees;

}  // namespace

PlayedFalcon::PlayedFalcon(const PlayedFalconSettings& settings, std::uint64_t seed)
    : settings_(settings), random_(seed), place_(delta_centre(settings.data.geometry)) {}

std::vector<std::uint8_t> PlayedFalcon::firmware() {
    std::vector<std::uint8_t> image(firmware_size);
    RandomValues random(77);
    for (std::uint8_t& byte : image) {
        byte = static_cast<std::uint8_t>(random.below(256));
    }
    return image;
}

void PlayedFalcon::power_cycle() {
    stage_ = Stage::off;
    out_.clear();
    heard_.clear();
    commands_.reset();
    command_ = {};
    homed_ = pulled_out_ = 0;
}

void PlayedFalcon::control(std::uint8_t request, std::uint16_t value) {
    switch (request) {
        case 0:  // reset and purge
            if (value != 2) {
                out_.clear();
            }
            break;
        case 1:  // modem lines
            if ((value & 0x0100) != 0) {
                const bool high = (value & 1) != 0;
                if (high && !dtr_) {
                    power_cycle();
                    stage_ = Stage::greeting;
                }
                dtr_ = high;
            }
            break;
        case 3:
            baud_ = value;
            break;
        case 9:
            latency_ = Nanoseconds{value} * 1'000'000;
            break;
        default:
            break;
    }
}

void PlayedFalcon::answer(std::span<const std::uint8_t> bytes, Nanoseconds at) {
    for (const std::uint8_t byte : bytes) {
        out_.push_back({byte, at});
    }
}

void PlayedFalcon::greet(std::uint8_t byte) {
    const std::vector<std::uint8_t> hello{0x0a, 0x43, 0x0d};
    heard_.push_back(byte);
    if (heard_.size() > hello.size()) {
        heard_.erase(heard_.begin());
    }
    if (heard_ == hello) {
        if (random_.unit() < settings_.settling) {
            answer(std::vector<std::uint8_t>{0x00});
        }
        answer(std::vector<std::uint8_t>{0x0a, 0x44, 0x2c, 0x0d});
        heard_.clear();
        stage_ = Stage::knocked;
    }
}

void PlayedFalcon::load(std::uint8_t byte) {
    heard_.push_back(byte);
    const bool wrong = random_.unit() < settings_.wrong_echo;
    const std::uint8_t back = wrong ? static_cast<std::uint8_t>(byte ^ 0x55) : byte;
    answer({&back, 1});
    if (heard_.size() == firmware_size) {
        stage_ = heard_ == firmware() ? Stage::running : Stage::dead;
        heard_.clear();
    }
}

void PlayedFalcon::write(std::span<const std::uint8_t> bytes, Nanoseconds now) {
    advance(now);
    for (const std::uint8_t byte : bytes) {
        switch (stage_) {
            case Stage::greeting:
                if (baud_ == 0x4138) {
                    greet(byte);
                }
                break;
            case Stage::knocked:
                if (baud_ == 0x0015 && !dtr_ && byte == 0x41) {
                    answer({&byte, 1});
                    stage_ = Stage::loading;
                } else if (baud_ == 0x4138) {
                    stage_ = Stage::greeting;  // it is greeted again
                    greet(byte);
                }
                break;
            case Stage::loading:
                load(byte);
                break;
            case Stage::running:
                commands_.take({&byte, 1});
                break;
            default:
                break;
        }
    }
    for (const auto before = command_.torques; running() && commands_.next(command_);) {
        if (before != std::array<std::int16_t, 3>{} && command_.torques == std::array<std::int16_t, 3>{}) {
            let_go_at_ = now;
        }
        commanded_ = now;
        const Vec3 asked = motor_force(delta_pose(settings_.data.geometry, place_));
        const Vec3 was_asked = std::exchange(asked_, asked);
        if (glm::length(asked) > glm::length(was_asked)) {
            most_step_ = std::max(most_step_, glm::distance(asked, was_asked));
        }
        next_report_ = std::max(next_report_ + packet_time, now);
        ++exchanges_;
        const FalconPacket packet = falcon_encode(report());
        if (lie_ != stand_ins::Lie::none && lied_at_ == 0) {
            lied_at_ = next_report_;
        }
        if (lie_ != stand_ins::Lie::is_silent) {
            answer(packet, next_report_);
        }
    }
}

// The chip sends what it has when its latency timer is over, or at once where a packet of USB is full; here a
// report counts as one.
Nanoseconds PlayedFalcon::readable_at(Nanoseconds asked) const {
    const Nanoseconds timer = asked + latency_;
    return out_.empty() ? timer : std::min(timer, out_.front().at);
}

std::vector<std::uint8_t> PlayedFalcon::read(std::size_t room, Nanoseconds asked, Nanoseconds now) {
    advance(now);
    if (now < readable_at(asked)) {
        return {};
    }
    std::vector<std::uint8_t> bytes{0x01, 0x60};
    while (bytes.size() < room && !out_.empty() && out_.front().at <= now) {
        bytes.push_back(out_.front().byte);
        out_.pop_front();
    }
    return bytes;
}

FalconReport PlayedFalcon::report() {
    const FalconData& data = settings_.data;
    const Vec3 turned = (delta_pose(data.geometry, place_).angles - data.zero_angles) *
                        (data.counts_a_turn * data.geometry.gear / (360.0 * delta_degrees));
    FalconReport report;
    for (int i = 0; i < 3; ++i) {
        report.encoders[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(std::lround(turned[i]));
    }
    report.buttons = static_cast<std::uint8_t>(buttons_ & 0xfu);
    report.homed = static_cast<std::uint8_t>(homed_);
    if (lying_field_ == stand_ins::Field::buttons) {
        report.buttons ^= lie_ == stand_ins::Lie::leaps ? 0xf : 0;
    } else if (lie_ == stand_ins::Lie::leaps) {
        report.encoders[0] = static_cast<std::int16_t>(report.encoders[0] + 500);
    } else if (lie_ == stand_ins::Lie::no_number || lie_ == stand_ins::Lie::infinite) {
        report.encoders[0] = 32'767;  // where no arm is
    }
    return report;
}

void PlayedFalcon::advance(Nanoseconds now) {
    if (time_ == 0 || now - time_ > nanoseconds_per_second) {
        time_ = now;
    }
    for (; time_ + step_time <= now; time_ += step_time) {
        if (time_ - commanded_ > settings_.torque_time && !is_let_go()) {
            command_.torques = {};
            let_go_at_ = time_;
        }
        step(to_seconds(step_time));
    }
}

Vec3 PlayedFalcon::motor_force(const DeltaPose& pose) const {
    const FalconData& data = settings_.data;
    const Vec3 counts(command_.torques[0], command_.torques[1], command_.torques[2]);
    return pose.state == DeltaState::out_of_reach
               ? Vec3(0.0)
               : delta_force(pose, counts * data.torque_a_count * data.geometry.gear);
}

// m p'' = F - b p' + k (meant - p) - c p', where F is what the torques do through the arm.
void PlayedFalcon::step(double seconds) {
    const FalconData& data = settings_.data;
    const DeltaPose pose = delta_pose(data.geometry, place_);
    force_ = motor_force(pose);
    const bool homed = homed_ == 7;
    if (command_.homing && !homed) {
        for (unsigned leg = 0; leg < 3; ++leg) {
            const double angle = pose.angles[static_cast<int>(leg)];
            pulled_out_ |= angle > out_angle ? 1u << leg : 0u;
            homed_ |= (pulled_out_ >> leg & 1u) != 0 && angle < in_angle ? 1u << leg : 0u;
        }
    }
    const Vec3 meant = homed ? meant_ : Vec3(0.0, 0.0, pulled_out_ == 7 ? -0.03 : 0.04);
    const Vec3 centre = delta_centre(data.geometry);
    const double mass = settings_.mass + settings_.hand_mass;
    const double damping = settings_.friction + settings_.hand_damping;
    const double stiffness = settings_.hand_stiffness * (homed ? 1.0 : 5.0);
    const Vec3 pull =
        stiffness * (centre + meant - place_ - seconds * velocity_) - damping * velocity_ + force_;
    velocity_ += seconds * pull / (mass + seconds * damping + seconds * seconds * stiffness);
    const Vec3 next = place_ + seconds * velocity_;
    const DeltaState there = delta_pose(data.geometry, next).state;
    if (there == DeltaState::out_of_reach || there == DeltaState::beyond_stops) {
        velocity_ = Vec3(0.0);  // against its stops
    } else {
        place_ = next;
    }
}

}  // namespace tactus::shared
