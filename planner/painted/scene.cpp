// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "planner/painted/gradient_vector_flow.hpp"
#include "planner/painted/lattice_turns.hpp"
#include "planner/painted/seats_in_shape.hpp"
#include "planner/painted/walls.hpp"
#include "planner/painted/way_field.hpp"
#include "planner/parallel.hpp"
#include "planner/plan_section.hpp"

namespace footlight::planner {
namespace {

constexpr double kBackgroundReach_m = 2;   // of its field
constexpr double kLeastStrokeShare = 0.1;  // of the largest piece of its colour
constexpr double kUnknownShare = 0.002;    // of the picture: worth a note
constexpr double kOfItsWidth = 1.75;       // nearer to its line is a stroke's own
constexpr double kBesideShare = 0.15;      // of a stroke's paint: worth a note
constexpr double kNearShape = 0.04;        // of the raster's diagonal, and a stroke's width: its ends meet their shapes

class SceneReader {
 public:
  SceneReader(const SceneTask& task, const Progress& progress)
      : task_(task),
        show_(*task.show),
        section_(show_.sections[task.section.at()]),
        options_(*task.options),
        grid_(show_.stage.grid),
        progress_(progress) {}

  Result<PaintedScene> run() {
    if (auto error = find_parties()) return *error;
    lay_floor();
    const Raster<std::int16_t> marks = read_marks(*task_.picture, options_);
    if (auto error = check_colours(marks)) return *error;
    on_floor_ = marks_on_floor(*task_.picture, marks, out_.picture, out_.floor, out_.width, out_.height);
    read_background();
    for (PaintedScene::Party& party : out_.parties) {
      if (auto error = read_shapes(party)) return *error;
      if (auto error = read_strokes(party)) return *error;
      if (auto error = check_ways(party)) return *error;
    }
    if (!place_people()) return Error{ErrorKind::interrupted, "planning was stopped"};
    return std::move(out_);
  }

 private:
  /// Of the section, or of one of its paints.
  [[nodiscard]] Error error(std::string text, std::string hint) const {
    return input_error(section_message(show_, task_.section, std::move(text), std::move(hint)));
  }
  [[nodiscard]] Error error_at(std::size_t paint, std::string text, std::string hint) const {
    return input_error(message_at(show_, options_.paint[paint].position,
                                  fmt::format("sections[{}].paint[{}]", task_.section.value(), paint), std::move(text),
                                  std::move(hint)));
  }
  [[nodiscard]] std::string path() const {
    const auto* from = std::get_if<PaintingSource>(&section_.from);
    return from == nullptr ? "the painting" : "'" + from->path + "'";
  }
  [[nodiscard]] std::string whose(const std::optional<GroupIndex>& group) const {
    return group ? "group '" + show_.groups[group->at()].name + "'" : "who is in no painted group";
  }

  void lay_floor() {
    out_.picture_width = task_.picture->width;
    out_.picture_height = task_.picture->height;
    out_.picture = lay_down(show_.stage, out_.picture_width, out_.picture_height);
    Point low = grid_.centre(CellIndex(0));
    Point high = low;
    for (int i = 0; i < grid_.size(); ++i) {
      const Point at = grid_.centre(CellIndex::of(i));
      low = {std::min(low.x, at.x), std::min(low.y, at.y)};
      high = {std::max(high.x, at.x), std::max(high.y, at.y)};
    }
    const double edge = grid_.pitch_m() / 2;
    const double width = high.x - low.x + 2 * edge;
    const double height = high.y - low.y + 2 * edge;
    const double floor_pixel = std::max(width, height) / options_.resolution;
    out_.floor = {{low.x - edge, high.y + edge}, floor_pixel};
    out_.width = std::max(1, static_cast<int>(std::ceil(width / floor_pixel - 1e-9)));
    out_.height = std::max(1, static_cast<int>(std::ceil(height / floor_pixel - 1e-9)));
  }

