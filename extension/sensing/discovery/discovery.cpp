#include "sensing/discovery/discovery.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/mesh/convex_hull.hpp"

namespace tactus {

namespace {

// Of the images that the scale of depth is learnt from, so many are kept in mind.
constexpr double scale_memory = 100.0;

// Where a mesh may be from where it is expected, when its drawing there does not fit (unit: meters).
constexpr double search_around = 0.03;
constexpr double search_points = 400.0;

// Between two images: where their stamps do not tell, as of a camera of 30 Hz, and at most (unit:
// microseconds).
constexpr std::uint64_t usual_gap_us = 33'333, longest_gap_us = 10'000'000;

// A pixel beside a drawing, at about its depth, is the object's, too: two pixels for jitter.
constexpr int claim_pixels = 2;
constexpr double claim_depth = 0.03;  // (unit: meters)

// A piece farther from a stranger than this is another one (unit: meters).
constexpr double same_stranger = 0.05;

// What every image of an object has in common: edges that the drawing and the camera see differently (unit:
// meters, radians).
constexpr double alike_place = 1e-4;
constexpr double alike_turn = 1e-3;

// So many images without it: it is lost.
constexpr int images_until_lost = 5;

// Of an object's outline so much may touch something else.
constexpr double max_going_on = 0.6;

// Mean cost of a piece's pixel where a mesh is believed: chance alone costs a half. What is left over may be
// something else that touches it. Where one depth is less sure than this share of the mesh's size, anything
// about as large agrees with much of it: all of the piece has to be the mesh then. Of 580 boxes of 6 to 30 cm
// at 0.85 to 2 m, 46 were taken for one of seven meshes with the larger cost alone and 4 are with both, of
// 597 meshes 6 more are not told from a single image.
constexpr double max_cost = 2.5;
constexpr double max_cost_far = 0.9;
constexpr double sure_share = 1.0 / 80.0;

// How much of the image a support has that is followed, at least; and how many levels are looked at.
constexpr double least_share_followed = 0.01;
constexpr std::size_t most_levels = 3;

// The diagonal of the box around a piece, at its nearest depth (unit: meters).
double size_across(const DepthImage& image, const Cluster& cluster) {
    std::uint16_t nearest = 0xffff;
    for (const std::uint32_t at : cluster.pixels) {
        nearest = std::min(nearest, image.depth_mm[at]);
    }
    const double depth = 1e-3 * nearest;
    return depth * std::hypot((cluster.box.right - cluster.box.left) / image.camera.focal_x,
                              (cluster.box.bottom - cluster.box.top) / image.camera.focal_y);
}

PixelBox box_around_ball(const DepthCamera& camera, const Vec3& center, double radius) {
    const double depth = -center.z - radius;
    if (!(depth > 0.05)) {
        return {0, 0, camera.width, camera.height};
    }
    const PixelPlace place = seen_at(camera, center);
    const double across = camera.focal_x * radius / depth, down = camera.focal_y * radius / depth;
    const auto clamped = [](double value, int limit) {
        return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
    };
    return {clamped(place.u - across, camera.width), clamped(place.v - down, camera.height),
            clamped(place.u + across + 1.0, camera.width), clamped(place.v + down + 1.0, camera.height)};
}

}  // namespace

Discovery::Discovery(std::shared_ptr<const std::vector<LearntMesh>> meshes, const SeeingSettings& settings)
    : meshes_(std::move(meshes)), settings_(settings), recogniser_(settings.recognition) {}

std::span<const SeenObject> Discovery::update(const DepthImage& image, const Pose& camera_in_world) {
    times_ = {};
    searched_ = false;
    camera_ = camera_in_world;
    let_pass(image.time_us);
    problem_ = check_image(image);
    if (!problem_.empty()) {
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            note_unseen(objects_[i], tracks_[i], true);
        }
        return objects_;
    }
    seen_part_ = seen_part(image);
    double from = seconds();
    find_support(image);
    times_.plane = seconds() - from;

    from = seconds();
    segmenter_.mark(image, settings_.accuracy, plane_, settings_.segmentation);
    segmenter_.find_pieces(image, settings_.segmentation);
    times_.segmentation = seconds() - from;

