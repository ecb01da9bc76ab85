#include "world/problem_of_place.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tactus {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double endless = std::numeric_limits<double>::infinity();

TEST(ProblemOfPlace, ThereIsNoneWhereItCanBeTouched) {
    EXPECT_EQ(problem_of_place(Mat3(1.0), Vec3(0.0)), "");
    EXPECT_EQ(problem_of_place(Mat3(-1e-6), Vec3(9e6)), "") << "mirrored, small and far";
}

TEST(ProblemOfPlace, ItSaysWhatToDo) {
    for (const double bad : {none, endless, -endless}) {
        EXPECT_NE(problem_of_place(Mat3(1.0), Vec3(0, bad, 0)).find("finite"), std::string::npos);
        EXPECT_NE(problem_of_place(Mat3(bad), Vec3(0.0)).find("finite"), std::string::npos);
    }
    EXPECT_NE(problem_of_place(Mat3(1e20), Vec3(0.0)).find("scaled by 1e+20"), std::string::npos);
    EXPECT_NE(problem_of_place(Mat3(0.0), Vec3(0.0)).find("scaled by 0"), std::string::npos);
    EXPECT_NE(problem_of_place(Mat3(1.0), Vec3(0, -1e30, 0)).find("10,000 km"), std::string::npos);
}

}  // namespace
}  // namespace tactus
