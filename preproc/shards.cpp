#include "preproc/shards.h"

#include "preproc/partial_file.h"
#include "runtime/paging/dataset_store.h"
#include "runtime/paging/page_envelope.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <utility>

namespace belvedere {
namespace {

namespace fs = std::filesystem;

std::string FolderOf(const std::string& out) {
  return out + ".shards";
}
std::string MarkPath(const std::string& out, const Shard& shard) {
  return ShardPath(out, shard) + ".whole";
}

// The same where what a shard is made of is.
std::string Fingerprint(const std::string& made_of) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(made_of.data());
  return fmt::format("{:08x}-{}", Crc32c({bytes, made_of.size()}), made_of.size());
}

std::optional<std::string> ReadMark(const std::string& out, const Shard& shard) {
  std::ifstream file(MarkPath(out, shard));
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  return line;
}

std::string MarkOf(const std::string& made_of, int64_t pages, uint32_t digest) {
  return fmt::format("{} {} pages, CRC-32C {:08x}", Fingerprint(made_of), pages, digest);
}

// Every page of the store and its deviations, by layer and in the order of the quadcodes.
template <typename Visit>
Status ForEachPage(DatasetWriter& store, Visit visit) {
  for (int layer = 0; layer < kMaxDatasetLayers; ++layer) {
    for (const uint64_t word : store.Resumed(layer)) {
      const Quadcode node = *Quadcode::FromWord(word);
      const auto page = store.Get(layer, node);
      if (!page) return Status::Error("a page is gone");
      if (Status status = visit(layer, node, *page, store.GetDeviations(layer, node)); !status.ok()) return status;
    }
  }
  return {};
}

uint32_t DigestWith(uint32_t digest, int layer, Quadcode node, const std::vector<uint8_t>& page,
                    const std::optional<std::vector<uint8_t>>& deviations) {
  digest = Crc32c(page, Crc32c(store::MakeKey(layer, node.word()), digest));
  return deviations ? Crc32c(*deviations, digest) : digest;
}

// Stores map much address space each: one is open at a time.
Result<std::unique_ptr<DatasetWriter>> OpenWhole(const std::string& out, const Shard& shard,
                                                 const std::string& made_of) {
  if (!PagesOfWhole(out, shard, made_of)) {
    return Status::Error(
        "{}: shard {} of {} is {}; make it with --shard {}/{}", ShardPath(out, shard), shard.number, shard.of,
        ReadMark(out, shard) ? "made of other sources, or by another program" : "not there, or not whole", shard.number,
        shard.of);
  }
  return DatasetWriter::TakeUp(ShardPath(out, shard), made_of);
}

Status CopyShard(const std::string& out, const Shard& shard, const std::string& made_of, int64_t batch_bytes,
                 DatasetWriter& into) {
  const auto store = OpenWhole(out, shard, made_of);
  if (!store.ok()) return store.status();
  int64_t pages = 0, uncommitted_bytes = 0;
  uint32_t digest = 0;
  Status status = ForEachPage(**store, [&](int layer, Quadcode node, const auto& page, const auto& deviations) {
    ++pages;
    digest = DigestWith(digest, layer, node, page, deviations);
    uncommitted_bytes += static_cast<int64_t>(page.size());
    Status put = deviations ? into.PutDeviations(layer, node, *deviations) : Status();
    if (put.ok()) put = into.Put(layer, node, page);
    if (!put.ok() || uncommitted_bytes < batch_bytes) return put;
    uncommitted_bytes = 0;
    return into.Commit();
  });
  if (!status.ok() || ReadMark(out, shard) == MarkOf(made_of, pages, digest)) return status;
  return Status::Error(
      "{}: its pages are not those of its mark: it is damaged; make it again with --shard {}/{} --fresh",
      ShardPath(out, shard), shard.number, shard.of);
}

std::optional<int> Number(const char* text) {
  if (text == nullptr) return std::nullopt;
  const std::string_view all = text;
  int number = 0;
  const auto [end, problem] = std::from_chars(all.data(), all.data() + all.size(), number);
  return problem == std::errc() && end == all.data() + all.size() ? std::optional(number) : std::nullopt;
}

}  // namespace

