// SPDX-License-Identifier: Apache-2.0
#include "config/nearest.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace footlight::config {
namespace {

constexpr std::size_t kLongest = 40;  // longer words are nobody's typing error
constexpr std::size_t kListed = 12;

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  std::array<std::vector<int>, 3> rows;  // before last, last, this
  for (auto& row : rows) row.resize(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) rows[1][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    rows[2][0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int change = lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1;
      int best = std::min({rows[1][j] + 1, rows[2][j - 1] + 1, rows[1][j - 1] + change});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1])) {
        best = std::min(best, rows[0][j - 2] + 1);
      }
      rows[2][j] = best;
    }
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
  }
  return rows[1][b.size()];
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.empty() || word.size() > kLongest) return {};
  std::string best;
  int best_distance = std::max(1, static_cast<int>(word.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongest) continue;
    const int distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < static_cast<int>(word.size())) {
      best = candidate;
      best_distance = distance;
    }
  }
  for (std::size_t c = 0; best.empty() && c < candidates.size(); ++c) {  // a word cut short, or gone on with
    const std::size_t shorter = std::min(word.size(), candidates[c].size());
    if (shorter >= 3 && word.substr(0, shorter) == std::string_view(candidates[c]).substr(0, shorter)) {
      best = candidates[c];
    }
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates, std::string_view kind) {
  const std::string best = nearest(word, candidates);
  if (!best.empty()) return "did you mean \"" + best + "\"?";
  if (candidates.empty()) return {};
  std::string out(kind);
  for (std::size_t i = 0; i < std::min(candidates.size(), kListed); ++i) out += (i == 0 ? ": " : ", ") + candidates[i];
  return candidates.size() > kListed ? out + ", ..." : out;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 60;
  std::size_t end = text.size();
  if (end > kShown) {
    end = kShown;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // not inside a character
  }
  std::string out = "\"";
  for (const char c : text.substr(0, end)) out += c == '\n' || c == '\r' || c == '\t' ? ' ' : c;
  return out + (end < text.size() ? "...\"" : "\"");
}

}  // namespace footlight::config