    from = seconds();
    const SeenScene scene{&image, &segmenter_.found(), settings_.accuracy, scale_};
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        if (objects_[i].mesh != SeenObject::no_mesh && follow(scene, objects_[i], tracks_[i])) {
            take_out_drawing(image, mesh(objects_[i].mesh), compose(inverse(camera_), objects_[i].measured));
        }
    }
    times_.tracking = seconds() - from;

    from = seconds();
    segmenter_.find_pieces(image, settings_.segmentation);
    recognise_one(scene);
    forget_old();
    times_.recognition = seconds() - from;
    return objects_;
}

// Stamps go back where a recording begins again or a camera is plugged in again, and stand still or leap
// where its clock fails: no such stamp tells how much time has passed, and what is known is followed all the
// same.
void Discovery::let_pass(std::uint64_t stamp_us) {
    const bool goes_on = now_ > 0 && stamp_us > stamp_us_;
    const std::uint64_t passed_us = goes_on ? std::min(stamp_us - stamp_us_, longest_gap_us) : usual_gap_us;
    now_ += static_cast<Nanoseconds>(passed_us) * 1000;
    stamp_us_ = stamp_us;
}

void Discovery::find_support(const DepthImage& image) {
    const bool is_due = to_seconds(now_ - support_looked_) >= settings_.support_looks && !is_support_used();
    std::optional<PlaneFit> fit;
    if (plane_ && !is_due) {
        fit = follow_plane(image, settings_.accuracy, *plane_, least_share_followed);
    }
    if (!fit) {
        fit = look_for_support(image);
        support_looked_ = now_;
    }
    plane_ = fit ? std::optional(fit->plane) : std::nullopt;
    support_.reset();
    if (!fit) {
        problem_ =
            "no level surface is seen: turn the camera so that what the objects stand on is in the image";
        return;
    }
    learn_scale(fit->plane);
    support_residual_ = scale_ * fit->residual;
    const Vec3 normal = direction_to_parent(camera_, fit->plane.normal());
    const double distance = scale_ * fit->plane.distance();
    support_ = WorldPlane{normal, glm::dot(normal, camera_.position) - distance};
}

// Something known is seen that was found with it.
bool Discovery::is_support_used() const {
    return std::ranges::any_of(objects_, [](const SeenObject& object) {
        return object.mesh != SeenObject::no_mesh && object.state != SeenState::lost;
    });
}

std::optional<PlaneFit> Discovery::look_for_support(const DepthImage& image) {
    if (settings_.support) {
        const Vec3 normal = direction_to_local(camera_, settings_.support->normal);
        const double distance =
            glm::dot(settings_.support->normal, camera_.position) - settings_.support->offset;
        const auto fit = distance > 0.0
                             ? find_known_plane(image, settings_.accuracy, ImagePlane{-normal / distance})
                             : std::nullopt;
        if (fit) {
            return fit;
        }
    }
    const PlaneSearch search{direction_to_local(camera_, settings_.up)};
    return most_used(image, find_planes(image, settings_.accuracy, search, most_levels));
}

// A table's top or the floor below it: the one that more things stand on, or the upper one; where nothing
// stands on any, the one that is seen most of.
std::optional<PlaneFit> Discovery::most_used(const DepthImage& image, const std::vector<PlaneFit>& planes) {
    std::optional<PlaneFit> best;
    int most = 0;
    for (const PlaneFit& plane : planes) {
        const int pieces = planes.size() > 1 ? standing_pieces(image, plane.plane) : 0;
        const bool is_upper = best && plane.plane.distance() < best->plane.distance();
        if (!best || pieces > most || (pieces == most && pieces > 0 && is_upper)) {
            best = plane;
            most = pieces;
        }
    }
    return best;
}

// Pieces that are no larger than an object, and whole.
int Discovery::standing_pieces(const DepthImage& image, const ImagePlane& plane) {
    segmenter_.mark(image, settings_.accuracy, plane, settings_.segmentation);
    const Segmentation& found = segmenter_.find_pieces(image, settings_.segmentation);
    return static_cast<int>(std::ranges::count_if(found.clusters, [&](const Cluster& cluster) {
        return !is_cut(cluster.box) && size_across(image, cluster) < settings_.largest;
    }));
}

bool Discovery::is_cut(const PixelBox& box) const {
    return box.left <= seen_part_.left || box.top <= seen_part_.top || box.right >= seen_part_.right ||
           box.bottom >= seen_part_.bottom;
}

