// SpecReader: keys of a spec's TOML tables by their type. Every mistake is one line that names the file, the line, the
// key and what is wanted, and for a key nobody knows the nearest that is known.
//
// Threads: values.
#pragma once

#include "runtime/base/status.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace belvedere {

std::string_view TomlTypeName(const toml::node& node);  // "a string", "a number", ..

class SpecReader {
 public:
  // file: as messages name it; outlives the reader.
  explicit SpecReader(const std::string& file) : file_(file) {}

  template <typename... Args>
  Status Error(const toml::node& node, fmt::format_string<Args...> format, Args&&... args) const {
    return Status::Error("{}:{}: {}", file_, node.source().begin.line,
                         fmt::format(format, std::forward<Args>(args)...));
  }
  Status CheckKeys(const toml::table& table, const std::vector<std::string_view>& known) const;

  // Fails where the key is missing.
  Result<std::string> String(const toml::table& table, std::string_view key) const;
  // `missing` where the key is.
  Result<std::string> String(const toml::table& table, std::string_view key, const std::string& missing) const;
  Result<double> Number(const toml::table& table, std::string_view key, double missing) const;
  Result<double> Number(const toml::node& node, std::string_view key) const;
  // None where it is no array.
  Result<std::vector<double>> Numbers(const toml::node& node, std::string_view key) const;

  const std::string& file() const { return file_; }

 private:
  const std::string& file_;
};

}  // namespace belvedere
