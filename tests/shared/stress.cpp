#include "shared/stress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/reference_descent.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::shared {

namespace {

constexpr double sheet_end = 2.9;  // before scaling: every unbounded surface goes on to 3 at least
constexpr std::size_t most_failures = 40;

// Which side of the mesh a point is on, as a number that must not change. In the mesh's own frame, before
// scaling.
using Side = std::function<int(const Vec3&)>;

struct Setting {
    const char* name = "";
    TriangleMesh mesh;
    Side side;           // empty: cannot be told
    double reach = 1.0;  // the hand stays within this of the origin along each axis
    double scale = 1.0;
    Vec3 place{0.0};
    double radius = 0.02;  // before scaling
};

void add_triangle(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
}

void add_quad(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    add_triangle(mesh, a, b, c);
    add_triangle(mesh, a, c, d);
}

Setting soup(RandomValues& random) {
    Setting s;
    s.name = "soup";
    s.mesh = shared::soup(20 + random.below(100), 1.0, static_cast<unsigned>(random.below(1 << 30)));
    return s;
}

Setting slivers(RandomValues& random) {
    Setting s;
    s.name = "slivers";
    const int count = 20 + random.below(60);
    for (int i = 0; i < count; ++i) {
        const Vec3 a = random.in_ball(1.0);
        const Vec3 b = random.flip() ? random.in_ball(1.0) : a + random.in_ball(0.3);
        const double width = random.below(4) == 0 ? 0.0 : random.magnitude(1e-18, 1e-2);
        add_triangle(s.mesh, a, b, a + (b - a) * random.between(-0.2, 1.2) + random.in_ball(1.0) * width);
    }
    add_triangle(s.mesh, random.in_ball(1.0), random.in_ball(1.0), random.in_ball(1.0));
    return s;
}

Setting wedge(RandomValues& random) {
    Setting s;
    s.name = "wedge";
    const double angle = (random.flip() ? random.between(0.5, 179.5) : (random.flip() ? 0.5 : 179.5)) *
                         std::numbers::pi / 180.0;
    s.mesh = shared::groove(angle, 8.0);
    for (Vec3& v : s.mesh.vertices) {
        v *= Vec3(4.0, 4.0, 1.0);
    }
    // Beside which wall, seen around the edge.
    s.side = [angle](const Vec3& p) { return std::abs(std::atan2(p.x, p.y)) < 0.5 * angle ? 1 : 0; };
    return s;
}

Setting plates(RandomValues& random) {
    Setting s;
    s.name = "plates";
    const double gap = random.below(3) == 0 ? 0.0 : random.magnitude(1e-12, 1e-3);
    for (const double y : {0.0, -gap}) {
        add_quad(s.mesh, {-4.0, y, -4.0}, {4.0, y, -4.0}, {4.0, y, 4.0}, {-4.0, y, 4.0});
    }
    s.side = [](const Vec3& p) { return p.y > 0.0 ? 1 : -1; };
    return s;
}

Setting t_junctions(RandomValues& random) {
    Setting s;
    s.name = "T-junctions";
    add_quad(s.mesh, {-4.0, 0.0, -4.0}, {0.0, 0.0, -4.0}, {0.0, 0.0, 4.0}, {-4.0, 0.0, 4.0});
    const int pieces = 2 + random.below(40);
    const double lift = random.between(-0.3, 0.3);  // the fine half may lean
    for (int i = 0; i < pieces; ++i) {
        const double z0 = -4.0 + 8.0 * i / pieces;
        const double z1 = -4.0 + 8.0 * (i + 1) / pieces;
        add_quad(s.mesh, {0.0, 0.0, z0}, {4.0, 4.0 * lift, z0}, {4.0, 4.0 * lift, z1}, {0.0, 0.0, z1});
    }
    s.side = [lift](const Vec3& p) { return p.y > std::max(p.x, 0.0) * lift ? 1 : -1; };
    return s;
}

Setting box(RandomValues& random) {
    Setting s;
    s.name = "box";
    const Vec3 half(random.between(0.1, 0.8), random.magnitude(1e-9, 0.8), random.between(0.1, 0.8));
    s.mesh = shared::box(half);
    s.side = [mesh = s.mesh](const Vec3& p) { return winding(mesh, p); };
    return s;
}

Setting star(RandomValues& random) {
    Setting s;
    s.name = "star";
    s.mesh = shared::icosphere(1 + random.below(2), 1.0);
    for (Vec3& v : s.mesh.vertices) {
        v *= random.between(0.3, 0.9);
    }
    s.side = [mesh = s.mesh](const Vec3& p) { return winding(mesh, p); };
    return s;
}

Setting hills(RandomValues& random) {
    Setting s;
    s.name = "hills";
    constexpr int cells = 12;
    std::vector<double> height;
    for (int i = 0; i < (cells + 1) * (cells + 1); ++i) {
        height.push_back(random.between(-0.3, 0.3));
    }
    constexpr double size = 6.0;
    const auto corner = [&](int x, int z) {
        return Vec3(size * (x / double{cells} - 0.5), height[static_cast<std::size_t>(z * (cells + 1) + x)],
                    size * (z / double{cells} - 0.5));
    };
    for (int z = 0; z < cells; ++z) {
        for (int x = 0; x < cells; ++x) {
            add_triangle(s.mesh, corner(x, z), corner(x, z + 1), corner(x + 1, z));
            add_triangle(s.mesh, corner(x + 1, z), corner(x, z + 1), corner(x + 1, z + 1));
        }
    }
    s.side = [height](const Vec3& p) {
        const double u = std::clamp((p.x / size + 0.5) * cells, 0.0, cells - 1e-9);
        const double v = std::clamp((p.z / size + 0.5) * cells, 0.0, cells - 1e-9);
        const int x = static_cast<int>(u);
        const int z = static_cast<int>(v);
        const double a = u - x;
        const double b = v - z;
        const auto at = [&](int i, int k) {
            return height[static_cast<std::size_t>((z + k) * (cells + 1) + x + i)];
        };
        const double surface = a + b <= 1.0
                                   ? at(0, 0) * (1.0 - a - b) + at(1, 0) * a + at(0, 1) * b
                                   : at(1, 1) * (a + b - 1.0) + at(0, 1) * (1.0 - a) + at(1, 0) * (1.0 - b);
        return p.y > surface ? 1 : -1;
    };
    return s;
}

// A pit (or, from below, a spike) of many facets that meet in one corner.
Setting pit(RandomValues& random) {
    Setting s;
    s.name = "pit";
    const int sides = 3 + random.below(120);
    const double slope = random.magnitude(0.02, 20.0);
    const double wide = std::min(4.0, 8.0 / slope);
    const auto rim = [&](int i) {
        const double a = 2.0 * std::numbers::pi * i / sides;
        return Vec3(wide * std::cos(a), wide * slope, wide * std::sin(a));
    };
    for (int i = 0; i < sides; ++i) {
        add_triangle(s.mesh, Vec3(0.0), rim(i), rim((i + 1) % sides));
    }
    s.reach = 0.2;
    s.radius = 0.01;
    return s;
}

// Sheets that share one edge, like the pages of a book.
Setting book(RandomValues& random) {
    Setting s;
    s.name = "book";
    const int pages = 3 + random.below(9);
    std::vector<double> angles;
    for (int i = 0; i < pages; ++i) {
        angles.push_back(random.between(-std::numbers::pi, std::numbers::pi));
        const Vec3 out(4.0 * std::cos(angles.back()), 4.0 * std::sin(angles.back()), 0.0);
        const Vec3 along(0.0, 0.0, 4.0);
        add_quad(s.mesh, -along, along, out + along, out - along);
    }
    std::ranges::sort(angles);
    s.side = [angles](const Vec3& p) {
        const auto below =
            static_cast<int>(std::ranges::upper_bound(angles, std::atan2(p.y, p.x)) - angles.begin());
        return below % static_cast<int>(angles.size());
    };
    return s;
}

Setting make_setting(RandomValues& random) {
    constexpr Setting (*kinds[])(RandomValues&) = {soup, slivers, wedge, plates, t_junctions,
                                                   box,  star,    hills, pit,    book};
    Setting s = kinds[random.below(static_cast<int>(std::size(kinds)))](random);
    s.radius *= random.magnitude(0.1, 3.0);
    s.scale = random.flip() ? 1.0 : random.magnitude(1e-3, 1e3);
    s.place = random.below(3) == 0 ? std::min(1e4, 1e6 * s.scale) * random.direction() : Vec3(0.0);
    for (Vec3& v : s.mesh.vertices) {
        v = s.place + s.scale * v;
    }
    return s;
}

// Where the hand goes next, before scaling.
class Hand {
public:
    Hand(RandomValues& random, double reach, double scale)
        : random_(random), reach_(reach), fast_(std::min(2.0 * reach, 0.1 / scale)), kind_(random.below(4)) {
        pace_ = reach * random.magnitude(1e-5, 3e-2);
        goal_ = random.in_box(reach);
    }

