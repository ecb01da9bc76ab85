// A played Falcon below libusb: umockdev shows it to this process as a device of the system, down to the
// kernel's calls.
//
// The process must run with umockdev's preloaded library; run_below_umockdev() sees to it.
#pragma once

#include <memory>

#include "shared/played_falcon.hpp"

namespace tactus::shared {

// Starts this program anew with umockdev in front of the C library, unless it is there already. False where
// umockdev is not on this system.
bool run_below_umockdev(char** arguments);

struct PlayedUsbSettings {
    PlayedFalconSettings falcon;
    double failing = 0.0;  // share of transfers that fail: with an error, a part only, or nothing in time
    int port = 1;          // of the bus's only hub, 1 … 9
    std::uint64_t seed = 1;
};

class PlayedUsb {
public:
    explicit PlayedUsb(const PlayedUsbSettings& settings);
    ~PlayedUsb();
    PlayedUsb(const PlayedUsb&) = delete;
    PlayedUsb& operator=(const PlayedUsb&) = delete;

    void plug();
    // In the middle of whatever is on the wire.
    void unplug();
    void set_failing(double share);
    // Another program holds it.
    void set_in_use(bool in_use);

    // Of the arm, at any time and from any thread.
    void mean(const Vec3& place);
    void press(unsigned buttons);
    void lie(stand_ins::Field field, stand_ins::Lie lie);
    Nanoseconds lied_at();  // see PlayedFalcon
    Vec3 hand();
    Vec3 force();
    double take_most_step();  // see PlayedFalcon
    std::uint8_t leds();
    bool running();
    // When the motors were last told to give no force after some (on the steady clock); 0: never.
    Nanoseconds let_go_at();
    // Whether they are told so now.
    bool is_let_go();
    std::uint64_t exchanges();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tactus::shared
