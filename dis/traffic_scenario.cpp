// The vehicles of each scenario; docs/dis.md has the table.
#include "dis/traffic_vehicle.h"

#include "runtime/earth/ellipsoid.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>

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

constexpr uint8_t kFriendly = 1, kOpposing = 2, kNeutral = 3;
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
  Vehicle vehicle{Air(57, static_cast<uint8_t>(1 + random.Below(3)), 0), kNeutral, kAircraftLights, {}, {}, course, {}};
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
  Vehicle vehicle{Air(85, static_cast<uint8_t>(1 + random.Below(2)), 0), kNeutral, kAircraftLights, {}, {}, course, {}};
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
  Vehicle vehicle{Air(21, 1, 0), rescue ? kNeutral : kFriendly, kAircraftLights, {}, {}, course, {}};
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
  Vehicle vehicle{Air(1, 3, 3), kFriendly, kAircraftLights, {}, {}, course, {}};
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
    vehicle = {Land(81, 1, 0), kNeutral, kHeadLights, {}, DeadReckoning::kFpw, {}, {}};
    vehicle.marking = Marking::Sanitise(fmt::format("CAR {}", 100 + random.Below(900)));
    course.speed_mps = random.Between(18.0, 30.0);
  } else if (kind < 8) {
    vehicle = {Land(83, 1, 0), kNeutral, kHeadLights, {}, DeadReckoning::kRvw, {}, {}};
    vehicle.marking = Marking::Sanitise(fmt::format("TRUCK {}", 100 + random.Below(900)));
    course.speed_mps = random.Between(14.0, 24.0);
  } else {
    vehicle = {Land(1, 1, 3), kFriendly, kPowerPlantOn, {}, DeadReckoning::kFpw, {}, {}};
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

// ---- airways

struct Airport {
  double latitude_deg, longitude_deg;
};
// Zurich, Geneva, Munich, Milan, London, Paris, Frankfurt, Amsterdam, Madrid, Rome, Vienna, Copenhagen, Istanbul, New
// York, Chicago, Los Angeles, San Francisco, Denver, Dallas, Atlanta, Tokyo, Singapore, Dubai, Sydney, Sao Paulo.
constexpr std::array<Airport, 25> kAirports = {
    {{47.458, 8.548},    {46.238, 6.109},    {48.354, 11.786},   {45.630, 8.723},    {51.470, -0.454},
     {49.010, 2.548},    {50.038, 8.562},    {52.309, 4.764},    {40.472, -3.561},   {41.800, 12.239},
     {48.110, 16.570},   {55.618, 12.656},   {41.262, 28.727},   {40.640, -73.778},  {41.978, -87.905},
     {33.942, -118.408}, {37.619, -122.375}, {39.861, -104.673}, {32.897, -97.038},  {33.637, -84.428},
     {35.772, 140.393},  {1.364, 103.992},   {25.253, 55.366},   {-33.946, 151.177}, {-23.432, -46.470}}};

// There along the great circle and back a little beside it, climbing and sinking over the first and last 200 km.
std::shared_ptr<const FlightTrack> Airway(Random& random, const Airport& from, const Airport& to, double speed_mps) {
  constexpr double kStep_m = 15e3, kClimb_m = 200e3, kBeside_m = 9e3;
  const double cruise_m = 8800 + 300 * static_cast<double>(random.Below(12));
  const glm::dvec3 a = UpAt(from.latitude_deg, from.longitude_deg), b = UpAt(to.latitude_deg, to.longitude_deg);
  const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
  const double length_m = angle * kEquatorialRadius_m;
  const auto steps = std::max<size_t>(4, static_cast<size_t>(length_m / kStep_m));
  const glm::dvec3 aside = glm::normalize(glm::cross(a, b)) * (kBeside_m / kEquatorialRadius_m);
  std::vector<TrackPlace> places;
  double time_s = -random.Between(0.0, 2.0 * length_m / speed_mps);
  for (const bool back : {false, true}) {
    for (size_t i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(back ? steps - i : i) / static_cast<double>(steps);
      glm::dvec3 up = (std::sin((1 - share) * angle) * a + std::sin(share * angle) * b) / std::sin(angle);
      if (back) up = glm::normalize(up + aside);
      const double end_m = length_m * std::min(share, 1 - share);
      Geodetic place = ToGeodetic(up * kEquatorialRadius_m);
      place.height_m = std::max(1500.0, cruise_m * std::min(1.0, end_m / kClimb_m));
      const glm::dvec3 here = ToEcef(place);
      if (!places.empty()) time_s += std::max(glm::distance(here, places.back().position_ecef), 100.0) / speed_mps;
      places.push_back({time_s, here});
    }
  }
  places.push_back({time_s + kBeside_m / speed_mps, places.front().position_ecef});
  return std::make_shared<const FlightTrack>(std::move(places), true);
}

Vehicle AirwayAircraft(Random& random) {
  const size_t from = random.Below(kAirports.size());
  const size_t to = (from + 1 + random.Below(kAirports.size() - 1)) % kAirports.size();
  Vehicle vehicle = Airliner(random, {}, 9000);
  vehicle.track = Airway(random, kAirports[from], kAirports[to], random.Between(220.0, 250.0));
  return vehicle;
}

// ---- convoy: one road for all, one behind the other

Vehicle ConvoyVehicle(size_t index) {
  constexpr double kSpacing_m = 45;
  Course course;
  course.latitude_deg = 36.98;
  course.longitude_deg = -118.225;
  course.heading_deg = -14;
  course.speed_mps = 12;
  course.leg_m = 40e3;
  course.radius_m = 80;
  course.height_m = 1200;
  course.banks = false;
  course.phase_m = 20e3 - kSpacing_m * static_cast<double>(index);
  const bool tank = index % 10 < 3;
  Vehicle vehicle{tank ? Land(1, 1, 3) : Land(83, 1, 0), kFriendly, kHeadLights | uint32_t{1} << 7, {}, {}, course, {}};
  vehicle.model = DeadReckoning::kFpw;
  vehicle.marking = Marking::Sanitise(fmt::format("{} {}", tank ? "LANCE" : "SUPPLY", index + 1));
  return vehicle;
}

// ---- dogfight: pairs on one circle, the second behind the first

Vehicle DogfightAircraft(Random& random, size_t index, std::vector<Course>& circles) {
  constexpr double kBehind_m = 900;
  const size_t pair = index / 2;
  if (circles.size() <= pair) {
    Course course = Within(random, 36.7, 37.4, -118.4, -118.0);
    SetSpeedAndSize(course, random.Between(180.0, 210.0), random.Between(1e3, 4e3), random.Between(2200.0, 3200.0));
    course.height_m = random.Between(5200.0, 7500.0);
    course.swing_m = 300;
    circles.push_back(course);
  }
  Course course = circles[pair];
  const bool hunter = index % 2 == 0;
  if (hunter) course.phase_m -= kBehind_m;
  Vehicle vehicle{hunter ? Air(1, 3, 3) : EntityType{1, 2, 222, 1, 1, 0, 0},
                  hunter ? kFriendly : kOpposing,
                  kAircraftLights | uint32_t{1} << 16,
                  {},
                  {},
                  course,
                  {}};
  vehicle.model = DeadReckoning::kRvb;
  vehicle.marking = Marking::Sanitise(fmt::format("{} {}", hunter ? "VIPER" : "BANDIT", pair + 1));
  return vehicle;
}

}  // namespace

