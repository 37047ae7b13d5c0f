// SPDX-License-Identifier: Apache-2.0
#include "app/import/drill_words.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>
#include <vector>

#include "config/nearest.hpp"
#include "config/quantity.hpp"

namespace footlight::app {
namespace {

constexpr double kStepsAYardLine = 8;
constexpr double kInchesAStep = 22.5;
constexpr double kMostSteps = 100;
constexpr const char* kSideHint = "for example: Side 1: 2.5 steps outside 40 yd ln";
constexpr const char* kDepthHint = "for example: 8.0 steps behind Front Hash (HS)";

struct Token {
  std::string text;  ///< lower case
  std::size_t offset = 0;
};

/// Words and numbers; what stands between them separates and means nothing else.
std::vector<Token> tokens_of(std::string_view text) {
  std::vector<Token> out;
  const auto separates = [](char c) { return std::string_view(" \t:,;()#").find(c) != std::string_view::npos; };
  for (std::size_t i = 0; i < text.size();) {
    if (separates(text[i])) {
      ++i;
      continue;
    }
    Token token{{}, i};
    for (; i < text.size() && !separates(text[i]); ++i) {
      token.text += text[i] >= 'A' && text[i] <= 'Z' ? static_cast<char>(text[i] - 'A' + 'a') : text[i];
    }
    out.push_back(std::move(token));
  }
  return out;
}

/// Takes words from the front as they are expected.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text), tokens_(tokens_of(text)) {}

  [[nodiscard]] bool at_end() const { return i_ == tokens_.size(); }
  [[nodiscard]] std::size_t offset() const { return at_end() ? text_.size() : tokens_[i_].offset; }
  /// Whether the next word is one of these; then it is taken.
  bool take(std::initializer_list<std::string_view> words) {
    if (at_end() || std::find(words.begin(), words.end(), tokens_[i_].text) == words.end()) return false;
    ++i_;
    return true;
  }
  bool take_both(std::string_view first, std::initializer_list<std::string_view> second) {
    if (i_ + 1 >= tokens_.size() || tokens_[i_].text != first) return false;
    if (std::find(second.begin(), second.end(), tokens_[i_ + 1].text) == second.end()) return false;
    i_ += 2;
    return true;
  }
  std::optional<double> number() {
    if (at_end()) return std::nullopt;
    const auto value = config::parse_number(tokens_[i_].text);
    if (value) ++i_;
    return value;
  }
  [[nodiscard]] DrillSteps wrong(const std::string& expected, const char* hint) const {
    return wrong_at(offset(),
                    at_end() ? "the words end where " + expected + " belongs"
                             : config::in_quotes(tokens_[i_].text) + " stands where " + expected + " belongs",
                    hint);
  }
  [[nodiscard]] static DrillSteps wrong_at(std::size_t offset, std::string error, const char* hint) {
    DrillSteps out;
    out.offset = offset;
    out.error = std::move(error);
    out.hint = hint;
    return out;
  }

 private:
  std::string_view text_;
  std::vector<Token> tokens_;
  std::size_t i_ = 0;
};

/// -1 for side 1, +1 for side 2; nothing when no side stands here.
std::optional<int> take_side(Words& words) {
  if (words.take_both("side", {"1", "one", "a"}) || words.take({"s1", "left"})) return -1;
  if (words.take_both("side", {"2", "two", "b"}) || words.take({"s2", "right"})) return 1;
  return std::nullopt;
}

/// How many steps are told, "on" being none.
std::optional<double> take_steps(Words& words) {
  if (words.take({"on", "at"})) return 0;
  const auto steps = words.number();
  if (steps) words.take({"step", "steps", "stp", "stps"});
  return steps;
}

struct Line {
  bool hash = false;
  bool back = false;
  HashLines kind = HashLines::college;
};

double steps_of(const Line& line, FieldDepth depth) {
  if (depth == FieldDepth::grid) {
    if (!line.hash) return line.back ? 84 : 0;
    if (line.kind == HashLines::college) return line.back ? 52 : 32;
    return line.back ? 56 : 28;
  }
  constexpr double kDepth_in = 160 * 12;
  const double hash_in = line.kind == HashLines::college ? 60 * 12 : 53 * 12 + 4;
  const double front_in = line.hash ? hash_in : 0;
  return (line.back ? kDepth_in - front_in : front_in) / kInchesAStep;
}

/// "Front Hash (HS)", "back side line"; nothing when no such line stands here.
std::optional<Line> take_line(Words& words, const DrillField& field, bool& assumed) {
  Line out;
  words.take({"the"});
  if (words.take({"back", "visitor", "visitors", "far"})) {
    out.back = true;
  } else if (!words.take({"front", "home", "near"})) {
    return std::nullopt;
  }
  if (words.take({"sideline"})) return out;
  if (words.take({"side"})) {
    words.take({"line", "ln"});
    return out;
  }
  if (!words.take({"hash"})) return std::nullopt;
  words.take({"line", "mark"});
  out.hash = true;
  if (words.take({"hs"}) || words.take_both("high", {"school"})) {
    out.kind = HashLines::high_school;
  } else if (!words.take({"ch", "co", "college", "ncaa"})) {
    out.kind = field.hashes;
    assumed = true;
  }
  return out;
}

}  // namespace

