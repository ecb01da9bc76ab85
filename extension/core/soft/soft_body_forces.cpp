// What the elements of a soft body push, and what they store.
#include <glm/geometric.hpp>

#include "core/soft/element_lanes.hpp"
#include "core/soft/soft_body.hpp"

namespace tactus {

namespace {

struct SpringState {
    LanesVec3 sum;  // e
    Lanes length;   // |e|
};

SpringState state_of(const std::vector<Lanes>& places, const SpringGroup& group) {
    LanesVec3 sum = gathered(places, group.node[0]) * group.share[0];
    for (std::size_t c = 1; c < 4; ++c) {
        sum = along(sum, gathered(places, group.node[c]), group.share[c]);
    }
    return {sum, lanes_sqrt(dot(sum, sum))};
}

}  // namespace

// f = -dE/dx: with b = lambda V (tr(R^T F) - 3) - 2 mu V, the stress times the volume is 2 mu V F + b R.
void SoftBody::add_tetrahedra() {
    for (std::size_t g = 0; g < model_->tetrahedra.size(); ++g) {
        const TetGroup& group = model_->tetrahedra[g];
        const LanesMat3 f = deformation_of(seen_, group);
        for (int i = 0; i < turns_a_step; ++i) {
            turn_[g] = turned_towards(turn_[g], f);
        }
        const LanesMat3 r = matrix_of(turn_[g]);
        const Lanes trace = common_trace(r, f);
        const Lanes b = multiply_subtract(group.bulk, trace - splat(3.0), group.shear);
        const LanesMat3 stress{scaled_sum(f.x, group.shear, r.x, b), scaled_sum(f.y, group.shear, r.y, b),
                               scaled_sum(f.z, group.shear, r.z, b)};
        LanesVec3 sum = splat(Vec3(0.0));
        for (std::size_t c = 0; c < 3; ++c) {
            const LanesVec3& gradient = group.gradient[c];
            const LanesVec3 back =
                along(along(stress.x * gradient.x, stress.y, gradient.y), stress.z, gradient.z);
            scatter(right_, group.node[c + 1], back * splat(-1.0));
            sum = sum + back;
        }
        scatter(right_, group.node[0], sum);
    }
}

// Of the mean deformation as a tetrahedron; of the bending K p, and what turns with F since p = R^T q turns
// with it: a torque t = sum of p x K p is a stress -R [t / (2/3 tr S)]x.
void SoftBody::add_cells() {
    const CellMaterial material(model_->design.material, model_->spacing);
    const std::size_t first = model_->tetrahedra.size();
    for (std::size_t g = 0; g < model_->cells.size(); ++g) {
        const CellGroup& group = model_->cells[g];
        std::array<LanesVec3, 8> t = transform_of(seen_, group);
        const LanesMat3 f = deformation_of(t, material.rate);
        LanesQuat& turn = turn_[first + g];
        for (int i = 0; i < turns_a_step; ++i) {
            turn = turned_towards(turn, f);
        }
        const LanesMat3 r = matrix_of(turn);
        const Lanes shear = group.volume * splat(material.shear), bulk = group.volume * splat(material.bulk);
        const Lanes trace = common_trace(r, f);
        const CellBending p = bending_of(t, r);
        const CellBending push = material.push_of(p);
        const LanesVec3 torque =
            cross(p.yz, push.yz) + cross(p.xz, push.xz) + cross(p.xy, push.xy) + cross(p.xyz, push.xyz);
        const LanesVec3 a = torque * (group.volume / lanes_max(trace * splat(2.0 / 3.0), splat(1.0)));
        const Lanes b = multiply_subtract(bulk, trace - splat(3.0), shear);
        const LanesVec3 stress[3] = {scaled_sum(f.x, shear, r.x, b) + r.z * a.y - r.y * a.z,
                                     scaled_sum(f.y, shear, r.y, b) + r.x * a.z - r.z * a.x,
                                     scaled_sum(f.z, shear, r.z, b) + r.y * a.x - r.x * a.y};
        const Lanes share = group.volume * splat(-1.0 / 8.0);
        t[0] = splat(Vec3(0.0));
        t[1] = stress[0] * splat(material.rate.x / 8.0);
        t[2] = stress[1] * splat(material.rate.y / 8.0);
        t[4] = stress[2] * splat(material.rate.z / 8.0);
        t[3] = image_of(r, push.xy) * share;
        t[5] = image_of(r, push.xz) * share;
        t[6] = image_of(r, push.yz) * share;
        t[7] = image_of(r, push.xyz) * -share;
        transform_corners(t);
        for (std::size_t i = 0; i < 8; ++i) {
            scatter(right_, group.node[i], t[i]);
        }
    }
}

void SoftBody::add_springs() {
    for (const SpringGroup& group : model_->springs) {
        const SpringState spring = state_of(seen_, group);
        const Lanes rest = group.length / lanes_max(spring.length, splat(1e-12));
        const LanesVec3 pull = spring.sum * (group.stiffness * (rest - splat(1.0)));
        for (std::size_t c = 0; c < 4; ++c) {
            scatter(right_, group.node[c], pull * group.share[c]);
        }
    }
}

SoftEnergy SoftBody::energy() const {
    SoftEnergy energy;
    for (std::size_t n = 0; n < place_.size(); ++n) {
        const Vec3 velocity = vector_of(velocity_[n]);
        energy.kinetic += 0.5 * model_->mass[n] * glm::dot(velocity, velocity);
    }
    const auto add = [&](const Lanes& values) {
        energy.elastic += values[0] + values[1] + values[2] + values[3];
    };
    const auto stretch = [&](LanesQuat turn, const LanesMat3& f, Lanes shear, Lanes bulk) {
        for (int i = 0; i < 4 * turns_a_step; ++i) {
            turn = turned_towards(turn, f);
        }
        const LanesMat3 r = matrix_of(turn);
        const LanesMat3 d{f.x - r.x, f.y - r.y, f.z - r.z};
        const Lanes change = common_trace(r, f) - splat(3.0);
        add(splat(0.5) * (shear * common_trace(d, d) + bulk * change * change));
        return r;
    };
    for (std::size_t g = 0; g < model_->tetrahedra.size(); ++g) {
        const TetGroup& group = model_->tetrahedra[g];
        stretch(turn_[g], deformation_of(place_, group), group.shear, group.bulk);
    }
    const CellMaterial material(model_->design.material, model_->spacing);
    for (std::size_t g = 0; g < model_->cells.size(); ++g) {
        const Lanes volume = model_->cells[g].volume;
        const std::array<LanesVec3, 8> t = transform_of(place_, model_->cells[g]);
        const LanesMat3 r = stretch(turn_[model_->tetrahedra.size() + g], deformation_of(t, material.rate),
                                    volume * splat(material.shear), volume * splat(material.bulk));
        const CellBending p = bending_of(t, r), push = material.push_of(p);
        add(splat(0.5) * volume *
            (dot(p.yz, push.yz) + dot(p.xz, push.xz) + dot(p.xy, push.xy) + dot(p.xyz, push.xyz)));
    }
    for (const SpringGroup& group : model_->springs) {
        const Lanes longer = state_of(place_, group).length - group.length;
        add(splat(0.5) * group.stiffness * longer * longer);
    }
    return energy;
}

}  // namespace tactus
