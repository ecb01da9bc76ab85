// Depth images in; objects with their places out.
//
// Every image: the support plane is followed, what stands out of it is marked, every object that is known
// already is followed to where it is now and its pixels are taken out. What is left over is new, or lost
// before: at most one piece an image is recognised, the others wait, so that following never does. A piece
// that is none of the meshes is told as a hull.
//
// One thread at a time. Nothing here knows a camera's driver.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/estimation/motion_filter.hpp"
#include "core/teleop/seen_pose.hpp"
#include "sensing/discovery/recognition.hpp"

namespace tactus {

// A plane of the world: normal . p = offset.
struct WorldPlane {
    Vec3 normal{0.0, 1.0, 0.0};  // unit
    double offset = 0.0;         // (unit: meters)
};

struct SeeingSettings {
    DepthAccuracy accuracy;
    SegmentationSettings segmentation;
    RecognitionSettings recognition;
    MotionFilterSettings motion;
    Vec3 up{0.0, 1.0, 0.0};             // of the world, unit: the support is about level
    std::optional<WorldPlane> support;  // where it is known: the camera's error of depth is learnt from it
    double max_misfit = 1.1;            // of what is followed: beyond, it is looked for anew (see ViewCheck)
    double least_quality = 0.6;         // of a drawing that is believed: 0 … 1
    double least_pixels_share = 0.25;   // of a mesh's drawing, not hidden: else nothing is said, 0 … 1
    int tries = 3;                      // of a piece, before it is told as a hull, > 0
    double remembered = 3.0;            // lost objects keep their name for so long (unit: seconds), >= 0
    double largest = 0.5;               // what is larger is no object (unit: meters), > 0
    double comes_out = 0.1;             // what was hidden appears no farther off (unit: meters), >= 0
    double support_looks = 1.0;         // between searches for a better support (unit: seconds), >= 0
};

// found: seen for the first time, or again; tracked: seen in the last image, too; cut: the same, of what is
// partly outside the image; hidden: something nearer stands before it; lost: it is not where it was.
enum class SeenState : std::uint8_t { found, tracked, cut, hidden, lost };

struct SeenObject {
    static constexpr std::size_t no_mesh = static_cast<std::size_t>(-1);

    std::uint32_t id = 0;
    std::size_t mesh = no_mesh;  // index in the library
    TriangleMesh hull;           // of what no mesh explains, in its own frame: what was seen of it, and its
                                 // shadow on the support
    Pose pose;                   // in the world; at rest, where it rests
    PoseDoubt covariance;        // of `pose`, in the world's axes
    PoseDoubt chance;            // of that, what is not the same in every image
    Vec3 linear_velocity{0.0};   // of the mesh's origin (unit: meters per second)
    Vec3 angular_velocity{0.0};  // (unit: radians per second)
    bool rests = false;
    double confidence = 0.0;  // 0 … 1
    SeenState state = SeenState::found;
    Pose measured;  // by the last image alone that showed it
};

struct DiscoveryTimes {
    double plane = 0.0, segmentation = 0.0, tracking = 0.0, recognition = 0.0;  // (unit: seconds)
};

class Discovery {
public:
    Discovery(std::shared_ptr<const std::vector<LearntMesh>> meshes, const SeeingSettings& settings);

    // All objects that are known, lost ones included, in the order in which they were found. An image that
    // nothing can be found in changes no place: confidence falls, and problem() says what is wrong.
    std::span<const SeenObject> update(const DepthImage& image, const Pose& camera_in_world);

    std::span<const SeenObject> objects() const { return objects_; }
    const std::string& problem() const { return problem_; }  // empty: none
    // Pieces of the last image that nothing known explains: of these, how many end where the image does, and
    // are not looked at; and how many look like a mesh and are too small or too far away to be sure.
    int cut_pieces() const { return cut_pieces_; }
    int far_pieces() const { return far_pieces_; }
    // In the world; none: no level surface is seen.
    const std::optional<WorldPlane>& support() const { return support_; }
    double support_residual() const { return support_residual_; }  // (unit: meters)
    // True depth over told depth: 1 where the support's place is not known.
    double depth_scale() const { return scale_; }
    // Points of the camera's frame that stand out of the support, for drawing (unit: meters).
    void cloud(const DepthImage& image, std::vector<Vec3>& points) const;
    const LearntMesh& mesh(std::size_t index) const { return (*meshes_)[index]; }
    const SeeingSettings& settings() const { return settings_; }
    // By pixel of the last image: 1 where something stands out of the support that no known object explains.
    const std::vector<std::uint8_t>& stands_out() const { return segmenter_.found().stands_out; }
    // The support as it was told, in the camera's frame: depths are not put right by depth_scale().
    const std::optional<ImagePlane>& plane() const { return plane_; }

