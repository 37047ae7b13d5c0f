// SPDX-License-Identifier: Apache-2.0
#include "config/text_scan.hpp"

#include <algorithm>
#include <cstdio>

namespace footlight::config {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

bool is_forbidden_control(unsigned char c) { return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F; }

std::string hexadecimal(unsigned char c) {
  char text[8];
  std::snprintf(text, sizeof text, "0x%02X", c);
  return text;
}

/// Follows quotes, comments and brackets as far as it takes to know how deep and how long flow collections are. A
/// bracket opens only where a value may begin, so that brackets in plain text do not count.
class FlowScan {
 public:
  explicit FlowScan(const TextLimits& limits) : limits_(limits) {}

  /// @return a finding's text, empty while all is well
  std::string_view take(char c, std::size_t offset) {
    if (c == '\n') {
      comment_ = false;
      if (depth_ == 0) quote_ = 0;
    } else if (comment_) {
      return {};
    }
    if (quote_ != 0) return inside_quotes(c, offset);
    if (c == '#' && (last_ == 0 || blank_before_)) {
      comment_ = true;
    } else if ((c == '"' || c == '\'') && value_may_begin()) {
      quote_ = c;
    } else if ((c == '[' || c == '{') && value_may_begin()) {
      if (depth_ == 0) opened_at_ = offset;
      if (++depth_ > limits_.max_depth) return "lists and mappings are nested too deep";
    } else if ((c == ']' || c == '}') && depth_ > 0) {
      --depth_;
    }
    remember(c);
    return too_long(offset);
  }

 private:
  [[nodiscard]] bool value_may_begin() const {
    return last_ == 0 || last_ == ':' || last_ == '-' || last_ == '?' || last_ == '[' || last_ == '{' || last_ == ',';
  }
  void remember(char c) {
    blank_before_ = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (c == '\n' && depth_ == 0) last_ = 0;
    if (!blank_before_) last_ = c;
  }
  std::string_view inside_quotes(char c, std::size_t offset) {
    if (escaped_) {
      escaped_ = false;
    } else if (c == '\\' && quote_ == '"') {
      escaped_ = true;
    } else if (c == quote_) {
      quote_ = 0;
      last_ = c;
    }
    return too_long(offset);
  }
  [[nodiscard]] std::string_view too_long(std::size_t offset) const {
    return depth_ > 0 && offset - opened_at_ >= limits_.max_flow_bytes ? "a [...] or {...} is too long" : "";
  }

  const TextLimits& limits_;
  int depth_ = 0;
  std::size_t opened_at_ = 0;
  char quote_ = 0;
  char last_ = 0;
  bool escaped_ = false;
  bool comment_ = false;
  bool blank_before_ = true;
};

}  // namespace

LineIndex::LineIndex(std::string_view text) : text_(text), starts_{0} {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') starts_.push_back(i + 1);
  }
}

LineIndex::Place LineIndex::place(int line0, int byte_column0) const {
  const std::size_t line = std::min(static_cast<std::size_t>(std::max(line0, 0)), starts_.size() - 1);
  return place_of(std::min(starts_[line] + static_cast<std::size_t>(std::max(byte_column0, 0)), text_.size()));
}

LineIndex::Place LineIndex::place_of(std::size_t offset) const {
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), std::min(offset, text_.size()));
  const std::size_t start = *std::prev(after);
  const std::string_view before = text_.substr(start, std::min(offset, text_.size()) - start);
  const auto characters = std::count_if(before.begin(), before.end(), [](char c) { return !is_continuation(c); });
  return {static_cast<int>(after - starts_.begin()), static_cast<int>(characters) + 1};
}

std::size_t utf8_length(std::string_view bytes, std::size_t offset) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned char lead = byte(offset);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead <= 0xDF   ? 2
                             : lead >= 0xE0 && lead <= 0xEF ? 3
                             : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                            : 0;
  if (length == 0 || offset + length > bytes.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if (!is_continuation(bytes[offset + k])) return 0;
  }
  const unsigned char second = byte(offset + 1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second >= 0xA0;
  const bool beyond = lead == 0xF4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

std::vector<ScanFinding> scan_text(std::string_view bytes, const TextLimits& limits) {
  FlowScan flow(limits);
  for (std::size_t i = 0; i < bytes.size();) {
    const auto c = static_cast<unsigned char>(bytes[i]);
    if (c == 0) return {{i, "a NUL byte", "a show file is UTF-8 text"}};
    if (is_forbidden_control(c)) {
      return {{i, "the control character " + hexadecimal(c), "a show file is UTF-8 text"}};
    }
    const std::size_t length = utf8_length(bytes, i);
    if (length == 0) return {{i, "the byte " + hexadecimal(c) + " is not UTF-8", "save the file as UTF-8"}};
    const std::string_view finding = flow.take(bytes[i], i);
    if (!finding.empty()) {
      return {{i, std::string(finding),
               "at most " + std::to_string(limits.max_depth) + " levels and " +
                   std::to_string(limits.max_flow_bytes / 1024) + " KiB; long data belong in CSV files"}};
    }
    i += length;
  }
  return {};
}

}  // namespace footlight::config
