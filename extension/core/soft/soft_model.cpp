#include "core/soft/soft_model.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <numeric>

#include "core/mesh/closed_mesh.hpp"
#include "core/mesh/mesh_check.hpp"
#include "core/soft/soft_draft.hpp"

namespace tactus {

namespace {

// A step of quasi-Newton on the energy of an implicit step needs a matrix that bounds its second derivative
// from above. In the space of F that is 2 mu along shears, 2 mu + 3 lambda along a change of volume and 0
// along turns: (2 mu + 3 lambda) |dF|^2 bounds them all, and is the same along x, y and z.
double bound_of(double shear, double bulk) {
    return shear + 3.0 * bulk;
}

// In the energy of a unit volume.
struct Stiffness {
    double shear, bulk;  // 2 mu, lambda (unit: pascals)
};

Stiffness stiffness_of(const SoftMaterial& m) {
    const double shear = m.stiffness / (1.0 + m.poisson_ratio);
    return {shear, shear * m.poisson_ratio / (1.0 - 2.0 * m.poisson_ratio)};
}

// Nodes b apart spread a press over a disc that is wider than Hertz's by 3/8 b: fitted to presses of blocks
// of 2 to 12 cells by spheres of half a cell to two cells (docs/soft.md).
LocalCompliance give_of(const SoftMaterial& material, const Vec3& cell_size) {
    constexpr double widening = 3.0 / 8.0;
    const double edge = (cell_size.x + cell_size.y + cell_size.z) / 3.0;
    return {material.stiffness / (1.0 - material.poisson_ratio * material.poisson_ratio), widening * edge};
}

struct Gradients {
    std::array<Vec3, 4> of_corner;
};

Gradients gradients_of(std::span<const Vec3> nodes, const Tetrahedron& t) {
    const Mat3 edges(nodes[t[1]] - nodes[t[0]], nodes[t[2]] - nodes[t[0]], nodes[t[3]] - nodes[t[0]]);
    const Mat3 inverse = glm::transpose(glm::inverse(edges));  // columns: gradients of corners 1 to 3
    return {{-(inverse[0] + inverse[1] + inverse[2]), inverse[0], inverse[1], inverse[2]}};
}

FreeTurn free_turn_of(const SoftModel& model) {
    const double nothing = 1e-9 * model.size;
    FreeTurn free;
    for (std::size_t i = 0; i < model.rest.size(); ++i) {
        const Vec3 from_pivot = model.rest[i] - free.pivot;
        const double distance = glm::length(from_pivot);
        if (model.held[i] == 0) {
            continue;
        }
        if (free.about == FreeTurn::About::itself) {
            free = {FreeTurn::About::place, model.rest[i], Vec3(0.0)};
        } else if (free.about == FreeTurn::About::place && distance > nothing) {
            free = {FreeTurn::About::line, free.pivot, from_pivot / distance};
        } else if (glm::length(glm::cross(free.axis, from_pivot)) > nothing) {
            return {FreeTurn::About::nothing};
        }
    }
    return free;
}

// The bound B resists a part of length l that turns as a mass does: by 2 B (dt + tau) dt / l^2 over the
// density, times a number that depends on its form: 4.65 for the first mode of a cantilever. A part is taken
// to be half as long as the body. Each iteration leaves a / (1 + a) of what is left of that share a.
int iterations_for(const SoftMaterial& material, double size, double seconds) {
    constexpr double left = 0.02;
    constexpr int most = 64;
    const auto [shear, bulk] = stiffness_of(material);
    const double added = 20.0 * 2.0 * bound_of(shear, bulk) * (seconds + material.damping) * seconds /
                         (material.density * size * size);
    return static_cast<int>(std::clamp(std::ceil(std::log(left) / std::log(added / (1.0 + added))), 1.0,
                                       static_cast<double>(most)));
}

class Assembly {
public:
    Assembly(SoftDraft&& draft, SoftDesign&& design)
        : draft_(std::move(draft)), model_(std::make_shared<SoftModel>()) {
        model_->design = std::move(design);
        model_->element_count = draft_.element_count();
        renumber();
        hold(model_->design.held);
    }

