// SPDX-License-Identifier: Apache-2.0
#include "app/import_command.hpp"

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/import/coordinate_list.hpp"
#include "app/import/drone_walks.hpp"
#include "app/import/import_sources.hpp"
#include "app/import/imported_show.hpp"
#include "app/import/new_folder.hpp"
#include "app/import/show_files.hpp"
#include "app/load.hpp"
#include "app/numbers.hpp"
#include "config/quantity.hpp"
#include "planner/plan_show.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::vector<std::string> files;
  std::string folder;
  std::string title;
  std::string like;
  std::string pitch;
  std::string snap;
  std::string unit = "m";
  std::optional<double> tempo;
  bool between_counts = false;
  bool no_plan = false;
  HashLines hashes = HashLines::college;
  FieldDepth depth = FieldDepth::grid;
  config::CountUnit count = config::CountUnit::beat;
};

/// How the plan of what was imported compares with the file.
struct Compared {
  bool valid = false;
  std::string refusal;
  WayDifference difference;
};

/// Everything that is told at the end.
struct Outcome {
  ImportSources sources;
  std::optional<config::Score> score;
  Imported imported;
  FittingGrid grid;
  std::optional<ImportedShow> made;
  std::optional<Compared> compared;
};

Result<std::optional<double>> length_of(const char* option, const std::string& text, const config::Range& range) {
  if (text.empty()) return std::optional<double>();
  const config::ParsedQuantity parsed = config::parse_quantity(text, config::Dimension::length);
  if (!parsed.value) return input_error(fmt::format("{}: {} ({})", option, parsed.text, parsed.hint));
  if (!range.contains(*parsed.value)) {
    return input_error(fmt::format("{}: '{}' is out of range ({})", option, text, config::to_text(range, "m")));
  }
  return parsed.value;
}

/// One import, from files to a folder.
class Import {
 public:
  Import(Session& session, const Options& options) : session_(session), options_(options) {}

  int run() {
    if (auto error = understand()) return session_.fail(*error);
    if (!is_music_alone()) {
      if (auto error = write()) return session_.fail(*error);
    }
    if (!session_.json) {
      for (const std::string& ignored : warnings()) session_.note("not kept: " + ignored);
      for (const std::string& note : notes()) session_.note(note);
    }
    session_.print(session_.json ? json().dump(2) + "\n" : text());
    return 0;
  }

 private:
  [[nodiscard]] bool is_music_alone() const { return out_.sources.tracks.empty() && out_.sources.lists.empty(); }

  std::optional<Error> understand() {
    auto sources = read_import_sources(options_.files);
    if (!sources) return sources.error();
    out_.sources = *std::move(sources);
    if (session_.stopped()) return Error{ErrorKind::interrupted, "interrupted while importing"};
    if (!options_.like.empty()) {
      auto like = read_show(session_, options_.like);
      if (!like) return like.error();
      like_ = std::move(like->show);
    }
    if (auto error = find_tempo()) return error;
    if (is_music_alone()) {
      if (options_.folder.empty()) return std::nullopt;
      return input_error("-o goes with people: of music alone the key 'music' is printed");
    }
    if (options_.folder.empty()) return input_error("say where the show belongs: -o FOLDER");
    return place();
  }

  std::optional<Error> find_tempo() {
    if (out_.sources.score) {
      if (options_.tempo) return input_error("--tempo and a file of music do not go together");
      auto score = config::score_of(*out_.sources.score, options_.count, out_.sources.score_file);
      if (!score) return score.error();
      out_.score = *std::move(score);
      tempo_ = out_.score->tempo;
    } else if (options_.tempo) {
      tempo_ = TempoMap(*options_.tempo, like_ ? like_->tempo.beats_per_measure() : 4);
    } else if (like_) {
      tempo_ = like_->tempo;
    }
    return std::nullopt;
  }

