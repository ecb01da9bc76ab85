#include "proxy/rough.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <numeric>
#include <span>

#include "proxy/players.hpp"
#include "shared/free_way.hpp"
#include "shared/judge_tree.hpp"
#include "shared/reference_descent.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/rough_paths.hpp"
#include "shared/settled_shape.hpp"
#include "shared/unseen_meshes.hpp"

namespace tactus::bench {

namespace {

using shared::FreeWay;
using shared::JudgeTree;
using shared::SlowVec3;

constexpr std::array radii{0.01, 0.05, 0.2};
constexpr double worth_a_doubt = 1e-5;     // an error of that much may be the judge's (unit: meters)
constexpr int max_unfinished_checks = 20;  // a case and kind: descent from far off is slow

struct Played {
    Vec3 hand{0.0};
    Vec3 position{0.0};
    double microseconds = 1e300;
    std::uint32_t status = 0;
};

struct Verdict {
    int contact_ticks = 0, penetrations = 0, passes = 0, unjudged = 0;
    int unfinished = 0, frozen = 0;
    int checked = 0, unsettled = 0, balanced = 0, other_replays = 0;
    int stuck = 0;                            // checked finished ticks that end farther off than 1e-3 radii
    double error_rms = 0.0, error_max = 0.0;  // of finished ticks, of the size
    double unfinished_error_max = 0.0;        // how far off unfinished ticks are, of the size
    double thrown_max = 0.0;                  // how far a tick leads away from its hand (unit: radii)
    double mean = 0.0, p95 = 0.0, p99 = 0.0;  // of the ticks in contact (unit: microseconds)
    double max = 0.0;                         // of all ticks (unit: microseconds)
    int slowest_tick = -1;
};

bool is_in_contact(const Played& tick) {
    return (tick.status & (proxy_touching | proxy_unfinished)) != 0;
}

// The same ticks over and over, each time by a player that is made anew; a tick's time is the least of them.
template <class MakePlayer>
std::vector<Played> play(const shared::SpanClock& clock, const MakePlayer& make, const std::vector<Vec3>& way,
                         int replays, Verdict& verdict) {
    std::vector<Played> ticks(way.size());
    for (int replay = 0; replay < replays; ++replay) {
        auto player = make();
        for (std::size_t i = 0; i < way.size(); ++i) {
            const std::uint64_t start = clock.now();
            const PlayedTick tick = player.tick(way[i]);
            const std::uint64_t end = clock.now();
            Played& played = ticks[i];
            if (replay == 0) {
                played.hand = way[i];
                played.position = tick.position;
                played.status = tick.status;
                verdict.contact_ticks += tick.touching;
            }
            verdict.other_replays += played.position != tick.position;
            played.microseconds = std::min(played.microseconds, 1e-3 * clock.nanoseconds(start, end));
        }
    }
    return ticks;
}

void judge_times(const std::vector<Played>& ticks, Verdict& verdict) {
    std::vector<double> contact;
    for (const Played& tick : ticks) {
        if (is_in_contact(tick)) {
            contact.push_back(tick.microseconds);
        }
    }
    const auto slowest = std::ranges::max_element(ticks, {}, &Played::microseconds);
    verdict.max = slowest->microseconds;
    verdict.slowest_tick = static_cast<int>(slowest - ticks.begin());
    if (!contact.empty()) {
        verdict.mean =
            std::accumulate(contact.begin(), contact.end(), 0.0) / static_cast<double>(contact.size());
        verdict.p95 = shared::quantile(contact, 0.95);
        verdict.p99 = shared::quantile(contact, 0.99);
    }
}

// Clearance of every tick, that a free way leads from each to the next, and not away from the hand.
void judge_places(const std::vector<Played>& ticks, const JudgeTree& tree, double radius, Verdict& verdict) {
    double known = -1.0;  // distance from the mesh at `known_at`
    Vec3 known_at(0.0);
    const Played* before = nullptr;
    for (const Played& tick : ticks) {
        if (tick.status & proxy_absent) {
            before = nullptr;
            continue;
        }
        const Vec3& p = tick.position;
        const double rounding = 8.0 * 0x1p-52 * (tree.magnitude() + glm::length(p));
        if (known - glm::distance(p, known_at) < 1.1 * radius) {
            const shared::JudgedNearest nearest = tree.nearest(p, 3.0 * radius);
            known = nearest.distance;
            known_at = p;
            if (known < radius - rounding) {
                const shared::Corners t = shared::corners_of(tree.mesh(), nearest.triangle);
                verdict.penetrations += shared::slow_distance(p, t) < radius - rounding;
            }
        }
        if (before) {
            const double thrown = glm::distance(p, tick.hand) - glm::distance(before->position, tick.hand);
            verdict.thrown_max = std::max(verdict.thrown_max, thrown / radius);
        }
        if (before && !is_straight_way_free(tree, before->position, p, radius)) {
            const double reach = glm::distance(before->position, tick.hand) + 0.01 * radius;
            const FreeWay way = find_free_way(tree, before->position, p, radius, tick.hand, reach);
            verdict.passes += way == FreeWay::none;
            verdict.unjudged += way == FreeWay::unknown;
        }
        before = &tick;
    }
}

// Unfinished ticks against exact descent. A tick that could have moved and has not is frozen; beyond the
// first checks, a tick that stands still is judged like the last one that was looked at.
class UnfinishedTicks {
public:
    UnfinishedTicks(shared::ReferenceDescent& reference, double radius, Verdict& verdict)
        : reference_(reference), radius_(radius), verdict_(verdict) {}

