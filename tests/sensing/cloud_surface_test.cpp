#include "sensing/discovery/cloud_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"
#include "shared/depth_scenes.hpp"

namespace tactus::cloud_surface_test {
namespace {

using namespace shared;

// A cube stands on the table; `knows`: the library has it.
struct Place {
    explicit Place(bool knows) {
        std::vector<LearntMesh> learnt;
        if (knows) {
            learnt.push_back(learn_mesh(library.front(), {}));
        }
        discovery.emplace(std::make_shared<const std::vector<LearntMesh>>(std::move(learnt)),
                          SeeingSettings{});
        scene.camera = kinect_camera(320, 240);
        scene.camera_pose = camera_above_table(0.85, 0.8);
        noise.error_share = 0.0;
        Pose pose = resting_pose(library.front(), false, 1);
        top = 2.0 * pose.position.y;
        scene.objects.push_back({0, pose});
    }
    void look(int images = 1) {
        for (int i = 0; i < images; ++i) {
            ++taken;
            draw_scene(library, scene, exact);
            const DepthImage image = noisy_image(exact, noise, taken, 33'333u * taken);
            discovery->update(image, scene.camera_pose);
            surface.update(image, *discovery, scene.camera_pose);
        }
    }
    // Of the corners above a place of the table, the highest and the middle one.
    std::vector<double> heights(const Vec3& at, double within) const {
        std::vector<double> found;
        for (const Vec3& corner : surface.mesh().vertices) {
            if (std::hypot(corner.x - at.x, corner.z - at.z) < within) {
                found.push_back(corner.y);
            }
        }
        std::ranges::sort(found);
        return found;
    }

    std::vector<LibraryMesh> library = library_meshes({"cube"});
    std::optional<Discovery> discovery;
    CloudSurface surface;
    DepthScene scene;
    DepthNoise noise;
    DepthBuffer exact;
    unsigned taken = 0;
    double top = 0.0;  // of the cube (unit: meters)
};

TEST(CloudSurface, LiesOnWhatNobodyKnowsAndBeneathTheTableElsewhere) {
    Place place(false);
    place.look(10);
    EXPECT_GT(place.surface.standing(), 40u);
    const Vec3 cube = place.scene.objects[0].pose.position;
    const std::vector<double> on_top = place.heights(cube, 0.03);
    ASSERT_GT(on_top.size(), 8u);
    for (const double height : on_top) {
        EXPECT_NEAR(height, place.top, 3e-3);
    }
    const std::vector<double> beside = place.heights(cube + Vec3(0.2, 0.0, 0.1), 0.03);
    ASSERT_GT(beside.size(), 4u);
    EXPECT_LT(beside.back(), -0.005);
}

// Deformed, not built anew: the same triangles of as many corners, and little motion where nothing moves.
TEST(CloudSurface, KeepsItsTrianglesAndLiesStill) {
    Place place(false);
    place.look(60);
    const TriangleMesh before = place.surface.mesh();
    double squares = 0.0;
    int counted = 0;
    place.look();
    const TriangleMesh& now = place.surface.mesh();
    ASSERT_EQ(now.triangles, before.triangles);
    ASSERT_EQ(now.vertices.size(), before.vertices.size());
    const Vec3 cube = place.scene.objects[0].pose.position;
    for (std::size_t i = 0; i < now.vertices.size(); ++i) {
        if (std::hypot(now.vertices[i].x - cube.x, now.vertices[i].z - cube.z) < 0.03) {
            const double moved = glm::distance(now.vertices[i], before.vertices[i]);
            squares += moved * moved;
            ++counted;
        }
    }
    ASSERT_GT(counted, 8);
    EXPECT_LT(std::sqrt(squares / counted), 1e-4);
}

TEST(CloudSurface, FollowsWhatIsPutElsewhere) {
    Place place(false);
    place.look(10);
    const Vec3 way(0.2, 0.0, 0.0);
    const Vec3 before = place.scene.objects[0].pose.position;
    place.scene.objects[0].pose.position += way;
    place.look(6);
    for (const double height : place.heights(before + way, 0.03)) {
        EXPECT_NEAR(height, place.top, 3e-3);
    }
    EXPECT_LT(place.heights(before, 0.03).back(), -0.005);
}

TEST(CloudSurface, GivesWayToWhatIsRecognised) {
    Place place(true);
    place.look(12);
    ASSERT_FALSE(place.discovery->objects().empty());
    EXPECT_EQ(place.discovery->objects().front().mesh, 0u);
    EXPECT_LT(place.surface.standing(), 6u);
}

}  // namespace
}  // namespace tactus::cloud_surface_test
