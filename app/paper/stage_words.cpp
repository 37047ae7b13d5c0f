// SPDX-License-Identifier: Apache-2.0
#include "app/paper/stage_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace footlight::app {
namespace {

constexpr double kYards5_m = 4.572;
// Of a college football field: hashes 60 feet from the side lines, 160 feet apart.
constexpr double kHash_m = 18.288;
constexpr double kField_m = 48.768;

double quarters(double steps) { return std::round(4 * steps) / 4; }

std::string number(double value) { return fmt::format("{:g}", value); }

std::string across(const PlaceWords& words, double x) {
  const double n = quarters(std::abs(x) / words.step_m);
  if (n == 0) return say(words.language, Word::on_centre);
  return say(words.language, x > 0 ? Word::left_of_centre : Word::right_of_centre, fmt::arg("n", number(n)));
}

std::string up(const PlaceWords& words, const Grid& grid, double y) {
  int nearest = 1;
  double best = std::numeric_limits<double>::infinity();
  for (int row = 1; row <= grid.rows(); ++row) {
    const double away = std::abs(y - grid.centre(Cell{0, row - 1}).y);
    if (!is_named_row(grid, row) || away >= best) continue;
    best = away;
    nearest = row;
  }
  const double n = quarters((y - grid.centre(Cell{0, nearest - 1}).y) / words.step_m);
  const auto row = fmt::arg("row", nearest);
  if (n == 0) return say(words.language, Word::on_row, row);
  return say(words.language, n > 0 ? Word::upstage_of_row : Word::downstage_of_row, fmt::arg("n", number(std::abs(n))),
             row);
}

std::string yard_line(Language language, double x) {
  const int line = std::min(10, static_cast<int>(std::lround(std::abs(x) / kYards5_m)));
  const double n = quarters((std::abs(x) - line * kYards5_m) / kDrillStep_m);
  if (line == 0 && n == 0) return say(language, Word::on_fifty);
  const int side_number = x < 0 ? 1 : 2;
  const int yards = 50 - 5 * line;
  const auto side = fmt::arg("side", side_number);
  const auto yard = fmt::arg("yard", yards);
  if (n == 0) return say(language, Word::side_on_line, side, yard);
  return say(language, n > 0 ? Word::side_outside : Word::side_inside, side, yard, fmt::arg("n", number(std::abs(n))));
}

std::string hash(Language language, double y) {
  constexpr std::pair<double, Word> kLines[] = {{0, Word::front_sideline},
                                                {kHash_m, Word::front_hash},
                                                {kField_m - kHash_m, Word::back_hash},
                                                {kField_m, Word::back_sideline}};
  const auto* nearest = std::ranges::min_element(
      kLines, {}, [&](const std::pair<double, Word>& line) { return std::abs(line.first - y); });
  const double n = quarters((y - nearest->first) / kDrillStep_m);
  const std::string_view name = text_of(language, nearest->second);
  if (n == 0) return say(language, Word::on_line, fmt::arg("line", name));
  return say(language, n > 0 ? Word::behind : Word::in_front_of, fmt::arg("line", name),
             fmt::arg("n", number(std::abs(n))));
}

/// 0 upstage, then every 45 degrees towards stage left.
std::size_t eighth_of(Point walk) {
  const double angle = std::atan2(walk.x, walk.y);
  return static_cast<std::size_t>((std::lround(angle / (std::numbers::pi / 4)) + 8) % 8);
}

}  // namespace

bool is_named_row(const Grid& grid, int row) { return row == 1 || row % (grid.rows() <= 20 ? 5 : 10) == 0; }

std::string place_in_words(const PlaceWords& words, const Grid& grid, Point at) {
  const char* comma = words.language == Language::chinese ? "，" : ", ";
  if (words.style == PlaceStyle::drill) return yard_line(words.language, at.x) + comma + hash(words.language, at.y);
  return across(words, at.x) + comma + up(words, grid, at.y);
}

Word direction_of(Point walk) {
  constexpr Word kWords[] = {Word::upstage,   Word::upstage_left,    Word::stage_left,  Word::downstage_left,
                             Word::downstage, Word::downstage_right, Word::stage_right, Word::upstage_right};
  return kWords[eighth_of(walk)];
}

Word facing_of(Point walk) {
  constexpr Word kWords[] = {Word::backward, Word::backward_left, Word::to_the_left,  Word::forward_left,
                             Word::forward,  Word::forward_right, Word::to_the_right, Word::backward_right};
  return kWords[eighth_of(walk)];
}

std::string spoken_count(double count) {
  std::string out = fmt::format("{:.2f}", count);
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  return out;
}

}  // namespace footlight::app