  std::optional<Error> check_colours(const Raster<std::int16_t>& marks) {
    std::vector<std::size_t> pixels(options_.paint.size(), 0);
    std::size_t any = 0;
    for (const std::int16_t mark : marks.cells) {
      if (mark >= 0) ++pixels[static_cast<std::size_t>(mark)];
      any += mark != kFloorMark ? 1 : 0;
    }
    if (any == 0) {
      return error(fmt::format("{} is empty: all of its pixels are white", path()), "paint shapes and strokes on it");
    }
    const auto unknown = unknown_colours(*task_.picture, marks);
    const std::string seen = unknown.empty() ? ""
                                             : fmt::format("the most frequent colour that is bound to nothing is {}",
                                                           to_text(unknown.front().colour));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (pixels[i] > 0) continue;
      return error_at(i, fmt::format("the colour {} is nowhere in {}", to_text(options_.paint[i].colour), path()),
                      seen.empty() ? "paint it, or leave it out" : seen);
    }
    std::size_t nothing = 0;
    for (const UnknownColour& one : unknown) nothing += one.pixels;
    const auto whole = static_cast<double>(marks.cells.size());
    if (static_cast<double>(nothing) < kUnknownShare * whole) return std::nullopt;
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, unknown.size()); ++i) {
      list += (i > 0 ? ", " : "") + to_text(unknown[i].colour);
    }
    out_.notes.push_back(fmt::format("{:.1f} % of the painting mean nothing and are taken for floor: no paint binds {}",
                                     100 * static_cast<double>(nothing) / whole, list));
    return std::nullopt;
  }

  void read_background() {
    out_.background = PixelSet(out_.width, out_.height);
    if (options_.background != PaintedOptions::Background::none) {
      out_.background = pixels_of(on_floor_.marks, kBackgroundMark);
    }
    const bool repels = options_.background == PaintedOptions::Background::repel;
    out_.background_field =
        background_field(out_.background, repels, std::max(2.0, kBackgroundReach_m / out_.floor.pixel_m));
    Stage stage = show_.stage;
    const auto walls = covered_cells(stage, *task_.picture, options_);
    std::set_difference(walls.begin(), walls.end(), stage.blocked.begin(), stage.blocked.end(),
                        std::back_inserter(out_.covered));
    std::vector<CellIndex> all;
    std::merge(stage.blocked.begin(), stage.blocked.end(), out_.covered.begin(), out_.covered.end(),
               std::back_inserter(all));
    stage.blocked = std::move(all);
    out_.ways.emplace(stage, task_.ways->keep_m());
    mark_blocked();
  }

  /// Pixels in which no cell's people could stand: those of cells that cannot be stood on. O(pixels)
  void mark_blocked() {
    out_.blocked = PixelSet(out_.width, out_.height);
    if (out_.ways->open()) return;
    PixelSet walls(out_.width, out_.height);
    std::vector<char> blocked(static_cast<std::size_t>(grid_.size()), 0);
    for (const CellIndex cell : out_.ways->blocked()) blocked[cell.at()] = 1;
    for (int y = 0; y < out_.height; ++y) {
      for (int x = 0; x < out_.width; ++x) {
        walls.at(x, y) = static_cast<std::uint8_t>(blocked[grid_.nearest(floor_point(x, y)).at()]);
      }
    }
    const double keep = out_.ways->keep_m() / out_.floor.pixel_m;
    const Raster<double> away = nearest_pixels(walls).distance_px;
    for (std::size_t i = 0; i < away.cells.size(); ++i) out_.blocked.cells[i] = away.cells[i] - 0.5 < keep ? 1 : 0;
  }
  [[nodiscard]] Point floor_point(int x, int y) const { return out_.floor.to_floor({x + 0.5, y + 0.5}); }

  std::optional<Error> find_parties() {
    std::set<std::optional<GroupIndex>> painted;
    for (const Paint& paint : options_.paint) painted.insert(paint.group);
    std::map<std::optional<GroupIndex>, int> people;
    for (const Performer& performer : show_.performers) {
      const bool own = performer.group && painted.count(performer.group) > 0;
      ++people[own ? performer.group : std::nullopt];
    }
    if (people.count(std::nullopt) > 0 && painted.count(std::nullopt) == 0) {
      return error(fmt::format("{} performers are in no group of the painting", people[std::nullopt]),
                   "bind a shape for everybody else, without a group, or put them into a painted group");
    }
    for (const auto& group : painted) {
      if (people.count(group) == 0) {
        const auto first = std::find_if(options_.paint.begin(), options_.paint.end(),
                                        [&](const Paint& paint) { return paint.group == group; });
        return error_at(static_cast<std::size_t>(first - options_.paint.begin()),
                        group ? fmt::format("nobody is in {}", whose(group)) : "everybody is in a painted group",
                        "leave the paint out, or give it a group that has people");
      }
      PaintedScene::Party party;
      party.group = group;
      party.people = people[group];
      out_.parties.push_back(std::move(party));
    }
    return std::nullopt;
  }

  /// Paints of a party in a role, by their order.
  [[nodiscard]] std::vector<std::size_t> paints(const PaintedScene::Party& party, Paint::Role role) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < options_.paint.size(); ++i) {
      if (options_.paint[i].group == party.group && options_.paint[i].role == role) out.push_back(i);
    }
    std::stable_sort(out.begin(), out.end(),
                     [&](std::size_t a, std::size_t b) { return options_.paint[a].order < options_.paint[b].order; });
    return out;
  }

  [[nodiscard]] std::vector<CellIndex> cells_in(const PixelSet& shape) const {
    std::vector<CellIndex> out;
    for (int i = 0; i < grid_.size(); ++i) {
      const CellIndex cell = CellIndex::of(i);
      if (!out_.ways->can_stand(cell)) continue;
      const Point pixel = out_.floor.to_pixel(grid_.centre(cell));
      if (shape.contains(pixel) && shape.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y)) != 0) {
        out.push_back(cell);
      }
    }
    return out;
  }

  std::optional<Error> read_shapes(PaintedScene::Party& party) {
    const auto shapes = paints(party, Paint::Role::shape);
    if (shapes.size() < 2) {
      return error(
          fmt::format("{} has {} in the painting", whose(party.group), shapes.empty() ? "no shape" : "one shape only"),
          "paint where they stand at the beginning and where at the end, two colours with order 1 and 2");
    }
    for (std::size_t n = 0; n < shapes.size(); ++n) {
      const std::size_t i = shapes[n];
      if (n > 0 && options_.paint[i].order == party.orders.back()) {
        return error_at(
            i, fmt::format("a second shape of {} has the order {}", whose(party.group), options_.paint[i].order),
            "give every shape a place of its own in the sequence");
      }
      PixelSet shape = pixels_of(on_floor_.marks, static_cast<std::int16_t>(i));
      const auto room = cells_in(shape).size();
      if (room < static_cast<std::size_t>(party.people)) {
        return error_at(i,
                        fmt::format("the shape {} has {} free cells for {} people of {}",
                                    to_text(options_.paint[i].colour), room, party.people, whose(party.group)),
                        "paint it larger, or take a finer grid");
      }
      party.orders.push_back(options_.paint[i].order);
      party.shapes.push_back(std::move(shape));
    }
    party.legs.resize(shapes.size() - 1);
    return std::nullopt;
  }

  std::optional<Error> read_strokes(PaintedScene::Party& party) {
    for (const std::size_t i : paints(party, Paint::Role::stroke)) {
      const Paint& paint = options_.paint[i];
      const auto from = std::find(party.orders.begin(), party.orders.end(), paint.order);
      if (from == party.orders.end() || from + 1 == party.orders.end()) {
        return error_at(i,
                        fmt::format("{} has no shape of order {} from which the stroke could lead on",
                                    whose(party.group), paint.order),
                        "a stroke has the order of the shape where it begins");
      }
      const auto leg = static_cast<std::size_t>(from - party.orders.begin());
      const PixelSet all = pixels_of(on_floor_.marks, static_cast<std::int16_t>(i));
      for (const PixelSet& piece : components(all, kLeastStrokeShare)) {
        StrokeResult read = read_stroke(piece, on_floor_.brightness);
        if (!read.stroke) {
          return error_at(i,
                          fmt::format("the stroke {} has no gradient: its brightness does not fall by {:g} of 255 "
                                      "from one end to the other, so that its sense is open",
                                      to_text(paint.colour), kLeastFall),
                          "paint it bright where people come from and dark where they go");
        }
        if (auto wrong = check_stroke(i, party, leg, *read.stroke)) return wrong;
        note_beside(i, *read.stroke);
        party.legs[leg].fields.push_back(flow_field(*read.stroke, out_.width, out_.height));
        party.legs[leg].strokes.push_back(std::move(*read.stroke));
      }
    }
    return std::nullopt;
  }

  std::optional<Error> check_stroke(std::size_t paint, const PaintedScene::Party& party, std::size_t leg,
                                    const Stroke& stroke) const {
    double widest = 0;
    for (const double half : stroke.half_width) widest = std::max(widest, half);
    const double near = 2 * widest + kNearShape * std::hypot(out_.width, out_.height);
    const auto away = [&](const PixelSet& shape, Point end) {
      double least = std::numeric_limits<double>::infinity();
      for (int y = 0; y < shape.height; ++y) {
        for (int x = 0; x < shape.width; ++x) {
          if (shape.at(x, y) != 0) least = std::min(least, distance(end, {x + 0.5, y + 0.5}));
        }
      }
      return least;
    };
    const PixelSet& from = party.shapes[leg];
    const PixelSet& to = party.shapes[leg + 1];
    const Point tail = stroke.line.front();
    const Point head = stroke.line.back();
    const double tail_px = away(from, tail);
    const double head_px = away(to, head);
    if (tail_px <= near && head_px <= near) return std::nullopt;
    const std::string ends =
        fmt::format("shape {} and shape {} of {}", party.orders[leg], party.orders[leg + 1], whose(party.group));
    if (away(from, head) <= near && away(to, tail) <= near) {
      return error_at(paint,
                      fmt::format("the stroke {} leads backwards between {}: its bright end is at shape {}",
                                  to_text(options_.paint[paint].colour), ends, party.orders[leg + 1]),
                      "a stroke is bright where people come from");
    }
    if (background_near(head) || background_near(tail)) {
      return error_at(paint,
                      fmt::format("the background cuts the stroke {} between {}: a piece of it ends there",
                                  to_text(options_.paint[paint].colour), ends),
                      "leave a gap in the background, or lead the stroke around it");
    }
    return error_at(paint,
                    fmt::format("the stroke {} does not connect {}: its tail is {:.1f} m from the one, its head {:.1f} "
                                "m from the other",
                                to_text(options_.paint[paint].colour), ends, tail_px * out_.floor.pixel_m,
                                head_px * out_.floor.pixel_m),
                    fmt::format("draw it out to within {:.1f} m of both", near * out_.floor.pixel_m));
  }

  /// Right beside the end of a stroke.
  [[nodiscard]] bool background_near(Point end) const {
    constexpr int kBeside_px = 2;
    for (int dy = -kBeside_px; dy <= kBeside_px; ++dy) {
      for (int dx = -kBeside_px; dx <= kBeside_px; ++dx) {
        const int x = static_cast<int>(end.x) + dx;
        const int y = static_cast<int>(end.y) + dy;
        if (out_.background.inside(x, y) && out_.background.at(x, y) != 0) return true;
      }
    }
    return false;
  }

  /// Paint of a stroke that its line does not explain.
  void note_beside(std::size_t paint, const Stroke& stroke) {
    std::size_t beside = 0;
    for (int y = 0; y < stroke.pixels.height; ++y) {
      for (int x = 0; x < stroke.pixels.width; ++x) {
        if (stroke.pixels.at(x, y) == 0) continue;
        bool within = false;
        for (std::size_t i = 0; i < stroke.line.size() && !within; ++i) {
          within = distance({x + 0.5, y + 0.5}, stroke.line[i]) <= kOfItsWidth * stroke.half_width[i];
        }
        beside += within ? 0 : 1;
      }
    }
    const double share = static_cast<double>(beside) / static_cast<double>(count(stroke.pixels));
    if (share < kBesideShare) return;
    out_.notes.push_back(
        fmt::format("{:.0f} % of the stroke {} lie beside the line that is read from it: it forks, turns "
                    "back within its own width, or two strokes of this colour cross",
                    100 * share, to_text(options_.paint[paint].colour)));
  }

  std::optional<Error> check_ways(const PaintedScene::Party& party) const {
    for (std::size_t leg = 0; leg < party.legs.size(); ++leg) {
      const WayField way = way_field(out_.blocked, party.shapes[leg + 1]);
      for (const CellIndex cell : cells_in(party.shapes[leg])) {
        const Point pixel = out_.floor.to_pixel(grid_.centre(cell));
        const int x = static_cast<int>(pixel.x);
        const int y = static_cast<int>(pixel.y);
        if (out_.blocked.at(x, y) != 0 || std::isfinite(way.length_px.at(x, y))) continue;
        return error(
            fmt::format("{} cannot come from shape {} to shape {}: what is blocked cuts cell {} off",
                        whose(party.group), party.orders[leg], party.orders[leg + 1], grid_.name(cell)),
            fmt::format("leave a gap of more than {:g} m and a cell in the background", 2 * out_.ways->keep_m()));
      }
    }
    return std::nullopt;
  }

  /// One map for each shape; a party's maps have one lattice, as wide to deep as its first shape.
  bool place_people() {
    struct Job {
      std::size_t party;
      std::size_t shape;
    };
    std::vector<Job> jobs;
    std::vector<Lattice> lattices;
    std::vector<std::vector<LatticeTurn>> turns;
    for (std::size_t p = 0; p < out_.parties.size(); ++p) {
      PaintedScene::Party& party = out_.parties[p];
      lattices.emplace_back(party.people, aspect(party.shapes.front()));
      turns.push_back(lattice_turns(party, lattices.back()));
      party.places.resize(party.shapes.size());
      for (std::size_t s = 0; s < party.shapes.size(); ++s) jobs.push_back({p, s});
    }
    const bool whole = for_each_index(jobs.size(), "painting", progress_, [&](std::size_t j) {
      PaintedScene::Party& party = out_.parties[jobs[j].party];
      const std::size_t s = jobs[j].shape;
      SodmTask task;
      task.shape = &party.shapes[s];
      task.lattice = &lattices[jobs[j].party];
      task.iterations = options_.iterations;
      task.seed = task_.seed;
      task.turn = turns[jobs[j].party][s];
      std::vector<Point> places = sodm(task);
      for (Point& at : places) at = out_.floor.to_floor(at);
      const bool first = s == 0;
      if (first || s + 1 == party.shapes.size()) {
        auto& cells = first ? party.begin : party.end;
        cells = seats_in_shape(grid_, places, cells_in(party.shapes[s]));
        for (std::size_t k = 0; k < places.size(); ++k) places[k] = grid_.centre(cells[k]);
      }
      party.places[s] = std::move(places);
    });
    return whole;
  }

  const SceneTask& task_;
  const Show& show_;
  const Section& section_;
  const PaintedOptions& options_;
  const Grid& grid_;
  const Progress& progress_;
  FloorMarks on_floor_;
  PaintedScene out_;
};

}  // namespace

std::size_t PaintedScene::people() const {
  std::size_t out = 0;
  for (const Party& party : parties) out += static_cast<std::size_t>(party.people);
  return out;
}

std::vector<CellIndex> PaintedScene::begin_cells() const {
  std::vector<CellIndex> out;
  for (const Party& party : parties) out.insert(out.end(), party.begin.begin(), party.begin.end());
  return out;
}

std::vector<CellIndex> PaintedScene::end_cells() const {
  std::vector<CellIndex> out;
  for (const Party& party : parties) out.insert(out.end(), party.end.begin(), party.end.end());
  return out;
}

std::vector<std::optional<GroupIndex>> PaintedScene::groups() const {
  std::vector<std::optional<GroupIndex>> out;
  for (const Party& party : parties) out.insert(out.end(), static_cast<std::size_t>(party.people), party.group);
  return out;
}

Result<PaintedScene> read_painting(const SceneTask& task, const Progress& progress) {
  return SceneReader(task, progress).run();
}

}  // namespace footlight::planner
