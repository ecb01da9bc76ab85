#include "core/soft/whole_turn.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tactus {

namespace {

Vec3 center_of_mass(const SoftModel& model, std::span<const Lanes> places) {
    Vec3 sum(0.0);
    double mass = 0.0;
    for (std::size_t n = 0; n < places.size(); ++n) {
        sum += model.mass[n] * vector_of(places[n]);
        mass += model.mass[n];
    }
    return sum / mass;
}

}  // namespace

WholeTurn::WholeTurn(const SoftModel& model, std::span<const Lanes> places) : model_(model), places_(places) {
    if (!is_free()) {
        return;
    }
    const FreeTurn& free = model.free_turn;
    pivot_ = free.about == FreeTurn::About::itself ? center_of_mass(model, places) : free.pivot;
    Mat3 products(0.0);  // sum m q q^T
    for (std::size_t n = 0; n < places.size(); ++n) {
        if (model.held[n] == 0) {
            const Vec3 q = vector_of(places[n]) - pivot_;
            products += glm::outerProduct(q, model.mass[n] * q);
        }
    }
    inertia_ = Mat3(products[0][0] + products[1][1] + products[2][2]) - products;
    set_inertia(inertia_);
}

void WholeTurn::put_under_stress(std::span<const Lanes> elastic, double stretch) {
    if (!is_free()) {
        return;
    }
    double under_stress = 0.0;
    for (std::size_t n = 0; n < places_.size(); ++n) {
        if (model_.held[n] == 0) {
            under_stress += glm::length(vector_of(places_[n]) - pivot_) * glm::length(vector_of(elastic[n]));
        }
    }
    const double seconds = model_.design.seconds;
    set_inertia(inertia_ + Mat3(seconds * seconds * stretch * under_stress));
}

void WholeTurn::set_inertia(const Mat3& inertia) {
    const FreeTurn& free = model_.free_turn;
    by_moment_ = free.about == FreeTurn::About::line
                     ? glm::outerProduct(free.axis, free.axis) / glm::dot(free.axis, inertia * free.axis)
                     : glm::inverse(inertia);
}

void WholeTurn::solve(std::vector<Lanes>& rows) const {
    if (!is_free()) {
        model_.factor.solve(rows);
        return;
    }
    const double inverse_square = 1.0 / (model_.design.seconds * model_.design.seconds);
    const Vec3 angle = by_forces(rows);
    for (std::size_t n = 0; n < rows.size(); ++n) {
        rows[n] -= row_of(way(angle, n) * (model_.mass[n] * inverse_square));
    }
    model_.factor.solve(rows);
    const Vec3 turned = angle - by_ways(rows);
    for (std::size_t n = 0; n < rows.size(); ++n) {
        rows[n] += row_of(way(turned, n));
    }
}

Vec3 WholeTurn::by_forces(std::span<const Lanes> forces) const {
    Vec3 moment(0.0);
    for (std::size_t n = 0; n < forces.size(); ++n) {
        moment += glm::cross(vector_of(places_[n]) - pivot_, vector_of(forces[n]));
    }
    return by_moment_ * moment * (model_.design.seconds * model_.design.seconds);
}

Vec3 WholeTurn::by_ways(std::span<const Lanes> ways) const {
    Vec3 moment(0.0);
    for (std::size_t n = 0; n < ways.size(); ++n) {
        moment += glm::cross(vector_of(places_[n]) - pivot_, model_.mass[n] * vector_of(ways[n]));
    }
    return by_moment_ * moment;
}

Vec3 WholeTurn::way(const Vec3& angle, std::size_t node) const {
    return model_.held[node] != 0 ? Vec3(0.0) : glm::cross(angle, vector_of(places_[node]) - pivot_);
}

}  // namespace tactus