  std::optional<Error> place() {
    const auto pitch = length_of("--pitch", options_.pitch, {kFinestPitch_m, 100});
    if (!pitch) return pitch.error();
    const auto snap = length_of("--snap", options_.snap, {0, 100, true});
    if (!snap) return snap.error();
    GridChoice choice;
    if (like_) choice.grid = like_->stage.grid;
    choice.pitch_m = *pitch;
    choice.snap_m = snap->value_or(0);
    if (like_ && *pitch) return input_error("--pitch and --like do not go together: the show has a grid");
    if (auto error = out_.sources.lists.empty() ? take_tracks(choice) : take_lists(choice)) return error;
    ShowFrame frame{title(), tempo_, out_.score ? out_.score->rehearsals : std::vector<config::Score::Rehearsal>{},
                    like_ ? &*like_ : nullptr};
    auto made = imported_show(out_.imported, out_.grid, frame);
    if (!made) return made.error();
    out_.made = *std::move(made);
    return std::nullopt;
  }

  std::optional<Error> take_tracks(const GridChoice& choice) {
    auto walks = drone_walks(out_.sources.tracks, {tempo_, options_.between_counts, choice});
    if (!walks) return walks.error();
    out_.imported = std::move(walks->imported);
    out_.grid = walks->grid;
    return std::nullopt;
  }

  std::optional<Error> take_lists(GridChoice choice) {
    const std::map<std::string, double> units{{"m", 1}, {"steps", kDrillStep}, {"yd", 0.9144}, {"ft", 0.3048}};
    auto imported =
        read_coordinate_lists(out_.sources.lists, {{options_.hashes, options_.depth}, units.at(options_.unit)});
    if (!imported) return imported.error();
    out_.imported = *std::move(imported);
    std::vector<ImportedPlace> places;
    for (const ImportedFormation& formation : out_.imported.formations) {
      places.insert(places.end(), formation.places.begin(), formation.places.end());
    }
    choice.coarsest_m = out_.imported.step_m > 0 ? out_.imported.step_m : 1;
    auto grid = fitting_grid(out_.imported, places, choice);
    if (!grid) return grid.error();
    out_.grid = *grid;
    return std::nullopt;
  }

  [[nodiscard]] std::string title() const {
    if (!options_.title.empty()) return options_.title;
    if (like_) return like_->title;
    const bool music_first = options_.files.front() == out_.sources.score_file;
    return std::filesystem::path(options_.files[music_first ? 1 : 0]).stem().string();
  }

  std::optional<Error> write() {
    auto folder = NewFolder::make(options_.folder);
    if (!folder) return folder.error();
    std::vector<std::string> remarks{fmt::format("Imported from {} by footlight import.",
                                                 std::filesystem::path(options_.files.front()).filename().string())};
    remarks.insert(remarks.end(), out_.made->notes.begin(), out_.made->notes.end());
    if (auto done = folder->fill(show_files(out_.made->show, remarks)); !done) return done.error();
    auto loaded = config::load_show(folder->path() / "show.yaml");
    if (!loaded) {
      return input_error("what was understood is no show that Footlight takes:\n" +
                         first_errors(loaded.error()).message);
    }
    if (!out_.sources.tracks.empty() && !options_.no_plan) {
      if (auto error = compare(loaded->show)) return error;
    }
    if (session_.stopped()) return Error{ErrorKind::interrupted, "interrupted while importing"};
    if (auto kept = folder->keep(); !kept) return kept.error();
    return std::nullopt;
  }

