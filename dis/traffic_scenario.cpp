// The vehicles of each scenario; docs/dis.md has the table.
#include "dis/traffic_vehicle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace belvedere::dis {
namespace {

// SplitMix64 (Steele, Lea and Flood 2014). The standard library's distributions differ between implementations, and the
// same seed must give the same traffic everywhere.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  uint64_t Next() {
    state_ += 0x9E3779B97F4A7C15u;
    uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double Between(double low, double high) { return low + (high - low) * static_cast<double>(Next() >> 11) * 0x1p-53; }
  size_t Below(size_t count) { return static_cast<size_t>(Next() % count); }

 private:
  uint64_t state_;
};

constexpr uint8_t kFriendly = 1, kNeutral = 3;
constexpr uint16_t kUnitedStates = 225;
constexpr uint32_t kPowerPlantOn = uint32_t{1} << 22;
constexpr uint32_t kAircraftLights = uint32_t{3} << 13 | kPowerPlantOn;  // navigation and anti-collision
constexpr uint32_t kHeadLights = uint32_t{1} << 12 | kPowerPlantOn;

EntityType Air(uint8_t category, uint8_t subcategory, uint8_t specific) {
  return {EntityType::kPlatform, EntityType::kAir, kUnitedStates, category, subcategory, specific, 0};
}
EntityType Land(uint8_t category, uint8_t subcategory, uint8_t specific) {
  return {EntityType::kPlatform, EntityType::kLand, kUnitedStates, category, subcategory, specific, 0};
}

// Places a course about a centre within a box, any way round.
Course Within(Random& random, double south, double north, double west, double east) {
  Course course;
  course.latitude_deg = random.Between(south, north);
  course.longitude_deg = random.Between(west, east);
  course.heading_deg = random.Between(0.0, 360.0);
  course.clockwise = random.Below(2) == 0;
  course.phase_m = random.Between(0.0, 1e5);
  return course;
}

// Places a course along the floor of the Owens valley, from Lone Pine to Bishop.
Course AlongOwensValley(Random& random) {
  struct Place {
    double latitude_deg, longitude_deg;
  };
  constexpr std::array<Place, 4> kFloor = {{{36.65, -118.10}, {36.80, -118.18}, {37.165, -118.28}, {37.33, -118.37}}};
  const double latitude = random.Between(36.70, 37.28);
  size_t leg = 0;
  while (latitude > kFloor[leg + 1].latitude_deg) ++leg;
  const Place &from = kFloor[leg], &to = kFloor[leg + 1];
  const double north = to.latitude_deg - from.latitude_deg, east = to.longitude_deg - from.longitude_deg;
  Course course;
  course.latitude_deg = latitude;
  course.longitude_deg = from.longitude_deg + east * (latitude - from.latitude_deg) / north;
  course.longitude_deg += random.Between(-0.015, 0.015);
  course.heading_deg =
      std::atan2(east * 0.8, north) * 57.29577951308232;  // a degree of longitude is shorter by a fifth
  course.clockwise = random.Below(2) == 0;
  course.phase_m = random.Between(0.0, 1e5);
  return course;
}

void SetSpeedAndSize(Course& course, double speed_mps, double leg_m, double radius_m) {
  course.speed_mps = speed_mps;
  course.leg_m = leg_m;
  course.radius_m = radius_m;
}

Vehicle Airliner(Random& random, Course course, double lowest_m) {
  constexpr std::array<const char*, 6> kLines = {"UAL", "AAL", "DAL", "SWA", "ASA", "JBU"};
  SetSpeedAndSize(course, random.Between(190.0, 245.0), random.Between(30e3, 110e3), random.Between(11e3, 16e3));
  course.swing_m = random.Below(3) == 0 ? 250.0 : 0.0;
  course.height_m = random.Between(lowest_m + course.swing_m, 12000.0 - course.swing_m);
  Vehicle vehicle{Air(57, static_cast<uint8_t>(1 + random.Below(3)), 0), kNeutral, kAircraftLights, {}, {}, course};
  vehicle.model = DeadReckoning::kRvw;
  const size_t line = random.Below(kLines.size());
  vehicle.marking = Marking::Sanitise(fmt::format("{}{}", kLines[line], 100 + random.Below(1900)));
  return vehicle;
}

Vehicle LightAircraft(Random& random) {
  const size_t region = random.Below(3);
  Course course = region == 0   ? Within(random, 36.75, 37.15, -120.6, -120.2)  // San Joaquin valley
                  : region == 1 ? AlongOwensValley(random)
                                : Within(random, 37.96, 38.04, -119.05, -118.95);  // Mono lake
  SetSpeedAndSize(course, random.Between(50.0, 75.0), random.Between(3e3, region == 2 ? 5e3 : 16e3),
                  random.Between(900.0, 1500.0));
  course.height_m = region == 0   ? random.Between(1500.0, 2800.0)
                    : region == 1 ? random.Between(2400.0, 3200.0)
                                  : random.Between(3200.0, 4200.0);
  course.swing_m = random.Between(0.0, 60.0);
  Vehicle vehicle{Air(85, static_cast<uint8_t>(1 + random.Below(2)), 0), kNeutral, kAircraftLights, {}, {}, course};
  vehicle.model = DeadReckoning::kFpw;
  const char letter = static_cast<char>('A' + random.Below(26));
  vehicle.marking = Marking::Sanitise(fmt::format("N{}{}K", 100 + random.Below(9900), letter));
  return vehicle;
}

