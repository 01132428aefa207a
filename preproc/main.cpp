// belvedere-build: sources to a dataset, and into one and out of it; what is in a dataset, and where; whether it is
// whole.

#include "preproc/build.h"
#include "preproc/dataset_spec.h"
#include "preproc/export.h"
#include "preproc/report.h"
#include "preproc/report_page.h"
#include "preproc/spec.h"
#include "preproc/update.h"
#include "preproc/vectors/feature_index.h"
#include "runtime/base/clock.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

using belvedere::Dataset;

// Where the page that reports a build goes: into the dataset's folder unless a path is given.
struct PageOptions {
  std::string path;
  bool none = false;
};

int Fail(const std::string& message) {
  fmt::print(stderr, "belvedere-build: {}\n", message);
  return 1;
}

// The page that a build before left there says nothing of this one.
belvedere::Status WritePage(const belvedere::BuildReport& report, const std::string& out, const PageOptions& page) {
  const std::string own = belvedere::ReportPathIn(out);
  std::error_code error;
  std::filesystem::remove(own, error);
  if (page.none) return {};
  const auto dataset = Dataset::Open(out);
  if (!dataset.ok()) return dataset.status();
  return belvedere::WriteReportPage(**dataset, report, page.path.empty() ? own : page.path);
}

int SayShard(const belvedere::BuildReport& report, const std::string& out, bool json) {
  fmt::print(stderr, "{}: {}\n", belvedere::ShardPath(out, *report.shard), belvedere::BuildReportLine(report));
  if (json) fmt::print("{}\n", belvedere::BuildReportJson(report));
  return 0;
}

int Say(const belvedere::BuildReport& report, const std::string& out, const PageOptions& page, bool json) {
  if (const belvedere::Status status = WritePage(report, out, page); !status.ok())
    return Fail(fmt::format("the dataset {} is built, but not its report: {}", out, status.message()));
  fmt::print(stderr, "{}: {}\n", out, belvedere::BuildReportLine(report));
  if (json) fmt::print("{}\n", belvedere::BuildReportJson(report));
  return 0;
}

int RunBuild(const std::string& spec_path, const belvedere::BuildOptions& options, const PageOptions& page, bool json) {
  const auto spec = belvedere::LoadSpec(spec_path);
  if (!spec.ok()) return Fail(spec.message());
  const auto report = belvedere::Build(*spec, options, belvedere::Clock::System());
  if (!report.ok()) return Fail(report.message());
  return report->shard ? SayShard(*report, options.out, json) : Say(*report, options.out, page, json);
}

// One of several that mpirun or srun has started: each makes its shard, the first then takes all together.
int RunRank(const std::string& spec_path, belvedere::BuildOptions options, const belvedere::Shard& rank,
            const PageOptions& page, bool json) {
  options.shard = rank;
  options.show_progress = rank.number == 1;
  const bool is_first = rank.number == 1;
  const int code = RunBuild(spec_path, options, page, false);
  if (code != 0 || !is_first) return code;
  options.shard.reset();
  options.merge = rank.of;
  options.wait_for_shards = true;
  return RunBuild(spec_path, options, page, json);
}

int RunUpdate(const belvedere::SpecChange& change, const belvedere::BuildOptions& options, const PageOptions& page,
              bool json) {
  const auto report = belvedere::Update(change, options, belvedere::Clock::System());
  if (!report.ok()) return Fail(report.message());
  return Say(*report, options.out, page, json);
}

int RunAdd(const std::string& spec_path, const belvedere::BuildOptions& options, const PageOptions& page, bool json) {
  const auto added = belvedere::LoadSpec(spec_path);
  if (!added.ok()) return Fail(added.message());
  return RunUpdate([&](belvedere::BuildSpec spec) { return belvedere::WithAdded(std::move(spec), *added); }, options,
                   page, json);
}

int RunInfo(const std::string& path, bool json) {
  const auto dataset = Dataset::Open(path);
  if (!dataset.ok()) return Fail(dataset.message());
  if (json) {
    fmt::print("{}\n", belvedere::DescribeDatasetJson(**dataset));
  } else {
    fmt::print("{}", belvedere::DescribeDataset(**dataset));
  }
  return 0;
}

int RunVerify(const std::string& path) {
  const auto dataset = Dataset::Open(path);
  if (!dataset.ok()) return Fail(dataset.message());
  const belvedere::Verification found = belvedere::VerifyDataset(**dataset);
  for (const std::string& problem : found.problems) fmt::print("{}\n", problem);
  if (!found.problems.empty())
    return Fail(
        fmt::format("{}: {} of {} pages or rules are bad; build it again", path, found.problems.size(), found.pages));
  fmt::print("{}: all {} pages are good, digest {:08x}\n", path, found.pages, found.digest);
  return 0;
}

