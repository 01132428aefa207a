// SettingsFile: a TOML file read strictly. Every mistake in it becomes one line that names the file, the line, the key
// and what was expected; a key that nobody asked for is a mistake too, and the nearest key that was asked for is named.
//
// Use: ask for each key that may be there, then CheckKeys on each table, then look at SettingsFile::status. Getters
// give nullopt when the key is not there or is wrong; the first mistake of the file is kept.
//
// Threads: one at a time.
#pragma once

#include "runtime/base/status.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace belvedere {

class SettingsTable {
 public:
  std::optional<std::string> String(std::string_view key);
  std::optional<double> Number(std::string_view key, double least, double most);
  std::optional<int64_t> Integer(std::string_view key, int64_t least, int64_t most);
  std::optional<bool> Boolean(std::string_view key);
  std::optional<std::vector<std::string>> Strings(std::string_view key);
  std::optional<std::vector<double>> Numbers(std::string_view key, size_t count);
  std::optional<std::vector<int64_t>> Integers(std::string_view key, size_t count, int64_t least, int64_t most);
  std::optional<SettingsTable> Table(std::string_view key);
  // [[key]] tables; empty when there are none.
  std::vector<SettingsTable> Tables(std::string_view key);
  // All keys whose values are strings, in the order of the keys, for tables whose keys the user makes up.
  std::vector<std::pair<std::string, std::string>> AllStrings();

  bool Has(std::string_view key) const;
  // Records "FILE:LINE: [table.]key MESSAGE".
  void Complain(std::string_view key, std::string_view message);
  // Complains of the first key that was never asked for.
  void CheckKeys();

 private:
  friend class SettingsFile;
  struct State;
  explicit SettingsTable(std::shared_ptr<State> state) : state_(std::move(state)) {}
  std::shared_ptr<State> state_;
};

class SettingsFile {
 public:
  // The first mistake ends reading when the file is no TOML at all.
  static Result<SettingsFile> Load(const std::string& path);
  static Result<SettingsFile> Parse(std::string_view text, const std::string& name);

  SettingsTable root() const;
  // ok, or the mistake that stands first in the file.
  Status status() const;

 private:
  struct State;
  explicit SettingsFile(std::shared_ptr<State> state) : state_(std::move(state)) {}
  std::shared_ptr<State> state_;
  friend class SettingsTable;
};

// The candidate that differs from `word` by the fewest letters, if that is few enough to be a slip; else empty.
std::string NearestWord(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace belvedere