    void judge(const Played& tick, double moved) {
        ++verdict_.unfinished;
        const bool still = moved < 1e-3 * radius_;
        int& checked = still ? still_checked_ : going_checked_;
        if (checked < max_unfinished_checks) {
            ++checked;
            const shared::ReferencePlace place = reference_.settle(tick.position, tick.hand);
            const auto error = static_cast<double>(glm::distance(place.position, SlowVec3(tick.position)));
            verdict_.unfinished_error_max = std::max(verdict_.unfinished_error_max, error);
            frozen_ = error > 1e-3 * radius_ && moved < 1e-3 * std::min(error, radius_);
        }
        verdict_.frozen += still && frozen_;
    }

private:
    shared::ReferenceDescent& reference_;
    double radius_;
    Verdict& verdict_;
    int still_checked_ = 0, going_checked_ = 0;
    bool frozen_ = false;
};

// Places against exact descent: some of the finished ticks, and those that say they are not finished.
void judge_ends(const std::vector<Played>& ticks, const JudgeTree& tree, double radius, int checks,
                Verdict& verdict) {
    shared::ReferenceDescent reference(tree, radius);
    UnfinishedTicks unfinished(reference, radius, verdict);
    const auto contacts = static_cast<int>(std::ranges::count_if(ticks, is_in_contact));
    const int every = std::max(1, contacts / std::max(1, checks));
    double sum = 0.0;
    int seen = 0;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        const Played& tick = ticks[i];
        if (tick.status & proxy_unfinished) {
            unfinished.judge(tick, i > 0 ? glm::distance(ticks[i - 1].position, tick.position) : 0.0);
        } else if (is_in_contact(tick) && seen++ % every == 0) {
            const shared::ReferencePlace place = reference.settle(tick.position, tick.hand);
            const auto error = static_cast<double>(glm::distance(place.position, SlowVec3(tick.position)));
            ++verdict.checked;
            verdict.unsettled += !place.settled;
            if (error > worth_a_doubt &&
                reference.is_balanced(tick.position, tick.hand, place.position, 0.5 * error)) {
                ++verdict.balanced;
                continue;
            }
            verdict.stuck += error > 1e-3 * radius;
            verdict.error_max = std::max(verdict.error_max, error);
            sum += error * error;
        }
    }
    const int held = verdict.checked - verdict.balanced;
    verdict.error_rms = held > 0 ? std::sqrt(sum / held) : 0.0;
}

// What is reported of a case, and of all cases of a kind.
struct Count {
    int Verdict::* figure;
    const char* name;
};
constexpr Count counts[] = {
    {&Verdict::contact_ticks, "contact_ticks"},
    {&Verdict::penetrations, "penetrations"},
    {&Verdict::passes, "passes"},
    {&Verdict::unjudged, "unjudged_ways"},
    {&Verdict::frozen, "frozen_ticks"},
    {&Verdict::unfinished, "unfinished_ticks"},
    {&Verdict::checked, "checked_ticks"},
    {&Verdict::unsettled, "reference_unsettled"},
    {&Verdict::balanced, "balanced_ticks"},
    {&Verdict::stuck, "stuck_ticks"},
    {&Verdict::other_replays, "other_replays"},
};
struct Size {
    double Verdict::* figure;
    const char* of_case;
    const char* of_kind;  // the largest
};
constexpr Size sizes[] = {
    {&Verdict::mean, "mean_us", "worst_mean_us"},
    {&Verdict::p95, "p95_us", "worst_p95_us"},
    {&Verdict::p99, "p99_us", "worst_p99_us"},
    {&Verdict::max, "max_us", "worst_max_us"},
    {&Verdict::error_rms, "error_rms", "error_rms_max"},
    {&Verdict::error_max, "error_max", "error_max"},
    {&Verdict::unfinished_error_max, "unfinished_error_max", "unfinished_error_max"},
    {&Verdict::thrown_max, "thrown_max_radii", "thrown_max_radii"},
};

void tell(const std::string& name, const Verdict& v, int ticks, shared::Report& report) {
    report.set(name + ".ticks", ticks);
    for (const Count& count : counts) {
        report.set(name + "." + count.name, v.*count.figure);
    }
    for (const Size& size : sizes) {
        report.set(name + "." + size.of_case, v.*size.figure);
    }
    std::printf("%-38s %7d %8.2f %8.2f %8.2f %9.2f %6d %5d %5d %5d %7d %7d %9.1e %9.1e %9.1e %7.1e\n",
                name.c_str(), v.contact_ticks, v.mean, v.p95, v.p99, v.max, v.slowest_tick, v.penetrations,
                v.passes, v.unjudged, v.frozen, v.unfinished, v.error_rms, v.error_max,
                v.unfinished_error_max, v.thrown_max);
    std::fflush(stdout);
}

struct Total {
    int cases = 0;
    double ticks = 0.0;
    Verdict sum;  // counts added, times and errors the largest

