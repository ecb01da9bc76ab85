#include "shared/teleop_figures.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <string_view>
#include <utility>

namespace tactus::shared {

namespace {

constexpr Nanoseconds period = 1'000'000;
constexpr double tick_seconds = 1e-3;

// A second-order Butterworth high-pass (bilinear transform), one component.
class HighPass {
public:
    explicit HighPass(double hertz) {
        const double k = std::tan(3.14159265358979 * hertz * tick_seconds);
        const double norm = 1.0 / (1.0 + std::sqrt(2.0) * k + k * k);
        b0_ = norm;
        a1_ = 2.0 * (k * k - 1.0) * norm;
        a2_ = (1.0 - std::sqrt(2.0) * k + k * k) * norm;
    }
    double operator()(double x) {
        const double y = b0_ * (x - 2.0 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
        x2_ = std::exchange(x1_, x);
        y2_ = std::exchange(y1_, y);
        return y;
    }

private:
    double b0_ = 0.0, a1_ = 0.0, a2_ = 0.0, x1_ = 0.0, x2_ = 0.0, y1_ = 0.0, y2_ = 0.0;
};

double percentile(std::vector<double> values, double share) {
    if (values.empty()) {
        return 0.0;
    }
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

bool write_rows(const std::string& path, const std::vector<std::string>& bodies,
                const std::vector<TeleopRow>& rows) {
    std::ofstream file(path);
    file << "time_us,hand_x,hand_y,hand_z,force_x,force_y,force_z,direct_x,direct_y,direct_z,far_x,far_y,"
            "far_z,model_x,model_y,model_z,truth_x,truth_y,truth_z,box_error_m,offset_m,jnd_share,depth_m,"
            "local_depth_m,felt_excess_1ms_N,felt_excess_100ms_N,felt_excess_100ms_jnd,let_go,"
            "far_hand_error_m,box_rotation_error_rad,touches,direct_touches,there_hand_x,there_hand_y,"
            "there_hand_z,there_force_x,there_force_y,there_force_z,correction_force_step_N,velocity_x,"
            "velocity_y,velocity_z,local_hand_x,local_hand_y,local_hand_z,local_velocity_x,local_velocity_y,"
            "local_velocity_z,local_force_x,local_force_y,local_force_z,round_trip_s,packets_forth,"
            "packets_back,bytes_forth,bytes_back,corrections,replays,states_beyond_history,samples_held,"
            "samples_filled";
    for (const std::string& body : bodies) {
        file << ",direct_touches_" << body;
    }
    file << "\n";
    const auto number = [&file](double value) {
        std::array<char, 32> text{};
        const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
        file << ',' << std::string_view(text.data(), end);
    };
    const auto put = [&number](const Vec3& v) {
        number(v.x);
        number(v.y);
        number(v.z);
    };
    // Of a sample that the far side has not answered nothing is known there.
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    for (const TeleopRow& row : rows) {
        file << row.time / 1000;
        put(row.hand);
        put(row.force);
        put(row.direct);
        put(row.far_known ? row.far : Vec3(unknown));
        put(row.model.position);
        put(row.far_known ? row.truth.position : Vec3(unknown));
        for (const double value :
             {row.far_known ? row.box_error : unknown, row.offset, row.jnd_share, row.depth, row.local_depth,
              row.excess_1ms.newtons, row.excess_100ms.newtons, row.excess_100ms.jnd}) {
            number(value);
        }
        file << ',' << row.let_go;
        number(row.far_known ? row.hand_error : unknown);
        number(row.far_known ? row.turn_error : unknown);
        file << ',' << row.touches << ',' << row.direct_touches;
        put(row.there_hand);
        put(row.there_force);
        number(row.force_step);
        for (const Vec3& of_arm : {row.velocity, row.local_hand, row.local_velocity, row.local_force}) {
            put(of_arm);
        }
        const LinkCounts& link = row.link;
        number(link.round_trip);
        for (const std::uint64_t count :
             {link.packets_forth, link.packets_back, link.bytes_forth, link.bytes_back, link.corrections,
              link.replays, link.states_beyond_history, link.samples_held, link.samples_filled}) {
            file << ',' << count;
        }
        for (const bool touched : row.direct_bodies) {
            file << ',' << touched;
        }
        file << '\n';
    }
    file.close();
    return !file.fail();
}

namespace {

// What a pushed hand did: how deep it went, how far beyond where it came to rest, and how much energy the
// device gave it (a wall that is really there takes some).
struct Pushing {
    double deepest = 0.0, settled = 0.0, energy = 0.0;
    std::size_t settled_ticks = 0;

    void add(const TeleopCase& experiment, double time, double depth, const Vec3& force,
             const Vec3& velocity) {
        deepest = std::max(deepest, depth);
        energy += glm::dot(force, velocity) * tick_seconds;
        if (time >= experiment.settled_from && time < experiment.settled_to) {
            settled += depth;
            ++settled_ticks;
        }
    }
    void tell(const std::string& prefix, TeleopFigures& figures) const {
        const double rest = settled_ticks > 0 ? settled / static_cast<double>(settled_ticks) : 0.0;
        figures[prefix + "penetration_max_mm"] = 1e3 * deepest;
        figures[prefix + "settled_depth_mm"] = 1e3 * rest;
        figures[prefix + "overshoot_mm"] = 1e3 * (deepest - rest);
        figures[prefix + "energy_J"] = energy;
    }
};

void evaluate_arm(const std::vector<TeleopRow>& rows, const TeleopCase& experiment, TeleopFigures& figures) {
    Pushing over_the_link, local;
    PortEnergy local_port;
    Series deviation, speed, felt, direct, off, contact;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const TeleopRow& row = rows[i];
        const double time = to_seconds(row.time);
        over_the_link.add(experiment, time, row.depth, row.force, row.velocity);
        local.add(experiment, time, row.local_depth, row.local_force, row.local_velocity);
        deviation.add(glm::distance(row.hand, row.local_hand));
        if (i > 0) {
            local_port.add(rows[i - 1].local_force, row.local_hand - rows[i - 1].local_hand);
        }
        if (time >= experiment.settled_from && time < experiment.settled_to) {
            speed.add(glm::length(row.velocity));
            felt.add(glm::length(row.force));
            direct.add(glm::length(row.direct));
            off.add(force_error(row.force, row.direct));
            contact.add(row.direct_touches ? 1.0 : 0.0);
        }
    }
    figures["local_energy_created_J"] = local_port.created();
    figures["restless_mm_s"] = 1e3 * speed.mean();
    // Of the ticks while the hand holds, in which it would touch the environment where it is: without any,
    // the force errors there are those of two hands in the air.
    figures["settled_contact_share"] = contact.mean();
    figures["settled_direct_force_N"] = direct.mean();
    figures["settled_force_error_N"] = off.mean();
    figures["settled_force_share"] = direct.sum > 0.0 ? felt.sum / direct.sum : 0.0;
    over_the_link.tell("", figures);
    local.tell("local_", figures);
    figures["hand_deviation_rms_mm"] = 1e3 * deviation.rms();
}

// How long after each leave-taking the object needs to be where it is at the far side (unit: seconds).
double longest_until_right(const std::vector<TeleopRow>& rows) {
    constexpr double right = 1e-4;
    constexpr std::size_t apart = 250;  // ticks without touch that make a leave-taking
    double longest = 0.0;
    for (std::size_t i = 1; i + apart < rows.size(); ++i) {
        if (!rows[i - 1].touches || rows[i].touches) {
            continue;
        }
        std::size_t end = i;
        while (end < rows.size() && !rows[end].touches) {
            ++end;
        }
        if (end - i < apart) {
            continue;
        }
        std::size_t wrong_at = i;
        for (std::size_t j = i; j < end; ++j) {
            if (rows[j].far_known && rows[j].box_error > right) {
                wrong_at = j;
            }
        }
        longest = std::max(longest, static_cast<double>(wrong_at - i) * tick_seconds);
    }
    return longest;
}

// How long at a time the object is farther from where it is at the far side than the boxes of the dynamic
// testbed are long (unit: seconds).
double longest_lost(const std::vector<TeleopRow>& rows) {
    constexpr double edge = 0.15;
    std::size_t longest = 0, now = 0;
    for (const TeleopRow& row : rows) {
        now = row.far_known ? (row.box_error > edge ? now + 1 : 0) : now;  // a sample may be left out
        longest = std::max(longest, now);
    }
    return static_cast<double>(longest) * tick_seconds;
}

// How one figure of all ticks spreads.
class Spread {
public:
    void add(double value) {
        values_.push_back(value);
        series_.add(value);
    }
    const Series& series() const { return series_; }
    void tell_before_unit(const std::string& name, const std::string& unit, TeleopFigures& figures) const {
        figures[name + "_mean_" + unit] = series_.mean();
        figures[name + "_p95_" + unit] = percentile(values_, 0.95);
        figures[name + "_p99_" + unit] = percentile(values_, 0.99);
        figures[name + "_max_" + unit] = series_.largest;
    }
    void tell(const std::string& name, const std::string& unit, TeleopFigures& figures) const {
        figures[name + "_" + unit + "_mean"] = series_.mean();
        figures[name + "_" + unit + "_p95"] = percentile(values_, 0.95);
        figures[name + "_" + unit + "_p99"] = percentile(values_, 0.99);
        figures[name + "_" + unit + "_max"] = series_.largest;
    }
    void count(std::map<int, std::uint64_t>& bins) const {
        for (const double value : values_) {
            const double place = value > 0.0 ? std::floor(100.0 * std::log10(value)) : no_bin;
            ++bins[static_cast<int>(std::clamp(place, double{no_bin}, double{last_bin}))];
        }
    }

private:
    std::vector<double> values_;
    Series series_;
};

void find_excess(std::vector<TeleopRow>& rows) {
    const auto within = [&](std::size_t i, std::size_t window) {
        const std::size_t before = i - std::min(i, window);
        return felt_excess(rows[i].force, rows[i].direct, rows[before].force, rows[before].direct);
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].excess_1ms = within(i, 1);
        rows[i].excess_100ms = within(i, 100);
    }
}

// The least that is left to any way that hears of a mistake one delay after it has shown: no way can be right
// before. Its force is right at once then, and nothing of that is felt; no way reaches both.
void assume_known(std::vector<TeleopRow>& rows, double delay) {
    const auto shows = std::ranges::find_if(rows, [](const TeleopRow& row) {
        return row.box_error > 1e-7 || force_error(row.force, row.direct) > 1e-6;
    });
    const auto known = static_cast<std::ptrdiff_t>(delay / tick_seconds);
    for (auto row = shows; row != rows.end(); ++row) {
        if (row - shows >= known) {
            row->force = row->direct;
            row->box_error = row->turn_error = 0.0;
            row->excess_1ms = row->excess_100ms = {};
        }
    }
}

// What is felt of the model's being put right: from the first correction on, and of nothing before it.
void evaluate_once_told(const std::vector<TeleopRow>& rows, TeleopFigures& figures) {
    const auto first =
        std::ranges::find_if(rows, [](const TeleopRow& row) { return row.link.corrections > 0; });
    const auto told = static_cast<std::size_t>(first - rows.begin());
    double newtons = 0.0, jnd = 0.0;
    for (std::size_t i = std::max<std::size_t>(told, 1); i < rows.size(); ++i) {
        const std::size_t before =
            std::max(i - std::min<std::size_t>(i, 100), told - std::min<std::size_t>(told, 1));
        const FeltExcess excess =
            felt_excess(rows[i].force, rows[i].direct, rows[before].force, rows[before].direct);
        newtons = std::max(newtons, excess.newtons);
        jnd = std::max(jnd, excess.jnd);
    }
    figures["felt_excess_once_told_100ms_N_max"] = newtons;
    figures["felt_excess_once_told_100ms_jnd_max"] = jnd;
}

void evaluate_excess(const std::vector<TeleopRow>& rows, const TeleopCase& experiment, TeleopFigures& figures,
                     TeleopBins* bins) {
    Spread steps_N, steps_jnd, changes_N, changes_jnd;
    double left = 0.0;
    for (const TeleopRow& row : rows) {
        const double time = to_seconds(row.time);
        if (time < experiment.measured_from || time >= experiment.measured_to) {
            continue;
        }
        left = force_error(row.force, row.direct);
        steps_N.add(row.excess_1ms.newtons);
        steps_jnd.add(row.excess_1ms.jnd);
        changes_N.add(row.excess_100ms.newtons);
        changes_jnd.add(row.excess_100ms.jnd);
    }
    const auto tell = [&](const Spread& spread, const std::string& name, const std::string& unit) {
        spread.tell(name, unit, figures);
        if (bins) {
            spread.count((*bins)[name + "_" + unit]);
        }
    };
    figures["force_error_left_N"] = left;  // when the last tick was measured
    tell(steps_N, "felt_excess_1ms", "N");
    tell(steps_jnd, "felt_excess_1ms", "jnd");
    tell(changes_N, "felt_excess_100ms", "N");
    tell(changes_jnd, "felt_excess_100ms", "jnd");
}

// Of the whole run. A force is held until the next tick.
void evaluate_energy(const std::vector<TeleopRow>& rows, TeleopFigures& figures) {
    PortEnergy hand, far;
    // The most that the hand, and that both together, have been given on balance since the start.
    double hand_most = 0.0, link_created = 0.0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const TeleopRow &before = rows[i - 1], &row = rows[i];
        hand.add(before.force, row.hand - before.hand);
        far.add(-before.there_force, row.there_hand - before.there_hand);
        hand_most = std::max(hand_most, hand.total());
        link_created = std::max(link_created, hand.total() + far.total());
    }
    figures["energy_at_hand_J"] = hand.total();
    figures["energy_at_far_side_J"] = far.total();
    figures["energy_at_hand_most_J"] = hand_most;
    figures["energy_created_J"] = hand.created();
    figures["link_energy_created_J"] = link_created;
}

// `seconds`: of the run, by which what is counted becomes a rate.
void evaluate_link(const LinkCounts& link, double seconds, TeleopFigures& figures) {
    const auto per_second = [&](std::uint64_t count) { return static_cast<double>(count) / seconds; };
    // With all that UDP and IPv4 add.
    constexpr std::uint64_t headers = 28;
    figures["packets_forth_per_s"] = per_second(link.packets_forth);
    figures["packets_back_per_s"] = per_second(link.packets_back);
    figures["packets_per_s"] = per_second(link.packets_forth + link.packets_back);
    figures["bytes_per_s"] = per_second(link.bytes_forth + link.bytes_back);
    figures["bits_forth_per_s"] = 8.0 * per_second(link.bytes_forth + link.packets_forth * headers);
    figures["bits_back_per_s"] = 8.0 * per_second(link.bytes_back + link.packets_back * headers);
    figures["bits_per_s"] = figures["bits_forth_per_s"] + figures["bits_back_per_s"];
    figures["corrections"] = static_cast<double>(link.corrections);
    figures["replays"] = static_cast<double>(link.replays);
    figures["states_beyond_history"] = static_cast<double>(link.states_beyond_history);
    figures["samples_held"] = static_cast<double>(link.samples_held);
    figures["samples_filled"] = static_cast<double>(link.samples_filled);
    figures["round_trip_ms"] = 1e3 * link.round_trip;
}

void evaluate_contact(const std::vector<TeleopRow>& rows, const std::vector<std::string>& bodies,
                      TeleopFigures& figures) {
    for (std::size_t body = 0; body < bodies.size(); ++body) {
        const auto ticks =
            std::ranges::count_if(rows, [body](const TeleopRow& row) { return row.direct_bodies[body]; });
        figures[bodies[body] + "_contact_share"] =
            static_cast<double>(ticks) / static_cast<double>(rows.size());
    }
}

}  // namespace

TeleopFigures evaluate(std::vector<TeleopRow>& rows, const TeleopCase& experiment,
                       const std::vector<std::string>& bodies, TeleopBins* bins) {
    TeleopFigures figures;
    Series shifted, turn, jitter, hand;
    Spread error, box;
    std::vector<double> shares;
    std::array<HighPass, 3> filters{HighPass(30.0), HighPass(30.0), HighPass(30.0)};
    const std::size_t shift =
        experiment.settings.traditional
            ? static_cast<std::size_t>((experiment.forth.delay + experiment.back.delay) / period + 1)
            : 0;
    double last_wrong = 0.0, first_touch = -1.0;
    // What is assumed below changes the force alone, and no energy.
    evaluate_energy(rows, figures);
    evaluate_contact(rows, bodies, figures);
    find_excess(rows);
    if (experiment.known_after) {
        assume_known(rows, *experiment.known_after);
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const TeleopRow& row = rows[i];
        const double wrong = force_error(row.force, row.direct);
        error.add(wrong);
        if (i >= shift && rows[i - shift].far_known) {
            shifted.add(force_error_shifted(row.force, rows[i - shift].far));
        }
        if (row.far_known) {
            box.add(1e3 * row.box_error);
            turn.add(row.turn_error);
            hand.add(1e3 * row.hand_error);
        }
        const Vec3 fast(filters[0](row.force.x), filters[1](row.force.y), filters[2](row.force.z));
        jitter.add(glm::length(fast));
        if (row.jnd_share > 0.0) {
            shares.push_back(row.jnd_share);
        }
        if (first_touch < 0.0 && row.direct_touches) {
            first_touch = to_seconds(row.time);
        }
        if (wrong > 0.02) {
            last_wrong = to_seconds(row.time);
        }
    }
    error.tell_before_unit("force_error", "N", figures);
    figures["force_error_shifted_mean_N"] = shifted.mean();
    figures["hand_position_error_rms_mm"] = hand.rms();
    figures["force_jitter_rms_N"] = jitter.rms();
    figures["correction_cost_jnd_p99"] = percentile(shares, 0.99);
    figures["seconds_until_right"] = first_touch < 0.0 ? 0.0 : std::max(0.0, last_wrong - first_touch);
    evaluate_excess(rows, experiment, figures, bins);
    evaluate_once_told(rows, figures);
    if (!rows.empty()) {
        evaluate_link(rows.back().link, experiment.seconds, figures);
    }
    double largest_step = 0.0;
    for (const TeleopRow& row : rows) {
        largest_step = std::max(largest_step, row.force_step);
    }
    figures["correction_force_step_max_N"] = largest_step;
    figures["let_go_ticks"] =
        static_cast<double>(std::ranges::count_if(rows, [](const TeleopRow& row) { return row.let_go; }));
    if (experiment.uses_arm) {
        evaluate_arm(rows, experiment, figures);
    }
    if (!experiment.object.empty()) {
        const auto last =
            std::find_if(rows.rbegin(), rows.rend(), [](const TeleopRow& row) { return row.far_known; });
        box.tell_before_unit("box_position_error", "mm", figures);
        figures["box_position_error_rms_mm"] = box.series().rms();
        figures["box_position_error_final_mm"] = last == rows.rend() ? 0.0 : 1e3 * last->box_error;
        if (last != rows.rend()) {
            for (int axis = 0; axis < 3; ++axis) {
                const std::string name = std::string("_final_") + "xyz"[axis];
                figures["model" + name] = last->model.position[axis];
                figures["truth" + name] = last->truth.position[axis];
            }
        }
        figures["box_rotation_error_rms_deg"] = 57.29577951308232 * turn.rms();
        figures["box_right_after_letting_go_s"] = longest_until_right(rows);
        figures["box_lost_longest_s"] = longest_lost(rows);
    }
    return figures;
}

}  // namespace tactus::shared
