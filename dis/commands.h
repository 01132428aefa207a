// The commands of belvedere-dis. Each writes its results to standard output and says with a Status what it could not
// do.
#pragma once

#include "dis/receiver.h"
#include "dis/traffic_sender.h"
#include "runtime/base/status.h"

#include <string>
#include <vector>

namespace belvedere::dis {

struct DecodeCommand {
  std::vector<std::string> files;
};
Status Decode(const DecodeCommand& command);

struct ResidualsCommand {
  std::vector<std::string> files;
};
Status PrintResiduals(const ResidualsCommand& command);

struct ExtrapolateCommand {
  std::string file;
};
Status ExtrapolateRows(const ExtrapolateCommand& command);

// seconds: 0 means until interrupted, in all of these.
struct TrafficCommand {
  std::string to;
  TrafficSenderOptions options;
  bool absolute_timestamps = false;
  double seconds = 0;
};
Status SendTraffic(TrafficCommand command);

struct ListenCommand {
  std::string listen;
  ReceiverOptions options;
  int exercise = -1;  // -1: all
  std::vector<std::string> sources;
  double seconds = 0;
  bool json = false;
};
Status Listen(ListenCommand command);

struct RecordCommand {
  std::string listen;
  std::string out;
  std::string interface_address;
  double seconds = 0;
};
Status Record(const RecordCommand& command);

struct ReplayCommand {
  std::string file;
  std::string to;
  std::string interface_address;
  double speed = 1;
  bool loop = false;
  bool control = false;  // by lines of standard input
  bool paused = false;   // at the start
};
Status Replay(const ReplayCommand& command);

}  // namespace belvedere::dis
