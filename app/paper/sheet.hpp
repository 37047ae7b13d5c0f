// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/paper/canvas.hpp"
#include "app/paper/paper_size.hpp"
#include "app/paper/part.hpp"
#include "app/paper/sheet_rows.hpp"
#include "app/paper/stamp.hpp"

namespace footlight::app {

/// How dot sheets are laid out.
struct SheetFormat {
  PaperSize paper = kA4;
  int a_page = 1;  ///< 1 sheet, or 2 or 4 cards to be cut
  PlaceWords words;
};

/// Draws dot sheets: on each page, or card, the performer's name, the way on the floor, and a row for each place. A
/// part that is longer than a page goes on on the next. Borrows everything.
class Sheets {
 public:
  Sheets(const Show& show, const Plan& plan, const Stamp& stamp, const SheetFormat& format);

  /// An empty document of this format's pages.
  [[nodiscard]] Canvas document(const std::string& title) const;
  /// Adds one performer's sheets, beginning on the next free card.
  /// @param code  what a QR code beside the name says; empty, or longer than `kMostCodeBytes`: none
  void draw(Canvas& canvas, PerformerIndex who, const Part& part, const std::string& code = {});
  /// How many pages were begun.
  [[nodiscard]] int pages() const { return (cards_ + format_.a_page - 1) / format_.a_page; }

 private:
  struct Columns {
    double count, place, way, beside, map;  ///< widths; a narrow card has all words in `place`
    bool narrow;
  };
  struct Card {
    Point corner;
    double width, height;
  };
  [[nodiscard]] Card next_card(Canvas& canvas);
  [[nodiscard]] Columns columns() const;
  [[nodiscard]] double height_of(const Canvas& canvas, const SheetRow& row) const;
  [[nodiscard]] std::vector<std::size_t> break_rows(const std::vector<double>& heights) const;
  double heading(Canvas& canvas, const Card& card, PerformerIndex who, const Part& part, const std::string& code) const;
  double heading_of_more(Canvas& canvas, const Card& card, PerformerIndex who, const std::string& page) const;
  void footing(Canvas& canvas, const Card& card, const std::string& digits, const std::string& page) const;
  void column_names(Canvas& canvas, Point at) const;
  void row(Canvas& canvas, Point at, const SheetRow& row) const;
  [[nodiscard]] Ink colour_of(PerformerIndex who) const;

  const Show& show_;
  const Plan& plan_;
  const Stamp& stamp_;
  SheetFormat format_;
  SheetWords words_;
  Columns columns_;
  Card card_;  ///< size of each; the corner is that of the first
  int cards_ = 0;
};

}  // namespace footlight::app
