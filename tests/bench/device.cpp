// Hands of metal: kinematics of a delta arm, and what leaves for any device. build/bench/device.json, and the
// passivity sweep in device_walls.csv beside it.
//
//   --places=N   of the workspace, for each geometry (1000000)
//   --inputs=N   at random to the safety layer (10000000)
//   --rounds=N   start-ups and replugs of the played Falcon, a tenth of its stalls (100); 0: none
//   --seconds=S  in contact, behind each of --phases=N phases between the loop and a device (10, 32), and at
//                each rate; 0: none
//   --displayed  nothing but that, and what lying devices are given
//   --driver=NAME  of that one alone (force_dimension, openhaptics, inverse3, falcon)
//   --plugged=falcon|force_dimension|openhaptics|inverse3 [--firmware=FILE] [--id=NAME]
//                the device of that kind that is plugged in, and nothing else
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "devices/drivers.hpp"
#include "devices/emulated_robot.hpp"
#include "devices/following_device.hpp"
#include "devices/path_device.hpp"
#include "devices/robot_table.hpp"
#include "devices/simulated_arm.hpp"
#include "platform/realtime_thread.hpp"
#ifdef __linux__
#include "shared/stand_in_devices_linux.hpp"
#endif
#ifdef TACTUS_PLAYED_USB
#include "devices/falcon/falcon_driver.hpp"
#include "played/falcon_figures.hpp"
#include "played/played_usb.hpp"
#endif
#include "shared/bench_kit.hpp"
#include "shared/delta_figures.hpp"
#include "shared/displayed_figures.hpp"
#include "shared/driver_figures.hpp"
#include "shared/lying_figures.hpp"
#include "shared/safety_figures.hpp"
#include "shared/script_forces.hpp"

