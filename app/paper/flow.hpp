// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/paper/canvas.hpp"
#include "app/paper/paper_size.hpp"
#include "app/paper/stamp.hpp"

namespace footlight::app {

/// Words and tables that run from page to page, each page with its title and stamp. Borrows everything.
class Flow {
 public:
  Flow(Canvas& canvas, const PaperSize& paper, const Stamp& stamp);

  /// The next page begins, under this title.
  void begin(const std::string& title);
  void heading(const std::string& words);
  void words(const std::string& words, bool bold = false);
  /// A row of cells with these shares of the width; a cell breaks its lines.
  void row(const std::vector<double>& shares, const std::vector<std::string>& cells, bool bold = false);
  /// Where the next words would begin, for a drawing below the last ones.
  [[nodiscard]] double at() const { return y_; }
  void space(double lines) { y_ += lines * paper_.words_pt; }

 private:
  void page();
  /// Goes on to the next page when there is less room than this.
  void keep(double height);
  [[nodiscard]] double width() const { return paper_.width_pt - 2 * paper_.margin_pt; }

  Canvas& canvas_;
  const PaperSize& paper_;
  const Stamp& stamp_;
  std::string title_;
  double y_ = 0;
  int pages_ = 0;
};

}  // namespace footlight::app