    // Whether a clock is read: function that gives seconds, or none.
    void time_with(double (*clock)()) { clock_ = clock; }
    const DiscoveryTimes& times() const { return times_; }

private:
    struct Track {
        MotionFilter motion;
        Nanoseconds seen = 0;  // last time
        double quality = 0.0;
        int unseen = 0;           // images in succession
        bool is_covered = false;  // in the last of these, by something nearer
        PoseDoubt lost;           // what it may have moved by since it was seen
        Vec3 extent{0.0};         // of a hull
    };
    struct Stranger {
        Vec3 place{0.0};  // in the world
        int tries = 0;
        bool is_far = false;  // it looks like a mesh, and too little of it is seen to be sure
        Nanoseconds seen = 0;
    };

    void let_pass(std::uint64_t stamp_us);
    void find_support(const DepthImage& image);
    std::optional<PlaneFit> look_for_support(const DepthImage& image);
    std::optional<PlaneFit> most_used(const DepthImage& image, const std::vector<PlaneFit>& planes);
    int standing_pieces(const DepthImage& image, const ImagePlane& plane);
    bool is_support_used() const;
    void learn_scale(const ImagePlane& told);
    bool follow(const SeenScene& scene, SeenObject& object, Track& track);
    Recognised look_around(const SeenScene& scene, const LearntMesh& known, const Pose& expected);
    void take_points_around(const SeenScene& scene, const Vec3& center, double reach);
    std::uint16_t piece_at(const SeenScene& scene, const LearntMesh& mesh, const Pose& mesh_in_camera) const;
    void take_out_drawing(const DepthImage& image, const LearntMesh& mesh, const Pose& mesh_in_camera);
    bool is_there(const Recognised& one) const;
    bool accepts(const Recognised& one) const;
    bool is_sure(const Recognised& one) const;
    void note(SeenObject& object, Track& track, const Recognised& one);
    void note_unseen(SeenObject& object, Track& track, bool hidden);
    void tell(SeenObject& object, const Track& track) const;
    void recognise_one(const SeenScene& scene);
    void note_new(const Recognised& one);
    std::optional<std::size_t> known_as(const Recognised& one) const;
    bool is_cut(const PixelBox& box) const;
    bool reaches_out(const LearntMesh& mesh, const Pose& mesh_in_camera, const DepthCamera& camera) const;
    void note_stranger(const Vec3& place, bool is_far);
    void note_hull(const SeenScene& scene, std::uint16_t piece, const Vec3& place);
    void forget_old();
    Vec3 place_of(const SeenScene& scene, std::uint16_t piece) const;
    double seconds() const { return clock_ ? clock_() : 0.0; }

    std::shared_ptr<const std::vector<LearntMesh>> meshes_;
    SeeingSettings settings_;
    std::vector<SeenObject> objects_;
    std::vector<Track> tracks_;  // of objects_
    std::vector<Stranger> strangers_;
    bool searched_ = false;  // in this image, every view of a mesh has been tried
    bool waits_ = false;     // a new piece could not be recognised in the last image, because of that
    PixelBox seen_part_;     // of this image
    int cut_pieces_ = 0, far_pieces_ = 0;
    Nanoseconds support_looked_ = 0;  // last time
    std::uint32_t next_id_ = 1;

    Pose camera_;                 // in the world
    Nanoseconds now_ = 0;         // of a clock of its own: see let_pass()
    std::uint64_t stamp_us_ = 0;  // of the last image
    std::optional<ImagePlane> plane_;
    std::optional<WorldPlane> support_;
    double support_residual_ = 0.0;
    double scale_ = 1.0;
    double scale_images_ = 0.0;
    std::string problem_;

    Segmenter segmenter_;
    Recogniser recogniser_;
    ViewChecker checker_;
    PointSet points_;
    double (*clock_)() = nullptr;
    DiscoveryTimes times_;
};

}  // namespace tactus
