// Motion: how an object moves between two reports of it. Dead reckoning by the models of IEEE 1278.1 annex E, and the
// blending of corrections into what is shown.
//
// KinematicState is what a report says: where the object was at time_s, and how it was moving. Extrapolate says where
// it is dt seconds later. The models, by the standard's names (F/R: orientation fixed or rotating; P/V: constant
// velocity, or velocity changing by a constant acceleration; W/B: velocity and acceleration along world or body axes):
//   1 static, 2 FPW, 3 RPW, 4 RVW, 5 FVW, 6 FPB, 7 RPB, 8 RVB, 9 FVB; every other number is taken as static.
// With A the skew matrix of the body's angular velocity w and R0 = ecef_from_body at time_s:
//   orientation   R(t) = R0 exp(A t)
//   world axes    p(t) = p0 + v t + a t^2 / 2                       v(t) = v + a t
//   body axes     p(t) = p0 + R0 (R1 v + R2 a)                      v(t) = v + a t, along the turning body's axes
//                 R1 = int_0^t exp(A s) ds,  R2 = int_0^t s exp(A s) ds; with no rotation R1 = t I, R2 = t^2/2 I
// R1 and R2 are closed forms in |w| t; below a small angle their series, so that nothing is lost as |w| goes to zero.
//
// Units:   metres, seconds, radians.
// Frames:  position ECEF. Body axes: x forward, y right, z down. Orientation is psi, theta, phi: turns about z, then
// the
//          new y, then the new x, that take ECEF axes to body axes. Velocity and acceleration ECEF for models 1 to 5,
//          body axes for 6 to 9; angular velocity always about body axes.
// Threads: pure functions; a Smoother belongs to its user.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace belvedere {

enum class DeadReckoning : uint8_t {
  kStatic = 1,
  kFpw,
  kRpw,
  kRvw,
  kFvw,
  kFpb,
  kRpb,
  kRvb,
  kFvb,
};
// The model of that number; static where the standard has none.
DeadReckoning DeadReckoningModel(int number);
bool ModelRotates(DeadReckoning model);
bool ModelAccelerates(DeadReckoning model);
bool ModelUsesBodyAxes(DeadReckoning model);

struct EulerAngles {
  double psi_rad = 0, theta_rad = 0, phi_rad = 0;
};

// Columns are the body's axes (forward, right, down) in ECEF.
glm::dmat3 EcefFromBody(const EulerAngles& orientation);
// psi and phi in (-pi, pi], theta in [-pi/2, pi/2]; at theta = +-pi/2, where only psi -+ phi is known, phi is 0.
EulerAngles ToEulerAngles(const glm::dmat3& ecef_from_body);
// The rotation exp([turn]x): by |turn| radians about turn.
glm::dmat3 RotationBy(const glm::dvec3& turn_rad);

struct KinematicState {
  glm::dvec3 position_ecef{0.0};
  glm::dvec3 velocity_mps{0.0};
  glm::dvec3 acceleration_mps2{0.0};
  glm::dvec3 angular_velocity_radps{0.0};
  EulerAngles orientation;
  DeadReckoning model = DeadReckoning::kStatic;
  double time_s = 0;  // when this was so, on the user's Clock::NowSeconds
};

// Limits beyond which a report is taken to be nonsense; ClampMotion brings it within and says whether it had to.
inline constexpr double kMaxSpeed_mps = 250e3;  // an airliner recorded and sent 720 times as fast
inline constexpr double kMaxAcceleration_mps2 = 10e3;
inline constexpr double kMaxAngularSpeed_radps = 100.0;
bool ClampMotion(KinematicState& state);

// The state dt_s later (or earlier); always finite, angles within the ranges of ToEulerAngles when it rotates and as
// they were when it does not. |dt_s| over an hour is taken as an hour. REQUIRES: the fields of `state` are finite.
KinematicState Extrapolate(const KinematicState& state, double dt_s);

// What is drawn: where, which way, and how fast over the world.
struct Pose {
  glm::dvec3 position_ecef{0.0};
  glm::dmat3 ecef_from_body{1.0};
  glm::dvec3 velocity_ecef_mps{0.0};
};
// The same as Extrapolate to time_s, without the way through Euler angles.
Pose PoseAt(const KinematicState& state, double time_s);

struct SmoothingOptions {
  double blend_s = 0.8;        // a correction is worked off in this time,
  double speed_share = 0.25;   // or longer, up to 4 blend_s, so that it changes the speed shown by less than this
  double jump_m = 200.0;       // a correction longer than this is a jump, and taken at once
  double jump_turn_rad = 2.0;  // so is one that turns it by more
};

// Shows one object. While reports agree with the path shown, it is that path. When a new report moves the path, what is
// shown leaves the old path with its old velocity and joins the new one with the new velocity: the offset from the new
// path is a cubic that starts at the old position and velocity and ends at zero in both, so neither steps. Orientation
// follows likewise, by a turn that shrinks to none. An object that was not shown for a second joins its path at once.
class Smoother {
 public:
  // The pose at time_s, which must not go back. `report` tells states apart: it changes with every new one.
  Pose Show(const KinematicState& state, uint32_t report, double time_s, const SmoothingOptions& options = {}) {
    return Show(state, PoseAt(state, time_s), report, time_s, options);
  }
  // The same for those who have PoseAt(state, time_s) already.
  Pose Show(const KinematicState& state, const Pose& path, uint32_t report, double time_s,
            const SmoothingOptions& options = {});

 private:
  struct Correction {
    glm::dvec3 offset_ecef{0.0};
    glm::dvec3 offset_velocity_mps{0.0};
    glm::dquat turn{1.0, 0.0, 0.0, 0.0};  // shown = turn * path, in ECEF
    double start_s = 0;
    double duration_s = 0;  // 0: none
  };
  Pose Corrected(Pose path, double time_s) const;
  void Correct(const Pose& path, double time_s, const SmoothingOptions& options);

  std::optional<KinematicState> path_;
  uint32_t report_ = 0;
  double shown_s_ = 0;
  Correction correction_;
};

}  // namespace belvedere
