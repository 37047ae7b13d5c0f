// SPDX-License-Identifier: Apache-2.0
#include "app/paper/sheet.hpp"

#include <algorithm>
#include <cmath>

#include "app/paper/drawn_floor.hpp"
#include "app/paper/qr_code.hpp"
#include "app/paper/way_map.hpp"

namespace footlight::app {
namespace {

constexpr double kGap = 6;       // between columns
constexpr double kRowGap = 4;    // above and below a row's words
constexpr double kFootPt = 5.5;  // size of the footing's words
constexpr double kFootingHeight = 22;
constexpr double kCellRoom = 5.6;  // of a cell's name on a narrow card, in sizes of words
constexpr double kNarrow = 400;    // cards below this width have one column of words
constexpr Ink kInk{0.05, 0.05, 0.05};
constexpr Ink kFaint{0.38, 0.38, 0.38};
constexpr Ink kHair{0, 0, 0, 0.25};

std::string joined(const std::string& a, const std::string& b, const char* between) {
  if (a.empty() || b.empty()) return a + b;
  return a + between + b;
}

std::string way_words(const SheetRow& row) { return joined(row.stay, row.way, "\n"); }
std::string beside_words(const SheetRow& row) { return joined(joined(row.beside, row.closest, "\n"), row.light, "\n"); }
/// Below the cell and its place on a narrow card.
std::string narrow_words(const SheetRow& row) {
  const std::string others = joined(joined(row.beside, row.closest, "   "), row.light, "   ");
  return joined(joined(row.stay, row.way, ", "), others, "\n");
}

}  // namespace

Sheets::Sheets(const Show& show, const Plan& plan, const Stamp& stamp, const SheetFormat& format)
    : show_(show), plan_(plan), stamp_(stamp), format_(format), words_(show, plan, format.words) {
  const PaperSize& paper = format.paper;
  const double width = paper.width_pt / (format.a_page == 4 ? 2 : 1);
  const double height = paper.height_pt / (format.a_page == 1 ? 1 : 2);
  // Cards are cut from the page: each keeps some of the margin.
  const double margin = format.a_page == 1 ? paper.margin_pt : std::min(paper.margin_pt, 20.0);
  card_ = {{margin, margin}, width - 2 * margin, height - 2 * margin};
  columns_ = columns();
}

Sheets::Columns Sheets::columns() const {
  const double size = format_.paper.words_pt;
  Columns out{};
  out.narrow = card_.width < kNarrow;
  out.count = 5.2 * size;
  out.map = (out.narrow ? 5.6 : 4.6) * size;
  const double rest = card_.width - out.count - out.map - kGap * (out.narrow ? 2 : 4);
  out.place = out.narrow ? rest : 0.30 * rest;
  out.way = out.narrow ? 0 : 0.38 * rest;
  out.beside = out.narrow ? 0 : 0.32 * rest;
  return out;
}

Canvas Sheets::document(const std::string& title) const {
  Canvas out = Canvas::pdf(format_.paper.width_pt, format_.paper.height_pt, {title, stamp_.line()});
  out.set_language(code_of(format_.words.language));
  return out;
}

Sheets::Card Sheets::next_card(Canvas& canvas) {
  const int on_page = cards_ % format_.a_page;
  if (cards_ > 0 && on_page == 0) canvas.next_page();
  ++cards_;
  Card out = card_;
  const int across = format_.a_page == 4 ? 2 : 1;
  const double width = format_.paper.width_pt / across;
  const double height = format_.paper.height_pt / (format_.a_page == 1 ? 1 : 2);
  out.corner = out.corner + Point{(on_page % across) * width, (on_page / across) * height};
  if (on_page == 0 && format_.a_page > 1) {  // where to cut
    canvas.ink(kHair);
    canvas.stroke_line({0, height}, {format_.paper.width_pt, height}, 0.3);
    if (across == 2) canvas.stroke_line({width, 0}, {width, format_.paper.height_pt}, 0.3);
  }
  return out;
}

Ink Sheets::colour_of(PerformerIndex who) const {
  const auto& group = show_.performers.at(who.at()).group;
  return ink_of(group ? show_.groups.at(group->at()).colour : show_.default_colour);
}

double Sheets::height_of(const Canvas& canvas, const SheetRow& row) const {
  const double size = format_.paper.words_pt;
  const double cell = 1.9 * size;  // the line with the cell's name, larger
  double words = 0;
  if (columns_.narrow) {
    words = std::max(cell, canvas.height_of(row.place, columns_.place - kCellRoom * size, size)) +
            canvas.height_of(narrow_words(row), columns_.place, size);
  } else {
    words = std::max({cell + canvas.height_of(row.place, columns_.place, size),
                      canvas.height_of(way_words(row), columns_.way, size),
                      canvas.height_of(beside_words(row), columns_.beside, size)});
  }
  return std::max(words, columns_.map) + kRowGap + (row.cue.empty() ? 0 : 2 * size);
}

/// The first row of each card.
std::vector<std::size_t> Sheets::break_rows(const std::vector<double>& heights) const {
  const double size = format_.paper.words_pt;
  const double first = card_.height - 6.6 * size - 1.8 * size - kFootingHeight;
  const double later = card_.height - 2.4 * size - 1.8 * size - kFootingHeight;
  std::vector<std::size_t> out{0};
  double room = first;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (heights[i] > room && i > out.back()) {
      out.push_back(i);
      room = later;
    }
    room -= heights[i];
  }
  return out;
}

