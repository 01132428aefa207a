#include "runtime/scene/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace belvedere {
namespace {

constexpr double kPi = std::numbers::pi;

double AngleBetween(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2.0 * kPi));
}

KinematicState Turning(DeadReckoning model) {
  KinematicState state;
  state.position_ecef = {-6378137.0, -5.0, -10.0};
  state.velocity_mps = {30, 35, 40};
  state.acceleration_mps2 = {-8, 5, 3};
  state.angular_velocity_radps = {0.3, -0.5, 0.9};
  state.orientation = {0.26, 0.35, 0.44};
  state.model = model;
  state.time_s = 100.0;
  return state;
}

// The models by brute force: small steps of the differential equations that the closed forms solve.
Pose Integrate(const KinematicState& state, double dt_s) {
  constexpr int kSteps = 20000;
  const double h = dt_s / kSteps;
  Pose pose{state.position_ecef, EcefFromBody(state.orientation), glm::dvec3(0.0)};
  glm::dvec3 velocity = state.velocity_mps;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 middle = ModelAccelerates(state.model) ? velocity + 0.5 * h * state.acceleration_mps2 : velocity;
    if (ModelAccelerates(state.model)) velocity += h * state.acceleration_mps2;
    const glm::dvec3 half = ModelRotates(state.model) ? 0.5 * h * state.angular_velocity_radps : glm::dvec3(0.0);
    pose.ecef_from_body = pose.ecef_from_body * RotationBy(half);
    pose.position_ecef += h * (ModelUsesBodyAxes(state.model) ? pose.ecef_from_body * middle : middle);
    pose.ecef_from_body = pose.ecef_from_body * RotationBy(half);
  }
  return pose;
}

TEST(Motion, EulerAnglesGoToMatrixAndBack) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> turn(-kPi, kPi), half(-kPi / 2, kPi / 2);
  for (int i = 0; i < 1000; ++i) {
    const EulerAngles in{turn(random), half(random), turn(random)};
    const EulerAngles out = ToEulerAngles(EcefFromBody(in));
    ASSERT_LT(AngleBetween(in.psi_rad, out.psi_rad), 1e-9);
    ASSERT_LT(AngleBetween(in.theta_rad, out.theta_rad), 1e-9);
    ASSERT_LT(AngleBetween(in.phi_rad, out.phi_rad), 1e-9);
  }
}

