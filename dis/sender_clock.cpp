#include "dis/sender_clock.h"

#include <algorithm>
#include <cmath>

namespace belvedere::dis {
namespace {

constexpr double kWindow_s = 30.0;              // of each of the two halves that the least sample is taken over
constexpr double kSetAhead_s = 0.5;             // a sample less by more is a clock that was set
constexpr double kPaceSlack_s = 0.25;           // jitter of the two datagrams that a pace is measured between,
constexpr double kPaceShare = 0.02;             // and how far a clock may run fast or slow
constexpr double kLongestLeastTransit_s = 1.0;  // a network is no slower; an absolute clock that says so is wrong

}  // namespace

void SenderClock::Least::Take(double sample, double transit) {
  sample_s = any ? std::min(sample_s, sample) : sample;
  transit_s = any ? std::min(transit_s, transit) : transit;
  any = true;
}

double SenderClock::Unwrap(double past_hour_s) {
  if (!started_) return past_hour_s;
  return last_stamp_s_ + std::remainder(past_hour_s - last_stamp_s_, 3600.0);
}

void SenderClock::StartAgain(double stamp_s, double arrival_s, double sample_s, double transit_s) {
  if (!started_) {
    pace_stamp_s_ = stamp_s;
    pace_arrival_s_ = arrival_s;
  }
  started_ = true;
  last_stamp_s_ = stamp_s;
  window_start_s_ = arrival_s;
  least_ = {};
  least_[0].Take(sample_s, transit_s);
}

void SenderClock::Learn(double sample_s, double transit_s, double arrival_s) {
  if (arrival_s - window_start_s_ > kWindow_s) {
    least_[1] = arrival_s - window_start_s_ > 2 * kWindow_s ? Least{} : least_[0];
    least_[0] = {};
    window_start_s_ = arrival_s;
  }
  least_[0].Take(sample_s, transit_s);
}

void SenderClock::JudgePace(double stamp_s, double arrival_s) {
  const double ours_s = arrival_s - pace_arrival_s_;
  if (ours_s < kPace_s) return;
  keeps_pace_ = std::abs(stamp_s - pace_stamp_s_ - ours_s) <= kPaceSlack_s + kPaceShare * ours_s;
  judged_ = true;
  pace_stamp_s_ = stamp_s;
  pace_arrival_s_ = arrival_s;
}

double SenderClock::StateTime(uint32_t timestamp, double arrival_s, double utc_s) {
  const double stamp_s = Unwrap(SecondsPastHour(timestamp));
  const double sample_s = arrival_s - stamp_s;
  const double transit_s = std::remainder(utc_s - SecondsPastHour(timestamp), 3600.0);
  if (!started_) {
    StartAgain(stamp_s, arrival_s, sample_s, transit_s);
  } else {
    const Least& before = least_[1].any && least_[1].sample_s < least_[0].sample_s ? least_[1] : least_[0];
    const double late_s = sample_s - before.sample_s;
    if (late_s < -kSetAhead_s || late_s > kLongestTransit_s) {
      JudgePace(stamp_s, arrival_s);
      StartAgain(stamp_s, arrival_s, sample_s, transit_s);
    } else {
      Learn(sample_s, transit_s, arrival_s);
      if (stamp_s >= last_stamp_s_) JudgePace(stamp_s, arrival_s);
    }
    last_stamp_s_ = std::max(last_stamp_s_, stamp_s);
  }
  if (!keeps_pace_) return arrival_s;
  const Least& other = least_[1].any ? least_[1] : least_[0];
  const double least_transit_s = std::min(least_[0].transit_s, other.transit_s);
  const bool utc =
      IsAbsolute(timestamp) && least_transit_s >= -kClockSkew_s && least_transit_s <= kLongestLeastTransit_s;
  const double late_s = utc ? transit_s : sample_s - std::min(least_[0].sample_s, other.sample_s);
  return late_s <= (judged_ || utc ? kLongestTransit_s : kProbation_s) ? arrival_s - late_s : arrival_s;
}

double SenderClocks::StateTime(const Sender& sender, uint32_t timestamp, double arrival_s, double utc_s) {
  auto known = clocks_.find(sender);
  if (known == clocks_.end()) {
    if (clocks_.size() >= kMostSenders) ForgetStalest();
    known = clocks_.try_emplace(sender).first;
  }
  known->second.heard_s = arrival_s;
  return known->second.clock.StateTime(timestamp, arrival_s, utc_s);
}

void SenderClocks::ForgetStalest() {
  clocks_.erase(std::min_element(clocks_.begin(), clocks_.end(),
                                 [](const auto& a, const auto& b) { return a.second.heard_s < b.second.heard_s; }));
}

}  // namespace belvedere::dis
