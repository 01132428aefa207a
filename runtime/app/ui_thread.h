// UiThread: owns the events of the windows and the master copy of every view, and manages the system while it runs.
//
// Some 60 times a second: events become commands, commands change pilots, followers are taken along by their targets,
// and whatever changed is published as view parameters. With no windows the same goes on off-screen.
//
// Threads: the main thread.
#pragma once

#include "render/window_system.h"
#include "runtime/app/gestures.h"
#include "runtime/app/key_map.h"
#include "runtime/app/station.h"
#include "runtime/app/target_tracker.h"
#include "runtime/app/view_pilot.h"
#include "runtime/app/watched_places.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace belvedere {

struct UiOptions {
  double seconds = 0;  // 0: until closed
  std::string pictures_folder;
  bool pictures_on_the_way = false;  // a few on the way, and one of every view at the end
};

class UiThread {
 public:
  // windows: null off-screen. All must outlive it.
  UiThread(const StationSpec& spec, const UiOptions& options, Station& station, WindowSystem* windows,
           const Clock& clock);

  Status OpenViews();
  // Until a window is closed, a quit command, SIGINT or SIGTERM, or the time is up.
  Status Run();
  void CloseViews();

 private:
  struct View {
    ViewId id = 0;
    std::string name;
    std::unique_ptr<ViewPilot> pilot;
    std::unique_ptr<Gestures> gestures;
    ViewChannel* channel = nullptr;
    std::optional<WindowId> window;
    int width_px = 0, height_px = 0;
  };

  Status OpenView(const WindowSpec& window);
  void TakeEvents(double longest_wait_s);
  void Do(View& view, const Command& command);
  void Watch(const View& view, const WatchCommand& command);
  void ShowWatched();
  void Advance(double now_s);
  void ShowNotices(double now_s);
  Status TakePictures(const std::string& moment);
  ViewParameters ParametersOf(const View& view, double now_s);
  double UtcAt(double now_s) const { return utc_at_start_s_ + spec_.time_rate * (now_s - start_s_); }

  const StationSpec& spec_;
  const UiOptions options_;
  Station& station_;
  WindowSystem* const windows_;
  const Clock& clock_;
  KeyMap keys_;
  TargetTracker targets_;
  WatchedPlaces watched_;
  std::shared_ptr<const std::vector<WatchArea>> outlined_;  // nullptr: none
  std::vector<View> views_;
  std::vector<InputEvent> events_;
  const double start_s_;
  double utc_at_start_s_;
  double last_s_;
  double next_notices_s_ = 0;
  uint64_t number_ = 0;
  int pictures_taken_ = 0;
  bool quit_ = false;
};

}  // namespace belvedere