namespace {

using namespace tactus;
using namespace tactus::shared;

constexpr int places_a_task = 50'000;
constexpr double seconds_of_ticks = 16.0;

void report_kinematics(Report& report, int places) {
    std::vector<DeltaFigures> parts(static_cast<std::size_t>((places + places_a_task - 1) / places_a_task));
    DeltaFigures all;
    for (const DeltaGeometry& geometry : {falcon_geometry, falcon_geometry_martin}) {
        run_on_two_threads(parts.size(), [&](std::size_t part) {
            parts[part] = check_delta(geometry, 1'000 + part, places_a_task);
        });
        for (const DeltaFigures& part : parts) {
            all.add(part);
        }
    }
    report.set("kinematics.places", all.places);
    report.set("kinematics.lost", all.lost);
    report.set("kinematics.round_trip_max_rad", all.round_trip_rad);
    report.set("kinematics.round_trip_max_m", all.round_trip_m);
    report.set("kinematics.jacobian_error_max", all.jacobian_error);
    report.set("kinematics.newton_steps_cold_max", all.steps_cold);
    report.set("kinematics.newton_steps_warm_max", all.steps_warm);
    report.set("falcon.force_direction_max_deg", all.force_direction_deg);
    report.set("falcon.force_size_error_max", all.force_size_error);
    std::printf(
        "kinematics  %d places, %d lost; there and back %.1e rad, %.1e m; Jacobian %.1e; Newton %d steps, "
        "warm %d\n",
        all.places, all.lost, all.round_trip_rad, all.round_trip_m, all.jacobian_error, all.steps_cold,
        all.steps_warm);
    std::printf("falcon      force off by %.1e degrees, %.1e of its size\n", all.force_direction_deg,
                all.force_size_error);
}

// How well the arm holds the hand, over a plane through its axis: device_conditioning.csv. Empty: no sound
// place.
bool write_conditioning() {
    KeptFile file(result_path("device").parent_path() / "device_conditioning.csv");
    std::FILE* const csv = file.get();
    if (!csv) {
        return false;
    }
    std::fprintf(csv, "geometry,x_mm,z_mm,condition\n");
    const auto write = [csv](const char* name, const DeltaGeometry& geometry) {
        for (int x = -80; x <= 80; x += 2) {
            for (int z = 60; z <= 190; z += 2) {
                const DeltaPose pose = delta_pose(geometry, {1e-3 * x, 0.0, 1e-3 * z});
                std::fprintf(csv, "%s,%d,%d,", name, x, z);
                if (pose.state == DeltaState::sound) {
                    std::fprintf(csv, "%.4g", condition_of(pose));
                }
                std::fprintf(csv, "\n");
            }
        }
    };
    write("falcon", falcon_geometry);
    write("falcon_martin", falcon_geometry_martin);
    return file.keep();
}

void report_random_input(Report& report, std::int64_t inputs) {
    constexpr std::size_t parts = 20;
    std::vector<SafetyFigures> figures(parts);
    run_on_two_threads(parts, [&](std::size_t part) {
        figures[part] = play_random_hand(2'000 + part, inputs / static_cast<std::int64_t>(parts));
    });
    SafetyFigures all;
    for (const SafetyFigures& part : figures) {
        all.add(part);
    }
    report.set("safety.inputs", static_cast<double>(all.inputs));
    report.set("safety.violations", static_cast<double>(all.violations));
    std::printf("safety      %lld random inputs, %lld with a force, %lld violations\n",
                static_cast<long long>(all.inputs), static_cast<long long>(all.working),
                static_cast<long long>(all.violations));
}

// Every wall as it is asked for, and as it is made safe.
// False where its rows could not be written.
bool report_walls(Report& report) {
    struct Row {
        ContactCase contact;
        ContactFigures safe, free;
    };
    std::vector<Row> rows;
    for (const double stiffness : {50.0, 100.0, 200.0, 500.0, 1e3, 2e3, 5e3, 1e4, 2e4}) {
        for (const double wall_damping : {0.0, 1.0, 5.0}) {
            for (const double device_damping : {0.5, 1.5, 5.0}) {
                for (const double rate : {250.0, 500.0, 1e3, 2e3, 4e3}) {
                    for (const double delay : {0.0, 0.004, 0.012, 0.04, 0.1}) {
                        Row row;
                        row.contact.wall = {stiffness, wall_damping};
                        row.contact.device_damping = device_damping;
                        row.contact.lag = {1.0 / rate, delay};
                        rows.push_back(row);
                    }
                }
            }
        }
    }
    run_on_two_threads(rows.size(), [&](std::size_t i) {
        ContactCase contact = rows[i].contact;
        rows[i].safe = play_contact(contact);
        contact.limited = contact.passive = false;
        rows[i].free = play_contact(contact);
    });
    double created = 0.0;
    double created_free = 0.0;
    int unstable = 0;
    int unstable_free = 0;
    KeptFile file(result_path("device").parent_path() / "device_walls.csv");
    std::FILE* const csv = file.get();
    if (!csv) {
        return false;
    }
    std::fprintf(csv,
                 "stiffness,wall_damping,device_damping,rate,delay,used,created_J,stable,"
                 "free_created_J,free_stable\n");
    for (const Row& row : rows) {
        created = std::max(created, row.safe.energy_created);
        created_free = std::max(created_free, row.free.energy_created);
        unstable += row.safe.stable ? 0 : 1;
        unstable_free += row.free.stable ? 0 : 1;
        std::fprintf(csv, "%g,%g,%g,%g,%g,%g,%g,%d,%g,%d\n", row.contact.wall.stiffness,
                     row.contact.wall.damping, row.contact.device_damping, 1.0 / row.contact.lag.seconds,
                     row.contact.lag.delay, row.safe.stiffness_used, row.safe.energy_created,
                     row.safe.stable ? 1 : 0, row.free.energy_created, row.free.stable ? 1 : 0);
    }
    report.set("safety.walls", static_cast<double>(rows.size()));
    report.set("safety.energy_created_max_J", created);
    report.set("safety.walls_unstable", unstable);
    report.set("safety.walls_unstable_unlimited", unstable_free);
    std::printf("walls       %zu, at most %.1e J made, %d unstable; as asked for: %.1e J, %d unstable\n",
                rows.size(), created, unstable, created_free, unstable_free);
    return file.keep();
}

// Forces that scripts compute, on an arm: see script_forces.hpp.
void report_scripts(Report& report, int runs) {
    ScriptFigures all;
    for (const ScriptForm form : script_forms) {
        for (int seed = 0; seed < runs; ++seed) {
            all.add(play_script(form, 3'000 + static_cast<std::uint64_t>(seed)));
        }
    }
    report.set("safety.script_forces", all.runs);
    report.set("safety.script_energy_created_max_J", all.energy_made_max);
    report.set("safety.script_shake_max_mm", 1e3 * all.shake_max);
    std::printf("scripts     %d forces, at most %.1e J made, shaking by %.2f mm\n", all.runs,
                all.energy_made_max, 1e3 * all.shake_max);
}

void report_exchanges(Report& report, const char* name, const ExchangeFigures& figures) {
    report.set(std::string(name) + ".exchanges_per_s", figures.per_second);
    report.set(std::string(name) + ".exchange_jitter_p99_ms", figures.jitter_p99_ms);
    std::printf("%-11s %.0f exchanges/s, from their pace by %.2f ms (p99)\n", name, figures.per_second,
                figures.jitter_p99_ms);
}

void report_ticks(Report& report, const char* name, double over_path) {
    report.set(std::string(name) + ".tick_over_path", over_path);
    std::printf("%-11s a tick's p99 is %.2f times that with a scripted path\n", name, over_path);
}

// Hands without a driver of their own; those that are led are one, whoever leads them.
void report_ticks_of_hands(Report& report) {
    PathDevice path{path_over_floor()};  // how far off the measure itself is
    report_ticks(report, "path", tick_over_path(path, seconds_of_ticks, [](double) {}));
    FollowingDevice led({});
    int tick = 0;
    report_ticks(report, "mouse", tick_over_path(led, seconds_of_ticks, [&](double time) {
                     if (tick++ % 16 == 0) {
                         led.aim({way_over_floor(time), 0});
                     }
                 }));
    SimulatedArm arm(path_over_floor(), {});
    report_ticks(report, "arm", tick_over_path(arm, seconds_of_ticks, [](double) {}));
    EmulatedRobot robot({}, std::make_shared<RobotTable>(RobotTable::Settings{}));
    report_ticks(report, "emulated_robot", tick_over_path(robot, seconds_of_ticks, [](double) {}));
}

#ifdef __linux__
// Keys of one device: quiet, beside busy processors, and at every rate that the world offers.
void report_displayed(Report& report, const std::string& name, const WatchedDevice& watched, int phases,
                      double seconds) {
    const auto play = [&](const std::string& manner, const DisplayedCase& c) {
        const DisplayedFigures figures = play_displayed(watched, c);
        const std::string key = name + "." + manner;
        report.set(key + "let_go_while_even", static_cast<double>(figures.let_go_while_even));
        report.set(key + "cuts", static_cast<double>(figures.cuts));
        report.set(key + "even_tick_share", figures.even_share());
        report.set(key + "displayed_over_asked_min", figures.over_asked_min);
        report.set(key + "reading_to_force_p50_us", figures.delay_p50_us);
        report.set(key + "reading_to_force_p99_us", figures.delay_p99_us);
        report.set(key + "write_p50_us", figures.write_p50_us);
        report.set(key + "write_p99_us", figures.write_p99_us);
        if (c.is_cut) {
            report.set(key + "return_step_max_N", figures.return_step_max);
        }
        std::printf(
            "%-15s %-10s %d of %d phases: displayed %.5f of asked, %llu cuts in even ticks (%.4f of all; "
            "%llu "
            "cuts in all), reading to force %.0f us (p99 %.0f), write %.1f us (p99 %.1f), back in steps of "
            "%.2f N\n",
            name.c_str(), manner.c_str(), figures.opened, c.phases, figures.over_asked_min,
            static_cast<unsigned long long>(figures.let_go_while_even), figures.even_share(),
            static_cast<unsigned long long>(figures.cuts), figures.delay_p50_us, figures.delay_p99_us,
            figures.write_p50_us, figures.write_p99_us, figures.return_step_max);
        std::fflush(stdout);
    };
    DisplayedCase c;
    c.phases = phases;
    c.seconds = seconds;
    c.is_cut = true;
    play("", c);
    c.is_cut = false;
    c.is_loaded = true;
    play("loaded.", c);
    c.is_loaded = false;
    c.phases = std::min(phases, 4);
    for (const int rate : {100, 250, 500, 640, 1000, 2000, 4000}) {
        const std::string manner = "rate_" + std::to_string(rate) + ".";
        c.rate = rate;
        const std::string refused = refusal(watched, c.rate);
        report.set(name + "." + manner + "refused", refused.empty() ? 0.0 : 1.0);
        if (refused.empty()) {
            play(manner, c);
        } else {
            std::printf("%-15s %-10s refused: %s\n", name.c_str(), manner.c_str(), refused.c_str());
        }
    }
}

// Looks on like a thread that nothing ordinary delays, but after all that it looks at.
void look_on(const std::function<void()>& work) {
    std::thread([&work] {
        RealtimeRequest request;
        request.fifo_priority = 50;
        request.lock_memory = false;
        request.cpu = any_processor;
        const RealtimeReport granted = make_thread_realtime(request);
        work();
        release_realtime(granted);
    }).join();
}

struct PlayedLie {
    LyingFigures figures;
    bool is_safe = false;
};

// Again where a processor stood still meanwhile.
PlayedLie play_lie(LyingHand& hand, stand_ins::Field field, stand_ins::Lie lie, bool is_cut) {
    constexpr int most_times = 10;
    PlayedLie played;
    played.figures.was_even = false;
    for (int i = 0; i < most_times && !played.figures.was_even; ++i) {
        played.figures = hand.play(field, lie);
    }
    played.is_safe = (played.figures.to_zero_ms >= 0.0 || !is_cut) && played.figures.has_returned &&
                     played.figures.return_step_max <= 1e-3 * hand.slew() + 1e-9;
    return played;
}

// What its motors give while it lies about a field: of all lies that no force may be given on, the longest
// time until it has gone. That a field is frozen shows when another one has moved on.
void report_lies(Report& report, const std::string& name, const LyingDevice& device) {
    using stand_ins::Field, stand_ins::Lie;
    LyingHand hand(device);
    if (!hand.is_there()) {
        std::printf("%-15s is not there\n", name.c_str());
        return;
    }
    double to_zero = 0.0, frozen_to_zero = 0.0, step = 0.0;
    int lies = 0, safe = 0;
    for (int field = 0; field < static_cast<int>(Field::count); ++field) {
        for (int lie = 1; lie < static_cast<int>(Lie::count); ++lie) {
            const bool is_cut = is_nonsense(device, static_cast<Field>(field), static_cast<Lie>(lie));
            const auto& [figures, is_safe] =
                play_lie(hand, static_cast<Field>(field), static_cast<Lie>(lie), is_cut);
            const bool is_zero = figures.to_zero_ms >= 0.0;
            ++lies;
            safe += is_safe ? 1 : 0;
            if (!is_safe) {
                std::printf(
                    "%-15s field %d, lie %d (stand_ins/stand_ins.hpp): %.2f N, none after %.2f ms, %s, steps "
                    "of %.3f N\n",
                    name.c_str(), field, lie, figures.force, figures.to_zero_ms,
                    figures.has_returned ? "back" : "not back", figures.return_step_max);
            }
            if (is_cut) {
                double& longest = static_cast<Lie>(lie) == Lie::is_frozen ? frozen_to_zero : to_zero;
                longest = std::max(longest, is_zero ? figures.to_zero_ms : 1e9);
            }
            step = std::max(step, figures.return_step_max);
        }
    }
    report.set(name + ".lies", lies);
    report.set(name + ".lies_safe", safe);
    report.set(name + ".lie_to_zero_max_ms", to_zero);
    report.set(name + ".lie_frozen_to_zero_max_ms", frozen_to_zero);
    report.set(name + ".lie_return_step_max_N", step);
    std::printf(
        "%-15s lies       %d of %d safe, no force after %.2f ms (frozen: %.2f), back in steps of %.2f N\n",
        name.c_str(), safe, lies, to_zero, frozen_to_zero, step);
    std::fflush(stdout);
}

void report_displayed_of_drivers(Report& report, int phases, double seconds, const std::string& only) {
    const auto play = [&](const std::string& name, const LyingDevice& device) {
        if (only.empty() || only == name) {
            report_displayed(report, name, device.watched, phases, seconds);
            look_on([&] { report_lies(report, name, device); });
        }
    };
    auto& dhd = *stand_in<stand_ins::ForceDimension>({"libdhd.so"}, "stand_in_force_dimension");
    dhd.has_wrist = true;
    dhd.buttons = 1;
    play("force_dimension", force_dimension_device());
    dhd.has_wrist = false;
    stand_in<stand_ins::OpenHaptics>({"libHD.so"}, "stand_in_openhaptics")->buttons = 1;
    play("openhaptics", openhaptics_device());
    HaplyService service;
    play("inverse3", inverse3_device(service));
}

void report_ticks(Report& report, const char* name, std::unique_ptr<Driver> driver) {
    DriverDevice device(std::move(driver));
    if (Loop(device).wait_for_hand()) {
        report_ticks(report, name, tick_over_path(device, seconds_of_ticks, [](double) {}));
    } else {
        std::printf("%-11s is not there: %s\n", name, device.health().text.c_str());
    }
}

// Against libraries and a service that stand in for the makers'.
void report_ticks_of_drivers(Report& report) {
    report_ticks(report, "force_dimension", std::make_unique<ForceDimensionDriver>(""));
    report_ticks(report, "openhaptics", std::make_unique<OpenHapticsDriver>(""));
    const HaplyService service;
    report_ticks(report, "inverse3", std::make_unique<Inverse3Driver>("", service.port()));
}
#else
// What stands in for the makers' libraries and service is Linux's alone.
void report_displayed_of_drivers(Report&, int, double, const std::string&) {}
void report_ticks_of_drivers(Report&) {}
#endif

// In a user's hand: no force is asked for.
int report_plugged(Report& report, const std::string& name, const std::string& firmware, std::string id) {
    const std::vector<std::pair<std::string, DriverKind>> kinds{
        {"falcon", DriverKind::falcon},
        {"force_dimension", DriverKind::force_dimension},
        {"openhaptics", DriverKind::openhaptics},
        {"inverse3", DriverKind::inverse3}};
    const auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& one) { return one.first == name; });
    if (kind == kinds.end()) {
        std::fprintf(stderr, "there is no driver '%s'\n", name.c_str());
        return 2;
    }
    DriverSettings settings;
    settings.id = std::move(id);
    std::ifstream file(firmware, std::ios::binary);
    settings.firmware.assign(std::istreambuf_iterator<char>(file), {});
    DriverDevice device(make_driver(kind->second, std::move(settings)));
    if (const Loop loop(device); !loop.wait_for_hand()) {
        std::fprintf(stderr, "%s\n", device.health().text.c_str());
        return 1;
    }
    report_exchanges(report, name.c_str(), exchanges(device, 10.0));
    report_ticks(report, name.c_str(), tick_over_path(device, seconds_of_ticks, [](double) {}));
    return 0;
}

#ifdef TACTUS_PLAYED_USB
void report_displayed_of_falcon(Report& report, int phases, double seconds) {
    PlayedUsb usb({});
    usb.plug();
    FalconSettings settings;
    settings.firmware = PlayedFalcon::firmware();
    const LyingDevice device{{[&settings] { return std::make_unique<FalconDriver>(settings); },
                              [&usb] { return usb.force(); }, [&usb] { return usb.take_most_step(); }},
                             [&usb](stand_ins::Field field, stand_ins::Lie lie) { usb.lie(field, lie); },
                             [&usb] { return usb.lied_at(); },
                             false};
    report_displayed(report, "falcon", device.watched, phases, seconds);
    usb.mean({0.0, -0.03, 0.0});
    usb.press(1);
    look_on([&] { report_lies(report, "falcon", device); });
}

void report_stalls(Report& report, const char* what, const StallFigures& figures) {
    const std::string name = std::string("safety.") + what;
    report.set(name + "_to_zero_max_ms", figures.max_ms);
    report.set(name + "_to_zero_p99_ms", figures.p99_ms);
    report.set(name + "s_ok_of_" + std::to_string(figures.stalls), figures.ok);
    std::printf("%-11s %d of %d let go within 2 ms, p99 %.2f ms, max %.2f ms\n", what, figures.ok,
                figures.stalls, figures.p99_ms, figures.max_ms);
}

// In real time, so on a machine that does nothing else.
void report_played_falcon(Report& report, int rounds) {
    const std::string of = std::to_string(rounds);
    const ExchangeFigures exchanged = falcon_exchanges(10.0);
    report_exchanges(report, "falcon", exchanged);
    const RoundTrips trips = falcon_round_trips(2 * rounds);
    report.set("falcon.round_trip_p50_ms", trips.p50_ms);
    report.set("falcon.round_trip_p99_ms", trips.p99_ms);
    const int starts = starts_ok(rounds, 0.3);
    report.set("falcon.starts_ok_of_" + of, starts);
    const int replugs = replugs_ok(rounds);
    report.set("falcon.replugs_ok_of_" + of, replugs);
    std::printf(
        "falcon      %.2f ms there and back (p99 %.2f), %d of %d starts with 30 %% of transfers failing, %d "
        "of "
        "%d replugs\n",
        trips.p50_ms, trips.p99_ms, starts, rounds, replugs, rounds);
    report_ticks(report, "falcon", falcon_tick_over_path(seconds_of_ticks));
    StallFigures loop = stall_loop(5 * rounds);
    StallFigures driver = stall_driver(5 * rounds);
    report_stalls(report, "loop_stall", loop);
    report_stalls(report, "driver_stall", driver);
    loop.max_ms = std::max(loop.max_ms, driver.max_ms);
    loop.p99_ms = std::max(loop.p99_ms, driver.p99_ms);
    loop.ok += driver.ok;
    loop.stalls += driver.stalls;
    report_stalls(report, "stall", loop);
}
#endif

}  // namespace

int main(int count, char** arguments) {
#ifdef TACTUS_PLAYED_USB
    if (!run_below_umockdev(arguments)) {
        return 2;
    }
#endif
    Options options(count, arguments);
    const int places = static_cast<int>(options.number("places", 1'000'000));
    const int rounds = static_cast<int>(options.number("rounds", 100));
    const auto inputs = static_cast<std::int64_t>(options.number("inputs", 10'000'000));
    const int phases = static_cast<int>(options.number("phases", 32));
    const double seconds = options.number("seconds", 10.0);
    const bool only_displayed = options.has("displayed");
    const std::string driver = options.text("driver");
    const std::string plugged = options.text("plugged");
    const std::string firmware = options.text("firmware");
    const std::string id = options.text("id");
    if (!options.understood()) {
        return 2;
    }
    Report report;
    if (!plugged.empty()) {
        return report_plugged(report, plugged, firmware, id);
    }
    if (seconds > 0.0) {
        report_displayed_of_drivers(report, phases, seconds, driver);
#ifdef TACTUS_PLAYED_USB
        if (driver.empty() || driver == "falcon") {
            report_displayed_of_falcon(report, phases, seconds);
        }
#endif
    }
    if (only_displayed) {
        return report.write_json(result_path("device")) ? 0 : 1;
    }
    report_kinematics(report, places);
    if (!write_conditioning()) {
        return 1;
    }
    report_random_input(report, inputs);
    if (!report_walls(report)) {
        return 1;
    }
    report_scripts(report, 50);
    if (rounds > 0) {
        report_ticks_of_hands(report);
        report_ticks_of_drivers(report);
    }
#ifdef TACTUS_PLAYED_USB
    if (rounds > 0) {
        report_played_falcon(report, rounds);
    }
#else
    std::printf("falcon      not played: that needs umockdev (Debian: libumockdev-dev)\n");
#endif
    return report.write_json(result_path("device")) ? 0 : 1;
}