DrillSteps side_to_side(std::string_view text) {
  Words words(text);
  auto side = take_side(words);
  const std::size_t steps_at = words.offset();
  const auto steps = take_steps(words);
  if (!steps) return words.wrong("a number of steps, or \"on\",", kSideHint);
  if (*steps < 0 || *steps > kMostSteps) return Words::wrong_at(steps_at, "not 0 to 100 steps", kSideHint);
  double outside = 0;
  if (words.take({"outside", "out"})) {
    outside = 1;
  } else if (words.take({"inside", "in"})) {
    outside = -1;
  } else if (*steps > 0) {
    return words.wrong(R"("inside" or "outside")", kSideHint);
  }
  words.take({"of"});
  words.take({"the"});
  if (!side) side = take_side(words);
  const std::size_t yard_at = words.offset();
  const auto yard = words.number();
  if (!yard) return words.wrong("the number of a yard line", kSideHint);
  if (*yard < 0 || *yard > 50 || std::fmod(*yard, 5) != 0) {
    return Words::wrong_at(yard_at, config::plain(*yard) + " is no yard line", "0, 5, 10 .. 50");
  }
  words.take({"yd", "yard", "yds", "yards"});
  words.take({"ln", "line", "lines"});
  if (!side) side = take_side(words);
  if (!words.at_end()) return words.wrong("nothing more", kSideHint);
  const double from_centre = (50 - *yard) / 5 * kStepsAYardLine + outside * *steps;
  if (from_centre < 0) {
    return Words::wrong_at(
        steps_at, config::plain(*steps) + " steps inside the " + config::plain(*yard) + " are on the other side",
        "tell it from that side: outside the yard line there");
  }
  if (from_centre > 0 && !side) {
    return Words::wrong_at(0, "no side is told", "Side 1 or Side 2, unless on the 50 yard line");
  }
  DrillSteps out;
  out.steps = from_centre * side.value_or(1);
  return out;
}

DrillSteps front_to_back(std::string_view text, const DrillField& field) {
  Words words(text);
  const std::size_t steps_at = words.offset();
  const auto steps = take_steps(words);
  if (!steps) return words.wrong("a number of steps, or \"on\",", kDepthHint);
  if (*steps < 0 || *steps > kMostSteps) return Words::wrong_at(steps_at, "not 0 to 100 steps", kDepthHint);
  double behind = 0;
  // Some programs print "frnt".
  if (words.take({"behind"})) {
    behind = 1;
  } else if (words.take_both("in", {"front", "frnt"}) || words.take_both("front", {"of"}) ||
             words.take_both("frnt", {"of"})) {
    behind = -1;
  } else if (*steps > 0) {
    return words.wrong(R"("behind" or "in front of")", kDepthHint);
  }
  words.take({"of"});
  DrillSteps out;
  const auto line = take_line(words, field, out.hash_assumed);
  if (!line) return words.wrong("a hash or side line, front or back,", kDepthHint);
  if (!words.at_end()) return words.wrong(line->hash ? "(HS), (CH) or nothing more" : "nothing more", kDepthHint);
  out.steps = steps_of(*line, field.depth) + behind * *steps;
  return out;
}

}  // namespace footlight::app