void Sheets::draw(Canvas& canvas, PerformerIndex who, const Part& part, const std::string& code) {
  const std::vector<SheetRow> rows = words_.rows_of(part);
  const std::string digits = digits_of(rows);
  std::vector<double> heights;
  for (const SheetRow& one : rows) heights.push_back(height_of(canvas, one));
  const std::vector<std::size_t> breaks = break_rows(heights);
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    const Card card = next_card(canvas);
    if (k == 0) canvas.bookmark(show_.performers.at(who.at()).name);
    const std::string page = breaks.size() == 1 ? ""
                                                : say(format_.words.language, Word::page_of, fmt::arg("page", k + 1),
                                                      fmt::arg("pages", breaks.size()));
    double y = k == 0 ? heading(canvas, card, who, part, code) : heading_of_more(canvas, card, who, page);
    const std::size_t end = k + 1 < breaks.size() ? breaks[k + 1] : rows.size();
    for (std::size_t i = breaks[k]; i < end; ++i) {
      row(canvas, {card.corner.x, y}, rows[i]);
      const double top = y + (rows[i].cue.empty() ? 0 : 2 * format_.paper.words_pt);
      draw_way_map(canvas, {card.corner.x + card.width - columns_.map, top + kRowGap / 2}, columns_.map,
                   plan_.stage.grid, part, i, colour_of(who));
      y += heights[i];
    }
    footing(canvas, card, digits, page);
  }
}

double Sheets::heading(Canvas& canvas, const Card& card, PerformerIndex who, const Part& part,
                       const std::string& code) const {
  const double size = format_.paper.words_pt;
  const Performer& performer = show_.performers.at(who.at());
  const Point at = card.corner;
  const double height = 6.2 * size;
  const double map_width = std::min(0.30 * card.width, 14 * size);
  double room = card.width - map_width - kGap;
  draw_floor_map(canvas, {at.x + card.width - map_width, at.y}, map_width, height, plan_.stage.grid, part,
                 colour_of(who));
  if (const auto square = qr_code(code)) {
    room -= height + kGap;
    draw_code(canvas, {at.x + room + kGap / 2, at.y}, height, *square);
  }
  const std::string name = canvas.shortened(performer.name, 2.6 * size, 0.9 * room);
  canvas.text(name, {at.x, at.y + 2.3 * size}, 2.4 * size, kInk, 0, true);
  const std::string id = performer.id == performer.name ? "" : "  " + performer.id;
  canvas.text(canvas.beginning(stamp_.title + id, size, room), {at.x, at.y + 3.9 * size}, size, kFaint, 0);
  if (performer.group) {
    canvas.ink(colour_of(who));
    canvas.fill_box({at.x, at.y + 4.6 * size}, size, size);
    canvas.ink(kInk);
    canvas.stroke_box({at.x, at.y + 4.6 * size}, size, size, 0.4);
    const std::string group =
        say(format_.words.language, Word::group, fmt::arg("name", show_.groups.at(performer.group->at()).name));
    canvas.text(canvas.shortened(group, size, room - 1.6 * size), {at.x + 1.6 * size, at.y + 5.5 * size}, size, kFaint,
                0);
  }
  column_names(canvas, {at.x, at.y + 6.6 * size});
  return at.y + 8.4 * size;
}