    void add(const Verdict& v, int ticks_of_case) {
        ++cases;
        ticks += ticks_of_case;
        for (const Count& count : counts) {
            sum.*count.figure += v.*count.figure;
        }
        for (const Size& size : sizes) {
            sum.*size.figure = std::max(sum.*size.figure, v.*size.figure);
        }
    }
};

void tell_total(const std::string& kind, const Total& total, shared::Report& report) {
    const Verdict& v = total.sum;
    report.set(kind + ".cases", total.cases);
    report.set(kind + ".ticks", total.ticks);
    report.set(kind + ".unfinished_share", v.unfinished / std::max(1.0, total.ticks));
    for (const Count& count : counts) {
        report.set(kind + "." + count.name, v.*count.figure);
    }
    for (const Size& size : sizes) {
        report.set(kind + "." + size.of_kind, v.*size.figure);
    }
    std::printf(
        "%d %s cases, %.0f ticks: %d penetrations, %d passes (%d ways too long to judge), %d "
        "frozen, %.2e unfinished (off by %.1e at most), thrown by %.1e radii at most, error rms %.1e max "
        "%.1e, worst mean %.2f "
        "p95 %.2f p99 %.2f max %.2f us, %d ticks different in a replay\n",
        total.cases, kind.c_str(), total.ticks, v.penetrations, v.passes, v.unjudged, v.frozen,
        v.unfinished / std::max(1.0, total.ticks), v.unfinished_error_max, v.thrown_max, v.error_rms,
        v.error_max, v.mean, v.p95, v.p99, v.max, v.other_replays);
}

// A mesh as spheres of each radius touch it in a world.
class NarrowedShapes {
public:
    NarrowedShapes(const shared::SpanClock& clock, std::shared_ptr<const TouchShape> whole, std::string name,
                   bool is_asked_for)
        : clock_(clock), whole_(std::move(whole)), name_(std::move(name)), is_asked_for_(is_asked_for) {}

