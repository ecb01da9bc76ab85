// The links of a world that is a side of a teleoperation: one of an operator, or one of an environment for
// each of its operators. Main thread only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "nodes/link_run.hpp"

namespace tactus {

class LinkRuns {
public:
    // See LinkRun. Attaches a side to the session, where there is any link.
    LinkRuns(const std::vector<MMTLink*>& nodes, HapticWorld& world, Session& session,
             const std::atomic<Nanoseconds>* ahead);

    bool empty() const { return runs_.empty(); }
    // The operator's, whose bodies are a model; null: the world's own scene is touched.
    LinkRun* model() const {
        return !runs_.empty() && runs_.front()->is_operator() ? runs_.front().get() : nullptr;
    }

    void forget(const MMTLink* node);
    void synchronise(Workers& workers, const LinkMoment& moment);
    void tell(const BodyMirrors& scene, const SessionSnapshot& snapshot, Nanoseconds now);
    void leave();
    void end();
    std::vector<LinkRun::News> take_news();
    std::vector<std::string> problems() const;

private:
    std::vector<std::unique_ptr<LinkRun>> runs_;
};

}  // namespace tactus