int RunExport(const std::string& path, const belvedere::ExportOptions& options) {
  const auto dataset = Dataset::Open(path);
  if (!dataset.ok()) return Fail(dataset.message());
  const auto report = belvedere::Export(**dataset, options, belvedere::Clock::System());
  if (!report.ok()) return Fail(report.message());
  fmt::print(stderr, "{}: {}\n", options.out, belvedere::ExportReportLine(*report));
  return 0;
}

int RunQuery(const std::string& path, const belvedere::FeatureQuery& query) {
  const auto dataset = Dataset::Open(path);
  if (!dataset.ok()) return Fail(dataset.message());
  const auto count =
      belvedere::QueryFeatures(**dataset, query, [](const std::string& line) { fmt::print("{}\n", line); });
  if (!count.ok()) return Fail(count.message());
  if (*count == query.limit)
    fmt::print(stderr, "belvedere-build: there may be more than these {}; ask with a greater --limit\n", *count);
  return 0;
}

// West, south, east, north, as given.
std::optional<belvedere::GeoBox> BoxOf(const std::vector<double>& degrees) {
  if (degrees.size() != 4) return std::nullopt;
  return belvedere::GeoBox{degrees[0], degrees[1], degrees[2], degrees[3]};
}

// As given on the command line.
struct QueryOptions {
  std::string dataset_path, of, name;
  std::vector<double> extent, near;
  double within_m = 1000;
  belvedere::FeatureQuery query;
};

CLI::App* AddQuery(CLI::App& app, QueryOptions& options) {
  CLI::App* command = app.add_subcommand("query", "features of vector layers, a line of GeoJSON each");
  command->add_option("DATASET", options.dataset_path, "folder of the dataset")->required();
  command->add_option("--layer", options.query.layer, "of this layer alone");
  command->add_option("--class", options.of,
                      "road, railway, river, water, border, coast, airport, place, building or other");
  command->add_option("--name", options.name, "whose name has this in it");
  command->add_option("--extent", options.extent, "WEST SOUTH EAST NORTH in degrees: that touch this box")->expected(4);
  CLI::Option* near =
      command->add_option("--near", options.near, "LAT LON in degrees: the nearest to this point first")->expected(2);
  command->add_option("--within", options.within_m, "metres from --near (default 1000)")
      ->check(CLI::PositiveNumber)
      ->needs(near);
  command->add_option("--where", options.query.where,
                      "a condition in SQL, on class, name, importance and attributes (JSON): "
                      "\"json_extract(attributes, '$.highway') = 'primary'\"");
  command->add_option("--limit", options.query.limit, "at most so many (default 100)")->check(CLI::PositiveNumber);
  return command;
}