/// Of a page that goes on.
double Sheets::heading_of_more(Canvas& canvas, const Card& card, PerformerIndex who, const std::string& page) const {
  const double size = format_.paper.words_pt;
  const Point at = card.corner;
  canvas.text(canvas.shortened(show_.performers.at(who.at()).name, 1.5 * size, 0.7 * card.width),
              {at.x, at.y + 1.5 * size}, 1.5 * size, kInk, 0, true);
  canvas.text(page, {at.x + card.width, at.y + 1.5 * size}, size, kFaint, 1);
  column_names(canvas, {at.x, at.y + 2.4 * size});
  return at.y + 4.2 * size;
}

void Sheets::column_names(Canvas& canvas, Point at) const {
  const double size = 0.85 * format_.paper.words_pt;
  const Language language = format_.words.language;
  const double base = at.y + 1.2 * size;
  double x = at.x;
  const auto name = [&](Word word, double width) {
    canvas.text(std::string(text_of(language, word)), {x, base}, size, kFaint, 0);
    x += width + kGap;
  };
  name(Word::count_heading, columns_.count);
  name(Word::place_heading, columns_.place);
  if (!columns_.narrow) {
    name(Word::way_heading, columns_.way);
    name(Word::others_heading, columns_.beside);
  }
  name(Word::map_heading, columns_.map);
  canvas.ink(kInk);
  canvas.stroke_line({at.x, at.y + 1.6 * size}, {at.x + card_.width, at.y + 1.6 * size}, 0.6);
}

void Sheets::row(Canvas& canvas, Point at, const SheetRow& row) const {
  const double size = format_.paper.words_pt;
  double y = at.y;
  if (!row.cue.empty()) {
    canvas.ink({0.90, 0.92, 0.95});
    canvas.fill_box({at.x, y + 1}, card_.width, 2 * size - 2);
    canvas.text(canvas.shortened(row.cue, size, card_.width - 4), {at.x + 2, y + 1.35 * size}, size, kInk, 0, true);
    y += 2 * size;
  }
  canvas.ink(kHair);
  canvas.stroke_line({at.x, y}, {at.x + card_.width, y}, 0.3);
  y += kRowGap / 2;
  const double base = y + 1.4 * size;
  canvas.text(row.count, {at.x, base}, 1.5 * size, kInk, 0, true);
  canvas.text(row.measure, {at.x, base + 1.4 * size}, size, kFaint, 0);
  double x = at.x + columns_.count + kGap;
  canvas.text(row.cell, {x, base}, 1.5 * size, kInk, 0, true);
  const double below = y + 1.9 * size;
  if (columns_.narrow) {
    const double beside_cell = columns_.place - kCellRoom * size;
    const double place = canvas.paragraph(row.place, {x + kCellRoom * size, y}, beside_cell, size, kInk);
    canvas.paragraph(narrow_words(row), {x, y + std::max(1.9 * size, place)}, columns_.place, size, kInk);
    return;
  }
  canvas.paragraph(row.place, {x, below}, columns_.place, size, kInk);
  x += columns_.place + kGap;
  canvas.paragraph(way_words(row), {x, y}, columns_.way, size, kInk);
  x += columns_.way + kGap;
  canvas.paragraph(beside_words(row), {x, y}, columns_.beside, size, kFaint);
}

void Sheets::footing(Canvas& canvas, const Card& card, const std::string& digits, const std::string& page) const {
  const Language language = format_.words.language;
  const double top = card.corner.y + card.height - kFootingHeight + 4;
  const std::string legend =
      say(language, Word::legend, fmt::arg("cm", fmt::format("{:g}", 100 * format_.words.step_m)),
          fmt::arg("beats", show_.tempo.beats_per_measure()));
  const double size = stamp_.valid ? kFootPt : kFootPt + 1;
  const std::string part = joined("   part " + digits, page, "   ");
  const std::string stamp = stamp_.line_of(canvas, size, card.width - canvas.width_of(part, size) - 1);
  canvas.paragraph(legend + "\n" + stamp + part, {card.corner.x, top}, card.width, size,
                   stamp_.valid ? kFaint : kOnPaper.refused);
}

}  // namespace footlight::app
