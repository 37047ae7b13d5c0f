// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include "config/csv.hpp"
#include "config/nearest.hpp"
#include "config/show_parts.hpp"

namespace footlight::config {
namespace {

/// Colours of a roster's groups where the show file names none: far apart for the eye, none near amber.
constexpr std::array<Colour, 8> kPalette{Colour{0x00, 0x72, 0xFF}, Colour{0xFF, 0x20, 0x20}, Colour{0x20, 0xE0, 0x40},
                                         Colour{0xFF, 0x40, 0xC0}, Colour{0x00, 0xE0, 0xE0}, Colour{0x90, 0x40, 0xFF},
                                         Colour{0xFF, 0xFF, 0xFF}, Colour{0xC0, 0xFF, 0x00}};

constexpr Range kRadii{0, 10, true};   // m
constexpr Range kSpeeds{0, 20, true};  // m/s
constexpr Range kAgilities{0, 4, false};
constexpr Range kReactions{0, 10, false};  // s

std::optional<CsvTable> load_table(ShowReading& show, const std::string& file,
                                   const std::vector<std::string>& columns) {
  Diagnostics& diagnostics = show.reading.diagnostics;
  const auto bytes = read_bounded(file, kMaxCsvBytes);
  if (!bytes) {
    diagnostics.error({file, 0, 0}, "", bytes.error().message);
    return std::nullopt;
  }
  return parse_csv(*bytes, file, columns, diagnostics);
}

/// The column, or an error at the header.
std::optional<std::size_t> needed_column(ShowReading& show, const CsvTable& table, std::string_view name,
                                         const std::string& hint) {
  const auto column = table.column(name);
  if (!column) {
    show.reading.diagnostics.error(table.at(table.header.front()), "",
                                   "the column \"" + std::string(name) + "\" is missing", hint);
  }
  return column;
}

/// One row of a roster after another becomes a performer.
class RosterReader {
 public:
  RosterReader(ShowReading& show, const CsvTable& table)
      : show_(show.show()),
        diagnostics_(show.reading.diagnostics),
        table_(table),
        groups_given_(!show_.groups.empty()) {
    for (std::size_t g = 0; g < show_.groups.size(); ++g) groups_.emplace(show_.groups[g].name, GroupIndex::of(g));
  }

  void read(const std::vector<CsvField>& row, std::size_t id_column) {
    const CsvField& id = row[id_column];
    if (id.text.empty()) return error(id, "the id is empty", "every performer has an id of her own");
    const auto [first, is_new] = lines_.emplace(id.text, id.line);
    if (!is_new) {
      return error(id, "the id " + in_quotes(id.text) + " stands here for the second time",
                   "first in line " + std::to_string(first->second));
    }
    Performer out;
    out.id = id.text;
    out.name = id.text;
    if (const CsvField* name = field(row, "name")) out.name = name->text;
    if (const CsvField* called = field(row, "call_name")) out.name = called->text;
    if (const CsvField* group = field(row, "group")) out.group = group_of(*group);
    out.radius_m = quantity(row, "radius", Dimension::length, kRadii).value_or(0);
    out.max_speed_mps = quantity(row, "speed", Dimension::speed, kSpeeds).value_or(0);
    out.agility = number(row, "agility", kAgilities);
    out.reaction_s = quantity(row, "reaction", Dimension::time, kReactions);
    if (const CsvField* worn = field(row, "wearable")) out.wearable = wearable_of(*worn);
    show_.performers.push_back(std::move(out));
  }

 private:
  void error(const CsvField& at, std::string text, std::string hint) {
    diagnostics_.error(table_.at(at), "", std::move(text), std::move(hint));
  }
  /// The row's field of that name when it is there and not empty.
  const CsvField* field(const std::vector<CsvField>& row, std::string_view name) const {
    const auto column = table_.column(name);
    return column && !row[*column].text.empty() ? &row[*column] : nullptr;
  }
  std::optional<double> quantity(const std::vector<CsvField>& row, std::string_view name, Dimension dimension,
                                 const Range& range) {
    const CsvField* written = field(row, name);
    if (written == nullptr) return std::nullopt;
    const ParsedQuantity parsed = parse_quantity(written->text, dimension);
    if (!parsed.value) {
      error(*written, parsed.text, parsed.hint);
      return std::nullopt;
    }
    return within(*written, *parsed.value, range, base_unit(dimension));
  }
  std::optional<double> number(const std::vector<CsvField>& row, std::string_view name, const Range& range) {
    const CsvField* written = field(row, name);
    if (written == nullptr) return std::nullopt;
    const auto value = parse_number(written->text);
    if (!value) {
      error(*written, in_quotes(written->text) + " is not a number", to_text(range, ""));
      return std::nullopt;
    }
    return within(*written, *value, range, "");
  }
  std::optional<double> within(const CsvField& written, double value, const Range& range, std::string_view unit) {
    if (range.contains(value)) return value;
    error(written, in_quotes(written.text) + " is out of range", to_text(range, unit));
    return std::nullopt;
  }
  std::optional<GroupIndex> group_of(const CsvField& written) {
    const auto known = groups_.find(written.text);
    if (known != groups_.end()) return known->second;
    if (groups_given_) {
      std::vector<std::string> names;
      for (const Group& group : show_.groups) names.push_back(group.name);
      error(written, "no group has the name " + in_quotes(written.text), suggestion(written.text, names, "groups"));
      return std::nullopt;
    }
    show_.groups.push_back({written.text, kPalette.at(show_.groups.size() % kPalette.size())});
    return groups_.emplace(written.text, GroupIndex::of(show_.groups.size() - 1)).first->second;
  }
  std::string wearable_of(const CsvField& written) {
    const auto [first, is_new] = worn_.emplace(written.text, written.line);
    if (!is_new) {
      error(written, "the wearable " + in_quotes(written.text) + " stands here for the second time",
            "first in line " + std::to_string(first->second));
    }
    return written.text;
  }