void FinishQuery(QueryOptions& options) {
  belvedere::FeatureQuery& query = options.query;
  if (!options.of.empty()) query.of = belvedere::FeatureClassOf(options.of);
  if (!options.of.empty() && !query.of) throw CLI::ValidationError("--class", "there is no class " + options.of);
  query.box = BoxOf(options.extent);
  if (query.box && !(query.box->west_deg <= query.box->east_deg && query.box->south_deg <= query.box->north_deg))
    throw CLI::ValidationError("--extent", "needs west <= east and south <= north; over 180 east is more than 180");
  if (!options.name.empty()) query.name = options.name;
  if (options.near.size() != 2) return;
  query.near = {options.near[0], options.near[1], options.within_m};
  if (!(std::abs(query.near->latitude_deg) <= 90 && std::abs(query.near->longitude_deg) <= 180))
    throw CLI::ValidationError("--near", "LAT is from -90 to 90, LON from -180 to 180");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"belvedere-build: makes a dataset of Earth from sources"};
  app.set_version_flag("--version", BELVEDERE_VERSION);
  app.footer(
      "belvedere-build SPEC.toml --out DATASET makes a dataset of the sources that the spec lists.\n"
      "The progress goes to standard error, the report (--json) to standard output.");
  std::string spec_path, dataset_path;
  belvedere::BuildOptions options;
  bool json = false;
  app.add_option("SPEC", spec_path, "what to build: a TOML file of layers and their sources");
  app.add_option("--out", options.out, "folder of the dataset; one that is there is replaced when the build succeeds");
  app.add_option("--jobs", options.jobs, "workers (default: one for each core)")->check(CLI::Range(1, 1024));
  app.add_flag("--fresh", options.fresh, "do not go on with a build that was interrupted");
  std::string shard;
  CLI::Option* sharding =
      app.add_option("--shard", shard, "K/N: make the Kth of N parts alone, to be put together with --merge N");
  app.add_option("--merge", options.merge, "put together the dataset of so many parts")
      ->check(CLI::Range(1, 4096))
      ->excludes(sharding);
  PageOptions page;
  CLI::Option* report = app.add_option(
      "--report", page.path, "where to write a page that shows what was built (default: DATASET/report.html)");
  app.add_flag("--no-report", page.none, "write none")->excludes(report);
  app.add_flag("--json", json, "print a report as JSON");
  CLI::App* info = app.add_subcommand("info", "layers, levels, extents, pages, bytes and sources of a dataset");
  info->add_option("DATASET", dataset_path, "folder of the dataset")->required();
  info->add_flag("--json", json, "print it as JSON");
  CLI::App* verify = app.add_subcommand("verify", "read and check every page of a dataset");
  verify->add_option("DATASET", dataset_path, "folder of the dataset")->required();
  const auto change = [&](const char* name, const char* what) {
    CLI::App* command = app.add_subcommand(name, what);
    command->add_option("DATASET", options.out, "folder of the dataset")->required();
    command->add_option("--jobs", options.jobs, "workers (default: one for each core)")->check(CLI::Range(1, 1024));
    command->add_flag("--no-report", page.none, "write no page that shows what was built");
    command->add_flag("--json", json, "print a report as JSON");
    return command;
  };
  CLI::App* adding = change("add", "add sources to a dataset; only what they cover is made anew");
  adding->add_option("SPEC", spec_path, "layers and their sources, which come over those that are there")->required();
  CLI::App* removing = change("remove", "remove a source from a dataset; only what it covered is made anew");
  std::string source, layer;
  removing->add_option("SOURCE", source, "its path, as info shows it or as it is opened")->required();
  removing->add_option("--layer", layer, "from this layer alone");
  CLI::App* updating = change("update", "make anew what sources cover whose files have changed");
  CLI::App* exporting = app.add_subcommand("export", "a layer as a GeoTIFF, or imagery as MBTiles");
  belvedere::ExportOptions exported;
  std::vector<double> extent;
  bool no_fill = false;
  exporting->add_option("DATASET", dataset_path, "folder of the dataset")->required();
  exporting->add_option("--layer", exported.layer, "its name")->required();
  exporting->add_option("--out", exported.out, "FILE.tif (cloud-optimised) or FILE.mbtiles")->required();
  exporting->add_option("--extent", extent, "WEST SOUTH EAST NORTH in degrees (default: where the level has pages)")
      ->expected(4);
  exporting->add_option("--level", exported.level, "its level (default: the finest in the extent)")
      ->check(CLI::Range(0, belvedere::kMaxLevel));
  exporting->add_flag("--no-fill", no_fill,
                      "leave empty what has no page of the level; else coarser ones are enlarged");
  QueryOptions asked;
  CLI::App* querying = AddQuery(app, asked);
  app.require_subcommand(0, 1);
  try {
    app.parse(argc, argv);
    const bool building = app.get_subcommands().empty();
    if (building && spec_path.empty()) throw CLI::RequiredError("SPEC");
    if (building && options.out.empty()) throw CLI::RequiredError("--out");
    options.shard = belvedere::ParseShard(shard);
    if (querying->parsed()) FinishQuery(asked);
    if (!shard.empty() && !options.shard) throw CLI::ValidationError("--shard", "must be K/N, K from 1 to N");
  } catch (const CLI::ParseError& problem) {
    return app.exit(problem) == 0 ? 0 : 2;
  }
  if (info->parsed()) return RunInfo(dataset_path, json);
  if (verify->parsed()) return RunVerify(dataset_path);
  if (querying->parsed()) return RunQuery(asked.dataset_path, asked.query);
  if (exporting->parsed()) {
    exported.extent = BoxOf(extent);
    if (no_fill) exported.enlarge = belvedere::Enlarge::kNothing;
    return RunExport(dataset_path, exported);
  }
  if (adding->parsed()) return RunAdd(spec_path, options, page, json);
  if (removing->parsed()) {
    return RunUpdate([&](belvedere::BuildSpec spec) { return belvedere::WithRemoved(std::move(spec), source, layer); },
                     options, page, json);
  }
  if (updating->parsed()) {
    return RunUpdate([](belvedere::BuildSpec spec) -> belvedere::Result<belvedere::BuildSpec> { return spec; }, options,
                     page, json);
  }
  const bool is_part = options.shard || options.merge > 0;
  const auto rank = is_part ? std::nullopt
                            : belvedere::ShardOfRank([](const char* name) -> const char* { return std::getenv(name); });
  if (rank && options.fresh)
    return Fail(fmt::format("--fresh means each rank's own part alone; remove {}.shards before they start instead",
                            options.out));
  if (rank) return RunRank(spec_path, options, *rank, page, json);
  return RunBuild(spec_path, options, page, json);
}
