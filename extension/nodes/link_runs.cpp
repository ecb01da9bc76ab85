#include "nodes/link_runs.hpp"

#include "session/shared_environment.hpp"

namespace tactus {

LinkRuns::LinkRuns(const std::vector<MMTLink*>& nodes, HapticWorld& world, Session& session,
                   const std::atomic<Nanoseconds>* ahead) {
    std::vector<std::unique_ptr<TeleopSide>> sides;
    for (MMTLink* const node : nodes) {
        runs_.push_back(std::make_unique<LinkRun>(*node, world, session, ahead));
        sides.push_back(runs_.back()->make_side({sides.size(), nodes.size()}));
    }
    if (sides.size() == 1) {
        session.attach(std::move(sides.front()));
    } else if (!sides.empty()) {
        session.attach(std::make_unique<SharedEnvironment>(std::move(sides)));
    }
}

void LinkRuns::forget(const MMTLink* node) {
    for (const auto& run : runs_) {
        if (run->is_of(node)) {
            run->forget_node();
        }
    }
}

void LinkRuns::synchronise(Workers& workers, const LinkMoment& moment) {
    for (const auto& run : runs_) {
        run->synchronise(workers, moment);
    }
}

void LinkRuns::tell(const BodyMirrors& scene, const SessionSnapshot& snapshot, Nanoseconds now) {
    for (const auto& run : runs_) {
        run->tell(scene, snapshot, now);
    }
}

void LinkRuns::leave() {
    for (const auto& run : runs_) {
        run->leave();
    }
}

void LinkRuns::end() {
    for (const auto& run : runs_) {
        run->end();
    }
}

std::vector<LinkRun::News> LinkRuns::take_news() {
    std::vector<LinkRun::News> news;
    for (const auto& run : runs_) {
        news.push_back(run->take_news());
    }
    return news;
}

std::vector<std::string> LinkRuns::problems() const {
    std::vector<std::string> all;
    for (const auto& run : runs_) {
        for (std::string& problem : run->problems()) {
            all.push_back(std::move(problem));
        }
    }
    return all;
}

}  // namespace tactus
