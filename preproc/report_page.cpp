#include "preproc/report_page.h"

#include "preproc/layer_section.h"
#include "preproc/markup.h"
#include "preproc/partial_file.h"
#include "runtime/earth/geoid.h"

#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

namespace belvedere {
namespace {

using namespace markup;

constexpr std::string_view kStyle = R"css(
:root{color-scheme:light dark;--line:#8884}
body{font:15px/1.5 system-ui,sans-serif;max-width:76rem;margin:2rem auto;padding:0 1.5rem}
h1{margin-bottom:0}h2{margin-top:2.5rem;border-bottom:1px solid var(--line)}h3{margin-bottom:.3rem}
.quiet{opacity:.75}
table{border-collapse:collapse;margin:.5rem 0;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:.2rem .8rem .2rem 0;border-bottom:1px solid var(--line);vertical-align:top}
td.n{text-align:right}td:first-child{white-space:nowrap}
.pictures{display:flex;flex-wrap:wrap;gap:1rem}figure{margin:0}figcaption{font-size:85%;max-width:36rem}
img{max-width:100%;display:block}
svg.map{width:720px;max-width:100%;display:block}
svg.map rect,svg.map circle{stroke-width:.8}svg.map text{font:bold 7px sans-serif}
svg.map .graticule{stroke:#fff3;stroke-width:.3;fill:none}
svg.bars{width:600px;max-width:100%}svg.bars rect{fill:#3a7ca5}svg.bars text{font-size:11px;fill:currentColor}
.bar{display:block;height:.7rem;background:#3a7ca5}
.swatch{display:inline-block;width:.9rem;height:.9rem;border:1px solid #8888;margin-right:.3rem;vertical-align:-2px}
.warn{border-left:4px solid #d08a00;padding-left:1rem}
)css";

std::string Remarks(std::string_view title, const std::vector<SourceRemark>& remarks) {
  if (remarks.empty()) return {};
  std::string out = fmt::format("<section class=\"warn\"><h3>{}</h3><table>{}<tbody>", title,
                                Head(std::array<std::string_view, 2>{"source", "reason"}));
  for (size_t i = 0; i < std::min(remarks.size(), kMostRows); ++i)
    out += fmt::format("<tr><td>{}</td><td>{}</td></tr>", Escape(remarks[i].source), Escape(remarks[i].reason));
  return out + "</tbody></table>" + More(remarks.size(), "sources") + "</section>";
}

std::string Facts(const Dataset& dataset, const BuildReport& report) {
  std::string out = "<table><tbody>";
  const auto row = [&](std::string_view name, const std::string& value) {
    out += fmt::format("<tr><th>{}</th><td>{}</td></tr>", name, value);
  };
  row("built", fmt::format("{} by belvedere-build {}", Escape(dataset.build_time()), BELVEDERE_VERSION));
  row("format", fmt::format("version {}", dataset.version()));
  row("size", fmt::format("{} pages, {}", Count(report.pages), Bytes(report.bytes)));
  row("read", fmt::format("{} of source pixels, unpacked", Bytes(report.bytes_read)));
  const std::string rounds =
      report.rounds <= 1 ? "" : fmt::format("; made {} times, since sources had to be left out", report.rounds);
  row("time", fmt::format("{} with {} worker{}: {} to open sources, {} for pages, {} to finish{}",
                          Seconds(report.seconds), report.jobs, report.jobs == 1 ? "" : "s", Seconds(report.opening_s),
                          Seconds(report.pages_s), Seconds(report.finishing_s), rounds));
  const double seconds = std::max(report.seconds, 1e-3);
  row("rate", fmt::format("{:.0f} pages/s, {:.1f} MB/s written", static_cast<double>(report.pages) / seconds,
                          static_cast<double>(report.bytes) / 1e6 / seconds));
  return out + "</tbody></table>";
}

}  // namespace

Result<std::string> ReportPage(const Dataset& dataset, const BuildReport& report) {
  GDALAllRegister();
  const auto geoid = Geoid::LoadEgm96();
  if (!geoid.ok()) return geoid.status();
  const std::string name = Escape(std::filesystem::path(dataset.path()).filename().string());
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Dataset {0}</title>"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'\"><meta name=\"viewport\" content=\"width=device-width\"><style>{1}</style></head><body>"
      "<h1>Dataset {0}</h1>",
      name, kStyle);
  out += Facts(dataset, report);
  out += Remarks("Sources that were skipped", report.skipped) + Remarks("Warnings", report.warnings);
  if (report.skipped.empty() && report.warnings.empty())
    out += "<p>No source was skipped, and there is nothing to warn of.</p>";
  for (const WholeLayer& whole : WholeLayers(dataset)) {
    const auto section = LayerSection(dataset, whole, **geoid);
    if (!section.ok()) return section;
    out += *section;
  }
  return out + "</body></html>\n";
}

Status WriteReportPage(const Dataset& dataset, const BuildReport& report, const std::string& path) {
  const auto page = ReportPage(dataset, report);
  if (!page.ok()) return page.status();
  auto file = PartialFile::Create(path);
  if (!file.ok()) return file.status();
  {
    std::ofstream out((*file)->path(), std::ios::binary);
    out << *page;
    out.flush();
    if (!out) return Status::Error("{}: cannot be written; check the folder and the space on the disk", path);
  }
  return (*file)->Commit();
}

std::string ReportPathIn(const std::string& dataset_path) {
  return (std::filesystem::path(dataset_path) / "report.html").string();
}

}  // namespace belvedere
