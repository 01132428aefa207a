#include "runtime/app/ui_thread.h"

#include "render/image_file.h"
#include "runtime/app/program.h"
#include "runtime/base/log.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>
#include <variant>

namespace belvedere {
namespace {

constexpr double kStep_s = 1.0 / 60;
constexpr double kNoticesEvery_s = 0.5;
constexpr double kPictureShares[] = {0.25, 0.5, 0.75};  // of the time, for pictures on the way

}  // namespace

UiThread::UiThread(const StationSpec& spec, const UiOptions& options, Station& station, WindowSystem* windows,
                   const Clock& clock)
    : spec_(spec),
      options_(options),
      station_(station),
      windows_(windows),
      clock_(clock),
      watched_(spec.watched),
      start_s_(clock.NowSeconds()),
      utc_at_start_s_(spec.utc_s.value_or(clock.UtcSeconds())),
      last_s_(start_s_) {
  ShowWatched();
  for (const auto& [key, command] : spec.keys) {
    const Status bound = keys_.Bind(key, command);
    if (!bound.ok()) LogWarning("{}: keys.{}: {}", spec.file, key, bound.message());
  }
}

Status UiThread::OpenViews() {
  for (const WindowSpec& window : spec_.windows) {
    if (Status status = OpenView(window); !status.ok()) return status;
  }
  return {};
}

Status UiThread::OpenView(const WindowSpec& window) {
  Result<std::vector<NamedLayer>> layers = station_.ImageLayers(window.view.layers);
  if (!layers.ok()) return Status::Error("{}: window \"{}\": {}", spec_.file, window.title, layers.message());
  View view;
  view.id = static_cast<ViewId>(views_.size() + 1);
  view.name = fmt::format("view-{}", view.id);
  view.width_px = window.width_px;
  view.height_px = window.height_px;
  Presenter* presenter = nullptr;
  if (windows_ != nullptr) {
    WindowOptions options;
    options.title = window.title;
    options.width_px = window.width_px;
    options.height_px = window.height_px;
    if (window.position_px) {
      options.x_px = window.position_px->first;
      options.y_px = window.position_px->second;
    }
    const Result<WindowId> id = windows_->CreateWindow(options);
    if (!id.ok()) return id.status();
    view.window = *id;
    presenter = windows_->PresenterOf(*id);
    const WindowSystem::Size size = windows_->SizeOf(*id);
    view.width_px = size.width_px;
    view.height_px = size.height_px;
  }
  view.pilot = std::make_unique<ViewPilot>(view.id, window, std::move(*layers));
  view.pilot->Resize(view.width_px, view.height_px);
  view.gestures = std::make_unique<Gestures>(keys_);
  const double now_s = clock_.NowSeconds();
  view.channel = &station_.AddView(ParametersOf(view, now_s), presenter);
  views_.push_back(std::move(view));
  return {};
}

ViewParameters UiThread::ParametersOf(const View& view, double now_s) {
  ViewParameters parameters = view.pilot->Parameters(++number_, now_s, UtcAt(now_s));
  parameters.exaggeration = spec_.exaggeration;
  parameters.target_frame_ms = spec_.frame_ms;
  parameters.time_rate = spec_.time_rate;
  parameters.watched = outlined_;
  return parameters;
}

void UiThread::CloseViews() {
  for (const View& view : views_) {
    station_.RemoveView(view.id);
    if (view.window) windows_->CloseWindow(*view.window);
  }
  views_.clear();
}

Status UiThread::Run() {
  size_t next_picture = 0;
  while (!quit_ && !StopAsked()) {
    const double now_s = clock_.NowSeconds();
    const double elapsed_s = now_s - start_s_;
    if (options_.seconds > 0 && elapsed_s >= options_.seconds) break;
    Advance(now_s);
    ShowNotices(now_s);
    if (options_.pictures_on_the_way && next_picture < std::size(kPictureShares) &&
        elapsed_s >= kPictureShares[next_picture] * options_.seconds) {
      ++next_picture;
      if (Status status = TakePictures(fmt::format("-{:.0f}s", elapsed_s)); !status.ok()) return status;
    }
    TakeEvents(std::max(0.0, now_s + kStep_s - clock_.NowSeconds()));
  }
  return options_.pictures_on_the_way ? TakePictures("") : Status();
}

void UiThread::TakeEvents(double longest_wait_s) {
  if (windows_ == nullptr) {
    std::this_thread::sleep_for(std::chrono::duration<double>(longest_wait_s));
    return;
  }
  events_.clear();
  windows_->PollEvents(events_, longest_wait_s);
  for (const InputEvent& event : events_) {
    const auto view =
        std::find_if(views_.begin(), views_.end(), [&](const View& one) { return one.window == event.window; });
    if (view == views_.end()) continue;
    if (event.kind == InputEvent::Kind::kResize) {
      view->width_px = event.width_px;
      view->height_px = event.height_px;
      view->pilot->Resize(event.width_px, event.height_px);
    }
    if (view->width_px < 1 || view->height_px < 1) continue;  // minimised
    for (const Command& command : view->gestures->Take(event, view->width_px, view->height_px)) Do(*view, command);
  }
}

void UiThread::Do(View& view, const Command& command) {
  if (std::holds_alternative<QuitCommand>(command)) quit_ = true;
  if (const auto* time = std::get_if<AdvanceTimeCommand>(&command)) {
    utc_at_start_s_ += time->seconds;
    for (View& other : views_) other.pilot->Apply(command, station_.ground());
    return;
  }
  const auto* watch = std::get_if<WatchCommand>(&command);
  if (watch != nullptr || std::holds_alternative<ForgetWatchedCommand>(command)) {
    if (watch != nullptr) Watch(view, *watch);
    if (watch == nullptr) watched_.Clear();
    if (watch == nullptr || watch->finished) station_.Watch(watched_.areas());
    ShowWatched();
    for (View& other : views_) other.pilot->Apply(command, station_.ground());
    return;
  }
  if (const auto* cycle = std::get_if<CycleTargetCommand>(&command)) {
    targets_.Cycle(view.pilot->spec().target_text, *station_.objects().Snapshot(), cycle->by);
  }
  if (std::holds_alternative<PictureCommand>(command)) {
    const Status status = TakePictures(fmt::format("-picture-{}", ++pictures_taken_));
    if (!status.ok()) LogWarning("{}", status.message());
  }
  view.pilot->Apply(command, station_.ground());
}

void UiThread::Watch(const View& view, const WatchCommand& command) {
  constexpr double kClick_px = 4;  // a drag that is no longer than that is none
  const auto under = [&](const PicturePoint& point) { return view.pilot->GroundUnder(point, station_.ground()); };
  const double dragged_px = std::hypot(command.rim.x_px - command.middle.x_px, command.rim.y_px - command.middle.y_px);
  if (dragged_px > kClick_px) watched_.Draw(under(command.middle), under(command.rim), command.finished);
  if (dragged_px <= kClick_px && command.finished) watched_.Click(under(command.middle));
}

void UiThread::ShowWatched() {
  std::vector<WatchArea> shown = watched_.Shown();
  outlined_ = shown.empty() ? nullptr : std::make_shared<const std::vector<WatchArea>>(std::move(shown));
}

void UiThread::Advance(double now_s) {
  const double seconds = now_s - last_s_;
  last_s_ = now_s;
  const std::shared_ptr<const ObjectSnapshot> snapshot = station_.objects().Snapshot();
  for (View& view : views_) {
    std::optional<Pose> target;
    const ViewSpec& spec = view.pilot->spec();
    if (view.pilot->follows() && spec.target) {
      const glm::dvec3 start_ecef = Camera::At(spec.position, 0, 0).eye_ecef;
      target = targets_.Follow(spec.target_text, *spec.target, start_ecef, *snapshot, now_s, station_.ground());
    }
    view.pilot->Advance(seconds, target, station_.ground());
    if (view.pilot->TakeChanged()) {
      view.channel->parameters.Publish(ParametersOf(view, now_s));
    }
  }
}

void UiThread::ShowNotices(double now_s) {
  if (now_s < next_notices_s_) return;
  next_notices_s_ = now_s + kNoticesEvery_s;
  std::vector<std::string> notices = station_.Notices();
  std::vector<std::string> waiting;
  for (const View& view : views_) {
    const std::string& target = view.pilot->spec().target_text;
    if (!view.pilot->follows() || targets_.IdOf(target)) continue;
    if (std::find(waiting.begin(), waiting.end(), target) == waiting.end()) waiting.push_back(target);
  }
  for (const std::string& target : waiting) notices.push_back("waiting for an object: " + target);
  station_.render().SetNotices(std::move(notices));
}

Status UiThread::TakePictures(const std::string& moment) {
  std::error_code error;
  std::filesystem::create_directories(options_.pictures_folder, error);
  for (const View& view : views_) {
    const Result<Picture> picture = station_.render().Capture(view.id, Renderer::Moment::kOfLastFrame).get();
    if (!picture.ok()) return picture.status();
    const std::string path = fmt::format("{}/{}{}.png", options_.pictures_folder, view.name, moment);
    if (Status status = WritePng(path, picture->width_px, picture->height_px, picture->rgb); !status.ok()) {
      return status;
    }
    LogInfo("wrote {}", path);
  }
  return {};
}

}  // namespace belvedere
