// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/rehearsal_report.hpp"

#include <algorithm>
#include <array>
#include <ctime>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/html_text.hpp"
#include "app/rehearsing/rehearsal_log.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;
using Kind = RehearsalEntry::Kind;
using OfCue = RehearsalReport::OfCue;

constexpr const char* kStyle =
    "body{font:15px/1.45 \"DejaVu Sans\",Verdana,sans-serif;color:#111;max-width:760px;margin:24px auto;padding:0 12px}"
    "h1{font-size:26px;margin:0}h2{font-size:19px;margin:30px 0 8px;border-bottom:2px solid #111}"
    "p.stamp{color:#555;font-size:12px;margin:2px 0 18px}table{border-collapse:collapse;width:100%;font-size:13px}"
    "th,td{text-align:right;padding:2px 8px;border-bottom:1px solid #ccc;vertical-align:top}"
    "th:first-child,td:first-child,td.note,th.note{text-align:left}"
    "@media print{body{max-width:none;margin:0}tr{break-inside:avoid}}";

std::string clock_text(double since_1970_s, const char* format) {
  const auto time = static_cast<std::time_t>(since_1970_s);
  std::tm local{};
  localtime_r(&time, &local);
  std::array<char, 40> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &local)};
}

/// "12:34", "1:02:03"
std::string span_text(double time_s) {
  const auto all = static_cast<long>(time_s + 0.5);
  if (all >= 3600) return fmt::format("{}:{:02}:{:02}", all / 3600, all / 60 % 60, all % 60);
  return fmt::format("{}:{:02}", all / 60, all % 60);
}

std::string counts_text(const std::vector<double>& counts) {
  std::string out;
  for (const double count : counts) out += fmt::format("{}{:.4g}", out.empty() ? "" : ", ", count);
  return out.empty() ? "-" : out;
}

std::string lamp_text(const OfCue& cue) {
  return cue.go_to_last_lamp_ms ? fmt::format("{:.0f} ms", *cue.go_to_last_lamp_ms) : "-";
}

std::vector<std::string> heads() {
  return {"cue", "starts", "ends", "held at count", "resets", "time", "GO to last lamp"};
}

std::vector<std::string> row_of(const OfCue& cue) {
  return {cue.number + (cue.name.empty() ? "" : " " + cue.name),
          std::to_string(cue.starts),
          std::to_string(cue.ends),
          counts_text(cue.holds),
          std::to_string(cue.resets),
          span_text(cue.run_s),
          lamp_text(cue)};
}

/// Everything beside the table, a line each.
std::vector<std::string> facts_of(const RehearsalReport& report) {
  std::vector<std::string> lines;
  if (report.programs > 1) lines.push_back(fmt::format("the program was started {} times", report.programs));
  if (report.refused > 0) lines.push_back(fmt::format("{} orders were refused", report.refused));
  if (report.late_latches) {
    lines.push_back(fmt::format("{} switches of lamps more than 1 ms late, the worst {:.3f} ms", *report.late_latches,
                                report.worst_latch_ms.value_or(0)));
  }
  std::uint64_t late = 0;
  for (const OfCue& cue : report.cues) late += cue.late_nodes;
  if (late > 0) lines.push_back(fmt::format("{} nodes were not right at the end of a cue", late));
  std::string absent;
  for (const std::string& name : report.absent) absent += (absent.empty() ? "" : ", ") + name;
  if (!absent.empty()) lines.push_back("absent: " + absent);
  for (const std::string& alarm : report.alarms) lines.push_back("alarm: " + alarm);
  return lines;
}

std::string head_line(const RehearsalReport& report) {
  return fmt::format("Rehearsed {}, {}", clock_text(report.began_since_1970_s, "%Y-%m-%d %H:%M"),
                     span_text(report.lasted_s));
}