    Vec3 next(const Vec3& now) {
        switch (kind_) {
            case 0:  // at 100 m/s to and fro
                return within(now + fast_ * random_.direction());
            case 1:  // anywhere at once
                return random_.below(4) == 0 ? random_.in_box(reach_) : now;
            case 2:  // straight to a goal, then to the next, at its pace
                if (glm::distance(now, goal_) <= pace_) {
                    goal_ = random_.in_box(reach_);
                }
                return now + pace_ * (goal_ - now) / std::max(pace_, glm::distance(now, goal_));
            default:  // trembling at a place
                return within(now + pace_ * random_.in_ball(1.0) - 1e-3 * now);
        }
    }

private:
    Vec3 within(const Vec3& p) const { return glm::clamp(p, Vec3(-reach_), Vec3(reach_)); }

    RandomValues& random_;
    double reach_, fast_;
    int kind_;
    double pace_ = 0.0;
    Vec3 goal_{0.0};
};

// A body that moves and turns about where it stands, up to a twentieth of a metre a tick (before scaling).
class Tumble {
public:
    Tumble(RandomValues& random, const Setting& setting) : random_(random), setting_(setting) {
        fastest_ = random.magnitude(1e-5, 5e-2);
    }

    Pose next() {
        if (random_.below(50) == 0) {
            velocity_ = fastest_ * random_.in_ball(1.0);
            axis_ = random_.direction();
            rate_ = fastest_ * random_.unit();
        }
        if (glm::length(offset_ + velocity_) > 0.5) {  // no sheet's rim comes near the hand
            velocity_ = Vec3(0.0);
            offset_ *= 0.99;
        }
        offset_ += velocity_;
        const Vec3 turn = std::sin(0.5 * rate_) * axis_;
        rotation_ = glm::normalize(Quat(std::cos(0.5 * rate_), turn.x, turn.y, turn.z) * rotation_);
        // Turned about the mesh's own place, not about the distant origin of its coordinates.
        return {setting_.place + setting_.scale * offset_ - rotation_ * setting_.place, rotation_};
    }

private:
    RandomValues& random_;
    const Setting& setting_;
    double fastest_ = 0.0;
    Vec3 velocity_{0.0};
    Vec3 offset_{0.0};
    Vec3 axis_{0.0, 1.0, 0.0};
    double rate_ = 0.0;
    Quat rotation_{1.0, 0.0, 0.0, 0.0};
};

class Watch {
public:
    Watch(std::uint64_t seed, const Setting& setting, bool rough, bool moving, StressCounts& counts)
        : seed_(seed),
          setting_(setting),
          rough_(rough),
          moving_(moving),
          counts_(counts),
          tree_(TriangleTree::build(setting.mesh)),
          reference_(setting.mesh, setting.radius * setting.scale) {}

