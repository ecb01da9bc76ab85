// Several tools in one tick. Those that may touch each other take their steps together: the motions nearest
// to all hands' at once (group_motion.hpp), along them as far as every one of them is free, and again. So
// what two tools press each other with is in balance, whatever else holds them. A tool by itself moves as
// ToolProxy::move does, to the bit. Holds nothing from one tick to the next.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/tool/group_motion.hpp"
#include "core/tool/tool_pair.hpp"
#include "core/tool/tool_proxy.hpp"

namespace tactus {

class ToolGroup {
public:
    static constexpr std::size_t max_tools = max_group;
    static constexpr std::size_t max_pairs = max_tools * (max_tools - 1) / 2;

    ToolGroup();

    void clear() { count_ = 0; }
    // `share`: of the coupling that its hand is given. What it is given is balanced. Not more than max_tools.
    void add(ToolProxy& tool, const Pose& hand, double share);
    // All that were added. Allocates nothing.
    void move(const TouchScene& scene);
    // In the order in which they were added.
    const ToolTick& tick_of(std::size_t tool) const { return members_[tool].tick; }

private:
    enum class State : std::uint8_t {
        still,  // it takes no steps together with others
        goes,
        arrived,
        stuck,  // for this tick
    };
    struct Member {
        ToolProxy* tool = nullptr;
        Pose hand;
        double share = 1.0;
        ToolTick tick;
        State state = State::still;
        bool slid = false;     // on a body
        bool was_cut = false;  // its last step, where the work has ended
        double trust = 1.0;
        int stalls = 0;

        bool moves() const { return state != State::still; }
        double stiffness() const { return share * tool->settings().stiffness; }
    };
    struct Meeting {
        ToolPair* pair = nullptr;
        int spheres = 0, surface = 0;  // among the members
        bool is_near = false;
        bool slid = false;
        ToolContacts contacts;
    };
    // Members that contacts link.
    struct Cluster {
        std::array<int, max_tools> members{};
        int count = 0;
        GroupSpace space;
        double stiffness = 0.0;  // k of group_motion.hpp (unit: newtons per meter)
        double skin = 0.0;       // the least (unit: meters)
    };
    // What a bound is made of.
    struct Source {
        ToolContact contact;
        Meeting* meeting = nullptr;  // null: a body holds the member
        int member = 0;
        double skin = 0.0;  // (unit: meters)

        bool touches() const;
    };
    struct Plan {
        GroupVector motion{};
        GroupMotion holding;
        bool possible = true;
        bool complete = true;  // false: friction is not all that it should be
    };
    using Motions = std::array<RigidMotion, max_tools>;  // of the members

    Member& member(int i) { return members_[static_cast<std::size_t>(i)]; }
    std::span<Member> members() { return {members_.data(), count_}; }
    std::span<Meeting> meetings() { return {meetings_.data(), meeting_count_}; }
    int place_of(const ToolProxy& tool);

    void find_meetings();
    void begin(const TouchScene& scene);
    void descend_together();
    void finish();
    void collect_meetings();
    std::uint32_t linked_to(int member);
    Cluster cluster_of(std::uint32_t members);
    void advance(Cluster& cluster);
    bool goes_on(const Cluster& cluster, const Plan& plan);
    Motions step(const Cluster& cluster, const Plan& plan, double trust);
    static ToolPair::Motions motions_of(const Meeting& meeting, const Motions& motions);
    void judge(const Cluster& cluster, const Motions& gone);

    // tool_group_plan.cpp
    Plan plan(Cluster& cluster);
    void collect_bounds(const Cluster& cluster);
    void add_walls(const Cluster& cluster, int place);
    void add_meeting(const Cluster& cluster, Meeting& meeting);
    void release_bounds();
    double friction_of(const Source& source) const;
    bool is_held(const GroupMotion& holding) const;
    void bound_friction();
    bool bound_slides(const Cluster& cluster, const GroupVector& x);
    GroupMotion nearest(const Cluster& cluster, const GroupVector& goal, double tolerance, WorkBudget& work,
                        const GroupMotion* like = nullptr);
    GroupMotion hold(const Cluster& cluster, const GroupVector& goal, const GroupMotion& like,
                     WorkBudget& work);
    bool begins_to_slide(const Cluster& cluster, const GroupMotion& held);
    bool is_at_rest(const Cluster& cluster, const GroupVector& x) const;
    GroupVector goal_with_friction(const Cluster& cluster, const GroupVector& goal,
                                   const GroupMotion& held) const;
    void keep_touches(const Cluster& cluster, const GroupMotion& holding);
    void keep_touch(const Cluster& cluster, const Source& source, const Vec3& force);
    void keep_meeting(int member, const Source& source, const Vec3& normal, const Vec3& force);

    std::array<Member, max_tools> members_;
    std::size_t count_ = 0;
    std::array<Meeting, max_pairs> meetings_;
    std::size_t meeting_count_ = 0;
    ToolContacts walls_;
    std::vector<Source> sources_;     // of the cluster that is looked at
    std::vector<GroupBound> bounds_;  // likewise, in the same order
    WorkBudget work_{0};
};

}  // namespace tactus
