// The usual way, by the Point Cloud Library:
//
//   pieces       VoxelGrid, plane by RANSAC, EuclideanClusterExtraction
//   recognition  for each mesh: FPFH, SampleConsensusPrerejective, ICP; the mesh that the piece lies on best
//   following    VoxelGrid, ICP from where it was
//
// Compiled with the system's own flags: Debian's PCL does not stand -march=native.
#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>
#include <pcl/sample_consensus/method_types.h>
#include <pcl/sample_consensus/model_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <cstdlib>
#include <exception>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "sensing/rival.hpp"

namespace tactus::shared {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Oriented = pcl::PointCloud<pcl::PointNormal>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;

// (unit: meters)
constexpr float leaf = 0.004F;
constexpr double plane_distance = 0.006;
constexpr double piece_gap = 0.012;
constexpr double normal_radius = 0.012;
constexpr double feature_radius = 0.025;
constexpr double alignment_distance = 0.01;
constexpr double icp_distance = 0.015;

constexpr int least_points = 30;
constexpr int plane_tries = 200;
constexpr int alignment_tries = 10000;
constexpr int icp_steps = 50;

Cloud::Ptr cloud_of(std::span<const Vec3> points) {
    auto cloud = pcl::make_shared<Cloud>();
    cloud->reserve(points.size());
    for (const Vec3& point : points) {
        cloud->emplace_back(static_cast<float>(point.x), static_cast<float>(point.y),
                            static_cast<float>(point.z));
    }
    return cloud;
}

Cloud::Ptr thinned(const Cloud::Ptr& cloud) {
    auto thin = pcl::make_shared<Cloud>();
    pcl::VoxelGrid<pcl::PointXYZ> grid;
    grid.setInputCloud(cloud);
    grid.setLeafSize(leaf, leaf, leaf);
    grid.filter(*thin);
    return thin;
}

Oriented::Ptr with_normals(const Cloud::Ptr& cloud) {
    Normals normals;
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(cloud);
    estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.setRadiusSearch(normal_radius);
    estimation.setViewPoint(0.0F, 0.0F, 0.0F);
    estimation.compute(normals);
    auto oriented = pcl::make_shared<Oriented>();
    for (std::size_t i = 0; i < cloud->size(); ++i) {
        if (pcl::isFinite(normals[i])) {
            pcl::PointNormal point;
            point.getVector3fMap() = (*cloud)[i].getVector3fMap();
            point.getNormalVector3fMap() = normals[i].getNormalVector3fMap();
            oriented->push_back(point);
        }
    }
    return oriented;
}

Features::Ptr features_of(const Oriented::Ptr& oriented) {
    auto features = pcl::make_shared<Features>();
    pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation;
    estimation.setRadiusSearch(feature_radius);
    estimation.setInputCloud(oriented);
    estimation.setInputNormals(oriented);
    estimation.compute(*features);
    return features;
}

// Points about a leaf apart all over the surface, with the faces' normals.
Oriented::Ptr surface_of(const TriangleMesh& mesh) {
    auto all = pcl::make_shared<Oriented>();
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
        const Vec3 across = glm::cross(q - p, r - p);
        const double longest = std::max({glm::distance(p, q), glm::distance(q, r), glm::distance(r, p)});
        if (!(glm::length(across) > 0.0)) {
            continue;
        }
        const Vec3 normal = glm::normalize(across);
        const int parts = std::max(1, static_cast<int>(std::ceil(2.0 * longest / leaf)));
        for (int i = 0; i < parts; ++i) {
            for (int j = 0; i + j < parts; ++j) {
                const Vec3 at = p + ((i + 1.0 / 3.0) / parts) * (q - p) + ((j + 1.0 / 3.0) / parts) * (r - p);
                pcl::PointNormal point;
                point.getVector3fMap() = Eigen::Vector3f(static_cast<float>(at.x), static_cast<float>(at.y),
                                                         static_cast<float>(at.z));
                point.getNormalVector3fMap() = Eigen::Vector3f(
                    static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z));
                all->push_back(point);
            }
        }
    }
    auto thin = pcl::make_shared<Oriented>();
    pcl::VoxelGrid<pcl::PointNormal> grid;
    grid.setInputCloud(all);
    grid.setLeafSize(leaf, leaf, leaf);
    grid.filter(*thin);
    for (pcl::PointNormal& point : *thin) {
        if (const auto normal = point.getNormalVector3fMap(); normal.norm() > 0.0F) {
            point.getNormalVector3fMap() = normal.normalized();
        } else {
            point.getNormalVector3fMap() = Eigen::Vector3f::UnitY();
        }
    }
    return thin;
}

// From the piece onto the mesh, turned round.
Pose mesh_in_camera(const Eigen::Matrix4f& onto_mesh) {
    const Eigen::Matrix4d back = onto_mesh.cast<double>().inverse();
    const Eigen::Quaterniond turn(Eigen::Matrix3d(back.topLeftCorner<3, 3>()));
    return {{back(0, 3), back(1, 3), back(2, 3)},
            glm::normalize(Quat(turn.w(), turn.x(), turn.y(), turn.z()))};
}

Eigen::Matrix4f camera_to_mesh(const Pose& in_camera) {
    const Pose back = inverse(in_camera);
    const Eigen::Quaterniond turn(back.rotation.w, back.rotation.x, back.rotation.y, back.rotation.z);
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = turn.toRotationMatrix();
    matrix(0, 3) = back.position.x;
    matrix(1, 3) = back.position.y;
    matrix(2, 3) = back.position.z;
    return matrix.cast<float>();
}

