#include "dis/traffic_sender.h"
#include "render/image_file.h"
#include "render/window_system.h"
#include "runtime/app/camera_path.h"
#include "runtime/app/commands_of_program.h"
#include "runtime/app/percentiles.h"
#include "runtime/app/station.h"
#include "runtime/app/tour_report.h"
#include "runtime/base/log.h"
#include "runtime/base/trace.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <filesystem>
#include <future>
#include <thread>

namespace belvedere {
namespace {

constexpr size_t kTraceEvents = size_t{1} << 20;
constexpr double kPublish_s = 1.0 / 60;  // how often poses are published
constexpr double kNoticesEvery_s = 0.5;
constexpr size_t kFramesBeforeRedraw = 6;  // whose median is the frame while paging
constexpr int kRedraws = 9;
constexpr double kIdleWithin_s = 10;
constexpr size_t kPicturesUnderWay = 4;

bool HasDisplay() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

void WaitSeconds(double seconds) {
  if (seconds > 0) std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// Traffic through the real socket path: a sender and the station's receiver on a loopback port.
class LoopbackTraffic {
 public:
  // A port that is probably free; the receiver says if it is not.
  static int Port() { return 40'000 + static_cast<int>(getpid() % 20'000); }

  static Result<std::unique_ptr<dis::TrafficSender>> Start(int entities, const Clock& clock) {
    dis::TrafficSenderOptions options;
    options.to = {"127.0.0.1", static_cast<uint16_t>(Port())};
    options.traffic.entities = static_cast<size_t>(entities);
    return dis::TrafficSender::Start(options, clock);
  }
};

class Tour {
 public:
  Tour(const TourOptions& options, CameraPath path, const Clock& clock)
      : options_(options), path_(std::move(path)), clock_(clock) {
    length_s_ = options.seconds > 0 ? std::min(options.seconds, path_.length_s()) : path_.length_s();
    utc_s_ = options.utc_s.value_or(EquinoxNoonAt(path_.PoseAt(path_.length_s()).position.longitude_deg));
  }
  ~Tour() {
    traffic_.reset();
    station_.reset();  // before the windows that it draws in
  }

  Status Start();
  void Fly();
  TourReport Report();

 private:
  Result<std::unique_ptr<Context>> MakeContext();
  Result<Presenter*> MakePresenter(int number);
  ViewParameters ParametersAt(int view, double elapsed_s, bool frozen);
  void Publish(double elapsed_s, bool frozen = false);
  void TakeSamples();
  void TakePictures();
  void WritePictures(size_t at_most_left);
  void MeasureRedraw(double elapsed_s);
  bool WaitUntilIdle();
  ViewId IdOf(int view) const { return static_cast<ViewId>(view + 1); }

