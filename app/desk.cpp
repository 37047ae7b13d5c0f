// SPDX-License-Identifier: Apache-2.0
#include "app/desk.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "app/html_text.hpp"
#include "app/natural_order.hpp"
#include "app/output_place.hpp"
#include "app/paper/flow.hpp"
#include "app/paper/lists.hpp"
#include "app/paper/poster.hpp"
#include "app/paper/qr_code.hpp"

namespace footlight::app {
namespace {

std::vector<PerformerIndex> everybody(const Show& show) {
  std::vector<PerformerIndex> out;
  for (std::size_t p = 0; p < show.performers.size(); ++p) out.push_back(PerformerIndex::of(p));
  sort_by_name(show, out);
  return out;
}

}  // namespace

void sort_by_name(const Show& show, std::vector<PerformerIndex>& people) {
  std::ranges::sort(people, [&](PerformerIndex a, PerformerIndex b) {
    const std::string& one = show.performers[a.at()].name;
    const std::string& other = show.performers[b.at()].name;
    return natural_less(one, other) || (!natural_less(other, one) && a < b);
  });
}

Desk::Desk(const Plan& plan, const Show& show, const Rig& rig, const SheetFormat& format,
           std::vector<PerformerIndex> people)
    : plan_(plan),
      show_(show),
      rig_(rig),
      format_(format),
      stamp_(plan),
      parts_(parts_of(plan, show)),
      people_(std::move(people)),
      files_(show.performers.size()) {
  std::set<std::string> taken{"index"};
  for (const PerformerIndex who : everybody(show)) {
    files_[who.at()] = file_name_of(show.performers[who.at()].name, taken);
  }
}

void Desk::add_codes(SheetCode kind, std::string base) {
  code_ = kind;
  base_ = std::move(base);
}

void Desk::keep_changed(const Plan& old) {
  // The old plan's people, called as now.
  Show show = show_;
  show.performers.clear();
  std::map<std::string, std::size_t> now;
  for (std::size_t p = 0; p < show_.performers.size(); ++p) now[show_.performers[p].id] = p;
  std::map<std::string, std::size_t> before;
  for (std::size_t p = 0; p < old.performers.size(); ++p) {
    const std::string& id = old.performers[p];
    const auto known = now.find(id);
    before[id] = p;
    Performer& performer = show.performers.emplace_back();
    if (known != now.end()) performer = show_.performers[known->second];
    performer.id = id;
    if (performer.name.empty()) performer.name = id;
  }
  if (old.sections.size() != show.sections.size()) show.cues.clear();
  const std::vector<Part> parts = parts_of(old, show);
  const SheetWords old_words(show, old, format_.words);
  const SheetWords words(show_, plan_, format_.words);
  std::erase_if(people_, [&](PerformerIndex who) {
    const auto then = before.find(plan_.performers[who.at()]);
    return then != before.end() && old_words.rows_of(parts[then->second]) == words.rows_of(parts_[who.at()]);
  });
}

std::string Desk::address_of(PerformerIndex who) const { return base_ + percent_encoded(file_of(who)) + ".html"; }

void Desk::draw(Sheets& sheets, Canvas& canvas, PerformerIndex who) const {
  const Part& part = parts_[who.at()];
  std::string code;
  if (code_ == SheetCode::address) code = address_of(who);
  if (code_ == SheetCode::text) {
    code = part_text(show_, plan_, stamp_, who, part, format_.words.language, kMostCodeBytes);
  }
  sheets.draw(canvas, who, part, code);
}

std::pair<std::string, int> Desk::sheet_pdf(PerformerIndex who) const {
  Sheets sheets(show_, plan_, stamp_, format_);
  Canvas canvas = sheets.document(show_.performers[who.at()].name);
  draw(sheets, canvas, who);
  const int unknown = canvas.missing_characters();
  return {canvas.finish(), unknown};
}

std::string Desk::list_pdf(const std::string& title, const auto& draw) const {
  const PaperSize& paper = format_.paper;
  Canvas canvas = Canvas::pdf(paper.width_pt, paper.height_pt, {title, stamp_.line()});
  canvas.set_language(code_of(format_.words.language));
  draw(canvas);
  return canvas.finish();
}

std::string Desk::calls_pdf() const {
  return list_pdf("Called cues", [&](Canvas& canvas) {
    Flow flow(canvas, format_.paper, stamp_);
    const Language language = format_.words.language;
    add_call_list(flow, plan_, show_, parts_, std::nullopt, language);
    for (std::size_t g = 0; g < show_.groups.size(); ++g) {
      add_call_list(flow, plan_, show_, parts_, GroupIndex::of(g), language);
    }
  });
}

std::string Desk::patch_pdf() const {
  return list_pdf("Patch list", [&](Canvas& canvas) {
    Flow flow(canvas, format_.paper, stamp_);
    add_patch_list(flow, plan_, show_, rig_);
  });
}

std::string Desk::floor_pdf() const {
  return list_pdf("Floor plan", [&](Canvas& canvas) { draw_floor_plan(canvas, format_.paper, stamp_, plan_, rig_); });
}

std::string Desk::chart_pdf(FormationIndex formation) const {
  return list_pdf(plan_.formations[formation.at()].id,
                  [&](Canvas& canvas) { draw_chart(canvas, format_.paper, stamp_, plan_, show_, formation); });
}

std::string Desk::page_html(const PartPages& pages, PerformerIndex who) const {
  return pages.page_of(who, parts_[who.at()]);
}

std::string Desk::index_html() const {
  std::vector<std::pair<std::string, std::string>> people;
  for (const PerformerIndex who : everybody(show_)) {
    people.emplace_back(show_.performers[who.at()].name, file_of(who) + ".html");
  }
  return parts_index(people, stamp_, format_.words.language);
}

}  // namespace footlight::app
