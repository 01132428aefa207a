#include "runtime/scene/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace belvedere {
namespace {

constexpr double kLongestStep_s = 3600.0;
constexpr double kUnseen_s = 1.0;  // nobody remembers where an object was shown that long ago

// The coefficients of A t and (A t)^2 in exp(A t), R1 / t and R2 / t^2, as functions of x = |w| t.
struct RotationSeries {
  double exp1, exp2;
  double first1, first2;
  double second1, second2;
};

// The series of the six in x^2: sin x / x = sum (-1)^k x^2k / (2k+1)! and so on, integrated term by term.
constexpr int kTerms = 7;
struct SeriesTerms {
  std::array<double, kTerms> exp1{}, exp2{}, first2{}, second1{}, second2{};
};
constexpr SeriesTerms MakeTerms() {
  SeriesTerms terms;
  double term = 1.0;  // (-1)^k / (2k)!
  for (size_t k = 0; k < kTerms; ++k) {
    const double n = 2.0 * static_cast<double>(k);
    terms.exp1[k] = term / (n + 1);
    terms.exp2[k] = terms.exp1[k] / (n + 2);
    terms.first2[k] = terms.exp2[k] / (n + 3);
    terms.second1[k] = terms.exp1[k] / (n + 3);
    terms.second2[k] = terms.exp2[k] / (n + 4);
    term *= -1.0 / ((n + 1) * (n + 2));
  }
  return terms;
}

double Sum(const std::array<double, kTerms>& terms, double square) {
  double sum = 0;
  for (size_t k = kTerms; k-- > 0;) sum = sum * square + terms[k];
  return sum;
}

RotationSeries SmallAngleSeries(double square) {
  static constexpr SeriesTerms kSeries = MakeTerms();
  RotationSeries sum{};
  sum.exp1 = Sum(kSeries.exp1, square);
  sum.exp2 = Sum(kSeries.exp2, square);
  sum.first1 = sum.exp2;
  sum.first2 = Sum(kSeries.first2, square);
  sum.second1 = Sum(kSeries.second1, square);
  sum.second2 = Sum(kSeries.second2, square);
  return sum;
}

RotationSeries SeriesOf(const glm::dvec3& turn_rad) {
  const double square = glm::dot(turn_rad, turn_rad);
  if (square < 0.25 * 0.25) return SmallAngleSeries(square);
  const double x = std::sqrt(square), sine = std::sin(x), cosine = std::cos(x);
  RotationSeries c{};
  c.exp1 = sine / x;
  c.exp2 = (1.0 - cosine) / square;
  c.first1 = c.exp2;
  c.first2 = (x - sine) / (square * x);
  c.second1 = (sine - x * cosine) / (square * x);
  c.second2 = (0.5 - (cosine + x * sine - 1.0) / square) / square;
  return c;
}

// identity I + once [turn]x + twice [turn]x^2, applied without forming the matrices.
glm::dvec3 Apply(double identity, double once, double twice, const glm::dvec3& turn, const glm::dvec3& vector) {
  const glm::dvec3 crossed = glm::cross(turn, vector);
  return identity * vector + once * crossed + twice * glm::cross(turn, crossed);
}

glm::dmat3 Exponential(const RotationSeries& c, const glm::dvec3& turn) {
  return {Apply(1.0, c.exp1, c.exp2, turn, {1, 0, 0}), Apply(1.0, c.exp1, c.exp2, turn, {0, 1, 0}),
          Apply(1.0, c.exp1, c.exp2, turn, {0, 0, 1})};
}

struct Advance {
  glm::dvec3 position_ecef, velocity_mps;  // velocity in the model's own axes
  glm::dmat3 ecef_from_body;
};

Advance AdvanceBy(const KinematicState& state, double dt_s) {
  const double dt = std::clamp(dt_s, -kLongestStep_s, kLongestStep_s);
  const glm::dmat3 start = EcefFromBody(state.orientation);
  Advance now{state.position_ecef, state.velocity_mps, start};
  if (state.model == DeadReckoning::kStatic) return now;
  const glm::dvec3 turn = ModelRotates(state.model) ? state.angular_velocity_radps * dt : glm::dvec3(0.0);
  const glm::dvec3 acceleration = ModelAccelerates(state.model) ? state.acceleration_mps2 : glm::dvec3(0.0);
  const RotationSeries c = SeriesOf(turn);
  if (ModelRotates(state.model)) now.ecef_from_body = start * Exponential(c, turn);
  now.velocity_mps += acceleration * dt;
  if (ModelUsesBodyAxes(state.model)) {
    now.position_ecef += start * (Apply(dt, dt * c.first1, dt * c.first2, turn, state.velocity_mps) +
                                  dt * Apply(0.5 * dt, dt * c.second1, dt * c.second2, turn, acceleration));
  } else {
    now.position_ecef += state.velocity_mps * dt + 0.5 * dt * dt * acceleration;
  }
  return now;
}

double Smoothstep(double u) {
  return u * u * (3.0 - 2.0 * u);
}

// (-pi, pi], with a rounding error short of -pi counted as pi, so that due south does not flicker between the two.
double OneTurn(double angle_rad) {
  return angle_rad < 1e-9 - std::numbers::pi ? angle_rad + 2.0 * std::numbers::pi : angle_rad;
}

bool ClampLength(glm::dvec3& vector, double longest) {
  const double length = std::hypot(vector.x, vector.y, vector.z);
  if (length <= longest) return false;
  vector *= longest / length;
  return true;
}

}  // namespace

