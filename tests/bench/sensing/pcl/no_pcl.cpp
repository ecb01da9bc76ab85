// In place of pcl_rival.cpp where the machine has no PCL.
#include "sensing/rival.hpp"

namespace tactus::shared {

std::unique_ptr<SensingRival> make_pcl_rival(const std::vector<TriangleMesh>&) {
    return nullptr;
}

}  // namespace tactus::shared
