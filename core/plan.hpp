// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/index.hpp"
#include "core/stage.hpp"
#include "core/time.hpp"

namespace footlight {

/// An instant at which a performer stands on the middle of a cell. Between two marks of one performer the walk is
/// straight and of constant speed; two marks on one cell are a wait.
struct Mark {
  Instant time;
  CellIndex cell;

  friend bool operator==(const Mark&, const Mark&) = default;
};

/// Everybody's cells at one instant that people talk about: a key formation of a video, an image, a list of cells.
struct Formation {
  std::string id;  ///< stable: "growth/12", section name and number from 1
  SectionIndex section;
  double count = 1;  ///< decimal
  Instant time;
  std::optional<int> frame;      ///< of the video's file
  std::vector<CellIndex> cells;  ///< one for each performer, distinct
  int in_picture = 0;            ///< how many stand in the picture; the others are in the reserve or on the way
  bool key = true;  ///< the director's (KF of Li 2020), exact where it is listed; else sampled between (p_t)
  int moved = 0;    ///< people whom the director put elsewhere by hand
  int pinned = 0;   ///< people whom the director put on a cell by name

  friend bool operator==(const Formation&, const Formation&) = default;
};

/// Affine map of stage to frame: pixel = (a x + b y + c, d x + e y + f), metres to pixels, pixel i covering [i, i + 1).
using StageToFrame = std::array<double, 6>;

/// How a section's film lies in show time and on the stage; one of each for a section.
struct FilmPlacement {
  std::string path;
  int first_frame = 0;  ///< shown at the section's start
  int last_frame = 0;   ///< shown at start + duration
  double show_fps = 0;  ///< frames per second of show, after stretching; 0 for an image
  int width = 0;        ///< pixels
  int height = 0;
  int threshold = 128;
  bool inverted = false;
  StageToFrame stage_to_frame{};

  friend bool operator==(const FilmPlacement&, const FilmPlacement&) = default;
};

/// Something round that moves through a section: nobody comes nearer to its edge than to a blocked cell's.
struct PlanObstacle {
  struct At {
    Instant time;
    Point centre;

    friend bool operator==(const At&, const At&) = default;
  };
  double radius_m = 0;
  std::vector<At> at;  ///< strictly ascending; straight and even between, at rest before and after

  friend bool operator==(const PlanObstacle&, const PlanObstacle&) = default;
};

struct PlanSection {
  std::string name;
  Instant start;
  Instant end;
  double max_speed_mps = 0;
  std::optional<FilmPlacement> film;      ///< video or image
  std::vector<CellIndex> reserve;         ///< ascending; who stands here is not in the picture
  std::vector<std::string> notes;         ///< what people should know: scaled by how much, thinned, given way
  std::vector<PlanObstacle> obstacles{};  ///< there from start to end

  friend bool operator==(const PlanSection&, const PlanSection&) = default;
};

/// What the planner adds to a transition between two mark instants for people to read.
struct TransitionFacts {
  Instant start;
  Instant end;
  double clearance_m = 0;  ///< smallest, closed form
  PerformerIndex closest_a;
  PerformerIndex closest_b;
  Instant closest_at;
  double longest_walk_m = 0;
  PerformerIndex longest_walker;
  double tolerated_lag_s = 0;  ///< largest independent lateness without coming too close, capped at 2 s

  friend bool operator==(const TransitionFacts&, const TransitionFacts&) = default;
};

/// Where everybody stands at every instant, with the limits it was proved against.
struct Plan {
  std::string title;
  std::string version;    ///< of the show, as its people call it; empty: it has none
  std::string show_hash;  ///< hex SHA-256 of the show file and everything it reads
  Stage stage;
  std::vector<std::string> performers;  ///< ids, in the order of the tracks
  std::vector<double> radius_m;         ///< one for each performer; 0: the stage's clearance holds
  std::vector<double> max_speed_mps;    ///< one for each performer; 0: the section's limit
  std::vector<PlanSection> sections;
  std::vector<Formation> formations;  ///< ascending by time
  std::vector<std::vector<Mark>>
      tracks;  ///< one for each performer, times strictly increasing, all from first to last instant
  std::vector<TransitionFacts> transitions;
  bool valid = false;  ///< set by `validate` alone

  friend bool operator==(const Plan&, const Plan&) = default;
};

/// Straight-line position between marks; before the first and after the last mark the performer stands. O(log marks)
[[nodiscard]] Point position_at(const Grid& grid, const std::vector<Mark>& track, Instant instant);

}  // namespace footlight
