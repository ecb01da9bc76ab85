// Two sessions with the same bodies, joined by a link with a delay, ticked in virtual time: what an
// operator's model and the environment have become after the same sample of the hand.
#pragma once

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <vector>

#include "emulated_link.hpp"
#include "session/side_plan.hpp"
#include "session_rig.hpp"
#include "shared/endpoints.hpp"

namespace tactus::session_test {

using shared::endpoint;

class LinkedPlaces : public EmulatedLink {
public:
    struct Place {
        Place(const SessionSettings& settings, int hands, InputRecorder* recorder)
            : session(settings, recorder), devices(hands) {}
        void add_hands() {
            Workspace workspace;
            workspace.force_limit = 100.0;
            for (HeldDevice& device : devices) {
                device.position = {0.0, 5.0, 0.0};
                ProxyDescription pointer;
                pointer.device = session.add_device(device, workspace).handle;
                session.add_proxy(pointer);
            }
        }
        Pose pose(SessionHandle body) const {
            const SessionSnapshot& snapshot = session.snapshot();
            const BodyState* const state = state_of(snapshot.bodies, snapshot.body_count, body);
            return state ? state->pose : Pose{};
        }

        Session session;
        std::vector<HeldDevice> devices;
        std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    };

    // `delay`: there and back (unit: seconds).
    LinkedPlaces(double delay, double loss, int hands, const TeleopSettings& here = {},
                 const TeleopSettings& there = {}, std::size_t tracked = 64,
                 InputRecorder* near_inputs = nullptr, InputRecorder* far_inputs = nullptr)
        : EmulatedLink(delay, loss),
          settings_(session_settings()),
          near(settings_, hands, near_inputs),
          far(settings_, hands, far_inputs) {
        OperatorRoom room;
        room.max_tracked = tracked;
        near.session.attach(
            {{{SidePlan::Kind::operator_side, here, endpoint(Side::operator_side, 1), room, {}},
              &at_near_,
              near.port}});
        far.session.attach(
            {{{SidePlan::Kind::environment, there, endpoint(Side::teleoperator_side, 2), {}, {}},
              &at_far_,
              far.port}});
        near.add_hands();
        far.add_hands();
    }

    SessionHandle add(const BodyAddition& there, const BodyAddition& here) {
        const SessionHandle handle = far.session.add_body(there).handle;
        EXPECT_EQ(near.session.add_body(here).handle, handle);
        near.port->bindings.try_push({handle, handle});
        watched.push_back(handle);
        return handle;
    }
    SessionHandle add(const BodyAddition& both) { return add(both, both); }
    void settle() {
        near.session.settle();
        far.session.settle();
    }

    void tick() {
        now += period;
        for (Place* const place : {&near, &far}) {
            place->session.tick(now);
            place->session.refresh();
            place->session.collect();
            place->port->statistics.refresh();
        }
        Moment& ours = moments_[near.port->statistics.front().sample];
        for (const SessionHandle body : watched) {
            ours.near.push_back(near.pose(body));
        }
        if (const auto same = moments_.find(far.port->statistics.front().sample); same != moments_.end()) {
            same->second.far.clear();
            for (const SessionHandle body : watched) {
                same->second.far.push_back(far.pose(body));
            }
            answered = same->first;
        }
    }
    void ticks(int count) {
        for (int i = 0; i < count; ++i) {
            tick();
        }
    }

    // How far model and environment are apart after the newest sample that both know (unit: meters).
    double apart(std::size_t watched_index) const {
        const auto found = moments_.find(answered);
        if (found == moments_.end() || found->second.far.size() <= watched_index ||
            found->second.near.size() <= watched_index) {
            return 0.0;
        }
        return glm::distance(found->second.near[watched_index].position,
                             found->second.far[watched_index].position);
    }
    const TeleopStatistics& statistics() const { return near.port->statistics.front(); }

    static SessionSettings session_settings() {
        SessionSettings settings;
        settings.max_bodies = 256;
        settings.max_parts = 512;
        settings.full_rate_bodies = 0;
        return settings;
    }

private:
    struct Moment {
        std::vector<Pose> near, far;
    };

    SessionSettings settings_;

public:
    Place near, far;
    Nanoseconds now = 0;
    std::vector<SessionHandle> watched;
    SampleSequence answered = no_sample;

private:
    std::map<SampleSequence, Moment> moments_;
};

}  // namespace tactus::session_test