  Show& show_;
  Diagnostics& diagnostics_;
  const CsvTable& table_;
  bool groups_given_;
  std::unordered_map<std::string, GroupIndex> groups_;
  std::unordered_map<std::string, int> lines_;
  std::unordered_map<std::string, int> worn_;
};

/// Fills one cell for each performer from the rows of a cells file.
class CellsReader {
 public:
  CellsReader(ShowReading& show, const CsvTable& table)
      : show_(show.show()),
        diagnostics_(show.reading.diagnostics),
        table_(table),
        cells_(show_.performers.size()),
        line_of_performer_(show_.performers.size()) {
    for (std::size_t p = 0; p < show_.performers.size(); ++p) ids_.emplace(show_.performers[p].id, p);
    for (std::size_t g = 0; g < show_.groups.size(); ++g) group_names_.push_back(show_.groups[g].name);
  }

  /// One row; without a column of performers the next one of them in the list.
  void read(const std::vector<CsvField>& row) {
    std::size_t who = next_++;
    if (performer_column_) {
      const CsvField& id = row[*performer_column_];
      const auto found = ids_.find(id.text);
      if (found == ids_.end()) return error(id, "no performer has the id " + in_quotes(id.text), ids_hint());
      who = found->second;
      if (line_of_performer_[who] != 0) {
        return error(id, "performer " + id.text + " stands here for the second time",
                     "first in line " + std::to_string(line_of_performer_[who]));
      }
    } else if (who >= cells_.size()) {
      return;  // counted; finish() says so
    }
    if (group_column_ && !read_group(row[*group_column_])) return;
    const CsvField& place = row[cell_column_ ? *cell_column_ : *column_column_];
    line_of_performer_[who] = place.line;
    if (const auto cell = cell_of(row, place)) take(who, *cell, place);
  }

  /// Columns of the place: `cell`, or `col` and `row`.
  bool find_columns() {
    performer_column_ = table_.column("performer");
    cell_column_ = table_.column("cell");
    column_column_ = table_.column("col");
    row_column_ = table_.column("row");
    group_column_ = table_.column("group");
    if (group_column_ && performer_column_) {
      error(table_.header[*group_column_], "the columns \"performer\" and \"group\" do not go together",
            "who stands where by name, or whose places they are");
      return false;
    }
    if (cell_column_ ? !column_column_ && !row_column_ : column_column_ && row_column_) return true;
    error(table_.header.front(),
          "the place of a performer is one column \"cell\" or the two columns \"col\" and \"row\"",
          "performer,col,row with numbers from 0, or performer,cell with names as A1");
    return false;
  }

  CellsSource finish() {
    if (performer_column_) {
      say_who_is_missing();
    } else if (next_ != cells_.size()) {
      diagnostics_.error({table_.file, 0, 0}, "",
                         std::to_string(next_) + " cells for " + std::to_string(cells_.size()) + " performers",
                         "one row for every performer");
    } else if (group_column_ && groups_.size() == cells_.size()) {
      compare_groups();
    }
    return {table_.file, std::move(cells_), performer_column_.has_value(), std::move(groups_)};
  }

 private:
  bool read_group(const CsvField& written) {
    std::optional<GroupIndex> group;
    if (!written.text.empty()) {
      const auto found = std::find(group_names_.begin(), group_names_.end(), written.text);
      if (found == group_names_.end()) {
        error(written, "no group has the name " + in_quotes(written.text),
              group_names_.empty() ? "the show has no groups" : suggestion(written.text, group_names_, "groups"));
        return false;
      }
      group = GroupIndex::of(found - group_names_.begin());
    }
    groups_.push_back(group);
    return true;
  }
  /// As many cells of each group as it has people.
  void compare_groups() {
    std::map<std::optional<GroupIndex>, int> more;
    for (const auto& group : groups_) ++more[group];
    for (const Performer& performer : show_.performers) --more[performer.group];
    for (const auto& [group, cells] : more) {
      if (cells == 0) continue;
      const auto people = std::count_if(show_.performers.begin(), show_.performers.end(),
                                        [&](const Performer& performer) { return performer.group == group; });
      const std::string whose = group ? "the group " + in_quotes(group_names_[group->at()]) : "people without a group";
      diagnostics_.error(
          {table_.file, 0, 0}, "",
          std::to_string(people + cells) + " cells for " + std::to_string(people) + " performers of " + whose,
          "one row for every performer");
    }
  }

