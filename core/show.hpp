// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/cue_number.hpp"
#include "core/diagnostic.hpp"
#include "core/index.hpp"
#include "core/look.hpp"
#include "core/stage.hpp"
#include "core/tempo_map.hpp"
#include "core/timecode.hpp"

namespace footlight {

/// One person. Order in the show file is the order everywhere.
struct Performer {
  std::string id;    ///< stable, unique; "1".."N" where the show only counts
  std::string name;  ///< as people call her; the id where none is given
  std::optional<GroupIndex> group;
  double radius_m =
      0;  ///< 0: the stage's clearance holds; else two people keep the sum of their radii where that is more
  double max_speed_mps = 0;  ///< 0: the section's or the stage's limit
  std::string wearable;      ///< id of the wearable in the rig; empty: none
  bool absent = false;       ///< does not come: a stand-in takes the places, or they stay empty
  std::string cover{};  ///< of who is absent: id of the understudy or performer who takes the whole way; empty: the
                        ///< planner's choice
  std::optional<double> agility{};     ///< how strongly she steps aside, [0, 4]; nothing: as the model of motion says
  std::optional<double> reaction_s{};  ///< before she gives way to others, [0, 10]; less is quicker; nothing: as above
};

/// Somebody who stands by and has no way of her own until she covers somebody.
struct Understudy {
  std::string id;                      ///< no performer's
  std::string name;                    ///< as people call her; the id where none is given
  std::vector<PerformerIndex> covers;  ///< whom she has learned
  double radius_m = 0;                 ///< as a performer's
  double max_speed_mps = 0;            ///< as a performer's
};

struct Group {
  std::string name;
  Colour colour;
  /// False: from the first formation to the last nobody else takes a place of the group. True: only between formations
  /// that give places to groups.
  bool exchange = true;
};

/// How a picture is laid on the stage.
enum class Fit {
  area,     ///< the largest key frame fills as many cells as there are performers
  contain,  ///< the whole frame fits on the stage without the reserve's columns
  cover,    ///< the stage is covered by the frame
};

/// Colours from the darkest to the lightest of each of red, green and blue, both included (Xu 2015, Eq. 1).
struct ColourRange {
  Colour from;
  Colour to;