    SoftModelResult result() {
        add_masses();
        add_tetrahedra();
        add_cells();
        add_springs();
        SoftModel& model = *model_;
        model.firmness.assign(model.rest.size(), 0.0);
        for (const SparseFactor::Entry& entry : entries_) {
            model.firmness[entry.row] += entry.row == entry.column ? entry.value : 0.0;
        }
        if (!model.factor.make(model.rest.size(), entries_)) {
            return {nullptr,
                    "its stiffness, size and density are too far apart to be computed with: choose "
                    "a stiffness or a density that is nearer to a real one"};
        }
        if (model.factor.entries() > max_factor_entries) {
            return {nullptr, "a step of it takes longer than a tick: give it fewer cells or vertices"};
        }
        const bool is_sheet = model.tetrahedra.empty() && model.cells.empty();
        model.wanted_iterations =
            is_sheet ? 1 : iterations_for(model.design.material, model.size, model.design.seconds);
        model.give = give_of(model.design.material, draft_.cell_size);
        model.anchors = std::move(draft_.anchors);
        model.surface = std::move(draft_.surface);
        model.closed = is_closed(model.surface);
        return {std::move(model_), {}};
    }

private:
    void connect(std::vector<std::vector<std::uint32_t>>& neighbours, std::span<const std::uint32_t> nodes) {
        for (const std::uint32_t a : nodes) {
            for (const std::uint32_t b : nodes) {
                if (a != b) {
                    neighbours[a].push_back(b);
                }
            }
        }
    }

    // Nodes come to stand in the order of elimination.
    void renumber() {
        std::vector<std::vector<std::uint32_t>> neighbours(draft_.nodes.size());
        for (const Tetrahedron& t : draft_.tetrahedra) {
            connect(neighbours, t);
        }
        for (const SoftDraft::Cell& cell : draft_.cells) {
            connect(neighbours, cell.node);
        }
        for (const SoftDraft::Spring& spring : draft_.springs) {
            connect(neighbours, spring.node);
        }
        const std::vector<std::uint32_t> order = dissection_order(draft_.nodes, neighbours);
        std::vector<std::uint32_t> place_of(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            place_of[order[i]] = static_cast<std::uint32_t>(i);
            model_->rest.push_back(draft_.nodes[order[i]]);
            model_->mass.push_back(draft_.mass[order[i]]);
        }
        const auto rename = [&](auto& nodes) {
            for (std::uint32_t& node : nodes) {
                node = place_of[node];
            }
        };
        std::ranges::for_each(draft_.tetrahedra, rename);
        std::ranges::for_each(draft_.cells, rename, &SoftDraft::Cell::node);
        std::ranges::for_each(draft_.springs, rename, &SoftDraft::Spring::node);
        std::ranges::for_each(draft_.anchors, rename, &SoftAnchor::node);
        Vec3 low = model_->rest.front(), high = low;
        for (const Vec3& node : model_->rest) {
            low = glm::min(low, node);
            high = glm::max(high, node);
        }
        model_->size = glm::distance(low, high);
    }

    void hold(const HeldParts& held) {
        SoftModel& model = *model_;
        model.held.assign(model.rest.size(), 0);
        for (std::size_t i = 0; i < model.rest.size(); ++i) {
            model.held[i] = held.holds(model.rest[i]) ? 1 : 0;
        }
        for (const std::uint32_t vertex : held.vertices) {
            for (std::size_t k = 0; vertex < draft_.anchors.size() && k < 4; ++k) {
                if (draft_.anchors[vertex].weight[k] > 1e-6) {
                    model.held[draft_.anchors[vertex].node[k]] = 1;
                }
            }
        }
        model.free_turn = free_turn_of(model);
    }

    void add_entry(std::uint32_t a, std::uint32_t b, double value) {
        if (model_->held[a] == 0 && model_->held[b] == 0 && a >= b) {
            entries_.push_back({a, b, value});
        }
    }

    // What is held has a row of its own: its way is nought.
    void add_masses() {
        const double inverse_square = 1.0 / (model_->design.seconds * model_->design.seconds);
        for (std::uint32_t i = 0; i < model_->rest.size(); ++i) {
            const bool held = model_->held[i] != 0;
            entries_.push_back({i, i, held ? 1.0 : model_->mass[i] * inverse_square});
        }
    }

