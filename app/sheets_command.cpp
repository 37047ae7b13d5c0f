// SPDX-License-Identifier: Apache-2.0
#include "app/sheets_command.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/desk.hpp"
#include "app/find_in_show.hpp"
#include "app/output_place.hpp"
#include "app/paper/qr_code.hpp"
#include "app/paper_files.hpp"
#include "app/plan_step.hpp"
#include "app/written.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  std::string output;
  std::string pages;
  std::string base_url;
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

  [[nodiscard]] bool one_file() const { return output.ends_with(".pdf"); }
  [[nodiscard]] Wanted wanted() const { return {{only.begin(), only.end()}, {}}; }
};

const std::map<std::string, PaperSize> kPapers{{"a4", kA4}, {"letter", kLetter}, {"phone", kPhone}};

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
  sort_by_name(show, out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
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

/// What stands before a page's name in its address. Errors: it is no address; one with a name would not fit a code.
Status<> add_codes(Desk& desk, const Options& options) {
  if (options.base_url.empty()) {
    if (!options.pages.empty()) desk.add_codes(SheetCode::text, {});
    return Done{};
  }
  std::string base = options.base_url;
  const bool web = base.starts_with("https://") || base.starts_with("http://");
  const auto odd = [](char c) { return c <= ' ' || c == '"' || c == '<' || c == '>' || c == '\x7F'; };
  if (!web || base.find("//") + 2 == base.size() || std::ranges::any_of(base, odd)) {
    return input_error(fmt::format(
        "--base-url: '{}' is no web address (write that of the folder with the pages, as https://example.org/show/)",
        base));
  }
  if (base.back() != '/' && base.back() != '=' && base.back() != '#') base += '/';
  desk.add_codes(SheetCode::address, base);
  for (const PerformerIndex who : desk.people()) {
    const std::size_t bytes = desk.address_of(who).size();
    if (bytes <= kMostCodeBytes) continue;
    return input_error(fmt::format("--base-url: the address of {}'s page has {} bytes, a code on a sheet holds {}",
                                   desk.show().performers[who.at()].name, bytes, kMostCodeBytes));
  }
  return Done{};
}

/// What the command line alone has wrong.
Status<> check(const Options& options) {
  if (options.output.empty() && options.pages.empty()) {
    return input_error("say what to write: -o FOLDER, -o FILE.pdf, --pages FOLDER");
  }
  if (options.one_file() && options.only.size() > 1) {
    return input_error("one PDF holds one kind of paper (name a folder, or one kind with --only)");
  }
  for (const std::string& place : {options.output, options.pages}) {
    if (place.empty()) continue;
    if (auto free = can_write(place); !free) return free;
  }
  return Done{};
}

Status<> write_all(PaperFiles& writer, const Desk& desk, const Options& options, const Wanted& wanted) {
  if (!options.pages.empty()) {
    if (auto done = writer.pages(options.pages); !done) return done;
  }
  if (options.output.empty()) return Done{};
  if (!options.one_file()) return writer.folder(options.output, wanted);
  if (desk.people().empty() && wanted.has("sheets")) return Done{};
  return writer.one(options.output, wanted);
}

void tell_written(Session& session, const Desk& desk, const Options& options, const std::vector<std::string>& files) {
  session.clear_line();
  if (session.json) {
    auto out = written_json(desk.stamp(), files);
    out["performers"] = desk.plan().performers.size();
    out["drawn"] = nlohmann::ordered_json::array();
    for (const PerformerIndex who : desk.people()) out["drawn"].push_back(desk.plan().performers[who.at()]);
    session.print(out.dump(2));
    return;
  }
  const auto told = [&](const std::string& place, const char* what) {
    const std::string sheets =
        fmt::format("{} of {} performers' {}", desk.people().size(), desk.plan().performers.size(), what);
    if (files.empty()) {
      session.print(sheets + " have changed; nothing was written");
      return;
    }
    const bool people = place == options.pages || !options.one_file() || options.wanted().has("sheets");
    session.print(fmt::format("{}: {}plan {}", place, people ? sheets + ", " : "", desk.stamp().plan));
  };
  if (!options.pages.empty()) told(options.pages, "pages");
  if (!options.output.empty()) told(options.output, "sheets");
}

int run(Session& session, const Options& options) {
  if (auto right = check(options); !right) return session.fail(right.error());
  auto planned = plan_for(session, options.choice, false);
  if (!planned) return session.fail(planned.error());
  if (const auto refused = refusal_of(planned->planned)) return session.fail(*refused);
  for (const std::string& place : {options.output, options.pages}) {
    if (place.empty()) continue;
    if (auto spared = spare_inputs(planned->loaded, place); !spared) return session.fail(spared.error());
  }
  auto people = people_of(planned->loaded.show, options);
  if (!people) return session.fail(people.error());
  const auto charts = charted(planned->plan(), options);
  if (!charts) return session.fail(charts.error());
  Wanted wanted = options.wanted();
  wanted.charts = *charts;
  if (options.one_file() && wanted.has("charts") && !options.only.empty() && charts->size() > 1) {
    return session.fail(input_error("one PDF holds one chart (name it with --formation, or name a folder)"));
  }
  Desk desk(planned->plan(), planned->loaded.show, planned->loaded.rig, format_of(options), *people);
  if (auto added = add_codes(desk, options); !added) return session.fail(added.error());
  if (!options.changed_since.empty()) {
    const auto old = plan_alone(options.changed_since);
    if (!old) return session.fail(old.error());
    desk.keep_changed(*old);
  }
  PaperFiles writer(session, desk);
  if (auto done = write_all(writer, desk, options, wanted); !done) return session.fail(done.error());
  tell_written(session, desk, options, writer.files());
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
  command->add_option("-o,--output", options->output, "a folder for everything, or FILE.pdf for one kind of paper");
  command->add_option("--pages", options->pages, "a folder for everybody's part as a page for a telephone, HTML");
  command->add_option("--base-url", options->base_url,
                      "where the pages will be found: sheets get a QR code that leads there");
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
  session.add_options(*command, true);
  command->footer(
      "Every page carries the title, the show's and the plan's hash. \"part\" at the foot of a sheet stays the same "
      "while\n"
      "the sheet does, so that older sheets can be told to be right still.\n\n"
      "Examples:\n  footlight sheets show.yaml -o out/paper\n  footlight sheets show.yaml -o cards.pdf --cards 4\n"
      "  footlight sheets show.yaml -o ana.pdf --performer \"Ana Ruiz\" --paper phone --language zh\n"
      "  footlight sheets show.yaml -o new.pdf --changed-since monday.plan\n"
      "  footlight sheets show.yaml --pages out/pages -o all.pdf --base-url https://example.org/show/\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