std::optional<Shard> ParseShard(std::string_view text) {
  const size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto number = Number(std::string(text.substr(0, slash)).c_str());
  const auto of = Number(std::string(text.substr(slash + 1)).c_str());
  if (!number || !of || *number < 1 || *number > *of) return std::nullopt;
  return Shard{*number, *of};
}

std::string ShardPath(const std::string& out, const Shard& shard) {
  return fmt::format("{}/{}-of-{}", FolderOf(out), shard.number, shard.of);
}

std::optional<Shard> ShardOfRank(const char* (*value_of)(const char*)) {
  // Open MPI; MPICH and its relatives; srun.
  for (const auto& [rank_name, size_name] : {std::pair{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                             {"PMI_RANK", "PMI_SIZE"},
                                             {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"}}) {
    const auto rank = Number(value_of(rank_name)), size = Number(value_of(size_name));
    if (rank && size && *size > 1 && *rank >= 0 && *rank < *size) return Shard{*rank + 1, *size};
  }
  return std::nullopt;
}

std::string NotesToJson(const BuildNotes& notes) {
  return nlohmann::json{{"skipped", notes.skipped}, {"seen", notes.seen}}.dump(
      -1, ' ', true, nlohmann::json::error_handler_t::replace);
}

BuildNotes NotesFromJson(const std::string& text) {
  if (text.empty()) return {};
  const auto notes = nlohmann::json::parse(text);
  return {notes.at("skipped").get<std::map<std::string, std::string>>(), notes.at("seen").get<std::set<std::string>>()};
}

Status MarkWhole(const std::string& out, const Shard& shard, const std::string& made_of, DatasetWriter& store) {
  int64_t pages = 0;
  uint32_t digest = 0;
  Status status = ForEachPage(store, [&](int layer, Quadcode node, const auto& page, const auto& deviations) {
    ++pages;
    digest = DigestWith(digest, layer, node, page, deviations);
    return Status();
  });
  if (!status.ok()) return Status::Error("{}: {}", ShardPath(out, shard), status.message());
  auto file = PartialFile::Create(MarkPath(out, shard));
  if (!file.ok()) return file.status();
  std::ofstream mark((*file)->path());
  mark << MarkOf(made_of, pages, digest) << "\n";
  mark.close();
  if (!mark) return Status::Error("{}: cannot be written; check the space on the disk", MarkPath(out, shard));
  return (*file)->Commit();
}

void RemoveMark(const std::string& out, const Shard& shard) {
  std::error_code error;
  fs::remove(MarkPath(out, shard), error);
}

std::optional<int64_t> PagesOfWhole(const std::string& out, const Shard& shard, const std::string& made_of) {
  const auto mark = ReadMark(out, shard);
  const std::string start = Fingerprint(made_of) + " ";
  int64_t pages = 0;
  if (!mark || !mark->starts_with(start)) return std::nullopt;
  const auto [end, problem] = std::from_chars(mark->data() + start.size(), mark->data() + mark->size(), pages);
  return problem == std::errc() ? std::optional(pages) : std::nullopt;
}

Result<Merged> MergeShards(const std::string& out, int shards, const std::string& made_of, int64_t batch_bytes,
                           DatasetWriter& into) {
  Merged merged;
  std::vector<BuildNotes> notes;
  for (int number = 1; number <= shards; ++number) {
    const auto store = OpenWhole(out, {number, shards}, made_of);
    if (!store.ok()) return store.status();
    notes.push_back(NotesFromJson((*store)->notes()));
    merged.notes.skipped.insert(notes.back().skipped.begin(), notes.back().skipped.end());
  }
  for (int number = 1; number <= shards; ++number) {
    const BuildNotes& own = notes[static_cast<size_t>(number - 1)];
    if (own.skipped.size() < merged.notes.skipped.size()) {
      merged.left_out.push_back(number);
      continue;
    }
    merged.notes.seen.insert(own.seen.begin(), own.seen.end());
    if (Status status = CopyShard(out, {number, shards}, made_of, batch_bytes, into); !status.ok()) return status;
  }
  Status status = into.Note(NotesToJson(merged.notes));
  if (status.ok()) status = into.Commit();
  if (!status.ok()) return status;
  return merged;
}

void RemoveShards(const std::string& out) {
  std::error_code error;
  fs::remove_all(FolderOf(out), error);
}

}  // namespace belvedere
