// SPDX-License-Identifier: Apache-2.0
#include "app/sheets_command.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/find_in_show.hpp"
#include "app/natural_order.hpp"
#include "app/output_place.hpp"
#include "app/paper/flow.hpp"
#include "app/paper/lists.hpp"
#include "app/paper/poster.hpp"
#include "app/paper/sheet.hpp"
#include "app/plan_step.hpp"
#include "config/output_file.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  std::string output;
  std::vector<std::string> only;
  std::vector<std::string> performers;
  std::string group;
  std::string changed_since;
  std::string formation;
  std::string paper = "a4";
  std::string language = "en";
  std::string words = "stage";
  int cards = 1;
  double step_cm = 100 * kDrillStep_m;
};

const std::map<std::string, PaperSize> kPapers{{"a4", kA4}, {"letter", kLetter}, {"phone", kPhone}};

/// Everything that the papers of one run are made from.
struct Desk {
  const Plan& plan;
  const Show& show;
  const Rig& rig;
  SheetFormat format;
  Stamp stamp;
  std::vector<Part> parts;
  std::vector<PerformerIndex> people;  ///< whose sheets are wanted, in natural order of names
};

SheetFormat format_of(const Options& options) {
  SheetFormat out;
  out.paper = kPapers.at(options.paper);
  out.a_page = options.cards;
  out.words.language = *language_from(options.language);
  out.words.style = options.words == "drill" ? PlaceStyle::drill : PlaceStyle::stage;
  out.words.step_m = options.words == "drill" ? kDrillStep_m : options.step_cm / 100;
  return out;
}

