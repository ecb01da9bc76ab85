// Which mesh a piece of the image is, and where.
//
// For each mesh every view is laid onto the piece, middle on middle, and drawn closer by a few points. The
// best are refined with more points, drawn and held against the image (view_check.hpp); the best of those
// with all points. The mesh whose drawing costs least is the one that is seen.
#pragma once

#include <memory>
#include <vector>

#include "sensing/discovery/pose_fit.hpp"
#include "sensing/discovery/view_check.hpp"

namespace tactus {

struct RecognitionSettings {
    std::size_t first_points = 64;     // that every view is laid onto, > 0
    std::size_t more_points = 192;     // that the best are refined with, > 0
    std::size_t tried = 120;           // views of a mesh that are drawn closer by more than a step, > 0
    std::size_t refined = 24;          // of these that are refined, > 0
    std::size_t drawn = 8;             // of these that are drawn, > 0
    double first_reach = 0.025;        // (unit: meters)
    double last_reach_deviations = 4;  // of one depth: farther off a point is none of the mesh
    int last_steps = 4;                // of the best, pixel by pixel and with the outline
};

struct Recognised {
    std::size_t mesh = 0;  // index of the learnt mesh
    PoseFit fit;           // in the camera's frame
    ViewCheck check;
    double cost_of_next = 0.0;  // least cost of another mesh; that of no mesh at all where there is none

    // Share of what is seen that speaks for this mesh at this place: 0 … 1.
    double confidence() const;
};

// Keeps memory from one call to the next.
class Recogniser {
public:
    explicit Recogniser(const RecognitionSettings& settings = {}) : settings_(settings) {}

    // Best first, one for each mesh that was asked for and that fits at all.
    std::vector<Recognised> recognise(const SeenScene& scene, std::span<const LearntMesh> meshes,
                                      std::uint16_t piece);
    // The mesh is near `start`: refined from there alone. `piece`: 0 where none is known.
    Recognised follow(const SeenScene& scene, const LearntMesh& mesh, const Pose& start, std::uint16_t piece);
    // One mesh alone.
    Recognised find(const SeenScene& scene, const LearntMesh& mesh, std::uint16_t piece);

private:
    struct Candidate {
        Pose pose;
        double cost = 0.0;
        std::size_t aspect = 0;
    };

    void take_points(const SeenScene& scene, std::uint16_t piece);
    void lay_views(const LearntMesh& mesh);
    void draw_closer(const LearntMesh& mesh, const PointSet& points, double first_reach, double last_reach,
                     int steps);
    void keep_best(std::size_t count);
    void refine(const SeenScene& scene, const LearntMesh& mesh, std::uint16_t piece, Recognised& one);
    Recognised best_of(const SeenScene& scene, const LearntMesh& mesh, std::uint16_t piece);

    RecognitionSettings settings_;
    PointSet few_, more_, all_;
    double deviation_ = 0.0;  // of one depth of the piece (unit: meters)
    std::vector<Candidate> candidates_;
    ViewChecker checker_;
    std::vector<std::uint32_t> inner_;  // pixels
};

}  // namespace tactus