    const std::shared_ptr<const TouchShape>& get(double radius, shared::Report& report) {
        if (!is_asked_for_) {
            return whole_;
        }
        const auto [at, is_new] = by_radius_.try_emplace(radius, whole_);
        if (is_new) {
            const std::uint64_t start = clock_.now();
            if (auto shape = narrowed(*whole_, radius, shared::run_on_two_threads)) {
                at->second = std::move(shape);
            }
            const double milliseconds = 1e-6 * clock_.nanoseconds(start, clock_.now());
            shared::settle(*at->second);
            const TouchPart& part = at->second->parts.front();
            const double all = static_cast<double>(part.tree()->triangle_count());
            char key[16];
            std::snprintf(key, sizeof key, "_r%g", radius);
            report.set(
                name_ + key + ".touchable_share",
                part.touchable ? static_cast<double>(part.touchable->tree->triangle_count()) / all : 1.0);
            report.set(name_ + key + ".narrowing_ms", milliseconds);
        }
        return at->second;
    }

private:
    const shared::SpanClock& clock_;
    std::shared_ptr<const TouchShape> whole_;
    std::string name_;
    bool is_asked_for_;
    std::map<double, std::shared_ptr<const TouchShape>> by_radius_;
};

std::string case_name(const std::string& mesh, double radius, const char* path) {
    char text[64];
    std::snprintf(text, sizeof text, "_r%g_", radius);
    return mesh + text + path;
}

struct Kind {
    std::string name;  // cases are called NAME_MESH_TRIANGLES_rR_PATH
    std::span<const shared::RoughMesh> meshes;
};

void measure_kind(const Kind& kind, const shared::SpanClock& clock, const RoughSettings& settings,
                  shared::Report& report) {
    const std::string prefix = settings.three_pass ? three_pass_prefix : "";
    Total total;
    for (const shared::RoughMesh& rough : kind.meshes) {
        // Names hold the number of triangles, which only the mesh itself knows.
        if (!shared::is_chosen(kind.name + "_" + rough.name + "_", settings.only, false)) {
            continue;
        }
        const auto mesh = std::make_shared<const TriangleMesh>(rough.make());
        const std::string mesh_name =
            kind.name + "_" + rough.name + "_" + std::to_string(mesh->triangles.size());
        std::vector<std::pair<double, const shared::RoughPath*>> chosen;
        for (const double radius : radii) {
            for (const shared::RoughPath& path : shared::rough_paths()) {
                if (shared::is_chosen(case_name(mesh_name, radius, path.name), settings.only)) {
                    chosen.emplace_back(radius, &path);
                }
            }
        }
        if (chosen.empty() || static_cast<int>(mesh->triangles.size()) > settings.max_triangles) {
            continue;
        }
        if (total.cases == 0) {
            std::printf("%-38s %7s %8s %8s %8s %9s %6s %5s %5s %5s %7s %7s %9s %9s %9s %7s\n", "case",
                        "contact", "mean us", "p95 us", "p99 us", "max us", "at", "penet", "pass", "?",
                        "frozen", "unfin.", "err rms", "err max", "unf. err", "thrown");
        }
        const JudgeTree tree(*mesh);
        const PlacedShape placed{MeshShape{mesh}, {}};
        const std::shared_ptr<const TouchShape> shape =
            make_touch_shape({&placed, 1}, shared::run_on_two_threads).shape;
        shared::settle(*shape);
        NarrowedShapes shapes(clock, shape, mesh_name, settings.narrowed);
        for (const auto& [radius, path] : chosen) {
            Verdict verdict;
            const std::vector<Vec3> way = path->make(tree, radius, settings.ticks);
            const auto ours = [&, radius = radius] {
                return OurPlayer(shapes.get(radius, report), radius, settings.max_work);
            };
            const auto three_pass = [&, radius = radius] {
                return ThreePassPlayer(tree, radius, *settings.three_pass);
            };
            const std::vector<Played> ticks = settings.three_pass
                                                  ? play(clock, three_pass, way, settings.replays, verdict)
                                                  : play(clock, ours, way, settings.replays, verdict);
            judge_times(ticks, verdict);
            judge_places(ticks, tree, radius, verdict);
            judge_ends(ticks, tree, radius, settings.checks, verdict);
            tell(prefix + case_name(mesh_name, radius, path->name), verdict, settings.ticks, report);
            total.add(verdict, settings.ticks);
        }
    }
    if (total.cases > 0) {
        tell_total(prefix + kind.name, total, report);
    }
}

}  // namespace

void measure_rough(const shared::SpanClock& clock, const RoughSettings& settings, shared::Report& report) {
    measure_kind({"rough", shared::rough_meshes()}, clock, settings, report);
    measure_kind({"unseen", shared::unseen_meshes()}, clock, settings, report);
}

}  // namespace tactus::bench