class PclRival final : public SensingRival {
public:
    explicit PclRival(const std::vector<TriangleMesh>& library) {
        for (const TriangleMesh& mesh : library) {
            Known known;
            known.surface = surface_of(mesh);
            known.features = features_of(known.surface);
            known.points = pcl::make_shared<Cloud>();
            for (const pcl::PointNormal& point : *known.surface) {
                known.points->emplace_back(point.x, point.y, point.z);
            }
            known_.push_back(std::move(known));
        }
    }

    std::vector<std::vector<Vec3>> pieces(std::span<const Vec3> points) override {
        const Cloud::Ptr cloud = thinned(cloud_of(points));
        auto in_plane = pcl::make_shared<pcl::PointIndices>();
        pcl::ModelCoefficients plane;
        pcl::SACSegmentation<pcl::PointXYZ> search;
        search.setModelType(pcl::SACMODEL_PLANE);
        search.setMethodType(pcl::SAC_RANSAC);
        search.setMaxIterations(plane_tries);
        search.setDistanceThreshold(plane_distance);
        search.setInputCloud(cloud);
        search.segment(*in_plane, plane);
        auto rest = pcl::make_shared<Cloud>();
        pcl::ExtractIndices<pcl::PointXYZ> extraction;
        extraction.setInputCloud(cloud);
        extraction.setIndices(in_plane);
        extraction.setNegative(true);
        extraction.filter(*rest);
        std::vector<std::vector<Vec3>> found;
        if (rest->empty()) {
            return found;
        }
        auto tree = pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
        tree->setInputCloud(rest);
        std::vector<pcl::PointIndices> clusters;
        pcl::EuclideanClusterExtraction<pcl::PointXYZ> clustering;
        clustering.setClusterTolerance(piece_gap);
        clustering.setMinClusterSize(least_points);
        clustering.setSearchMethod(tree);
        clustering.setInputCloud(rest);
        clustering.extract(clusters);
        for (const pcl::PointIndices& cluster : clusters) {
            std::vector<Vec3>& piece = found.emplace_back();
            for (const int i : cluster.indices) {
                const pcl::PointXYZ& point = (*rest)[static_cast<std::size_t>(i)];
                piece.emplace_back(point.x, point.y, point.z);
            }
        }
        return found;
    }

    RivalMatch recognise(std::span<const Vec3> piece) override {
        const Oriented::Ptr seen = with_normals(thinned(cloud_of(piece)));
        RivalMatch best;
        if (seen->size() < static_cast<std::size_t>(least_points)) {
            return best;
        }
        const Features::Ptr features = features_of(seen);
        auto points = pcl::make_shared<Cloud>();
        for (const pcl::PointNormal& point : *seen) {
            points->emplace_back(point.x, point.y, point.z);
        }
        double least = std::numeric_limits<double>::infinity();
        std::srand(1);
        for (std::size_t i = 0; i < known_.size(); ++i) {
            pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33>
                alignment;
            alignment.setInputSource(seen);
            alignment.setSourceFeatures(features);
            alignment.setInputTarget(known_[i].surface);
            alignment.setTargetFeatures(known_[i].features);
            alignment.setMaximumIterations(alignment_tries);
            alignment.setNumberOfSamples(3);
            alignment.setCorrespondenceRandomness(5);
            alignment.setSimilarityThreshold(0.9F);
            alignment.setMaxCorrespondenceDistance(alignment_distance);
            alignment.setInlierFraction(0.5F);
            Oriented aligned;
            alignment.align(aligned);
            if (!alignment.hasConverged()) {
                continue;
            }
            double fitness = 0.0;
            const Eigen::Matrix4f onto =
                closest(points, known_[i].points, alignment.getFinalTransformation(), fitness);
            if (fitness < least) {
                least = fitness;
                best = {true, i, mesh_in_camera(onto)};
            }
        }
        return best;
    }

    Pose follow(std::size_t mesh, std::span<const Vec3> points, const Pose& from) override {
        const Cloud::Ptr cloud = thinned(cloud_of(points));
        if (cloud->size() < static_cast<std::size_t>(least_points)) {
            return from;
        }
        double fitness = 0.0;
        return mesh_in_camera(closest(cloud, known_[mesh].points, camera_to_mesh(from), fitness));
    }

private:
    struct Known {
        Oriented::Ptr surface;
        Features::Ptr features;
        Cloud::Ptr points;
    };

    static Eigen::Matrix4f closest(const Cloud::Ptr& seen, const Cloud::Ptr& mesh,
                                   const Eigen::Matrix4f& from, double& fitness) {
        pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
        icp.setInputSource(seen);
        icp.setInputTarget(mesh);
        icp.setMaximumIterations(icp_steps);
        icp.setMaxCorrespondenceDistance(icp_distance);
        icp.setTransformationEpsilon(1e-9);
        Cloud moved;
        icp.align(moved, from);
        fitness = icp.getFitnessScore();
        return icp.getFinalTransformation();
    }

    std::vector<Known> known_;
};

}  // namespace

std::unique_ptr<SensingRival> make_pcl_rival(const std::vector<TriangleMesh>& library) {
    try {
        return std::make_unique<PclRival>(library);
    } catch (const std::exception&) {
        return nullptr;
    }
}

}  // namespace tactus::shared