  void error(const CsvField& at, std::string text, std::string hint) {
    diagnostics_.error(table_.at(at), "", std::move(text), std::move(hint));
  }
  [[nodiscard]] std::string ids_hint() const {
    return "ids run from " + show_.performers.front().id + " to " + show_.performers.back().id;
  }
  void say_who_is_missing() {
    std::size_t missing = 0;
    std::string first;
    for (std::size_t p = 0; p < line_of_performer_.size(); ++p) {
      if (line_of_performer_[p] != 0) continue;
      if (missing++ == 0) first = show_.performers[p].id;
    }
    if (missing == 0) return;
    diagnostics_.error({table_.file, 0, 0}, "",
                       missing == 1 ? "performer " + first + " has no cell"
                                    : std::to_string(missing) + " performers have no cell, the first is " + first,
                       "one row for every performer");
  }
  void take(std::size_t who, Cell cell, const CsvField& place) {
    const CellIndex index = show_.stage.grid.index(cell);
    if (std::binary_search(show_.stage.blocked.begin(), show_.stage.blocked.end(), index)) {
      return error(place, "the cell " + cell_name(cell) + " is blocked", "nobody can stand on a blocked cell");
    }
    const auto [other, is_free] = who_.emplace(index.value(), who);
    if (!is_free) {
      const std::string first = "first in line " + std::to_string(line_of_performer_[other->second]);
      if (!performer_column_) {
        return error(place, "the cell " + cell_name(cell) + " stands here for the second time", first);
      }
      return error(place,
                   "performers " + show_.performers[other->second].id + " and " + show_.performers[who].id +
                       " both stand on " + cell_name(cell),
                   first);
    }
    cells_[who] = index;
  }
  std::optional<Cell> cell_of(const std::vector<CsvField>& row, const CsvField& place) {
    const Grid& grid = show_.stage.grid;
    std::optional<Cell> cell;
    if (cell_column_) {
      cell = parse_cell(place.text);
      if (!cell) error(place, in_quotes(place.text) + " is not a cell", "write for example A1");
    } else {
      const auto column = number(row[*column_column_]);
      const auto row_number = number(row[*row_column_]);
      if (column && row_number) cell = Cell{*column, *row_number};
    }
    if (!cell || grid.contains(*cell)) return cell;
    const Cell last{grid.columns() - 1, grid.rows() - 1};
    if (cell_column_) {
      error(place, "the cell " + cell_name(*cell) + " is off the grid", "A1 to " + cell_name(last));
    } else {
      error(place, "column " + std::to_string(cell->column) + ", row " + std::to_string(cell->row) + " is off the grid",
            "columns 0 to " + std::to_string(last.column) + ", rows 0 to " + std::to_string(last.row));
    }
    return std::nullopt;
  }
  std::optional<int> number(const CsvField& written) {
    const auto value = parse_integer(written.text);
    if (!value) error(written, in_quotes(written.text) + " is not a whole number", "columns and rows count from 0");
    return value;
  }

  Show& show_;
  Diagnostics& diagnostics_;
  const CsvTable& table_;
  std::vector<CellIndex> cells_;
  std::vector<int> line_of_performer_;
  std::unordered_map<std::string, std::size_t> ids_;
  std::unordered_map<std::uint32_t, std::size_t> who_;
  std::size_t next_ = 0;  // rows read
  std::optional<std::size_t> performer_column_;
  std::optional<std::size_t> cell_column_;
  std::optional<std::size_t> column_column_;
  std::optional<std::size_t> row_column_;
  std::optional<std::size_t> group_column_;
  std::vector<std::string> group_names_;
  std::vector<std::optional<GroupIndex>> groups_;
};

}  // namespace

void read_roster_csv(ShowReading& show, const std::string& file) {
  const auto table = load_table(
      show, file,
      {"id", "name", "call_name", "group", "cast", "cover", "radius", "speed", "agility", "reaction", "wearable"});
  if (!table) return;
  const auto id = needed_column(show, *table, "id", "only id is needed: id,name,group ...");
  if (!id) return;
  if (table->rows.size() > 100'000) {
    show.reading.diagnostics.error({file, 0, 0}, "", std::to_string(table->rows.size()) + " performers",
                                   "at most 100000");
    return;
  }
  RosterReader reader(show, *table);
  for (const auto& row : table->rows) reader.read(row, *id);
  if (table->rows.empty()) {
    show.reading.diagnostics.error({file, 0, 0}, "", "nobody is in the roster", "one row for every performer");
  }
}

CellsSource read_cells_csv(ShowReading& show, const std::string& file) {
  const auto table = load_table(show, file, {"performer", "group", "col", "row", "cell"});
  if (!table || !show.has_stage || !show.has_performers) return {file, {}, true};
  CellsReader reader(show, *table);
  if (!reader.find_columns()) return {file, {}, true};
  for (const auto& row : table->rows) reader.read(row);
  return reader.finish();
}

}  // namespace footlight::config