TEST(Motion, BodyAxesAreForwardRightDown) {
  // On the equator at 0 E, flying north and level: forward is +z, right (east) +y, down -x.
  const glm::dmat3 axes = EcefFromBody({0.0, -kPi / 2, kPi});
  EXPECT_LT(glm::length(axes[0] - glm::dvec3(0, 0, 1)), 1e-12);
  EXPECT_NEAR(glm::determinant(axes), 1.0, 1e-12);
  const glm::dmat3 yawed = EcefFromBody({kPi / 2, 0, 0});
  EXPECT_LT(glm::length(yawed[0] - glm::dvec3(0, 1, 0)), 1e-12);
  EXPECT_LT(glm::length(yawed[1] - glm::dvec3(-1, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(yawed[2] - glm::dvec3(0, 0, 1)), 1e-12);
}

TEST(Motion, GimbalLockKeepsTheMatrix) {
  for (const double theta : {kPi / 2, -kPi / 2}) {
    const glm::dmat3 axes = EcefFromBody({0.7, theta, -0.4});
    const glm::dmat3 again = EcefFromBody(ToEulerAngles(axes));
    for (int column = 0; column < 3; ++column) EXPECT_LT(glm::length(axes[column] - again[column]), 1e-9);
  }
}

TEST(Motion, EveryModelSolvesItsEquations) {
  for (int number = 2; number <= 9; ++number) {
    const KinematicState state = Turning(DeadReckoningModel(number));
    for (const double dt_s : {0.01, 0.3, 4.0}) {
      const Pose expected = Integrate(state, dt_s);
      const Pose pose = PoseAt(state, state.time_s + dt_s);
      ASSERT_LT(glm::length(pose.position_ecef - expected.position_ecef), 2e-5) << number << " " << dt_s;
      for (int column = 0; column < 3; ++column) {
        ASSERT_LT(glm::length(pose.ecef_from_body[column] - expected.ecef_from_body[column]), 1e-6) << number;
      }
    }
  }
}

TEST(Motion, VelocityOfAPoseIsTheSlopeOfItsPosition) {
  for (int number = 1; number <= 9; ++number) {
    const KinematicState state = Turning(DeadReckoningModel(number));
    const double t = state.time_s + 0.7, h = 1e-3;
    const glm::dvec3 slope = (PoseAt(state, t + h).position_ecef - PoseAt(state, t - h).position_ecef) / (2.0 * h);
    EXPECT_LT(glm::length(PoseAt(state, t).velocity_ecef_mps - slope), 1e-3) << number;
  }
}

TEST(Motion, NothingIsLostAsTurningGoesToZero) {
  KinematicState straight = Turning(DeadReckoning::kRvb);
  straight.angular_velocity_radps = {0, 0, 0};
  const KinematicState still = Extrapolate(straight, 10.0);
  for (const double w : {1e-12, 1e-8, 1e-5}) {
    KinematicState state = straight;
    state.angular_velocity_radps = {0, 0, w};
    const KinematicState later = Extrapolate(state, 10.0);
    EXPECT_LT(glm::length(later.position_ecef - still.position_ecef), 1e-6 + w * 1e5) << w;
  }
  // The series and the closed form meet: |w| t just under and over 0.25.
  KinematicState state = straight;
  state.angular_velocity_radps = {0.25, 0, 0};
  const glm::dvec3 under = Extrapolate(state, 1.0 - 1e-12).position_ecef;
  const glm::dvec3 over = Extrapolate(state, 1.0 + 1e-12).position_ecef;
  EXPECT_LT(glm::length(under - over), 1e-8);
}

TEST(Motion, UnknownModelsStandStill) {
  for (const int number : {0, 10, 255}) {
    const KinematicState state = Turning(DeadReckoningModel(number));
    const KinematicState later = Extrapolate(state, 5.0);
    EXPECT_EQ(later.position_ecef, state.position_ecef);
    EXPECT_EQ(later.orientation.psi_rad, state.orientation.psi_rad);
    EXPECT_EQ(PoseAt(state, 105.0).velocity_ecef_mps, glm::dvec3(0.0));
  }
}

TEST(Motion, NonsenseIsClampedAndStaysFinite) {
  for (int number = 1; number <= 9; ++number) {
    KinematicState state = Turning(DeadReckoningModel(number));
    state.velocity_mps = {3e38, -3e38, 3e38};
    state.acceleration_mps2 = {3e38, 0, 0};
    state.angular_velocity_radps = {0, 3e38, 0};
    state.orientation.psi_rad = 1e30;
    for (const bool clamped : {false, true}) {
      ASSERT_EQ(clamped && ClampMotion(state), clamped);
      const Pose pose = PoseAt(state, 1e9);
      for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(std::isfinite(pose.position_ecef[i]));
        EXPECT_TRUE(std::isfinite(pose.velocity_ecef_mps[i]));
        EXPECT_TRUE(std::isfinite(pose.ecef_from_body[i][i]));
      }
    }
    EXPECT_NEAR(glm::length(state.velocity_mps), kMaxSpeed_mps, 1e-6);
    EXPECT_FALSE(ClampMotion(state));
  }
}

TEST(Motion, PublishedReferenceCases) {
  std::ifstream file(std::string(BELVEDERE_SOURCE_DIR) + "/../shared/dis/dead_reckoning_vectors.csv");
  if (!file) GTEST_SKIP() << "no ../shared/dis/dead_reckoning_vectors.csv";
  std::string line, cell;
  std::getline(file, line);
  std::vector<std::string> names;
  for (std::stringstream row(line); std::getline(row, cell, ',');) names.push_back(cell);
  int rows = 0;
  while (std::getline(file, line)) {
    std::map<std::string, double> v;
    std::stringstream row(line);
    std::string id;
    for (size_t i = 0; i < names.size() && std::getline(row, cell, ','); ++i) {
      if (i == 0) id = cell;
      if (i != 0 && names[i] != "name" && !names[i].starts_with("source")) v[names[i]] = std::stod(cell);
    }
    KinematicState state;
    state.position_ecef = {v["x0"], v["y0"], v["z0"]};
    state.velocity_mps = {v["vx"], v["vy"], v["vz"]};
    state.acceleration_mps2 = {v["ax"], v["ay"], v["az"]};
    state.angular_velocity_radps = {v["wx"], v["wy"], v["wz"]};
    state.orientation = {v["psi0_rad"], v["theta0_rad"], v["phi0_rad"]};
    state.model = DeadReckoningModel(static_cast<int>(v["drm"]));
    const KinematicState later = Extrapolate(state, v["dt_s"]);
    for (int i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      EXPECT_NEAR(later.position_ecef[i], v[axis + "1"], v["tol_pos_m"]) << id;
      EXPECT_NEAR(later.velocity_mps[i], v["v" + axis + "1"], v["tol_pos_m"]) << id;
    }
    EXPECT_NEAR(later.orientation.psi_rad, v["psi1_rad"], v["tol_ang_rad"]) << id;
    EXPECT_NEAR(later.orientation.theta_rad, v["theta1_rad"], v["tol_ang_rad"]) << id;
    EXPECT_NEAR(later.orientation.phi_rad, v["phi1_rad"], v["tol_ang_rad"]) << id;
    ++rows;
  }
  EXPECT_EQ(rows, 26);
}

KinematicState Flying(const glm::dvec3& position, const glm::dvec3& velocity, double time_s) {
  KinematicState state;
  state.position_ecef = position;
  state.velocity_mps = velocity;
  state.model = DeadReckoning::kFpw;
  state.time_s = time_s;
  return state;
}

TEST(Smoother, ACorrectionStepsNeitherPositionNorVelocity) {
  Smoother smoother;
  const KinematicState before = Flying({0, 0, 0}, {200, 0, 0}, 0.0);
  KinematicState after = Flying({208, 6, 0}, {195, 20, 0}, 1.0);
  after.orientation.psi_rad = 0.3;
  constexpr double h = 1e-4;
  Pose last = smoother.Show(before, 1, 1.0 - h);
  Pose next = smoother.Show(after, 2, 1.0);
  EXPECT_LT(glm::length(next.position_ecef - last.position_ecef), 200 * h * 1.01);
  EXPECT_LT(glm::length(next.velocity_ecef_mps - last.velocity_ecef_mps), 1e-3);
  EXPECT_LT(glm::length(next.ecef_from_body[0] - last.ecef_from_body[0]), 1e-6);
  for (double t = 1.0 + h; t < 5.0; t += h) {
    last = next;
    next = smoother.Show(after, 2, t);
    const glm::dvec3 slope = (next.position_ecef - last.position_ecef) / h;
    ASSERT_LT(glm::length(slope - next.velocity_ecef_mps), 0.05) << t;
    ASSERT_LT(glm::length(next.velocity_ecef_mps - last.velocity_ecef_mps), 0.05) << t;
    ASSERT_NEAR(glm::length(next.velocity_ecef_mps), 200.0, 60.0) << t;
  }
  const Pose path = PoseAt(after, 5.0);
  const Pose shown = smoother.Show(after, 2, 5.0);
  EXPECT_LT(glm::length(shown.position_ecef - path.position_ecef), 1e-9);
  EXPECT_LT(glm::length(shown.ecef_from_body[0] - path.ecef_from_body[0]), 1e-12);
}

TEST(Smoother, CorrectionsThatFollowEachOtherDoNotStepEither) {
  Smoother smoother;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> error(-5, 5);
  KinematicState state = Flying({0, 0, 0}, {100, 0, 0}, 0.0);
  Pose last = smoother.Show(state, 0, 0.0);
  for (int i = 1; i < 2000; ++i) {
    const double t = i * 0.01;
    if (i % 23 == 0) {
      state = Flying({100 * t + error(random), error(random), error(random)}, {100, error(random), 0}, t);
    }
    const Pose next = smoother.Show(state, static_cast<uint32_t>(i / 23), t);
    ASSERT_LT(glm::length(next.position_ecef - last.position_ecef), 100 * 0.01 * 1.6) << t;
    last = next;
  }
}

TEST(Smoother, AJumpIsTakenAtOnceAndSoIsAPathNotSeenForASecond) {
  Smoother smoother;
  smoother.Show(Flying({0, 0, 0}, {100, 0, 0}, 0.0), 1, 0.0);
  const KinematicState far = Flying({5000, 0, 0}, {100, 0, 0}, 0.5);
  EXPECT_EQ(smoother.Show(far, 2, 0.5).position_ecef, PoseAt(far, 0.5).position_ecef);
  const KinematicState aside = Flying({5000, 20, 0}, {100, 0, 0}, 3.0);
  EXPECT_EQ(smoother.Show(aside, 3, 3.0).position_ecef, PoseAt(aside, 3.0).position_ecef);
  const KinematicState near = Flying({5000, 40, 0}, {100, 0, 0}, 3.1);
  EXPECT_GT(glm::length(smoother.Show(near, 4, 3.1).position_ecef - PoseAt(near, 3.1).position_ecef), 10.0);
}

}  // namespace
}  // namespace belvedere