// Whether a part of it, seen or not, is outside the image.
bool Discovery::reaches_out(const LearntMesh& mesh, const Pose& mesh_in_camera,
                            const DepthCamera& camera) const {
    return std::ranges::any_of(mesh.mesh.vertices, [&](const Vec3& vertex) {
        const PixelPlace place = seen_at(camera, to_parent(mesh_in_camera, vertex));
        return !(place.depth > 0.0 && place.u >= seen_part_.left && place.u <= seen_part_.right - 1 &&
                 place.v >= seen_part_.top && place.v <= seen_part_.bottom - 1);
    });
}

// A camera whose depths are all too large by a share sees a plane, too, farther away by that share, and
// turned no other way.
void Discovery::learn_scale(const ImagePlane& told) {
    if (!settings_.support) {
        return;
    }
    const double distance = glm::dot(settings_.support->normal, camera_.position) - settings_.support->offset;
    const double scale = distance / told.distance();
    if (!(std::abs(scale - 1.0) < 5.0 * settings_.accuracy.error)) {
        problem_ = "the support is not where it should be: calibrate the camera's place";
        return;
    }
    scale_images_ = std::min(scale_images_ + 1.0, scale_memory);
    scale_ += (scale - scale_) / scale_images_;
}

// The piece that most of the drawing's agreeing pixels belong to; 0: none.
std::uint16_t Discovery::piece_at(const SeenScene& scene, const LearntMesh& mesh,
                                  const Pose& mesh_in_camera) const {
    const PixelBox box =
        box_around_ball(scene.image->camera, to_parent(mesh_in_camera, mesh.center), 0.5 * mesh.radius);
    std::vector<int> votes(scene.segmentation->clusters.size() + 1, 0);
    for (int v = box.top; v < box.bottom; v += 2) {
        for (int u = box.left; u < box.right; u += 2) {
            ++votes[scene.segmentation->piece[static_cast<std::size_t>(v * scene.image->camera.width + u)]];
        }
    }
    votes[0] = 0;
    const auto most = std::ranges::max_element(votes);
    return *most > 0 ? static_cast<std::uint16_t>(most - votes.begin()) : std::uint16_t{0};
}

bool Discovery::is_there(const Recognised& one) const {
    const ViewCheck& check = one.check;
    const int visible = check.drawn - check.hidden;
    return visible > settings_.least_pixels_share * check.drawn && check.confirmed > 0 &&
           check.confirmed >= settings_.least_quality * (visible + check.seen_through);
}

// What is found anew could also be a part of something larger.
bool Discovery::accepts(const Recognised& one) const {
    return is_there(one) && one.check.goes_on <= max_going_on * one.check.outline;
}

void Discovery::take_points_around(const SeenScene& scene, const Vec3& center, double reach) {
    const DepthImage& image = *scene.image;
    const PixelBox box = box_around_ball(image.camera, center, reach);
    const double pixels = (box.right - box.left) * (box.bottom - box.top);
    const int stride = std::max(1, static_cast<int>(std::sqrt(pixels / search_points)));
    points_.clear();
    for (int v = box.top; v < box.bottom; v += stride) {
        for (int u = box.left; u < box.right; u += stride) {
            const auto at = static_cast<std::size_t>(v * image.camera.width + u);
            const double depth = scene.scale * 1e-3 * image.depth_mm[at];
            const Vec3 point = depth * ray_through(image.camera, u, v);
            const Vec3 off = point - center;
            if (scene.segmentation->stands_out[at] != 0 && glm::dot(off, off) < reach * reach) {
                points_.add(point, depth_deviation(settings_.accuracy, depth));
            }
        }
    }
    points_.close();
}

// First what stands around the place is drawn to the mesh; where that does not do, every view of the mesh is
// tried, once an image, and not while a new piece waits for that: what stays hidden would be looked for for
// ever, and nothing new be found.
Recognised Discovery::look_around(const SeenScene& scene, const LearntMesh& known, const Pose& expected) {
    take_points_around(scene, to_parent(expected, known.center), known.radius + search_around);
    const PoseFit fit = fit_pose(known.field, points_, expected, search_around, 0.008, 8);
    const std::uint16_t piece = piece_at(scene, known, fit.pose);
    Recognised best = recogniser_.follow(scene, known, fit.pose, piece);
    const bool fits = is_there(best) && best.check.misfit <= settings_.max_misfit;
    if (!fits && piece != 0 && !searched_ && !waits_) {
        searched_ = true;
        const Recognised anew = recogniser_.find(scene, known, piece);
        best = !is_there(best) || anew.check.cost < best.check.cost ? anew : best;
    }
    return best;
}