std::vector<RehearsalEntry> notes_of(const RehearsalReport& report) {
  std::vector<RehearsalEntry> notes = report.notes;
  for (const OfCue& cue : report.cues) notes.insert(notes.end(), cue.notes.begin(), cue.notes.end());
  return notes;
}

OfCue* find(RehearsalReport& report, const std::string& number) {
  const auto found = std::ranges::find(report.cues, number, &OfCue::number);
  return found == report.cues.end() ? nullptr : &*found;
}

/// How long cues ran, by the wall clock, between what begins and what ends.
struct Running {
  OfCue* cue = nullptr;
  double since_s = 0;
  void begin(OfCue* what, double now_s) { *this = {what, now_s}; }
  void end(double now_s) {
    if (cue != nullptr) cue->run_s += std::max(0.0, now_s - since_s);
    cue = nullptr;
  }
};

void count(RehearsalReport& report, const RehearsalEntry& entry, Running& running) {
  OfCue* const cue = find(report, entry.cue);
  const double now_s = entry.since_1970_s;
  switch (entry.kind) {
    case Kind::begun:
      ++report.programs;
      running.cue = nullptr;  // nobody knows how long it ran when it was cut off
      return;
    case Kind::start:
    case Kind::goes_on:
      if (cue != nullptr) ++(entry.kind == Kind::start ? cue->starts : cue->goes_on);
      return running.begin(cue, now_s);
    case Kind::end:
      if (cue != nullptr) ++cue->ends;
      return running.end(now_s);
    case Kind::hold:
      if (cue != nullptr) cue->holds.push_back(entry.count);
      return running.end(now_s);
    case Kind::reset:
      if (cue != nullptr) ++cue->resets;
      return;
    case Kind::refused:
      ++report.refused;
      return;
    case Kind::alarm:
      report.alarms.push_back(entry.text);
      return;
    case Kind::note:
      (cue != nullptr ? cue->notes : report.notes).push_back(entry);
      return;
    case Kind::absent:
      if (std::ranges::find(report.absent, entry.text) == report.absent.end()) report.absent.push_back(entry.text);
      return;
    case Kind::order:
    case Kind::ended:
      return;
  }
}

}  // namespace

RehearsalReport report_of(const Show& show, const std::vector<controller::CuePlay>& plays,
                          const std::vector<RehearsalEntry>& entries, const LiveReport* live) {
  RehearsalReport report;
  report.title = show.title;
  for (const controller::CuePlay& play : plays) {
    OfCue& cue = report.cues.emplace_back();
    cue.number = play.cue.number.to_text();
    cue.name = play.cue.name;
  }
  if (!entries.empty()) {
    report.began_since_1970_s = entries.front().since_1970_s;
    report.lasted_s = std::max(0.0, entries.back().since_1970_s - entries.front().since_1970_s);
  }
  for (const Performer& performer : show.performers) {
    if (performer.absent) report.absent.push_back(performer.name);
  }
  Running running;
  for (const RehearsalEntry& entry : entries) count(report, entry, running);
  if (live == nullptr) return report;
  report.late_latches = live->late_latches;
  report.worst_latch_ms = 0;
  for (const LiveBusReport& bus : live->buses) {
    report.worst_latch_ms = std::max(*report.worst_latch_ms, bus.latch.worst_ms);
  }
  for (const LiveCueReport& told : live->cues) {
    OfCue* const cue = find(report, told.number);
    if (cue == nullptr || cue->starts == 0) continue;
    if (told.go_to_last_lamp_ms > 0) cue->go_to_last_lamp_ms = told.go_to_last_lamp_ms;
    cue->late_nodes = told.unconfirmed;
  }
  return report;
}