/// Who is asked for, by name; everybody where nobody is.
Result<std::vector<PerformerIndex>> people_of(const Show& show, const Options& options) {
  std::vector<PerformerIndex> out;
  for (const std::string& word : options.performers) {
    auto found = find_performer(show, word);
    if (!found) return Error{ErrorKind::input, "--performer: " + found.error().message};
    out.push_back(*found);
  }
  std::optional<GroupIndex> group;
  if (!options.group.empty()) {
    auto found = find_group(show, options.group);
    if (!found) return Error{ErrorKind::input, "--group: " + found.error().message};
    group = *found;
  }
  for (std::size_t p = 0; p < show.performers.size(); ++p) {
    const bool wanted = group ? show.performers[p].group == group : options.performers.empty();
    if (wanted) out.push_back(PerformerIndex::of(p));
  }
  std::ranges::sort(out, [&](PerformerIndex a, PerformerIndex b) {
    const std::string& one = show.performers[a.at()].name;
    const std::string& other = show.performers[b.at()].name;
    return natural_less(one, other) || (!natural_less(other, one) && a < b);
  });
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Only those whose sheets say something else than those of an earlier plan.
Status<> keep_changed(Desk& desk, const std::string& file) {
  auto old = plan_alone(file);
  if (!old) return std::move(old).error();
  // The old plan's people, called as now.
  Show show = desk.show;
  show.performers.clear();
  std::map<std::string, std::size_t> now;
  for (std::size_t p = 0; p < desk.show.performers.size(); ++p) now[desk.show.performers[p].id] = p;
  std::map<std::string, std::size_t> before;
  for (std::size_t p = 0; p < old->performers.size(); ++p) {
    const std::string& id = old->performers[p];
    const auto known = now.find(id);
    before[id] = p;
    Performer& performer = show.performers.emplace_back();
    if (known != now.end()) performer = desk.show.performers[known->second];
    performer.id = id;
    if (performer.name.empty()) performer.name = id;
  }
  if (old->sections.size() != show.sections.size()) show.cues.clear();
  const std::vector<Part> parts = parts_of(*old, show);
  const SheetWords old_words(show, *old, desk.format.words);
  const SheetWords words(desk.show, desk.plan, desk.format.words);
  std::erase_if(desk.people, [&](PerformerIndex who) {
    const auto then = before.find(desk.plan.performers[who.at()]);
    return then != before.end() && old_words.rows_of(parts[then->second]) == words.rows_of(desk.parts[who.at()]);
  });
  return Done{};
}

void warn_of_missing(Session& session, int missing) {
  if (missing > 0) {
    session.note(fmt::format(
        "{} characters are drawn as empty boxes: no font here has them (Chinese: install fonts-noto-cjk)", missing));
  }
}

Result<std::string> all_sheets(Session& session, const Desk& desk) {
  Sheets sheets(desk.show, desk.plan, desk.stamp, desk.format);
  Canvas canvas = sheets.document(desk.stamp.title);
  for (std::size_t i = 0; i < desk.people.size(); ++i) {
    if (session.stopped())
      return Error{ErrorKind::interrupted, "interrupted while drawing sheets; nothing was written"};
    session.tell("sheets", static_cast<double>(i) / static_cast<double>(desk.people.size()));
    sheets.draw(canvas, desk.people[i], desk.parts[desk.people[i].at()]);
  }
  warn_of_missing(session, canvas.missing_characters());
  return canvas.finish();
}

std::string list_pdf(const Desk& desk, const std::string& title, const auto& draw) {
  const PaperSize& paper = desk.format.paper;
  Canvas canvas = Canvas::pdf(paper.width_pt, paper.height_pt, {title, desk.stamp.line()});
  canvas.set_language(code_of(desk.format.words.language));
  draw(canvas);
  return canvas.finish();
}

std::string calls_pdf(const Desk& desk) {
  return list_pdf(desk, "Called cues", [&](Canvas& canvas) {
    Flow flow(canvas, desk.format.paper, desk.stamp);
    const Language language = desk.format.words.language;
    add_call_list(flow, desk.plan, desk.show, desk.parts, std::nullopt, language);
    for (std::size_t g = 0; g < desk.show.groups.size(); ++g) {
      add_call_list(flow, desk.plan, desk.show, desk.parts, GroupIndex::of(g), language);
    }
  });
}

std::string patch_pdf(const Desk& desk) {
  return list_pdf(desk, "Patch list", [&](Canvas& canvas) {
    Flow flow(canvas, desk.format.paper, desk.stamp);
    add_patch_list(flow, desk.plan, desk.show, desk.rig);
  });
}

std::string floor_pdf(const Desk& desk) {
  return list_pdf(desk, "Floor plan",
                  [&](Canvas& canvas) { draw_floor_plan(canvas, desk.format.paper, desk.stamp, desk.plan, desk.rig); });
}

std::string chart_pdf(const Desk& desk, FormationIndex formation) {
  return list_pdf(desk, desk.plan.formations[formation.at()].id, [&](Canvas& canvas) {
    draw_chart(canvas, desk.format.paper, desk.stamp, desk.plan, desk.show, formation);
  });
}

/// The formation that was asked for, else the last one of each section.
Result<std::vector<FormationIndex>> charted(const Plan& plan, const Options& options) {
  std::vector<FormationIndex> out;
  if (!options.formation.empty()) {
    auto found = find_formation(plan, options.formation);
    if (!found) return Error{ErrorKind::input, "--formation: " + found.error().message};
    return std::vector{*found};
  }
  for (std::size_t f = 0; f < plan.formations.size(); ++f) {
    if (f + 1 == plan.formations.size() || plan.formations[f + 1].section != plan.formations[f].section) {
      out.push_back(FormationIndex::of(f));
    }
  }
  return out;
}

using File = std::pair<std::string, std::string>;  // name in the folder, content

/// Everybody's own file, a block of people at a time on all processors.
Status<> write_sheets(Session& session, const Desk& desk, const std::filesystem::path& folder) {
  std::set<std::string> taken;
  std::vector<std::string> names;
  for (const PerformerIndex who : desk.people) {
    names.push_back(file_name_of(desk.show.performers[who.at()].name, taken) + ".pdf");
  }
  constexpr std::size_t kBlock = 64;
  int missing = 0;
  for (std::size_t begin = 0; begin < desk.people.size(); begin += kBlock) {
    if (session.stopped()) return Error{ErrorKind::interrupted, "interrupted while writing sheets"};
    session.tell("sheets", static_cast<double>(begin) / static_cast<double>(desk.people.size()));
    const std::size_t end = std::min(begin + kBlock, desk.people.size());
    std::vector<std::pair<std::string, int>> drawn(end - begin);
    tbb::parallel_for(begin, end, [&](std::size_t i) {
      Sheets sheets(desk.show, desk.plan, desk.stamp, desk.format);
      const PerformerIndex who = desk.people[i];
      Canvas canvas = sheets.document(desk.show.performers[who.at()].name);
      sheets.draw(canvas, who, desk.parts[who.at()]);
      const int unknown = canvas.missing_characters();
      drawn[i - begin] = {canvas.finish(), unknown};
    });
    for (std::size_t i = begin; i < end; ++i) {
      missing += drawn[i - begin].second;
      if (auto done = config::write_file(folder / names[i], drawn[i - begin].first); !done) return done;
    }
  }
  warn_of_missing(session, missing);
  return Done{};
}

bool wants(const Options& options, const std::string& what) {
  return options.only.empty() || std::ranges::find(options.only, what) != options.only.end();
}

Status<> write_folder(Session& session, const Desk& desk, const Options& options,
                      const std::vector<FormationIndex>& charts) {
  const std::filesystem::path folder = options.output;
  if (auto made = make_folder(folder / (wants(options, "sheets") ? "sheets" : "")); !made) return made;
  const auto write = [&](const std::string& name, const std::string& content) -> Status<> {
    if (session.stopped()) return Error{ErrorKind::interrupted, "interrupted while writing " + name};
    session.tell(name, 0);
    return config::write_file(folder / name, content);
  };
  if (wants(options, "sheets")) {
    if (auto done = write_sheets(session, desk, folder / "sheets"); !done) return done;
  }
  if (wants(options, "calls")) {
    if (auto done = write("calls.pdf", calls_pdf(desk)); !done) return done;
  }
  if (wants(options, "patch")) {
    if (auto done = write("patch.pdf", patch_pdf(desk)); !done) return done;
  }
  if (wants(options, "floor")) {
    if (auto done = write("floor.pdf", floor_pdf(desk)); !done) return done;
  }
  if (!wants(options, "charts")) return Done{};
  std::set<std::string> taken;
  for (const FormationIndex formation : charts) {
    const std::string name = "chart-" + file_name_of(desk.plan.formations[formation.at()].id, taken) + ".pdf";
    if (auto done = write(name, chart_pdf(desk, formation)); !done) return done;
  }
  return Done{};
}

Result<std::string> one_file(Session& session, const Desk& desk, const Options& options,
                             const std::vector<FormationIndex>& charts) {
  const std::string what = options.only.empty() ? "sheets" : options.only.front();
  if (what == "calls") return calls_pdf(desk);
  if (what == "patch") return patch_pdf(desk);
  if (what == "floor") return floor_pdf(desk);
  if (what == "charts") return chart_pdf(desk, charts.back());
  return all_sheets(session, desk);
}

int run(Session& session, const Options& options) {
  const bool one = options.output.ends_with(".pdf");
  if (one && options.only.size() > 1) {
    return session.fail(input_error("one PDF holds one kind of paper (name a folder, or one kind with --only)"));
  }
  if (auto free = can_write(options.output); !free) return session.fail(free.error());
  auto planned = plan_for(session, options.choice, false);
  if (!planned) return session.fail(planned.error());
  if (const auto refused = refusal_of(planned->planned)) return session.fail(*refused);
  if (auto spared = spare_inputs(planned->loaded, options.output); !spared) return session.fail(spared.error());
  const Plan& plan = planned->plan();
  const Show& show = planned->loaded.show;
  auto people = people_of(show, options);
  if (!people) return session.fail(people.error());
  const auto charts = charted(plan, options);
  if (!charts) return session.fail(charts.error());
  if (one && wants(options, "charts") && !options.only.empty() && charts->size() > 1) {
    return session.fail(input_error("one PDF holds one chart (name it with --formation, or name a folder)"));
  }
  Desk desk{plan, show, planned->loaded.rig, format_of(options), Stamp(plan), parts_of(plan, show), *people};
  if (!options.changed_since.empty()) {
    if (auto done = keep_changed(desk, options.changed_since); !done) return session.fail(done.error());
  }
  const std::string sheets = fmt::format("{} of {} performers' sheets", desk.people.size(), plan.performers.size());
  if (one && desk.people.empty()) {
    session.print(sheets + " have changed; nothing was written");
    return 0;
  }
  if (one) {
    auto content = one_file(session, desk, options, *charts);
    if (!content) return session.fail(content.error());
    if (auto done = config::write_file(options.output, *content); !done) return session.fail(done.error());
  } else if (auto done = write_folder(session, desk, options, *charts); !done) {
    return session.fail(done.error());
  }
  session.clear_line();
  const std::string drawn = !one || wants(options, "sheets") ? sheets + ", " : "";
  session.print(fmt::format("{}: {}plan {}", options.output, drawn, desk.stamp.plan));
  return 0;
}

void add_look_options(CLI::App& command, Options& options) {
  command.add_option("--paper", options.paper, "a4, letter or phone")->check(CLI::IsMember({"a4", "letter", "phone"}));
  command.add_option("--cards", options.cards, "cards a page: 1, 2 or 4")->check(CLI::IsMember({1, 2, 4}));
  command.add_option("--language", options.language, "en or zh")->check(CLI::IsMember({"en", "zh"}));
  command.add_option("--words", options.words, "how a place is told: stage, or drill (yard lines and hashes)")
      ->check(CLI::IsMember({"stage", "drill"}));
  command.add_option("--step", options.step_cm, "the step by which stage words count, cm (default: 57.15, 8 to 5)")
      ->check(CLI::Range(10.0, 1000.0));
}

}  // namespace