  friend bool operator==(const ColourRange&, const ColourRange&) = default;
};

/// What counts as the picture in a frame, and where it lies on the stage.
struct PictureOptions {
  Fit fit = Fit::area;
  std::optional<int> threshold;         ///< 0..255; Otsu over the section when absent
  bool invert = false;                  ///< dark pixels are the picture; of colours: all others
  std::optional<ColourRange> colour{};  ///< of an image in the place of the threshold
};

struct VideoSource {
  std::string path;  ///< as resolved against the show file's folder
  int first_frame = 0;
  std::optional<int> last_frame;  ///< included; the film's last when absent
  PictureOptions picture;
};
struct ImageSource {
  std::string path;
  PictureOptions picture;
};
/// Explicit cells, read from CSV by config. With a `performer` column everybody's cell is given; without one the cells
/// are given and the planner chooses who goes where.
struct CellsSource {
  std::string path;
  std::vector<CellIndex> cells;  ///< as many as performers; of performer p when assigned
  bool assigned = true;          ///< the file says who stands where
  /// Whose place each cell is, where the file has a column of groups (then not assigned); nothing: of who is in none.
  std::vector<std::optional<GroupIndex>> groups{};
};
struct Part;  // core/parts.hpp
/// One formation that is put together of drawings: shapes, lettering, pictures, meshes; each for some of the people.
struct PartsSource {
  std::shared_ptr<const std::vector<Part>> parts;  ///< at least one
};
/// A painting that says where people stand, where they go and what is in the way, by its colours (core/motion.hpp).
struct PaintingSource {
  std::string path;  ///< as resolved against the show file's folder
};
using Source = std::variant<VideoSource, ImageSource, CellsSource, PartsSource, PaintingSource>;

/// Key frames of a video, Li 2020 Eq. 3-4.
struct Sampling {
  Duration interval = milliseconds(3200);  ///< longest time between key frames, show time (the paper's c)
  double hash = 0.10;                      ///< share of differing hash bits that makes a new key frame, (0, 1]
  bool snap_to_count = true;               ///< key frames fall on whole counts
};

/// `joint` is meant for videos; other formations are matched as by `hierarchical`. The last four are models of motion:
/// they lead people along curved ways from the formation before to the section's own.
enum class PlannerModel { flat, hierarchical, joint, collective, srd, painted, swarm };
enum class PairingCost { squared, euclidean };

struct PlannerOptions {
  PlannerModel model = PlannerModel::joint;
  int layers = 2;                  ///< hierarchical: 1..6
  int region_size = 60;            ///< most people in a region of the first division (T_n)
  double region_variance_m2 = 30;  ///< largest mean squared distance from a region's anchor (T_v), m^2
  PairingCost cost = PairingCost::squared;
  double effort = 1;  ///< joint: how much walking counts against the drawing, 0.01..100
};

/// An instant of a video whose frame is one of the director's formations (KF of Li 2020), exact; what is sampled
/// between (p_t) is the planner's.
struct SectionKey {
  std::optional<double> count;  ///< of the music
  double film_s = 0;            ///< without a count: time of the video's file
  Position position;
};

/// The cells of a section's formations that belong to a group.
struct Region {
  GroupIndex group;
  std::vector<CellIndex> cells;  ///< ascending
  Position position;
};

/// What a director changes by hand in one formation of a section; all of it happens at once.
struct Override {
  struct Move {
    CellIndex from;
    CellIndex to;
    Position position;
  };
  struct Place {
    CellIndex cell;
    Position position;
  };
  struct Pin {
    PerformerIndex performer;
    CellIndex cell;
    Position position;
  };
  std::optional<double> count;  ///< the formation at this count
  int number = 0;               ///< without a count: the section's formation with this number, from 1
  std::vector<Move> move;
  std::vector<Place> add;     ///< somebody from the reserve comes here
  std::vector<Place> remove;  ///< who is here goes to the reserve
  std::vector<Pin> pin;
  Position position;
};

struct Motion;   // core/motion.hpp
struct Terrain;  // core/terrain.hpp

/// A stretch of the show with one source of formations: [start, start + duration + hold].
struct Section {
  std::string name;  ///< unique; the stable id
  Source from;
  double start_count = 1;
  /// A video is stretched over it, a model of motion moves people through it; 0 for other images and cells. 0 for a
  /// video: its own length, which is known only when it is decoded (config::settle_film_lengths puts it here).
  double duration_counts = 0;
  double hold_counts = 0;  ///< everybody stands still after the last formation
  Sampling sampling;
  PlannerOptions planner;
  std::shared_ptr<const Motion> motion;  ///< of a model of motion; else nothing
  std::optional<double> max_speed_mps;
  std::vector<SectionKey> keys;  ///< of a video; without any the sampled formations are the key formations
  std::vector<Override> overrides;
  std::vector<Region> regions;
  Position position;  ///< of the section in the show file, for messages

  [[nodiscard]] double end_count() const { return start_count + duration_counts + hold_counts; }
};

enum class ContinueMode { manual, auto_continue, auto_follow };

/// Inputs that gate cues: a trap that is closed, a lift that is level.
inline constexpr std::size_t kMostGates = 32;

/// What GO starts. The continue mode stands on the earlier cue.
struct Cue {
  CueNumber number;
  std::string name;
  SectionIndex section;
  ContinueMode continue_mode = ContinueMode::manual;
  Duration pre_wait{};
  Duration post_wait{};
  std::string notes;
  std::uint32_t gates = 0;  ///< bit g: the cue needs gate g of the show
  Position position;
};

/// What a cell's lamp tells (docs/looks.md).
enum class LampRole {
  here,      ///< somebody stands on it now and stays
  arrive,    ///< somebody walks to it now
  next,      ///< somebody will walk to it at the next move
  handover,  ///< somebody stands on it now and leaves, somebody else is the next here
};
inline constexpr int kLampRoles = 4;

/// Colour (nothing: the group's) and effect of a role.
struct LookChoice {
  std::optional<Colour> colour;
  Effect effect = Effect::steady;
  std::uint8_t brightness = 255;
};

struct Show {
  std::string title;
  std::string version;  ///< as its people call it; empty: it has none
  std::string file;     ///< path of the show file
  Stage stage;
  std::shared_ptr<const Terrain> terrain;  ///< nothing: level ground
  std::vector<Performer> performers;
  std::vector<Understudy> understudies;
  std::vector<Group> groups;
  TempoMap tempo;
  TimeRules time;
  std::vector<Section> sections;   ///< ascending by start, not overlapping
  std::vector<Cue> cues;           ///< ascending by number and by section
  std::vector<std::string> gates;  ///< what has to be closed, in place, clear; at most kMostGates, unique
  std::map<LampRole, LookChoice> looks;
  double announce_counts = 4;            ///< the next places light this long before a move; a count-down
  Colour default_colour{255, 255, 255};  ///< of performers without a group
  std::string rig_file;                  ///< resolved; empty: simulated buses made for the stage
};

}  // namespace footlight