Vehicle Helicopter(Random& random) {
  const bool mono = random.Below(3) == 0;
  Course course = mono ? Within(random, 37.98, 38.03, -119.03, -118.97) : AlongOwensValley(random);
  SetSpeedAndSize(course, random.Between(35.0, 65.0), random.Between(1500.0, mono ? 3e3 : 8e3),
                  random.Between(400.0, 800.0));
  course.height_m = mono ? random.Between(2350.0, 2900.0) : random.Between(1700.0, 2200.0);
  course.swing_m = random.Between(0.0, 40.0);
  const bool rescue = random.Below(2) == 0;
  Vehicle vehicle{Air(21, 1, 0), rescue ? kNeutral : kFriendly, kAircraftLights, {}, {}, course};
  vehicle.model = DeadReckoning::kRvw;
  vehicle.marking = Marking::Sanitise(fmt::format("{} {}", rescue ? "RESCUE" : "HUEY", 1 + random.Below(99)));
  return vehicle;
}

Vehicle Fighter(Random& random, Course course, bool valley, double lowest_m) {
  SetSpeedAndSize(course, random.Between(195.0, 255.0), random.Between(10e3, 30e3), random.Between(4e3, 8e3));
  course.height_m = random.Between(lowest_m, 9800.0);
  if (valley) {
    SetSpeedAndSize(course, random.Between(180.0, 200.0), random.Between(10e3, 20e3), 3500.0);
    course.height_m = random.Between(3000.0, 3600.0);
  }
  Vehicle vehicle{Air(1, 3, 3), kFriendly, kAircraftLights, {}, {}, course};
  vehicle.model = DeadReckoning::kRvb;
  vehicle.marking = Marking::Sanitise(fmt::format("VIPER {}", 1 + random.Below(99)));
  return vehicle;
}

Vehicle GroundVehicle(Random& random) {
  Course course = AlongOwensValley(random);
  course.banks = false;
  course.height_m = 1200.0;
  Vehicle vehicle;
  const size_t kind = random.Below(10);
  if (kind < 5) {
    vehicle = {Land(81, 1, 0), kNeutral, kHeadLights, {}, DeadReckoning::kFpw, {}};
    vehicle.marking = Marking::Sanitise(fmt::format("CAR {}", 100 + random.Below(900)));
    course.speed_mps = random.Between(18.0, 30.0);
  } else if (kind < 8) {
    vehicle = {Land(83, 1, 0), kNeutral, kHeadLights, {}, DeadReckoning::kRvw, {}};
    vehicle.marking = Marking::Sanitise(fmt::format("TRUCK {}", 100 + random.Below(900)));
    course.speed_mps = random.Between(14.0, 24.0);
  } else {
    vehicle = {Land(1, 1, 3), kFriendly, kPowerPlantOn, {}, DeadReckoning::kFpw, {}};
    vehicle.marking = Marking::Sanitise(fmt::format("ARMOR {}", 1 + random.Below(99)));
    course.speed_mps = random.Between(6.0, 12.0);
  }
  constexpr double kComfort_mps2 = 2.0;
  course.radius_m = std::max(30.0, course.speed_mps * course.speed_mps / kComfort_mps2);
  course.leg_m = random.Between(1500.0, 6000.0);
  vehicle.course = course;
  return vehicle;
}

Vehicle SierraAircraft(Random& random, size_t index) {
  constexpr double kOverAllPeaks_m = 4600.0;
  const size_t kind = index % 20;
  if (kind < 8) return Airliner(random, Within(random, 36.8, 38.5, -120.6, -117.5), kOverAllPeaks_m);
  if (kind < 13) return LightAircraft(random);
  if (kind < 16) return Helicopter(random);
  const bool valley = random.Below(4) == 0;
  const Course course = valley ? AlongOwensValley(random) : Within(random, 36.8, 38.2, -119.6, -117.8);
  return Fighter(random, course, valley, kOverAllPeaks_m + 400.0);
}

Vehicle StormAircraft(Random& random, size_t index) {
  constexpr double kOverEverest_m = 9000.0;
  const Course course = Within(random, -70.0, 70.0, -180.0, 180.0);
  return index % 4 == 3 ? Fighter(random, course, false, kOverEverest_m) : Airliner(random, course, kOverEverest_m);
}

}  // namespace

Result<std::vector<Vehicle>> MakeVehicles(std::string_view scenario, size_t count, uint64_t seed) {
  const bool sierra = scenario == "sierra";
  if (!sierra && scenario != "storm") {
    return Status::Error("scenario '{}' is not known; there are 'sierra' and 'storm'", scenario);
  }
  if (count == 0 || count > kMostVehicles) {
    return Status::Error("{} entities: the number must be from 1 to {}", count, kMostVehicles);
  }
  const size_t ground = sierra ? count / 5 : 0;
  Random random(seed);
  std::vector<Vehicle> vehicles;
  vehicles.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const bool drives = i >= count - ground;
    vehicles.push_back(drives ? GroundVehicle(random) : sierra ? SierraAircraft(random, i) : StormAircraft(random, i));
  }
  return vehicles;
}

}  // namespace belvedere::dis