bool Discovery::follow(const SeenScene& scene, SeenObject& object, Track& track) {
    if (object.state == SeenState::lost) {
        object.confidence *= 0.9;
        return false;
    }
    const LearntMesh& known = mesh(object.mesh);
    const Pose expected = compose(inverse(camera_), track.motion.at(settings_.motion, now_));
    Recognised one = recogniser_.follow(scene, known, expected, piece_at(scene, known, expected));
    if (!is_there(one) || one.check.misfit > settings_.max_misfit) {
        const Recognised around = look_around(scene, known, expected);
        const bool is_better = accepts(around) && (!is_there(one) || around.check.misfit < one.check.misfit);
        one = is_better ? around : one;
    }
    if (is_there(one)) {
        note(object, track, one);
        if (reaches_out(known, one.fit.pose, scene.image->camera)) {
            object.state = SeenState::cut;
        }
        return true;
    }
    const int visible = one.check.drawn - one.check.hidden;
    const bool is_hidden = visible <= settings_.least_pixels_share * one.check.drawn;
    note_unseen(object, track, is_hidden);
    track.is_covered = is_hidden && one.check.drawn > 0 && object.state != SeenState::lost;
    return false;
}

// The drawing's pixels are explained: what is left over is something else.
void Discovery::take_out_drawing(const DepthImage& image, const LearntMesh& known,
                                 const Pose& mesh_in_camera) {
    const SeenScene scene{&image, &segmenter_.found(), settings_.accuracy, scale_};
    checker_.check(scene, known, mesh_in_camera, 0);
    const PixelBox box = checker_.drawn_box();
    const DepthBuffer& drawing = checker_.drawing();
    for (int v = box.top; v < box.bottom; ++v) {
        for (int u = box.left; u < box.right; ++u) {
            const float depth = drawing.depth[static_cast<std::size_t>(v * image.camera.width + u)];
            if (!std::isfinite(depth)) {
                continue;
            }
            for (int y = std::max(0, v - claim_pixels);
                 y <= std::min(image.camera.height - 1, v + claim_pixels); ++y) {
                for (int x = std::max(0, u - claim_pixels);
                     x <= std::min(image.camera.width - 1, u + claim_pixels); ++x) {
                    const auto at = static_cast<std::size_t>(y * image.camera.width + x);
                    if (std::abs(scale_ * 1e-3 * image.depth_mm[at] - depth) < claim_depth) {
                        segmenter_.take_out(at);
                    }
                }
            }
        }
    }
}

void Discovery::note(SeenObject& object, Track& track, const Recognised& one) {
    const bool again = object.state == SeenState::lost || track.unseen > 0;
    object.measured = compose(camera_, one.fit.pose);
    if (object.state == SeenState::lost) {
        track.motion.forget();
    }
    // Chance alone: what all images are off together is no motion.
    track.motion.see(settings_.motion, object.measured,
                     turned_covariance(fit_covariance(one.fit, {}), camera_.rotation), now_);
    object.state = again && object.state != SeenState::hidden ? SeenState::found : SeenState::tracked;
    track.seen = now_;
    track.unseen = 0;
    track.is_covered = false;
    track.lost = {};
    track.quality += 0.3 * (one.check.quality() - track.quality);
    object.confidence = std::max(object.confidence, 0.0) + 0.3 * (track.quality - object.confidence);
    tell(object, track);
}

void Discovery::note_unseen(SeenObject& object, Track& track, bool hidden) {
    ++track.unseen;
    object.confidence *= hidden ? 0.98 : 0.8;
    if (object.state != SeenState::lost) {
        object.state = hidden || track.unseen < images_until_lost ? SeenState::hidden : SeenState::lost;
    }
    // Nothing tells where it goes: it may be anywhere where it could have gone.
    const double seconds_unseen = to_seconds(now_ - track.seen);
    track.lost.place += Mat3(settings_.motion.push * 1e-3 * seconds_unseen);
    track.lost.turn += Mat3(settings_.motion.twist * 1e-3 * seconds_unseen);
    tell(object, track);
    object.linear_velocity = object.angular_velocity = Vec3(0.0);
}

