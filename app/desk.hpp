// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/paper/part_page.hpp"
#include "app/paper/sheet.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// What a code on a sheet leads to.
enum class SheetCode {
  none,
  text,     ///< itself: counts and cells, as many as fit
  address,  ///< the performer's page
};

/// Everything that the papers and pages of one run are made from, and how each is made. Borrows plan, show and rig.
class Desk {
 public:
  Desk(const Plan& plan, const Show& show, const Rig& rig, const SheetFormat& format,
       std::vector<PerformerIndex> people);

  /// Sheets have codes from here on. @param base  what stands before the files' names in their address
  void add_codes(SheetCode kind, std::string base);
  /// Keeps only those whose sheets say something else than they would of an earlier plan.
  void keep_changed(const Plan& old);

  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] const Show& show() const { return show_; }
  [[nodiscard]] const Stamp& stamp() const { return stamp_; }
  [[nodiscard]] const SheetFormat& format() const { return format_; }
  /// Whose sheets are wanted, in natural order of names.
  [[nodiscard]] const std::vector<PerformerIndex>& people() const { return people_; }
  /// "Ana-Ruiz": what a performer's files are called, whoever else is wanted.
  [[nodiscard]] const std::string& file_of(PerformerIndex who) const { return files_[who.at()]; }
  [[nodiscard]] std::string address_of(PerformerIndex who) const;

  /// Adds one performer's sheets to a document of `sheets`.
  void draw(Sheets& sheets, Canvas& canvas, PerformerIndex who) const;
  /// One performer's sheets as a file, and how many of its characters no font has.
  [[nodiscard]] std::pair<std::string, int> sheet_pdf(PerformerIndex who) const;
  [[nodiscard]] std::string calls_pdf() const;
  [[nodiscard]] std::string patch_pdf() const;
  [[nodiscard]] std::string floor_pdf() const;
  [[nodiscard]] std::string chart_pdf(FormationIndex formation) const;
  [[nodiscard]] std::string page_html(const PartPages& pages, PerformerIndex who) const;
  [[nodiscard]] std::string index_html() const;

 private:
  [[nodiscard]] std::string list_pdf(const std::string& title, const auto& draw) const;

  const Plan& plan_;
  const Show& show_;
  const Rig& rig_;
  SheetFormat format_;
  Stamp stamp_;
  std::vector<Part> parts_;
  std::vector<PerformerIndex> people_;
  std::vector<std::string> files_;
  SheetCode code_ = SheetCode::none;
  std::string base_;
};

/// Performers in natural order of their names.
void sort_by_name(const Show& show, std::vector<PerformerIndex>& people);

}  // namespace footlight::app
