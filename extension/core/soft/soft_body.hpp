// A body that gives, as it moves: a volume or a sheet of nodes, pressed by hands, held where it is pinned,
// lying on what is solid.
//
// One step of implicit Euler from the state (x, v) with masses M, elastic energy E and gravity g ends where
//
//     G(x') = 1/2 |x' - y|^2_M / dt^2 + E(x'),    y = x + dt v + dt^2 g,
//
// is least. A step of Newton's method from x0 = x + dt v would solve with the second derivative of E there,
// another matrix in every tick. Here it solves with one that bounds all of them, W, factored once:
//
//     (M / dt^2 + W) (x' - x0) = -dG/dx (x0).
//
// Where E is quadratic with the matrix H, that is exactly implicit Euler of a body with the masses
// M + dt^2 (W - H): multiply out with v' = (x' - x) / dt. Since W >= H these are masses, so that the sum of
// their kinetic energy and E never grows but by the work of what presses, whatever the step, the stiffness
// and the masses are. They are felt in quick motions of stiff bodies alone: at rest every force is exact, and
// so is free fall (W moves nothing that does not deform). More steps of the same kind in one tick
// (`iterations`) take the added masses off.
//
// Tetrahedra are corotated: E = V (mu |F - R|^2 + lambda / 2 (tr(R^T F) - 3)^2) with the rotation R nearest
// to F, which is followed from tick to tick. It is finite for whatever F, and what was turned inside out
// comes back. Damping takes the elastic forces at x + (dt + tau) v.
//
// A hand presses by a spring between it and a point of the surface, as on rigid bodies (see SpringForce); it
// is solved along with the rest: the point's compliance in the step, w . A^-1 w, is known from one more solve
// with the same factor. So the force is what the hand and the body have agreed on at the step's end, however
// light the nodes are.
//
// Everything is allocated when it is made. All in the body's frame, in metres.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/geometry/solid.hpp"
#include "core/soft/soft_model.hpp"
#include "core/soft/whole_turn.hpp"

namespace tactus {

// A hand's spring that presses a point of the surface: what it presses with when the step begins, and how
// that changes as hand and point move on. Never pulls.
struct SoftPush {
    std::uint32_t triangle = 0;  // of the model's surface
    Vec3 weights{0.0};           // of its corners in the point
    Vec3 force{0.0};             // (unit: newtons)
    double stiffness = 0.0;      // > 0 (unit: newtons per meter)
    double damping = 0.0;        // (unit: newton seconds per meter)
    Vec3 hand_velocity{0.0};     // (unit: meters per second)
    bool sticks = false;         // holds in all directions; else along `force` alone
};

// A solid that the body cannot enter, where it is at the end of the step.
struct SoftObstacle {
    const Solid* solid = nullptr;
    Pose pose;                  // of the solid, at the step's end
    Pose previous;              // at its begin
    double friction = 0.0;      // (dimensionless)
    double inverse_mass = 0.0;  // of what it belongs to; 0: it does not give way (unit: 1/kilograms)
    // What the step has pushed it by, and about its origin (units: newton seconds, newton meter seconds).
    Vec3 impulse{0.0};
    Vec3 turn{0.0};
};

enum SoftStatus : std::uint32_t {
    soft_lost = 1u << 0,  // it left the range of numbers and is back in its shape at rest
};

struct SoftEnergy {
    double kinetic = 0.0;  // (unit: joules)
    double elastic = 0.0;
};

class SoftBody {
public:
    static constexpr std::size_t max_pushes = 12;

    explicit SoftBody(std::shared_ptr<const SoftModel> model);

    const SoftModel& model() const { return *model_; }

    // One step. Pushes beyond max_pushes do not press. Allocates nothing; SoftStatus.
    std::uint32_t step(const Vec3& gravity, std::span<const SoftPush> pushes,
                       std::span<SoftObstacle> obstacles);

    // Asleep, it takes no time, and its surface stays where it is. It sleeps once nothing moves, and wakes
    // where it is pressed.
    bool is_asleep() const { return still_ticks_ >= ticks_to_sleep; }
    void wake() { still_ticks_ = 0; }

    // Back in its shape at rest, and still.
    void reset();
    // In the shape and the motion of one of the same structure (same_structure()), awake. Allocates nothing.
    void go_on_from(const SoftBody& other);

    // Where the vertices of the surface are; as many as the model has. How far the farthest has gone from
    // where `out` had it (unit: meters).
    double write_surface(std::span<Vec3> out) const;
    Vec3 surface_point(std::uint32_t triangle, const Vec3& weights) const;
    // What a push of the last step has pressed with (unit: newtons).
    const Vec3& pressed(std::size_t push) const { return contacts_[push].force; }

    std::span<const Lanes> places() const { return place_; }
    std::span<const Lanes> velocities() const { return velocity_; }
    void put(std::size_t node, const Vec3& place, const Vec3& velocity);
    SoftEnergy energy() const;

    int iterations;  // of a step, >= 1

private:
    static constexpr int ticks_to_sleep = 256;
    static constexpr std::size_t corners_of_push = 12;  // three vertices on four nodes each

    struct Contact {
        std::array<std::uint32_t, corners_of_push> node{};
        std::array<double, corners_of_push> weight{};  // 0 where the node is held
        double stiffness = 0.0;                        // k + c / dt (unit: newtons per meter)
        Vec3 slack{0.0};      // way of the point at which the spring would not press (unit: meters)
        Vec3 direction{0.0};  // of the force at first
        bool sticks = false;
        Vec3 force{0.0};  // (unit: newtons)
    };

    // What bears a vertex of the surface.
    struct Support {
        Vec3 force{0.0};           // (unit: newtons)
        std::size_t obstacle = 0;  // by its place among those of the step
        Vec3 change{0.0};          // of the force, in the step that is made
    };

    // A vertex of the surface, at the step's end.
    struct AtObstacle {
        Vec3 place, normal;
        double distance;
        Vec3 slipped;  // along the solid's surface, since the step's begin
    };

    void begin_contacts(std::span<const SoftPush> pushes);
    void find_compliance();
    void add_tetrahedra();
    void add_cells();
    void add_springs();
    void iterate(std::span<SoftObstacle> obstacles);
    void press_contacts();
    Vec3 way_of(const Contact& contact) const;
    void add_supports();
    void add_force(const SoftAnchor& anchor, const Vec3& force);
    AtObstacle at(std::size_t vertex, const SoftObstacle& obstacle) const;
    void bear(const WholeTurn& whole, std::span<SoftObstacle> obstacles);
    double change_supports(const SoftObstacle& obstacle, std::size_t index);
    void keep_out(SoftObstacle& obstacle);
    bool finish();

    std::shared_ptr<const SoftModel> model_;
    std::vector<Lanes> place_, velocity_;  // by node: x, y, z
    std::vector<Support> supports_;        // by vertex of the surface
    std::vector<LanesQuat> turn_;          // of each group of tetrahedra, then of cells
    // Of the step that is made.
    std::vector<Lanes> next_;      // x'
    std::vector<Lanes> inertial_;  // y
    std::vector<Lanes> seen_;      // where the elastic forces are taken
    std::vector<Lanes> right_;     // forces, then ways
    std::vector<Lanes> answers_;   // of the nodes to a unit force at each of up to four contacts
    std::vector<std::array<double, max_pushes>> answer_;  // the same by node, of all contacts
    std::array<Contact, max_pushes> contacts_{};
    std::size_t contact_count_ = 0;
    std::array<std::array<double, max_pushes>, max_pushes> compliance_{};  // (unit: meters per newton)
    int still_ticks_ = 0;
};

}  // namespace tactus