  const TourOptions options_;
  const CameraPath path_;
  const Clock& clock_;
  double length_s_ = 0, utc_s_ = 0;
  std::unique_ptr<WindowSystem> windows_;
  std::vector<WindowId> window_ids_;
  std::unique_ptr<Station> station_;
  std::unique_ptr<dis::TrafficSender> traffic_;
  std::vector<LayerUse> layers_;
  std::vector<ViewChannel*> channels_;
  uint64_t number_ = 0;
  std::vector<FrameSample> samples_;
  std::vector<double> ratios_;
  double first_image_s_ = 0;
  double flown_s_ = 0, paused_s_ = 0;
  bool stopped_ = false;
  struct PictureUnderWay {
    uint64_t frame;
    std::future<Result<Picture>> picture;
  };
  std::deque<PictureUnderWay> pictures_;
  uint64_t next_picture_ = 0;
};

Result<std::unique_ptr<Context>> Tour::MakeContext() {
  if (options_.headless || !HasDisplay()) return MakeOffscreenContext();
  Result<std::unique_ptr<WindowSystem>> windows = WindowSystem::Make(clock_);
  if (!windows.ok()) return windows.status();
  windows_ = std::move(*windows);
  return windows_->SharedContext();
}

Result<Presenter*> Tour::MakePresenter(int number) {
  if (!windows_) return static_cast<Presenter*>(nullptr);
  WindowOptions window;
  window.title = fmt::format("Belvedere tour, view {}", number + 1);
  window.width_px = options_.size.width_px;
  window.height_px = options_.size.height_px;
  const Result<WindowId> id = windows_->CreateWindow(window);
  if (!id.ok()) return id.status();
  window_ids_.push_back(*id);
  return windows_->PresenterOf(*id);
}

Status Tour::Start() {
  Result<std::unique_ptr<Context>> context = MakeContext();
  if (!context.ok()) return context.status();
  StationOptions rooms;
  rooms.dataset = options_.dataset;
  rooms.cache_bytes = static_cast<size_t>(options_.cache_MiB) << 20;
  rooms.render.max_fps = options_.max_fps;
  rooms.render.upload_budget_ms = options_.upload_ms;
  if (options_.traffic > 0) rooms.feed.listen = {fmt::format("127.0.0.1:{}", LoopbackTraffic::Port())};
  Result<std::unique_ptr<Station>> station = Station::Start(rooms, clock_, std::move(*context));
  if (!station.ok()) return station.status();
  station_ = std::move(*station);
  if (options_.traffic > 0) {
    if (station_->receivers().empty()) return Status::Error("tour: no port for the traffic of --traffic; try again");
    Result<std::unique_ptr<dis::TrafficSender>> traffic = LoopbackTraffic::Start(options_.traffic, clock_);
    if (!traffic.ok()) return traffic.status();
    traffic_ = std::move(*traffic);
  }
  const Result<std::vector<NamedLayer>> layers = station_->ImageLayers(options_.layers);
  if (!layers.ok()) return layers.status();
  layers_ = UsesOf(*layers);
  for (int view = 0; view < options_.views; ++view) {
    const Result<Presenter*> presenter = MakePresenter(view);
    if (!presenter.ok()) return presenter.status();
    channels_.push_back(&station_->AddView(ParametersAt(view, 0, false), *presenter));
  }
  return {};
}

ViewParameters Tour::ParametersAt(int view, double elapsed_s, bool frozen) {
  double own_s = elapsed_s + path_.length_s() * view / options_.views;
  if (own_s > path_.length_s()) own_s -= path_.length_s();
  const CameraPose pose = path_.PoseAt(own_s);
  ViewParameters parameters;
  parameters.view = IdOf(view);
  parameters.number = ++number_;
  parameters.time_s = clock_.NowSeconds();
  parameters.utc_s = utc_s_ + options_.time_rate * elapsed_s;
  parameters.time_rate = frozen ? 0 : options_.time_rate;
  parameters.eye_ecef = pose.eye_ecef();
  if (!frozen) parameters.eye_velocity_mps = path_.VelocityAt(own_s);
  parameters.ecef_from_camera = pose.ecef_from_camera();
  parameters.vertical_fov = Radians::FromDegrees(pose.vfov_deg);
  parameters.width_px = options_.size.width_px;
  parameters.height_px = options_.size.height_px;
  parameters.error_px = options_.error_px;
  parameters.target_frame_ms = options_.frame_ms;
  parameters.texel_px = options_.texel_px;
  parameters.image_layers = layers_;
  parameters.hud = options_.hud;
  parameters.frozen = frozen;
  return parameters;
}

void Tour::Publish(double elapsed_s, bool frozen) {
  for (int view = 0; view < options_.views; ++view) {
    channels_[static_cast<size_t>(view)]->parameters.Publish(ParametersAt(view, elapsed_s, frozen));
  }
}

void Tour::TakeSamples() {
  for (const FrameSample& sample : station_->render().TakeSamples()) {
    if (first_image_s_ == 0 && sample.has_terrain) {
      first_image_s_ = SecondsSinceStart() - (clock_.NowSeconds() - sample.time_s);
    }
    samples_.push_back(sample);
  }
}

void Tour::TakePictures() {
  if (options_.frames_folder.empty()) return;
  const uint64_t frame = channels_[0]->frame.Get()->frame;
  if (frame >= next_picture_ && pictures_.size() < kPicturesUnderWay) {
    next_picture_ = frame - frame % static_cast<uint64_t>(options_.every) + static_cast<uint64_t>(options_.every);
    pictures_.push_back({frame, station_->render().Capture(IdOf(0), Renderer::Moment::kOfLastFrame)});
  }
  WritePictures(kPicturesUnderWay);
}

// Writes those that are there, and waits for the oldest until no more than so many are left.
void Tour::WritePictures(size_t at_most_left) {
  while (!pictures_.empty()) {
    PictureUnderWay& oldest = pictures_.front();
    const bool there = oldest.picture.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (!there && pictures_.size() <= at_most_left) return;
    const Result<Picture> picture = oldest.picture.get();
    const std::string path = fmt::format("{}/frame-{:06}.png", options_.frames_folder, oldest.frame);
    const Status status =
        picture.ok() ? WritePng(path, picture->width_px, picture->height_px, picture->rgb) : picture.status();
    if (!status.ok()) LogWarning("{}", status.message());
    pictures_.pop_front();
  }
}

bool Tour::WaitUntilIdle() {
  const double give_up_s = clock_.NowSeconds() + kIdleWithin_s;
  while (clock_.NowSeconds() < give_up_s) {
    const RequestQueue::Statistics requests = SumOf(station_->paging().queues);
    if (requests.waiting == 0 && requests.issued == requests.served + requests.cancelled) return true;
    WaitSeconds(0.02);
  }
  return false;
}

// Compares the frames just drawn with the same lists drawn again while no server works and the managers keep their cut.
void Tour::MeasureRedraw(double elapsed_s) {
  TakeSamples();
  std::vector<double> while_paging_ms;
  for (auto sample = samples_.rbegin(); sample != samples_.rend() && while_paging_ms.size() < kFramesBeforeRedraw;
       ++sample) {
    if (sample->view == IdOf(0)) while_paging_ms.push_back(sample->draw_ms + sample->upload_ms);
  }
  const double pause_s = clock_.NowSeconds();
  Publish(elapsed_s, true);
  if (WaitUntilIdle()) {
    const std::vector<double> alone_ms = station_->render().Redraw(IdOf(0), kRedraws).get();
    const double alone = PercentileOf(alone_ms, 0.5);
    if (alone > 0 && !while_paging_ms.empty()) ratios_.push_back(PercentileOf(while_paging_ms, 0.5) / alone);
  }
  static_cast<void>(station_->render().TakeSamples());  // frames of the pause are no part of the tour
  paused_s_ += clock_.NowSeconds() - pause_s;
}

void Tour::Fly() {
  const double start_s = clock_.NowSeconds();
  double next_notices_s = 0;
  int redraws = 0;
  std::vector<InputEvent> events;
  for (double due_s = start_s;; due_s += kPublish_s) {
    const double now_s = clock_.NowSeconds();
    flown_s_ = now_s - start_s - paused_s_;
    if (flown_s_ >= length_s_ || stopped_) break;
    Publish(flown_s_);
    TakeSamples();
    TakePictures();
    if (now_s >= next_notices_s) {
      next_notices_s = now_s + kNoticesEvery_s;
      station_->render().SetNotices(station_->Notices());
    }
    if (redraws < options_.redraw_points && flown_s_ >= length_s_ * (redraws + 1) / (options_.redraw_points + 1)) {
      ++redraws;
      MeasureRedraw(flown_s_);
      due_s = clock_.NowSeconds();
    }
    due_s = std::max(due_s, now_s - kPublish_s);
    const double wait_s = due_s + kPublish_s - clock_.NowSeconds();
    if (windows_) {
      events.clear();
      windows_->PollEvents(events, std::max(wait_s, 0.0));
      for (const InputEvent& event : events) {
        stopped_ = stopped_ || event.kind == InputEvent::Kind::kClose ||
                   (event.kind == InputEvent::Kind::kKey && event.pressed && event.key == Key::kEscape);
      }
    } else {
      WaitSeconds(wait_s);
    }
    stopped_ = stopped_ || StopAsked();
  }
  TakeSamples();
  WritePictures(0);
}

TourReport Tour::Report() {
  TourReport report;
  report.renderer = station_->render().facts().renderer;
  report.width_px = options_.size.width_px;
  report.height_px = options_.size.height_px;
  report.views = options_.views;
  report.error_px = options_.error_px;
  report.seconds = flown_s_;
  report.complete = !stopped_;
  report.first_image_s = first_image_s_;
  report.samples = std::move(samples_);
  for (int view = 0; view < options_.views; ++view) report.scene_hz.push_back(station_->scene_hz(IdOf(view)));
  report.cache = station_->paging().cache.Stats();
  report.requests = SumOf(station_->paging().queues);
  report.peak_rss_bytes = PeakResidentBytes();
  report.threads = ThreadCount();
  report.paging_ratios = ratios_;
  if (traffic_) report.traffic_sent = traffic_->sent();
  for (const auto& receiver : station_->receivers()) {
    report.traffic_received += receiver->Counters().intake.received;
    report.traffic_lost += receiver->Counters().lost_by_kernel;
  }
  return report;
}

}  // namespace

int FlyTour(const TourOptions& options) {
  if (!options.trace.empty()) Trace::Start(kTraceEvents);
  Result<CameraPath> path = CameraPath::Load(options.path);
  if (!path.ok()) return CouldNot(path.status());
  if (!options.frames_folder.empty()) {
    std::error_code error;
    std::filesystem::create_directories(options.frames_folder, error);
    if (error) return CouldNot(Status::Error("{}: cannot make the folder: {}", options.frames_folder, error.message()));
  }
  Tour tour(options, std::move(*path), Clock::System());
  if (Status status = tour.Start(); !status.ok()) return CouldNot(status);
  tour.Fly();
  const TourReport report = tour.Report();
  if (Status status = WriteText(options.report, ToJson(report)); !status.ok()) return CouldNot(status);
  if (!options.frame_csv.empty()) {
    if (Status status = WriteText(options.frame_csv, ToCsv(report.samples)); !status.ok()) return CouldNot(status);
  }
  if (!options.trace.empty()) {
    if (Status status = Trace::Write(options.trace); !status.ok()) return CouldNot(status);
  }
  if (!report.complete)
    return CouldNot(Status::Error("tour: stopped after {:.1f} s; the report is of those", report.seconds));
  return kExitDone;
}

}  // namespace belvedere