    // Of the elastic matrix, with what damping adds to it.
    double with_damping() const { return 1.0 + model_->design.material.damping / model_->design.seconds; }

    void add_tetrahedra() {
        const auto [shear, bulk] = stiffness_of(model_->design.material);
        const std::size_t count = draft_.tetrahedra.size();
        model_->tetrahedra.assign((count + 3) / 4, TetGroup{});
        for (TetGroup& group : model_->tetrahedra) {
            group.shear = group.bulk = splat(0.0);
            group.gradient[0] = group.gradient[1] = group.gradient[2] = splat(Vec3(0.0));
        }
        for (std::size_t i = 0; i < count; ++i) {
            const Tetrahedron& t = draft_.tetrahedra[i];
            const double volume = tetrahedron_volume(model_->rest, t);
            const Gradients gradients = gradients_of(model_->rest, t);
            TetGroup& group = model_->tetrahedra[i / 4];
            const std::size_t lane = i % 4;
            group.shear[lane] = shear * volume;
            group.bulk[lane] = bulk * volume;
            const double bound = bound_of(shear, bulk) * volume * with_damping();
            for (std::size_t c = 0; c < 4; ++c) {
                group.node[c][lane] = t[c];
                if (c > 0) {
                    LanesVec3& gradient = group.gradient[c - 1];
                    gradient.x[lane] = gradients.of_corner[c].x;
                    gradient.y[lane] = gradients.of_corner[c].y;
                    gradient.z[lane] = gradients.of_corner[c].z;
                }
                for (std::size_t d = 0; d < 4; ++d) {
                    add_entry(t[c], t[d], bound * glm::dot(gradients.of_corner[c], gradients.of_corner[d]));
                }
            }
        }
    }

    void add_cells() {
        const auto [shear, bulk] = stiffness_of(model_->design.material);
        const Vec3& size = draft_.cell_size;
        const Vec3 slope = 0.25 / size;
        CellGroup empty;
        empty.slope = splat(slope);
        empty.shear = empty.bulk = splat(0.0);
        model_->cells.assign((draft_.cells.size() + 3) / 4, empty);
        for (std::size_t i = 0; i < draft_.cells.size(); ++i) {
            const SoftDraft::Cell& cell = draft_.cells[i];
            const double volume = size.x * size.y * size.z * cell.filled;
            CellGroup& group = model_->cells[i / 4];
            const std::size_t lane = i % 4;
            group.shear[lane] = shear * volume;
            group.bulk[lane] = bulk * volume;
            const double bound = bound_of(shear, bulk) * volume * with_damping();
            const auto gradient = [&](std::size_t c) {
                return slope *
                       Vec3((c & 1) != 0 ? 1.0 : -1.0, (c & 2) != 0 ? 1.0 : -1.0, (c & 4) != 0 ? 1.0 : -1.0);
            };
            for (std::size_t c = 0; c < 8; ++c) {
                group.node[c][lane] = cell.node[c];
                for (std::size_t d = 0; d < 8; ++d) {
                    add_entry(cell.node[c], cell.node[d], bound * glm::dot(gradient(c), gradient(d)));
                }
            }
        }
    }

    void add_springs() {
        const std::size_t count = draft_.springs.size();
        model_->springs.assign((count + 3) / 4, SpringGroup{});
        for (SpringGroup& group : model_->springs) {
            group.stiffness = group.length = splat(0.0);
            group.share[0] = group.share[1] = group.share[2] = group.share[3] = splat(0.0);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const SoftDraft::Spring& spring = draft_.springs[i];
            SpringGroup& group = model_->springs[i / 4];
            const std::size_t lane = i % 4;
            group.stiffness[lane] = spring.stiffness;
            group.length[lane] = spring.length;
            for (std::size_t c = 0; c < 4; ++c) {
                group.node[c][lane] = spring.node[c];
                group.share[c][lane] = spring.share[c];
                for (std::size_t d = 0; d < 4; ++d) {
                    const double value = spring.stiffness * spring.share[c] * spring.share[d];
                    if (value != 0.0) {
                        add_entry(spring.node[c], spring.node[d], value * with_damping());
                    }
                }
            }
        }
    }