    // All places in the frame of the body.
    void look(int tick, const Vec3& hand, const Vec3& before, const Vec3& p, const ProxyTick& at,
              const Proxy& proxy) {
        ++counts_.ticks;
        if (!std::isfinite(p.x + p.y + p.z)) {
            ++counts_.nans;
            fail("NaN", tick, hand, p, at, 0.0);
            return;
        }
        if (at.status & proxy_absent) {
            side_ = unknown;
            return;
        }
        counts_.contact_ticks += (at.status & proxy_touching) != 0;
        const double radius = setting_.radius * setting_.scale;
        // Coordinates themselves are only so exact; the skin keeps the proxy well above that.
        const double rounding = 8.0 * 0x1p-52 * (tree_.magnitude() + glm::length(p));
        double distance = tree_.nearest(p, 2.0 * radius).distance;
        if (tick % 64 == 0) {
            distance = std::min(distance, static_cast<double>(slow_distance(p, setting_.mesh)));
        }
        if (distance < radius - rounding) {
            ++counts_.penetrations;
            fail("penetration", tick, hand, p, at, radius - distance);
        }
        if (setting_.side && tick % 16 == 0) {
            const Vec3 seen = (p - setting_.place) / setting_.scale;
            const bool within = std::max({std::abs(seen.x), std::abs(seen.y), std::abs(seen.z)}) < sheet_end;
            const int side = within ? setting_.side(seen) : unknown;  // beyond, the way leads around the rim
            if (side != unknown && side_ != unknown && side != side_) {
                ++counts_.passes;
                fail("pass", tick, hand, p, at, side);
            }
            side_ = side;
        }
        const bool unfinished = at.status & proxy_unfinished;
        counts_.unfinished_ticks += unfinished;
        if (!rough_ && proxy.touching().size() > 0 && (unfinished || tick % 101 == 0)) {
            const ReferencePlace place = reference_.settle(p, hand);
            const auto error = static_cast<double>(glm::distance(place.position, SlowVec3(p)));
            ++counts_.checked_ticks;
            if (error > 1e-3 * radius && glm::distance(before, p) < 1e-3 * radius) {
                ++counts_.stuck_ticks;
                fail("stuck", tick, hand, p, at, error / radius);
            }
            if (!unfinished) {
                counts_.error_max = std::max(counts_.error_max, error / radius);
            }
        }
    }

private:
    static constexpr int unknown = -12345;