void add_sheets_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("sheets", "Print dot sheets, called cues, charts, patch list, floor plan");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  command->add_option("-o,--output", options->output, "a folder for everything, or FILE.pdf for one kind of paper")
      ->required();
  command->add_option("--only", options->only, "sheets, calls, charts, patch, floor; commas between them")
      ->delimiter(',')
      ->check(CLI::IsMember({"sheets", "calls", "charts", "patch", "floor"}));
  command->add_option("--performer", options->performers, "whose sheets: ids or names, commas between them")
      ->delimiter(',');
  command->add_option("--group", options->group, "the sheets of this group");
  command->add_option("--changed-since", options->changed_since,
                      "only sheets that say something else than this plan's");
  command->add_option("--formation", options->formation, "chart this formation (default: the last of each section)");
  add_look_options(*command, *options);
  session.add_options(*command, false);
  command->footer(
      "Every page carries the title, the show's and the plan's hash. \"part\" at the foot of a sheet stays the same "
      "while\n"
      "the sheet does, so that older sheets can be told to be right still.\n\n"
      "Examples:\n  footlight sheets show.yaml -o out/paper\n  footlight sheets show.yaml -o cards.pdf --cards 4\n"
      "  footlight sheets show.yaml -o ana.pdf --performer \"Ana Ruiz\" --paper phone --language zh\n"
      "  footlight sheets show.yaml -o new.pdf --changed-since monday.plan\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