DeadReckoning DeadReckoningModel(int number) {
  return number >= 1 && number <= 9 ? static_cast<DeadReckoning>(number) : DeadReckoning::kStatic;
}

bool ModelRotates(DeadReckoning model) {
  return model == DeadReckoning::kRpw || model == DeadReckoning::kRvw || model == DeadReckoning::kRpb ||
         model == DeadReckoning::kRvb;
}

bool ModelAccelerates(DeadReckoning model) {
  return model == DeadReckoning::kRvw || model == DeadReckoning::kFvw || model == DeadReckoning::kRvb ||
         model == DeadReckoning::kFvb;
}

bool ModelUsesBodyAxes(DeadReckoning model) {
  return model >= DeadReckoning::kFpb;
}

glm::dmat3 EcefFromBody(const EulerAngles& orientation) {
  const double sin_psi = std::sin(orientation.psi_rad), cos_psi = std::cos(orientation.psi_rad);
  const double sin_theta = std::sin(orientation.theta_rad), cos_theta = std::cos(orientation.theta_rad);
  const double sin_phi = std::sin(orientation.phi_rad), cos_phi = std::cos(orientation.phi_rad);
  return {{cos_theta * cos_psi, cos_theta * sin_psi, -sin_theta},
          {sin_phi * sin_theta * cos_psi - cos_phi * sin_psi, sin_phi * sin_theta * sin_psi + cos_phi * cos_psi,
           sin_phi * cos_theta},
          {cos_phi * sin_theta * cos_psi + sin_phi * sin_psi, cos_phi * sin_theta * sin_psi - sin_phi * cos_psi,
           cos_phi * cos_theta}};
}

EulerAngles ToEulerAngles(const glm::dmat3& ecef_from_body) {
  const glm::dvec3& forward = ecef_from_body[0];
  const glm::dvec3& right = ecef_from_body[1];
  const glm::dvec3& down = ecef_from_body[2];
  const double cos_theta = std::hypot(forward.x, forward.y);
  EulerAngles angles;
  angles.theta_rad = std::atan2(-forward.z, cos_theta);
  if (cos_theta < 1e-9) {
    angles.psi_rad = OneTurn(std::atan2(-right.x, right.y));
    return angles;
  }
  angles.psi_rad = OneTurn(std::atan2(forward.y, forward.x));
  angles.phi_rad = OneTurn(std::atan2(right.z, down.z));
  return angles;
}

glm::dmat3 RotationBy(const glm::dvec3& turn_rad) {
  return Exponential(SeriesOf(turn_rad), turn_rad);
}