// What all depths may be off together moves the object along the line of sight: unless the scale is known, it
// is no surer than that.
void Discovery::tell(SeenObject& object, const Track& track) const {
    object.pose = track.motion.pose();
    object.linear_velocity = track.motion.linear_velocity();
    object.angular_velocity = track.motion.angular_velocity();
    object.rests = track.motion.rests();
    object.chance.place =
        track.motion.place_covariance() + track.lost.place + Mat3(alike_place * alike_place);
    object.chance.turn = track.motion.turn_covariance() + track.lost.turn + Mat3(alike_turn * alike_turn);
    object.covariance = object.chance;
    if (scale_images_ == 0.0) {
        const Vec3 along = settings_.accuracy.error * (object.pose.position - camera_.position);
        object.covariance.place += glm::outerProduct(along, along);
    }
}

Vec3 Discovery::place_of(const SeenScene& scene, std::uint16_t piece) const {
    Vec3 sum(0.0);
    double count = 0.0;
    const auto width = static_cast<std::uint32_t>(scene.image->camera.width);
    for (const std::uint32_t at : scene.segmentation->clusters[piece - 1u].pixels) {
        const double depth = scene.scale * 1e-3 * scene.image->depth_mm[at];
        sum += depth * ray_through(scene.image->camera, at % width, at / width);
        count += 1.0;
    }
    return to_parent(camera_, sum / std::max(1.0, count));
}

// The largest piece that has not been tried too often yet.
void Discovery::recognise_one(const SeenScene& scene) {
    std::uint16_t chosen = 0;
    std::size_t most = 0;
    cut_pieces_ = far_pieces_ = 0;
    for (std::size_t i = 0; i < scene.segmentation->clusters.size(); ++i) {
        const auto piece = static_cast<std::uint16_t>(i + 1);
        const std::size_t size = scene.segmentation->clusters[i].pixels.size();
        if (is_cut(scene.segmentation->clusters[i].box)) {
            // A wall goes on outside the image, too.
            cut_pieces_ += size_across(*scene.image, scene.segmentation->clusters[i]) < settings_.largest;
            continue;
        }
        if (size <= most) {
            continue;
        }
        const Vec3 place = place_of(scene, piece);
        const auto tried = std::ranges::find_if(strangers_, [&](const Stranger& stranger) {
            return stranger.tries >= settings_.tries && glm::length(stranger.place - place) < same_stranger;
        });
        if (tried != strangers_.end()) {
            far_pieces_ += tried->is_far;
            note_hull(scene, piece, place);
        } else {
            chosen = piece;
            most = size;
        }
    }
    waits_ = chosen != 0 && searched_;
    if (chosen == 0 || searched_) {
        return;
    }
    const std::vector<Recognised> found = recogniser_.recognise(scene, *meshes_, chosen);
    const bool is_like = !found.empty() && accepts(found.front()) &&
                         found.front().check.cost < max_cost * found.front().check.pixels;
    if (is_like && is_sure(found.front())) {
        note_new(found.front());
    } else {
        note_stranger(place_of(scene, chosen), is_like);
    }
}

bool Discovery::is_sure(const Recognised& one) const {
    const double deviation = depth_deviation(settings_.accuracy, -one.fit.pose.position.z);
    return deviation < sure_share * 2.0 * mesh(one.mesh).radius ||
           one.check.cost < max_cost_far * one.check.pixels;
}

// Of the objects of that mesh that are not seen now: first those whose place is seen to be empty, or is not
// in the image, the nearest of them. What something hides is there still, unless it has come out from behind
// it.
std::optional<std::size_t> Discovery::known_as(const Recognised& one) const {
    const Vec3 place = compose(camera_, one.fit.pose).position;
    std::optional<std::size_t> best;
    std::pair<bool, double> best_rank;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const double apart = glm::length(objects_[i].measured.position - place);
        const std::pair<bool, double> rank{tracks_[i].is_covered, apart};
        const bool may_be = objects_[i].mesh == one.mesh && tracks_[i].unseen > 0 &&
                            (!tracks_[i].is_covered || apart < settings_.comes_out);
        if (may_be && (!best || rank < best_rank)) {
            best = i;
            best_rank = rank;
        }
    }
    return best;
}

void Discovery::note_new(const Recognised& one) {
    if (const std::optional<std::size_t> known = known_as(one)) {
        note(objects_[*known], tracks_[*known], one);
        objects_[*known].state = SeenState::found;
        return;
    }
    SeenObject object;
    object.id = next_id_++;
    object.mesh = one.mesh;
    Track track;
    track.quality = one.check.quality();
    object.confidence = one.confidence();
    note(object, track, one);
    object.state = SeenState::found;
    objects_.push_back(std::move(object));
    tracks_.push_back(track);
}

