// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/paper/canvas.hpp"
#include "app/paper/film_view.hpp"
#include "app/paper/stamp.hpp"
#include "app/paper/view.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// How a preview looks.
struct PreviewStyle {
  Seat seat = Seat::above;
  bool film = false;  ///< what the film shows, and who stands outside of it in a colour of its own
};

/// Who stands outside of the picture where the film is shown: vermilion, which people with any colour vision tell from
/// white (Okabe, Ito 2008).
inline constexpr Ink kOutside{0.835, 0.369, 0.0};

/// Draws the stage at any instant of a show into a box of a canvas. Borrows everything.
class Preview {
 public:
  /// @param films of each section, or null; empty: none
  Preview(const Plan& plan, const Show& show, std::vector<const Film*> films, PreviewStyle style, Point corner,
          double width, double height);

  /// The stage without people, as it is in a section.
  void draw_ground(Canvas& canvas, SectionIndex section) const;
  /// The film and everybody at an instant, over the ground of its section.
  void draw_people(Canvas& canvas, Instant instant) const;
  [[nodiscard]] SectionIndex section_of(Instant instant) const;
  [[nodiscard]] const View& view() const { return view_; }
  /// Radius of a dot there.
  [[nodiscard]] double dot_radius(Point floor) const;

 private:
  void ground_from_audience(Canvas& canvas, SectionIndex section) const;
  void film_from_audience(Canvas& canvas, const Mask& picture, const StageToFrame& placement) const;
  [[nodiscard]] Ink colour_of(std::size_t performer, Point at, SectionIndex section, const Mask* picture) const;

  const Plan& plan_;
  const Show& show_;
  std::vector<FilmView> films_;
  PreviewStyle style_;
  View view_;
  std::vector<std::vector<bool>> reserve_;  ///< of each section, by cell
};

/// A whole picture of one moment after another: title, count and time above the stage, the stamp below. Borrows
/// everything.
class PreviewFrame {
 public:
  PreviewFrame(const Plan& plan, const Show& show, const Stamp& stamp, std::vector<const Film*> films,
               PreviewStyle style, double width, double height);
  /// What does not move in a section: draw it once and copy it.
  void draw_still(Canvas& canvas, SectionIndex section) const;
  /// Over `draw_still` of the instant's section.
  void draw_moving(Canvas& canvas, Instant instant) const;
  [[nodiscard]] const Preview& preview() const { return preview_; }

 private:
  const Plan& plan_;
  const Show& show_;
  const Stamp& stamp_;
  double words_;  ///< their size
  Preview preview_;
};

/// The key formations beside each other, each over its name and count.
void draw_contact_sheet(Canvas& canvas, const Plan& plan, const Show& show, const Stamp& stamp,
                        const std::vector<const Film*>& films, PreviewStyle style);

}  // namespace footlight::app