bool ClampMotion(KinematicState& state) {
  const bool speed = ClampLength(state.velocity_mps, kMaxSpeed_mps);
  const bool acceleration = ClampLength(state.acceleration_mps2, kMaxAcceleration_mps2);
  const bool turning = ClampLength(state.angular_velocity_radps, kMaxAngularSpeed_radps);
  return speed || acceleration || turning;
}

KinematicState Extrapolate(const KinematicState& state, double dt_s) {
  const Advance now = AdvanceBy(state, dt_s);
  KinematicState later = state;
  later.position_ecef = now.position_ecef;
  later.velocity_mps = now.velocity_mps;
  if (ModelRotates(state.model)) later.orientation = ToEulerAngles(now.ecef_from_body);
  later.time_s += dt_s;
  return later;
}

Pose PoseAt(const KinematicState& state, double time_s) {
  const Advance now = AdvanceBy(state, time_s - state.time_s);
  Pose pose{now.position_ecef, now.ecef_from_body, glm::dvec3(0.0)};
  if (state.model != DeadReckoning::kStatic) {
    pose.velocity_ecef_mps = ModelUsesBodyAxes(state.model) ? now.ecef_from_body * now.velocity_mps : now.velocity_mps;
  }
  return pose;
}

Pose Smoother::Show(const KinematicState& state, const Pose& path, uint32_t report, double time_s,
                    const SmoothingOptions& options) {
  if (!path_ || time_s - shown_s_ > kUnseen_s) {
    correction_ = {};
  } else if (report != report_) {
    Correct(path, time_s, options);
  }
  path_ = state;
  report_ = report;
  shown_s_ = time_s;
  return Corrected(path, time_s);
}

Pose Smoother::Corrected(Pose pose, double time_s) const {
  const double since_s = time_s - correction_.start_s;
  if (since_s >= correction_.duration_s) return pose;
  const double duration_s = correction_.duration_s;
  const double u = std::max(since_s / duration_s, 0.0);
  const double left = 1.0 - Smoothstep(u);  // the cubic Hermite basis and its derivatives
  const double slope = u * (1.0 - u) * (1.0 - u);
  pose.position_ecef += left * correction_.offset_ecef + slope * duration_s * correction_.offset_velocity_mps;
  pose.velocity_ecef_mps += -6.0 * u * (1.0 - u) / duration_s * correction_.offset_ecef +
                            (1.0 - u) * (1.0 - 3.0 * u) * correction_.offset_velocity_mps;
  const glm::dquat turn = glm::slerp(glm::dquat(1, 0, 0, 0), correction_.turn, left);
  pose.ecef_from_body = glm::mat3_cast(turn) * pose.ecef_from_body;
  return pose;
}

void Smoother::Correct(const Pose& next, double time_s, const SmoothingOptions& options) {
  const Pose shown = Corrected(PoseAt(*path_, time_s), time_s);
  correction_ = {};
  Correction correction;
  correction.offset_ecef = shown.position_ecef - next.position_ecef;
  correction.offset_velocity_mps = shown.velocity_ecef_mps - next.velocity_ecef_mps;
  correction.turn = glm::normalize(glm::quat_cast(shown.ecef_from_body * glm::transpose(next.ecef_from_body)));
  if (correction.turn.w < 0.0) correction.turn = -correction.turn;
  const double offset_m = glm::length(correction.offset_ecef);
  const double turn_rad = 2.0 * std::acos(std::min(correction.turn.w, 1.0));
  if (!(offset_m <= options.jump_m) || !(turn_rad <= options.jump_turn_rad)) return;
  // The cubic is steepest at its middle, 1.5 offsets a duration.
  const double speed_mps = glm::length(next.velocity_ecef_mps);
  const double gentle_s = 1.5 * offset_m / std::max(options.speed_share * speed_mps, 1e-3);
  correction.duration_s =
      speed_mps < 1.0 ? options.blend_s : std::clamp(gentle_s, options.blend_s, 4.0 * options.blend_s);
  ClampLength(correction.offset_velocity_mps, options.jump_m / correction.duration_s);
  correction.start_s = time_s;
  correction_ = correction;
}

}  // namespace belvedere