void Discovery::note_stranger(const Vec3& place, bool is_far) {
    for (Stranger& stranger : strangers_) {
        if (glm::length(stranger.place - place) < same_stranger) {
            ++stranger.tries;
            stranger.place = place;
            stranger.is_far = is_far;
            stranger.seen = now_;
            return;
        }
    }
    strangers_.push_back({place, 1, is_far, now_});
}

// What is seen of it, and its shadow on the support: it stands there, or nobody knows better.
void Discovery::note_hull(const SeenScene& scene, std::uint16_t piece, const Vec3& place) {
    const auto width = static_cast<std::uint32_t>(scene.image->camera.width);
    std::vector<Vec3> points;
    Vec3 low(1e9), high(-1e9);
    const auto& pixels = scene.segmentation->clusters[piece - 1u].pixels;
    const std::size_t stride = std::max<std::size_t>(1, pixels.size() / 500);
    for (std::size_t i = 0; i < pixels.size(); i += stride) {
        const double depth = scene.scale * 1e-3 * scene.image->depth_mm[pixels[i]];
        const Vec3 point = to_parent(
            camera_, depth * ray_through(scene.image->camera, pixels[i] % width, pixels[i] / width));
        points.push_back(point - place);
        if (support_) {
            const double height = glm::dot(support_->normal, point) - support_->offset;
            points.push_back(point - height * support_->normal - place);
        }
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    if (glm::length(high - low) > settings_.largest) {
        return;  // a wall, an arm that reaches out of the image
    }
    SeenObject* object = nullptr;
    Track* track = nullptr;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        if (objects_[i].mesh == SeenObject::no_mesh &&
            glm::length(objects_[i].measured.position - place) < same_stranger) {
            object = &objects_[i];
            track = &tracks_[i];
        }
    }
    if (object == nullptr) {
        objects_.emplace_back();
        tracks_.emplace_back();
        object = &objects_.back();
        track = &tracks_.back();
        object->id = next_id_++;
        object->hull = convex_hull(points);
        if (object->hull.triangles.empty()) {
            objects_.pop_back();
            tracks_.pop_back();
            return;
        }
    }
    object->state = track->seen == 0 ? SeenState::found : SeenState::tracked;
    object->measured = {place, {1.0, 0.0, 0.0, 0.0}};
    object->confidence = 0.3;
    // The middle of what is seen tells the place to about a pixel; it says nothing of a turn.
    const double deviation = 2.0 * depth_deviation(settings_.accuracy, glm::length(place - camera_.position));
    Matrix6 covariance{};
    for (std::size_t i = 0; i < 3; ++i) {
        covariance[i][i] = deviation * deviation;
        covariance[i + 3][i + 3] = 1.0;
    }
    track->motion.see(settings_.motion, object->measured, covariance, now_);
    track->seen = now_;
    track->unseen = 0;
    track->lost = {};
    for (Stranger& stranger : strangers_) {
        if (glm::length(stranger.place - place) < same_stranger) {
            stranger.place = place;
            stranger.seen = now_;
        }
    }
    tell(*object, *track);
}

void Discovery::forget_old() {
    const auto is_old = [this](Nanoseconds seen) { return to_seconds(now_ - seen) > settings_.remembered; };
    std::erase_if(strangers_, [&](const Stranger& stranger) { return is_old(stranger.seen); });
    for (std::size_t i = objects_.size(); i-- > 0;) {
        if (objects_[i].mesh == SeenObject::no_mesh && tracks_[i].seen != now_) {
            note_unseen(objects_[i], tracks_[i], false);
        }
        const bool gone = objects_[i].state == SeenState::lost && is_old(tracks_[i].seen);
        if (gone) {
            objects_.erase(objects_.begin() + static_cast<std::ptrdiff_t>(i));
            tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
}

void Discovery::cloud(const DepthImage& image, std::vector<Vec3>& points) const {
    points.clear();
    const std::vector<std::uint8_t>& stands_out = segmenter_.found().stands_out;
    const auto width = static_cast<std::size_t>(image.camera.width);
    for (std::size_t at = 0; at < stands_out.size() && at < image.depth_mm.size(); ++at) {
        if (stands_out[at] != 0) {
            points.push_back(
                1e-3 * scale_ * image.depth_mm[at] *
                ray_through(image.camera, static_cast<double>(at % width), static_cast<double>(at / width)));
        }
    }
}

}  // namespace tactus
