// SPDX-License-Identifier: Apache-2.0
#include "app/commission/walk.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "config/nearest.hpp"

namespace footlight::app {
namespace {

constexpr std::string_view kBack = "back";
constexpr std::string_view kDead = "dead";

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

}  // namespace

Walk::Walk(const Rig& rig, const Stage& stage, std::vector<FloorLamp> lamps, WalkOrder order)
    : rig_(rig),
      stage_(stage),
      lamps_(std::move(lamps)),
      order_(walking_order(lamps_, stage.grid, order)),
      how_(order) {}

std::string Walk::question() const {
  const FloorLamp& asked = lamps_[lamp()];
  const std::string name = lamp_name(rig_, asked.place);
  const std::string count = fmt::format("{} of {}: {}", position() + 1, order_.size(), name);
  if (!asked.cell) return count + " was never assigned: on which cell does it shine?";
  return fmt::format("{} should be on {}", count, stage_.grid.name(*asked.cell));
}

std::optional<std::size_t> Walk::lamp_on(CellIndex cell) const {
  for (std::size_t i = 0; i < answers_.size(); ++i) {
    if (answers_[i].cell == cell) return order_[i];
  }
  return std::nullopt;
}

Result<CellIndex> Walk::cell_of(std::string_view text) const {
  const auto cell = parse_cell(text);
  if (!cell) {
    return input_error(config::in_quotes(std::string(text)) +
                       " is no answer (Enter: right; a cell, as B4: it shines there; d: dead; b: back; q: stop)");
  }
  const Grid& grid = stage_.grid;
  if (!grid.contains(*cell)) {
    return input_error(fmt::format("{} is beyond the stage (its last cell is {})", cell_name(*cell),
                                   cell_name({grid.columns() - 1, grid.rows() - 1})));
  }
  if (std::ranges::binary_search(stage_.blocked, grid.index(*cell))) {
    return input_error(cell_name(*cell) + " is blocked (a lamp there is nobody's place)");
  }
  return grid.index(*cell);
}

Result<Walk::Said> Walk::answer(std::string_view text) {
  text = trimmed(text);
  if (text == "q") return Said::quit;
  if (text == "b") {
    if (answers_.empty()) return input_error("this is the first lamp");
    answers_.pop_back();
    last_line_ = kBack;
    return Said::back;
  }
  if (finished()) return input_error("every lamp has been asked for");
  const std::size_t asked = lamp();
  const auto note = [&](std::string_view what) {
    last_line_ = fmt::format("{} {} {}", asked, lamp_name(rig_, lamps_[asked].place), what);
  };
  if (text == "d") {
    answers_.push_back({});
    note(kDead);
    return Said::dead;
  }
  std::optional<CellIndex> cell = lamps_[asked].cell;
  if (text.empty() || text == "y") {
    if (!cell) return input_error("the rig does not know where this lamp is (the cell where it shines, as B4)");
  } else {
    if (text.starts_with("n ")) text = trimmed(text.substr(2));
    const auto there = cell_of(text);
    if (!there) return there.error();
    cell = *there;
  }
  if (const auto other = lamp_on(*cell)) {
    return input_error(fmt::format("{} is where {} shines, as you said (b goes back)", stage_.grid.name(*cell),
                                   lamp_name(rig_, lamps_[*other].place)));
  }
  answers_.push_back({cell});
  note(stage_.grid.name(*cell));
  return Said::placed;
}

std::string Walk::head() const {
  return fmt::format("footlight commission walk 1: {} lamps, wiring {:02x}, grid {} x {}, order {}", lamps_.size(),
                     wiring_tag(rig_), stage_.grid.columns(), stage_.grid.rows(),
                     how_ == WalkOrder::floor ? "floor" : "bus");
}

Status<> Walk::take_up(std::string_view text, const std::string& file) {
  answers_.clear();
  int number = 0;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (++number == 1) {
      if (line == head()) continue;
      return input_error(
          fmt::format("{}:1: it is the walk \"{}\", and this one would be \"{}\" (finish it with its own "
                      "rig and order, or take the file away)",
                      file, line, head()));
    }
    const auto wrong = [&](const std::string& why) {
      return input_error(fmt::format("{}:{}: {}: {} (take away this line and those after it)", file, number,
                                     config::in_quotes(std::string(line)), why));
    };
    if (line == kBack) {
      if (answers_.empty()) return wrong("there is nothing to go back to");
      answers_.pop_back();
      continue;
    }
    if (finished()) return wrong("every lamp has its answer already");
    const std::string begin = fmt::format("{} {} ", lamp(), lamp_name(rig_, lamps_[lamp()].place));
    if (!line.starts_with(begin)) return wrong("the next lamp would be \"" + begin + "...\"");
    const std::string_view what = line.substr(begin.size());
    if (what.size() < 2) return wrong("it has no answer");
    if (auto taken = answer(what == kDead ? "d" : what); !taken) return wrong(taken.error().message);
  }
  return Done{};
}

std::vector<std::optional<CellIndex>> Walk::seen() const {
  std::vector<std::optional<CellIndex>> out(lamps_.size());
  for (std::size_t i = 0; i < answers_.size(); ++i) out[order_[i]] = answers_[i].cell;
  return out;
}

std::vector<std::size_t> Walk::dead() const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < answers_.size(); ++i) {
    if (!answers_[i].cell) out.push_back(order_[i]);
  }
  return out;
}

}  // namespace footlight::app