  std::optional<Error> compare(const Show& show) {
    const std::vector<std::optional<Film>> films(show.sections.size());
    auto planned = planner::plan_show(show, films, session_.progress());
    session_.clear_line();
    if (!planned) return planned.error();
    std::vector<DroneTrack> tracks;
    for (std::size_t p = 0; p < show.performers.size(); ++p) {
      if (!show.performers[p].absent) tracks.push_back(out_.sources.tracks[out_.made->order[p]]);
    }
    out_.compared = Compared{planned->plan.valid, planned->refusal.empty() ? "" : planned->refusal.front(),
                             difference_of(planned->plan, tracks, out_.grid.shift)};
    if (out_.compared->difference.largest_m > 0) {
      const auto& name = tracks[out_.compared->difference.person].name;
      for (std::size_t p = 0; p < out_.imported.people.size(); ++p) {
        if (out_.imported.people[p].name == name) out_.compared->difference.person = p;
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> out;
    if (out_.score) out = out_.score->ignored;
    out.insert(out.end(), out_.imported.ignored.begin(), out_.imported.ignored.end());
    return out;
  }

  /// What was set or came out otherwise, and deserves a word.
  [[nodiscard]] std::vector<std::string> notes() const {
    if (!out_.made) return {};
    std::vector<std::string> out = out_.made->notes;
    if (!out_.compared) return out;
    const WayDifference& difference = out_.compared->difference;
    if (!out_.compared->valid) out.push_back("the plan of it is refused: " + out_.compared->refusal);
    if (difference.people > 0) {
      out.push_back(fmt::format(
          "{} people walk otherwise than in the file between formations; the farthest is {} at {:.3f} s, {:.3f} m away",
          difference.people, out_.imported.people[difference.person].name, to_seconds(difference.when),
          difference.largest_m));
    }
    return out;
  }

  [[nodiscard]] double last_count() const {
    const ImportedFormation& last = out_.imported.formations.back();
    return last.count + last.hold_counts;
  }

  [[nodiscard]] Json music_json() const {
    Json out{{"tempo_changes", tempo_.changes().size()},
             {"meter_changes", tempo_.meters().size() - 1},
             {"first_tempo", tempo_.changes().front().bpm},
             {"beats_per_measure", tempo_.beats_per_measure()},
             {"pickup_counts", tempo_.pickup_counts()}};
    if (!out_.score) return out;
    out["file"] = out_.sources.score_file;
    out["counts"] = out_.score->counts;
    out["duration_s"] = to_seconds(tempo_.at(1 + out_.score->counts));
    Json changes = Json::array();
    for (const TempoChange& change : tempo_.changes()) {
      changes.push_back(
          {{"count", change.count}, {"time_s", to_seconds(tempo_.at(change.count))}, {"tempo", change.bpm}});
    }
    out["changes"] = std::move(changes);
    Json marks = Json::array();
    for (const auto& mark : out_.score->rehearsals) {
      marks.push_back({{"count", mark.count}, {"measure", tempo_.measure_beat(mark.count)}, {"text", mark.text}});
    }
    out["rehearsal_marks"] = std::move(marks);
    return out;
  }

  [[nodiscard]] Json json() const {
    Json out{{"kind", is_music_alone()             ? "music"
                      : out_.sources.lists.empty() ? "tracks"
                                                   : "coordinates"},
             {"files", options_.files},
             {"music", music_json()}};
    if (out_.made) {
      const Grid& grid = out_.made->show.stage.grid;
      out["people"] = out_.imported.people.size();
      out["formations"] = out_.imported.formations.size();
      out["last_count"] = last_count();
      out["grid"] = {{"kind", to_text(grid.kind())},
                     {"columns", grid.columns()},
                     {"rows", grid.rows()},
                     {"pitch_m", grid.pitch_m()}};
      out["shift_m"] = {out_.grid.shift.x, out_.grid.shift.y};
      out["moved"] = {{"places", out_.made->on.moved}, {"largest_m", out_.made->on.largest_move_m}};
      out["show"] = (std::filesystem::path(options_.folder) / "show.yaml").string();
    }
    if (out_.compared) {
      const WayDifference& difference = out_.compared->difference;
      out["plan"] = {{"valid", out_.compared->valid},
                     {"as_in_file", difference.people == 0},
                     {"people_elsewhere", difference.people},
                     {"largest_difference_m", difference.largest_m}};
    }
    out["ignored"] = warnings();
    out["notes"] = notes();
    return out;
  }

  [[nodiscard]] std::string text() const {
    std::string out;
    if (out_.score) {
      out += fmt::format("{}: {:g} counts, {}, {} changes of tempo, {} of meter, {} rehearsal marks\n",
                         out_.sources.score_file, out_.score->counts,
                         clock_text(to_seconds(tempo_.at(1 + out_.score->counts))), tempo_.changes().size() - 1,
                         tempo_.meters().size() - 1, out_.score->rehearsals.size());
    }
    if (out_.made) out += people_text();
    if (out_.made) {
      const std::string show = (std::filesystem::path(options_.folder) / "show.yaml").string();
      return out + fmt::format("{0}\n\nnext:\n  footlight check {0}\n  footlight plan {0}\n", show);
    }
    return out + "\n" + music_yaml(tempo_, out_.score->rehearsals);
  }

  static std::string clock_text(double seconds) {
    const double tenths = std::round(seconds * 10);
    return fmt::format("{:.0f}:{:04.1f}", std::floor(tenths / 600), std::fmod(tenths, 600) / 10);
  }

  [[nodiscard]] std::string people_text() const {
    const Grid& grid = out_.made->show.stage.grid;
    std::string out =
        fmt::format("{} people, {} formations to count {:g}; {} x {} cells of {:g} m\n", out_.imported.people.size(),
                    out_.imported.formations.size(), last_count(), grid.columns(), grid.rows(), grid.pitch_m());
    const Point& shift = out_.grid.shift;
    const auto more = [](double by_m, const char* there, const char* back) {
      return fmt::format("everything lies {:g} m farther {} than in the file\n", std::abs(by_m),
                         by_m > 0 ? there : back);
    };
    if (shift.x != 0) out += more(shift.x, "stage left", "stage right");
    if (shift.y != 0) out += more(shift.y, "upstage", "downstage");
    const OnCells& on = out_.made->on;
    if (on.moved > 0) {
      out += fmt::format("{} places were moved onto cells, the farthest by {:.3f} m: {} in {}\n", on.moved,
                         on.largest_move_m, out_.imported.people[on.farthest_person].name,
                         out_.imported.formations[on.farthest_formation].name);
    }
    if (!out_.compared) return out;
    if (out_.compared->difference.people > 0) return out;
    return out + "the plan of it has everybody where the file has them, at every instant\n";
  }

  static constexpr double kDrillStep = 0.5715;
  Session& session_;
  const Options& options_;
  std::optional<Show> like_;
  TempoMap tempo_;
  Outcome out_;
};

template <class Value>
CLI::Validator choice_of(std::map<std::string, Value> values) {
  return CLI::CheckedTransformer(std::move(values), CLI::ignore_case);
}

void add_choices(CLI::App& command, Options& options) {
  command.add_option("--hash", options.hashes, "hash lines without (HS) or (CH): college or high-school")
      ->transform(choice_of<HashLines>({{"college", HashLines::college}, {"high-school", HashLines::high_school}}))
      ->option_text("KIND");
  command.add_option("--field", options.depth, "grid: 84 steps deep, as drill programs draw it; measured: 160 feet")
      ->transform(choice_of<FieldDepth>({{"grid", FieldDepth::grid}, {"measured", FieldDepth::measured}}))
      ->option_text("KIND");
  command.add_option("--count", options.count, "what a count is in music: beat, note (of the meter) or quarter")
      ->transform(choice_of<config::CountUnit>({{"beat", config::CountUnit::beat},
                                                {"note", config::CountUnit::note},
                                                {"quarter", config::CountUnit::quarter}}))
      ->option_text("UNIT");
}

}  // namespace

void add_import_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("import", "Make a show of other programs' tracks, coordinates and music");
  auto options = std::make_shared<Options>();
  command->add_option("FILE", options->files, "a drone tool's zip or CSV files, coordinate lists, MIDI or MusicXML")
      ->required();
  command->add_option("-o,--output", options->folder, "the folder to make");
  command->add_option("--title", options->title, "title of the show (default: the first file's name)");
  command->add_option("--like", options->like, "a show file whose stage, people and music it shall have");
  command->add_option("--pitch", options->pitch, "of the grid, as '1 m' (default: the largest that fits)");
  command->add_option("--snap", options->snap, "move people onto cells, at most that far, as '0.3 m'");
  command->add_option("--unit", options->unit, "of columns x and y without one: m, steps (8 to 5), yd or ft")
      ->check(CLI::IsMember({"m", "steps", "yd", "ft"}));
  command->add_option("--tempo", options->tempo, "counts a minute where no file of music says it (default: 120)")
      ->check(CLI::Range(1.0, 1000.0));
  command->add_flag("--between-counts", options->between_counts, "formations may be between whole counts");
  command->add_flag("--no-plan", options->no_plan, "do not plan it to compare its walks with the tracks");
  add_choices(*command, *options);
  session.add_options(*command, true);
  command->footer(
      "Examples:\n  footlight import drones.zip -o my-show\n  footlight import drones.zip --like show.yaml -o again\n"
      "  footlight import coordinates.csv march.mid -o field-show\n"
      "  footlight import march.musicxml            # prints the key 'music'\n");
  command->callback(
      [&session, &chosen, options] { chosen = [&, options] { return Import(session, *options).run(); }; });
}

}  // namespace footlight::app