std::string rehearsal_text(const RehearsalReport& report) {
  std::string out = report.title + "\n" + head_line(report) + "\n\n";
  std::vector<std::vector<std::string>> rows{heads()};
  for (const OfCue& cue : report.cues) rows.push_back(row_of(cue));
  std::vector<std::size_t> width(rows[0].size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  }
  for (const auto& row : rows) {
    out += fmt::format("{:<{}}", row[0], width[0]);
    for (std::size_t i = 1; i < row.size(); ++i) out += fmt::format("  {:>{}}", row[i], width[i]);
    out += "\n";
  }
  out += "\n";
  for (const std::string& line : facts_of(report)) out += line + "\n";
  const auto notes = notes_of(report);
  out += notes.empty() ? "no notes\n" : "notes:\n";
  for (const RehearsalEntry& note : notes) out += "  " + note_line(note) + "\n";
  return out;
}

std::string rehearsal_json(const RehearsalReport& report) {
  const auto notes_json = [](const std::vector<RehearsalEntry>& notes) {
    Json list = Json::array();
    for (const RehearsalEntry& note : notes) {
      list.push_back({{"count", note.count},
                      {"cue", note.cue},
                      {"about", to_text(note.about)},
                      {"whom", note.whom},
                      {"text", note.text},
                      {"who", note.who},
                      {"since_1970_s", note.since_1970_s}});
    }
    return list;
  };
  Json out{{"title", report.title},
           {"began_since_1970_s", report.began_since_1970_s},
           {"lasted_s", report.lasted_s},
           {"programs", report.programs},
           {"cues", Json::array()}};
  for (const OfCue& cue : report.cues) {
    out["cues"].push_back(
        {{"cue", cue.number},
         {"name", cue.name},
         {"starts", cue.starts},
         {"ends", cue.ends},
         {"holds_at_count", cue.holds},
         {"goes_on", cue.goes_on},
         {"resets", cue.resets},
         {"run_s", cue.run_s},
         {"go_to_last_lamp_ms", cue.go_to_last_lamp_ms ? Json(*cue.go_to_last_lamp_ms) : Json(nullptr)},
         {"late_nodes", cue.late_nodes},
         {"notes", notes_json(cue.notes)}});
  }
  out["notes"] = notes_json(report.notes);
  out["alarms"] = report.alarms;
  out["refused"] = report.refused;
  out["late_latches"] = report.late_latches ? Json(*report.late_latches) : Json(nullptr);
  out["worst_latch_ms"] = report.worst_latch_ms ? Json(*report.worst_latch_ms) : Json(nullptr);
  out["absent"] = report.absent;
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string rehearsal_html(const RehearsalReport& report) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}: rehearsal</title>\n<style>{1}</style></head><body>\n<h1>{0}</h1>\n"
      "<p class=\"stamp\">{2}</p>\n<h2>Cues</h2>\n<table>\n<tr>",
      escaped(report.title), kStyle, escaped(head_line(report)));
  for (const std::string& head : heads()) out += "<th>" + escaped(head) + "</th>";
  out += "</tr>\n";
  for (const OfCue& cue : report.cues) {
    out += "<tr>";
    for (const std::string& cell : row_of(cue)) out += "<td>" + escaped(cell) + "</td>";
    out += "</tr>\n";
  }
  out += "</table>\n";
  const auto facts = facts_of(report);
  for (const std::string& line : facts) out += "<p>" + escaped(line) + "</p>\n";
  out += "<h2>Notes</h2>\n";
  const auto notes = notes_of(report);
  if (notes.empty()) return out + "<p>None.</p>\n</body></html>\n";
  out +=
      "<table>\n<tr><th>cue</th><th>count</th><th class=\"note\">for</th><th class=\"note\">note</th>"
      "<th class=\"note\">by</th></tr>\n";
  for (const RehearsalEntry& note : notes) {
    out += fmt::format(
        "<tr><td>{}</td><td>{:.4g}</td><td class=\"note\">{}</td><td class=\"note\">{}</td><td class=\"note\">{}</td>"
        "</tr>\n",
        escaped(note.cue), note.count, escaped(note.about == Remark::About::all ? "all" : note.whom),
        escaped(note.text), escaped(note.who));
  }
  return out + "</table>\n</body></html>\n";
}

}  // namespace footlight::app
