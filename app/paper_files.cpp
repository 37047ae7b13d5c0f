// SPDX-License-Identifier: Apache-2.0
#include "app/paper_files.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/output_place.hpp"
#include "config/output_file.hpp"

namespace footlight::app {

void PaperFiles::warn_of_missing(int characters) {
  if (characters == 0) return;
  session_.note(fmt::format(
      "{} characters are drawn as empty boxes: no font here has them (Chinese: install fonts-noto-cjk)", characters));
}

Status<> PaperFiles::write(const std::filesystem::path& file, const std::string& content) {
  if (session_.stopped()) return Error{ErrorKind::interrupted, "interrupted; every file that was written is whole"};
  auto done = config::write_file(file, content);
  if (done) files_.push_back(file.string());
  return done;
}

Status<> PaperFiles::folder(const std::filesystem::path& folder, const Wanted& wanted) {
  const bool sheets = wanted.has("sheets");
  if (auto made = make_folder(folder / (sheets ? "sheets" : "")); !made) return made;
  if (sheets) {
    const auto made = [&](PerformerIndex who) { return desk_.sheet_pdf(who); };
    if (auto done = each(folder / "sheets", ".pdf", made); !done) return done;
  }
  const std::pair<const char*, std::function<std::string()>> lists[] = {{"calls", [&] { return desk_.calls_pdf(); }},
                                                                        {"patch", [&] { return desk_.patch_pdf(); }},
                                                                        {"floor", [&] { return desk_.floor_pdf(); }}};
  for (const auto& [name, made] : lists) {
    if (!wanted.has(name)) continue;
    session_.tell(name, 0);
    if (auto done = write(folder / (std::string(name) + ".pdf"), made()); !done) return done;
  }
  if (!wanted.has("charts")) return Done{};
  std::set<std::string> taken;
  for (const FormationIndex formation : wanted.charts) {
    const std::string name = "chart-" + file_name_of(desk_.plan().formations[formation.at()].id, taken) + ".pdf";
    session_.tell(name, 0);
    if (auto done = write(folder / name, desk_.chart_pdf(formation)); !done) return done;
  }
  return Done{};
}

Status<> PaperFiles::one(const std::filesystem::path& file, const Wanted& wanted) {
  const std::string what = wanted.only.empty() ? "sheets" : *wanted.only.begin();
  auto content = what == "calls"    ? Result<std::string>(desk_.calls_pdf())
                 : what == "patch"  ? Result<std::string>(desk_.patch_pdf())
                 : what == "floor"  ? Result<std::string>(desk_.floor_pdf())
                 : what == "charts" ? Result<std::string>(desk_.chart_pdf(wanted.charts.back()))
                                    : all_sheets();
  if (!content) return std::move(content).error();
  return write(file, *content);
}

Status<> PaperFiles::pages(const std::filesystem::path& folder) {
  if (auto made = make_folder(folder); !made) return made;
  const PartPages pages(desk_.show(), desk_.plan(), desk_.stamp(), desk_.format().words);
  const auto made = [&](PerformerIndex who) { return std::pair(desk_.page_html(pages, who), 0); };
  auto done = each(folder, ".html", made);
  if (!done || desk_.people().size() != desk_.show().performers.size()) return done;
  return write(folder / "index.html", desk_.index_html());
}

Result<std::string> PaperFiles::all_sheets() {
  Sheets sheets(desk_.show(), desk_.plan(), desk_.stamp(), desk_.format());
  Canvas canvas = sheets.document(desk_.stamp().title);
  for (std::size_t i = 0; i < desk_.people().size(); ++i) {
    if (session_.stopped())
      return Error{ErrorKind::interrupted, "interrupted while drawing sheets; nothing was written"};
    session_.tell("sheets", static_cast<double>(i) / static_cast<double>(desk_.people().size()));
    desk_.draw(sheets, canvas, desk_.people()[i]);
  }
  warn_of_missing(canvas.missing_characters());
  return canvas.finish();
}

/// Everybody's own file, a block of people at a time on all processors.
Status<> PaperFiles::each(const std::filesystem::path& folder, const std::string& ending,
                          const std::function<std::pair<std::string, int>(PerformerIndex)>& made) {
  const std::vector<PerformerIndex>& people = desk_.people();
  constexpr std::size_t kBlock = 64;
  int missing = 0;
  for (std::size_t begin = 0; begin < people.size(); begin += kBlock) {
    session_.tell(ending == ".pdf" ? "sheets" : "pages",
                  static_cast<double>(begin) / static_cast<double>(people.size()));
    const std::size_t end = std::min(begin + kBlock, people.size());
    std::vector<std::pair<std::string, int>> drawn(end - begin);
    tbb::parallel_for(begin, end, [&](std::size_t i) { drawn[i - begin] = made(people[i]); });
    for (std::size_t i = begin; i < end; ++i) {
      missing += drawn[i - begin].second;
      if (auto done = write(folder / (desk_.file_of(people[i]) + ending), drawn[i - begin].first); !done) return done;
    }
  }
  warn_of_missing(missing);
  return Done{};
}

}  // namespace footlight::app