    void fail(const char* what, int tick, const Vec3& hand, const Vec3& p, const ProxyTick& at,
              double number) {
        // One of a kind and case tells enough.
        if (what != told_ && counts_.failures.size() < most_failures) {
            told_ = what;
            char text[400];
            std::snprintf(text, sizeof text,
                          "%s: seed %llu (%s, scale %.3g, radius %.3g, at %.3g%s%s), tick %d, by %.3g, "
                          "status %u, proxy "
                          "%.17g %.17g %.17g, hand %.17g %.17g %.17g",
                          what, static_cast<unsigned long long>(seed_), setting_.name, setting_.scale,
                          setting_.radius * setting_.scale, glm::length(setting_.place),
                          rough_ ? ", rough" : "", moving_ ? ", moving" : "", tick, number, at.status, p.x,
                          p.y, p.z, hand.x, hand.y, hand.z);
            counts_.failures.emplace_back(text);
        }
    }

    std::uint64_t seed_;
    const Setting& setting_;
    bool rough_, moving_;
    StressCounts& counts_;
    TriangleTree tree_;
    ReferenceDescent reference_;
    int side_ = unknown;
    const char* told_ = nullptr;
};

}  // namespace

void run_stress_case(std::uint64_t seed, int ticks, StressCounts& counts) {
    RandomValues random(seed);
    const Setting setting = make_setting(random);
    const bool rough = random.below(4) == 0;
    const bool moving = random.below(4) == 0;
    TouchMaterial material;
    material.static_friction = rough ? 0.4 : 0.0;
    material.dynamic_friction = rough ? 0.3 : 0.0;
    TouchRig rig(setting.radius * setting.scale);
    const int body = rig.add(setting.mesh, {}, material);
    if (body < 0) {
        return;  // all slivers of this seed have no area at all: such a mesh is refused
    }
    Watch watch(seed, setting, rough, moving, counts);
    Hand hand(random, setting.reach, setting.scale);
    Tumble tumble(random, setting);
    Vec3 at = random.in_box(setting.reach);
    Vec3 before = setting.place + setting.scale * at;
    for (int tick = 0; tick < ticks; ++tick) {
        const Vec3 in_world = setting.place + setting.scale * at;
        const Pose pose = moving ? tumble.next() : Pose{};
        const ProxyTick moved = moving ? rig.tick(in_world, body, pose) : rig.tick(in_world);
        const Vec3 in_body = to_local(pose, moved.position);
        watch.look(tick, to_local(pose, in_world), before, in_body, moved, rig.proxy);
        before = in_body;
        at = hand.next(at);
    }
}

}  // namespace tactus::shared