Result<std::vector<Vehicle>> MakeVehicles(std::string_view scenario, size_t count, uint64_t seed) {
  constexpr std::array<std::string_view, 5> kScenarios = {"sierra", "storm", "airways", "convoy", "dogfight"};
  const auto* const known = std::find(kScenarios.begin(), kScenarios.end(), scenario);
  if (known == kScenarios.end()) {
    return Status::Error("scenario '{}' is not known; there are {}", scenario, fmt::join(kScenarios, ", "));
  }
  const bool sierra = scenario == "sierra";
  if (count == 0 || count > kMostVehicles) {
    return Status::Error("{} entities: the number must be from 1 to {}", count, kMostVehicles);
  }
  const size_t ground = sierra ? count / 5 : 0;
  Random random(seed);
  std::vector<Vehicle> vehicles;
  vehicles.reserve(count);
  std::vector<Course> circles;
  for (size_t i = 0; i < count; ++i) {
    if (sierra) vehicles.push_back(i >= count - ground ? GroundVehicle(random) : SierraAircraft(random, i));
    if (scenario == "storm") vehicles.push_back(StormAircraft(random, i));
    if (scenario == "airways") vehicles.push_back(AirwayAircraft(random));
    if (scenario == "convoy") vehicles.push_back(ConvoyVehicle(i));
    if (scenario == "dogfight") vehicles.push_back(DogfightAircraft(random, i, circles));
  }
  return vehicles;
}

}  // namespace belvedere::dis
