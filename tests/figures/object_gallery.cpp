// The pictures of moving objects in docs/pictures: what appearance, events, trails and clusters look like.
//
//   object_gallery DATASET FOLDER
//
// Each picture is a scene put into the object table of a station that draws off-screen.
#include "dis/engagement_events.h"
#include "render/image_file.h"
#include "runtime/app/station.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/scene/label_format.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace belvedere {
namespace {

constexpr double kSouth_deg = 36.83, kWest_deg = -118.17;  // the floor of the Owens valley

[[noreturn]] void Give(const std::string& line) {
  fmt::print(stderr, "object_gallery: {}\n", line);
  std::_Exit(1);
}

void Sleep(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

class Gallery {
 public:
  Gallery(const std::string& dataset, std::string folder) : folder_(std::move(folder)) {
    Result<std::unique_ptr<Context>> context = MakeOffscreenContext();
    if (!context.ok()) Give(context.message());
    StationOptions options;
    options.dataset = dataset;
    Result<std::unique_ptr<Station>> station = Station::Start(options, clock_, std::move(*context));
    if (!station.ok()) Give(station.message());
    station_ = std::move(*station);
    ViewParameters view = View(0, 0, 3000, 0, -90, 12);
    station_->AddView(view, nullptr);
    Settle();
    station_->RemoveView(1);
    ground_m_ = station_->ground()(kSouth_deg, kWest_deg);
  }

  // An object at metres east, north and up of the middle of the scene.
  ObjectRecord At(double east_m, double north_m, double height_m, EntityType type, double heading_deg,
                  double speed_mps) {
    const double latitude = kSouth_deg + north_m / 111e3, longitude = kWest_deg + east_m / 89e3;
    const glm::dmat3 camera = CameraAxes(latitude, longitude, Radians::FromDegrees(heading_deg), {}, {});
    ObjectRecord record;
    record.id = {1, 1, ++ids_};
    record.type = type;
    record.kinematics.position_ecef = ToEcef({latitude, longitude, height_m});
    record.kinematics.velocity_mps = -speed_mps * camera[2];
    record.kinematics.orientation = ToEulerAngles(glm::dmat3(-camera[2], camera[0], -camera[1]));
    record.kinematics.model = DeadReckoning::kFpw;
    return record;
  }
  glm::dvec3 Place(double east_m, double north_m, double height_m) const {
    return ToEcef({kSouth_deg + north_m / 111e3, kWest_deg + east_m / 89e3, height_m});
  }
  double ground_m() const { return ground_m_; }  // of the middle
  double now() const { return clock_.NowSeconds(); }
  ObjectTable& objects() { return station_->objects(); }
  void Put(ObjectRecord record) {
    record.kinematics.time_s = record.received_s = now();
    objects().Put(record);
  }

  // Looks from metres east, north and up of the middle; hour: local sun time, about.
  ViewParameters View(double east_m, double north_m, double height_m, double heading_deg, double pitch_deg,
                      double hour) {
    const Geodetic eye{kSouth_deg + north_m / 111e3, kWest_deg + east_m / 89e3, height_m};
    ViewParameters view;
    view.view = 1;
    view.number = ++numbers_;
    view.time_s = now();
    view.utc_s = (hour + 7.9) * 3600;
    view.eye_ecef = ToEcef(eye);
    view.ecef_from_camera = CameraAxes(eye.latitude_deg, eye.longitude_deg, Radians::FromDegrees(heading_deg),
                                       Radians::FromDegrees(pitch_deg), {});
    view.width_px = 960;
    view.height_px = 540;
    view.hud = false;
    view.image_layers = UsesOf(*station_->ImageLayers({}));
    return view;
  }

  // Calls `put`, waits until ground and models are there, calls `happen`, waits that long and takes the picture.
  void Take(const std::string& name, const ViewParameters& view, const std::function<void()>& put,
            const std::function<void()>& happen, double wait_s) {
    station_->AddView(view, nullptr);
    put();
    objects().Tick(now());
    Settle();
    happen();
    for (const double end_s = now() + wait_s; now() < end_s; Sleep(0.02)) objects().Tick(now());
    const Result<Picture> picture = station_->render().Capture(1, Renderer::Moment::kOfLastFrame).get();
    if (!picture.ok()) Give(picture.message());
    const std::string path = folder_ + "/" + name + ".png";
    const Status written = WritePng(path, picture->width_px, picture->height_px, picture->rgb);
    if (!written.ok()) Give(written.message());
    fmt::print("{}\n", path);
    station_->RemoveView(1);
    for (const EntityId& id : objects().Ids()) objects().Remove(id);
  }

 private:
  void Settle() {
    for (int i = 0; i < 200; ++i) {
      const Result<Picture> picture = station_->render().Capture(1, Renderer::Moment::kOfParameters).get();
      if (picture.ok() && picture->settled && i > 8) return;
      Sleep(0.1);
    }
  }

  const Clock& clock_ = Clock::System();
  const std::string folder_;
  double ground_m_ = 0;
  std::unique_ptr<Station> station_;
  uint16_t ids_ = 0;
  uint64_t numbers_ = 0;
};

constexpr EntityType kTank{1, 1, 225, 1, 1, 3, 0}, kTruck{1, 1, 225, 83, 1, 0, 0}, kFighter{1, 2, 225, 1, 3, 3, 0},
    kAirliner{1, 2, 225, 57, 1, 0, 0};

void Appearance(Gallery& gallery) {
  const auto ground = [&](double east_m, double north_m, EntityType type, uint32_t appearance, double speed_mps) {
    ObjectRecord record = gallery.At(east_m, north_m, gallery.ground_m(), type, 60, speed_mps);
    record.appearance = appearance;
    record.force = 2;
    gallery.Put(record);
  };
  const auto scene = [&] {
    ground(-20, 24, kTank, 0, 0);                         // whole
    ground(-4, 30, kTank, 3 << 3 | 1 << 5 | 1 << 15, 0);  // destroyed, smoke, flames
    ground(-15, 40, kTruck, 2 << 7 | 1 << 12, 15);        // dust, head lights
    ground(16, 28, kTank, 2 << 3 | 1 << 6, 4);            // damaged, engine smokes
  };
  ViewParameters view = gallery.View(0, -10, gallery.ground_m() + 9, 0, -9, 10);
  view.labels = false;
  gallery.Take(
      "objects-appearance", view, scene, [] {}, 1.0);
}

void Night(Gallery& gallery) {
  const auto scene = [&] {
    ObjectRecord airliner = gallery.At(-60, 160, 1500, kAirliner, 70, 90);
    airliner.appearance = 7 << 12;
    gallery.Put(airliner);
    ObjectRecord fighter = gallery.At(40, 120, 1485, kFighter, 60, 120);
    fighter.appearance = 3 << 13 | 1 << 16;
    gallery.Put(fighter);
  };
  ViewParameters view = gallery.View(0, 0, 1480, 0, 4, 19.4);
  view.labels = false;
  gallery.Take(
      "objects-night", view, scene, [] {}, 0.4);
}

void Battle(Gallery& gallery) {
  const double ground_m = gallery.ground_m();
  const auto tank = [&] { gallery.Put(gallery.At(-40, 60, ground_m, kTank, 80, 0)); };
  const auto shots = [&] {
    const double now_s = gallery.now();
    const auto add = [&](const std::vector<SceneEvent>& events) {
      for (const SceneEvent& event : events) gallery.objects().AddEvent(event);
    };
    dis::Detonation shell;
    shell.descriptor.type = {2, 9, 225, 2, 1, 0, 0};
    shell.descriptor.warhead = 1000;
    shell.result = 3;
    shell.position_ecef = gallery.Place(30, 80, ground_m);
    add(dis::EventsOf(shell, now_s - 0.2, 300));
    shell.position_ecef = gallery.Place(8, 60, ground_m);
    add(dis::EventsOf(shell, now_s - 3.0, 300));
    shell.position_ecef = gallery.Place(-8, 45, ground_m);
    add(dis::EventsOf(shell, now_s - 20.0, 300));
    dis::Fire fire;
    fire.position_ecef = gallery.Place(-34, 61, ground_m + 2);
    fire.velocity_mps = glm::vec3(glm::normalize(gallery.Place(30, 80, ground_m + 2) - fire.position_ecef) * 300.0);
    add(dis::EventsOf(fire, now_s + 0.20));
  };
  ViewParameters view = gallery.View(-8, -15, ground_m + 14, 0, -9, 11);
  view.labels = false;
  gallery.Take("objects-battle", view, tank, shots, 0.30);
}

void Labels(Gallery& gallery) {
  std::vector<ObjectRecord> flight;
  for (int i = 0; i < 14; ++i) {
    ObjectRecord one = gallery.At(-2500 + 400 * i, 3500 + 500 * (i * 7 % 5), 3000 + 130 * (i * 5 % 7),
                                  i % 3 == 0 ? kFighter : kAirliner, 40 + 25 * (i % 5), 180);
    one.force = static_cast<uint8_t>(1 + i % 3);
    one.marking = Marking::Sanitise(fmt::format("CALL{:02d}", i));
    flight.push_back(one);
  }
  const auto scene = [&] {
    for (ObjectRecord& one : flight) gallery.Put(one);
  };
  ViewParameters view = gallery.View(0, -3000, 3600, 0, -4, 10);
  view.label_format =
      std::make_shared<const LabelFormat>(*LabelFormat::Parse("{marking} {model}\\n{level} {speed}kt {heading}"));
  view.trails_s = 20;
  view.vectors_s = 10;
  gallery.Take(
      "objects-labels", view, scene, [] {}, 8.0);
}

void Models(Gallery& gallery) {
  const double ground_m = gallery.ground_m();
  const auto put = [&] {
    ObjectRecord tank = gallery.At(-11, 22, ground_m, kTank, 60, 0);
    tank.part_array = {{{0, 4096 + 11, 1.1F}, {0, 4416 + 13, 0.25F}}};
    tank.part_count = 2;
    tank.appearance = 4 << 9;  // hatch open
    gallery.Put(tank);
    ObjectRecord helicopter = gallery.At(14, 36, ground_m + 9, {1, 2, 225, 21, 1, 0, 0}, -60, 5);
    helicopter.appearance = 1 << 22 | 3 << 13;
    gallery.Put(helicopter);
    ObjectRecord fighter = gallery.At(-1, 30, ground_m + 3.2, kFighter, 235, 1);
    for (const uint16_t station : {uint16_t{640}, uint16_t{641}, uint16_t{768}, uint16_t{769}, uint16_t{512}}) {
      fighter.attached_array[fighter.attached_count++] = {station, {2, 1, 225, 1, 1, 0, 0}};
    }
    gallery.Put(fighter);
    ObjectRecord airliner = gallery.At(-55, 150, ground_m + 26, kAirliner, 100, 60);
    airliner.appearance = 1 << 25 | 7 << 12;
    gallery.Put(airliner);
    ObjectRecord missile = gallery.At(2, 12, ground_m + 5.5, {2, 1, 225, 1, 1, 0, 0}, 75, 90);
    missile.appearance = 1 << 16 | 1 << 7;
    gallery.Put(missile);
    const uint32_t postures[] = {1, 4, 1, 5};  // upright, kneeling, upright, prone
    for (int i = 0; i < 4; ++i) {
      ObjectRecord soldier = gallery.At(1.2 * i, 9.5 + 0.5 * i, ground_m, {3, 1, 225, 1, 0, 0, 0}, 40, 0);
      soldier.appearance = postures[i] << 16;
      gallery.Put(soldier);
    }
  };
  ViewParameters view = gallery.View(-1, 2, ground_m + 4.0, 0, -3, 10);
  view.labels = false;
  gallery.Take(
      "objects-models", view, put, [] {}, 0.3);
}

// What types become: each with the name of its model, and two that fit no entry of their own.
void Types(Gallery& gallery) {
  const double ground_m = gallery.ground_m();
  const auto put = [&] {
    const auto one = [&](double east_m, double north_m, double up_m, EntityType type, uint8_t force) {
      ObjectRecord record = gallery.At(east_m, north_m, ground_m + up_m, type, 60, 0);
      record.force = force;
      gallery.Put(record);
    };
    one(-34, 95, 16, kAirliner, 3);
    one(-14, 62, 13, kFighter, 1);
    one(2, 60, 11, {1, 2, 225, 85, 1, 0, 0}, 3);
    one(16, 58, 12, {1, 2, 225, 21, 1, 0, 0}, 1);
    one(34, 70, 13, {1, 2, 0, 200, 0, 0, 0}, 0);  // of the air, and no more is known
    one(-14, 42, 0, kTank, 1);
    one(-3, 40, 0, kTruck, 1);
    one(6, 38, 0, {1, 1, 225, 81, 1, 0, 0}, 3);
    one(12, 34, 0, {3, 1, 225, 1, 0, 0, 0}, 1);
    one(17, 36, 2, {2, 1, 225, 1, 1, 0, 0}, 2);
    one(28, 44, 2, {4, 1, 225, 1, 0, 0, 0}, 2);  // a kind that has no model
  };
  ViewParameters view = gallery.View(0, -2, ground_m + 7, 0, -1, 15);
  view.frames = true;
  view.label_format = std::make_shared<const LabelFormat>(*LabelFormat::Parse("{type}\\n{model}"));
  gallery.Take(
      "objects-types", view, put, [] {}, 0.3);
}

// Vehicles where the valley's floor ends, on a slope of 19 degrees, sent with no more than a rough height.
void Slope(Gallery& gallery) {
  constexpr double kEast_m = -9000, kHeight_m = 1600;
  const auto put = [&] {
    for (int i = 0; i < 9; ++i) {
      ObjectRecord one = gallery.At(kEast_m + 30 - 16 * (i % 5), 16 + 13 * i, kHeight_m, i % 3 == 2 ? kTruck : kTank,
                                    275 + 15 * (i % 3), 0);
      one.force = static_cast<uint8_t>(1 + i % 2);
      gallery.Put(one);
    }
  };
  ViewParameters view = gallery.View(kEast_m + 75, -25, kHeight_m + 12, -25, -4, 10);
  view.labels = false;
  gallery.Take(
      "objects-ground", view, put, [] {}, 0.5);
}

void Groups(Gallery& gallery) {
  const auto put = [&] {
    for (int i = 0; i < 900; ++i) {
      const double around = 0.7 * i, out_m = 1500.0 * std::sqrt(i);
      ObjectRecord one = gallery.At(out_m * std::cos(around), out_m * std::sin(around), 5000 + 7 * i,
                                    i % 3 == 0 ? kFighter : kAirliner, 40, 150);
      one.force = static_cast<uint8_t>(1 + i % 3);
      gallery.Put(one);
    }
  };
  ViewParameters view = gallery.View(0, -120e3, 90e3, 0, -36, 10);
  gallery.Take(
      "objects-groups", view, put, [] {}, 1.5);
}

int Run(const std::string& dataset, const std::string& folder) {
  Gallery gallery(dataset, folder);
  Appearance(gallery);
  Night(gallery);
  Battle(gallery);
  Labels(gallery);
  Models(gallery);
  Types(gallery);
  Slope(gallery);
  Groups(gallery);
  return 0;
}

}  // namespace
}  // namespace belvedere

int main(int argc, char** argv) {
  if (argc == 3) return belvedere::Run(argv[1], argv[2]);
  fmt::print(stderr, "usage: object_gallery DATASET FOLDER\n");
  return 2;
}