    SoftDraft draft_;
    std::shared_ptr<SoftModel> model_;
    std::vector<SparseFactor::Entry> entries_;
};

bool is_within(double value, double low, double high) {
    return value >= low && value <= high;
}

// What is wrong with the material or the time of a step; else empty.
std::string check_soft_material(const SoftMaterial& m, double seconds) {
    if (!is_within(m.stiffness, 1e2, 1e7)) {
        return "its stiffness is not between 100 Pa and 10 MPa: set it so";
    }
    if (!is_within(m.poisson_ratio, 0.0, 0.45)) {
        return "its Poisson's ratio is not between 0 and 0.45: set it so";
    }
    if (!is_within(m.density, 1.0, 3e4)) {
        return "its density is not between 1 and 30,000 kg/m³: set it so";
    }
    if (!is_within(m.thickness, 1e-5, 0.1)) {
        return "its thickness is not between 0.01 mm and 0.1 m: set it so";
    }
    if (!is_within(m.damping, 0.0, 1.0) || !is_within(m.drag, 0.0, 1000.0) ||
        !is_within(m.friction, 0.0, 10.0)) {
        return "its damping is not between 0 and 1 s, its drag not between 0 and 1000 1/s, or its friction "
               "not between 0 and 10: set all three so";
    }
    return is_within(seconds, 1e-5, 0.1) ? "" : "the time of a tick is not between 0.01 ms and 0.1 s";
}

// The outer sides: faces of one tetrahedron alone, seen counter-clockwise from outside.
std::vector<std::array<std::uint32_t, 3>> outer_faces(std::span<const Tetrahedron> tetrahedra) {
    constexpr std::array<std::array<std::size_t, 3>, 4> faces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    std::map<std::array<std::uint32_t, 3>, int> uses;
    const auto key = [](std::array<std::uint32_t, 3> face) {
        std::ranges::sort(face);
        return face;
    };
    const auto for_each_face = [&](auto&& use) {
        for (const Tetrahedron& t : tetrahedra) {
            for (const auto& [a, b, c] : faces) {
                use(std::array{t[a], t[b], t[c]});
            }
        }
    };
    for_each_face([&](const auto& face) { ++uses[key(face)]; });
    std::vector<std::array<std::uint32_t, 3>> outer;
    for_each_face([&](const auto& face) {
        if (uses[key(face)] == 1) {
            outer.push_back(face);
        }
    });
    return outer;
}

}  // namespace

int SoftModel::iterations_within(double seconds) const {
    return std::max(1, std::min(wanted_iterations, static_cast<int>(seconds / iteration_time())));
}

double SoftModel::total_mass() const {
    return std::accumulate(mass.begin(), mass.end(), 0.0);
}

bool SoftModel::is_free() const {
    return std::ranges::all_of(held, [](std::uint8_t h) { return h == 0; });
}

bool same_structure(const SoftModel& one, const SoftModel& other) {
    return one.rest == other.rest && one.held == other.held &&
           one.tetrahedra.size() == other.tetrahedra.size() && one.cells.size() == other.cells.size() &&
           one.springs.size() == other.springs.size() && one.surface.triangles == other.surface.triangles &&
           one.surface.vertices == other.surface.vertices;
}

double tetrahedron_volume(std::span<const Vec3> nodes, const Tetrahedron& t) {
    const Vec3& o = nodes[t[0]];
    return glm::dot(nodes[t[1]] - o, glm::cross(nodes[t[2]] - o, nodes[t[3]] - o)) / 6.0;
}

SoftDraftResult draft_tetrahedra(const SoftDesign& design) {
    const std::vector<Vec3>& vertices = design.points;
    if (design.tetrahedra.empty()) {
        return {{}, "it has no tetrahedra: give it at least one"};
    }
    SoftDraft draft;
    std::vector<std::uint32_t> node_of(vertices.size(), 0xffff'ffffu);  // vertices without use are left out
    for (const Tetrahedron& t : design.tetrahedra) {
        Tetrahedron named{};
        for (std::size_t c = 0; c < 4; ++c) {
            if (t[c] >= vertices.size()) {
                return {{},
                        "a corner of a tetrahedron is no vertex: give numbers below " +
                            std::to_string(vertices.size())};
            }
            const Vec3& place = vertices[t[c]];
            if (!(std::abs(place.x) <= 1e4 && std::abs(place.y) <= 1e4 && std::abs(place.z) <= 1e4)) {
                return {{},
                        "vertex " + std::to_string(t[c]) +
                            " of the tetrahedra is no place within 10 km: correct it"};
            }
            if (node_of[t[c]] == 0xffff'ffffu) {
                node_of[t[c]] = static_cast<std::uint32_t>(draft.nodes.size());
                draft.nodes.push_back(place);
            }
            named[c] = node_of[t[c]];
        }
        draft.tetrahedra.push_back(named);
    }
    draft.mass.assign(draft.nodes.size(), 0.0);
    for (std::size_t i = 0; i < draft.tetrahedra.size(); ++i) {
        const Tetrahedron& t = draft.tetrahedra[i];
        const double longest = std::max({glm::distance(draft.nodes[t[0]], draft.nodes[t[1]]),
                                         glm::distance(draft.nodes[t[0]], draft.nodes[t[2]]),
                                         glm::distance(draft.nodes[t[0]], draft.nodes[t[3]])});
        const double volume = tetrahedron_volume(draft.nodes, t);
        if (!(volume > 1e-6 * longest * longest * longest)) {
            return {{},
                    "tetrahedron " + std::to_string(i) +
                        (volume < 0.0 ? " is turned inside out: swap two of its corners"
                                      : " is flat: move one of its corners or leave it out")};
        }
        for (const std::uint32_t corner : t) {
            draft.mass[corner] += 0.25 * design.material.density * volume;
        }
    }
    draft.surface = {draft.nodes, outer_faces(draft.tetrahedra)};
    for (std::uint32_t i = 0; i < draft.nodes.size(); ++i) {
        draft.anchors.push_back({{i, i, i, i}, {1.0, 0.0, 0.0, 0.0}});
    }
    return {std::move(draft), {}};
}

SoftModelResult make_soft(SoftDesign design) {
    if (std::string error = check_soft_material(design.material, design.seconds); !error.empty()) {
        return {nullptr, std::move(error)};
    }
    SoftDraftResult made = design.form == SoftDesign::Form::volume  ? draft_volume(design)
                           : design.form == SoftDesign::Form::sheet ? draft_sheet(design)
                                                                    : draft_tetrahedra(design);
    if (!made.error.empty()) {
        return {nullptr, std::move(made.error)};
    }
    const SoftDraft& draft = made.draft;
    if (draft.nodes.size() > max_soft_nodes || draft.element_count() > max_soft_elements) {
        return {nullptr,
                "it has more than 4,096 nodes or 12,000 elements, for which a tick has no time: give "
                "it fewer cells or vertices"};
    }
    return Assembly(std::move(made.draft), std::move(design)).result();
}

SoftModelResult make_soft_volume(const TriangleMesh& surface, int cells, const SoftMaterial& material,
                                 const HeldParts& held, double seconds) {
    return make_soft({SoftDesign::Form::volume, surface, cells, {}, {}, material, held, seconds});
}

SoftModelResult make_soft_tetrahedra(std::span<const Vec3> vertices, std::span<const Tetrahedron> tetrahedra,
                                     const SoftMaterial& material, const HeldParts& held, double seconds) {
    return make_soft({SoftDesign::Form::tetrahedra,
                      {},
                      0,
                      {vertices.begin(), vertices.end()},
                      {tetrahedra.begin(), tetrahedra.end()},
                      material,
                      held,
                      seconds});
}

SoftModelResult make_soft_sheet(const TriangleMesh& surface, const SoftMaterial& material,
                                const HeldParts& held, double seconds) {
    return make_soft({SoftDesign::Form::sheet, surface, 0, {}, {}, material, held, seconds});
}

}  // namespace tactus
