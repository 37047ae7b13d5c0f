// SPDX-License-Identifier: Apache-2.0
#include "app/import/coordinate_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "app/natural_order.hpp"
#include "config/csv.hpp"
#include "config/nearest.hpp"
#include "config/quantity.hpp"

namespace footlight::app {
namespace {

constexpr double kStep_m = 0.5715;  // 8 to 5
constexpr std::size_t kMostPeople = 100'000;
constexpr double kFar_m = 1e5;

enum class Column { none, who, symbol, set, counts, count, side, depth, x, y };

struct KnownColumn {
  const char* name;  ///< lower case, letters, digits
  Column column;
  double unit_m = 0;  ///< of x and y; 0: as chosen
};
constexpr std::array<KnownColumn, 39> kColumns{{
    {"performer", Column::who},
    {"name", Column::who},
    {"label", Column::who},
    {"id", Column::who},
    {"marcher", Column::who},
    {"drillnumber", Column::who},
    {"symbol", Column::symbol},
    {"set", Column::set},
    {"page", Column::set},
    {"counts", Column::counts},
    {"count", Column::count},
    {"side", Column::side},
    {"sidetoside", Column::side},
    {"side1side2", Column::side},
    {"leftright", Column::side},
    {"lefttoright", Column::side},
    {"lateral", Column::side},
    {"frontback", Column::depth},
    {"fronttoback", Column::depth},
    {"homevisitor", Column::depth},
    {"x", Column::x},
    {"y", Column::y},
    {"xm", Column::x, 1},
    {"ym", Column::y, 1},
    {"xsteps", Column::x, kStep_m},
    {"ysteps", Column::y, kStep_m},
    {"xyd", Column::x, 0.9144},
    {"yyd", Column::y, 0.9144},
    {"xft", Column::x, 0.3048},
    {"yft", Column::y, 0.3048},
    {"measure", Column::none},
    {"measures", Column::none},
    {"zm", Column::none},
    {"z", Column::none},
    {"r", Column::none},
    {"g", Column::none},
    {"b", Column::none},
    {"notes", Column::none},
    {"section", Column::none},
}};

std::string plain_name(std::string_view header) {
  std::string out;
  for (const char c : header) {
    const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9')) out += lower;
  }
  return out;
}

struct Row {
  std::string set;
  double count = 0;  ///< as the column says: of the walk, or of the show
  config::CsvField when;
  ImportedPlace place;
};

/// Rows of all files, person by person.
class ListReader {
 public:
  explicit ListReader(const ListChoice& choice) : choice_(choice) {}

  void read(const ListFile& file) {
    const auto table = config::parse_csv(file.text, file.name, {}, diagnostics_);
    out_.files.push_back(file.name);
    if (!table || !find_columns(*table)) return;
    for (const auto& row : table->rows) read_row(*table, row);
  }

  Result<Imported> finish() {
    if (!diagnostics_.has_errors() && rows_.empty()) {
      diagnostics_.error({out_.files.front(), 0, 0}, "", "no row says where anybody is",
                         "one row for each person and set");
    }
    if (rows_.size() > kMostPeople) {
      diagnostics_.error({out_.files.front(), 0, 0}, "", fmt::format("{} performers", rows_.size()), "at most 100000");
    }
    if (!diagnostics_.has_errors()) make_formations();
    if (diagnostics_.has_errors()) return first_errors(diagnostics_);
    if (hash_assumed_) {
      out_.ignored.push_back(fmt::format("hash lines without their kind: taken as {} (--hash)",
                                         choice_.field.hashes == HashLines::college ? "college" : "high-school"));
    }
    for (const std::string& column : ignored_columns_)
      out_.ignored.push_back("the column " + config::in_quotes(column));
    return std::move(out_);
  }

 private:
  struct Less {
    bool operator()(const std::string& a, const std::string& b) const { return natural_less(a, b); }
  };

  bool find_columns(const config::CsvTable& table) {
    at_.clear();
    units_.clear();
    bool known = true;
    for (std::size_t c = 0; c < table.header.size(); ++c) {
      const std::string name = plain_name(table.header[c].text);
      const auto* found = std::find_if(kColumns.begin(), kColumns.end(), [&](const auto& k) { return k.name == name; });
      if (found == kColumns.end()) {
        std::vector<std::string> names;
        for (const KnownColumn& k : kColumns) names.emplace_back(k.name);
        diagnostics_.error(table.at(table.header[c]), "", "unknown column " + config::in_quotes(table.header[c].text),
                           config::suggestion(name, names, "known columns"));
        known = false;
      } else if (found->column == Column::none) {
        ignored_columns_.insert(table.header[c].text);
      } else if (!at_.emplace(found->column, c).second) {
        diagnostics_.error(table.at(table.header[c]), "",
                           config::in_quotes(table.header[c].text) + " says what a column before it says, too",
                           "keep one of the two");
        known = false;
      } else {
        units_[found->column] = found->unit_m > 0 ? found->unit_m : choice_.unit_m;
      }
    }
    if (has(Column::side)) out_.step_m = kStep_m;
    return known && right_columns(table);
  }

  bool right_columns(const config::CsvTable& table) {
    const auto wrong = [&](const char* what, const char* hint) {
      diagnostics_.error(table.at(table.header.front()), "", what, hint);
      return false;
    };
    const bool words = has(Column::side) && has(Column::depth);
    const bool numbers = has(Column::x) && has(Column::y);
    if (words == numbers) {
      return wrong(R"(the place of a performer is "side to side" and "front-back", or x and y)",
                   "Set,Counts,Side 1-Side 2,Front-Back or set,counts,x_m,y_m");
    }
    if (has(Column::counts) && has(Column::count)) {
      return wrong(R"("counts" and "count" do not go together)",
                   "counts of the walk into the set, or the count of the show");
    }
    if (has(Column::set) && !has(Column::counts) && !has(Column::count)) {
      return wrong("no column says when the sets are", "counts: of the walk into the set; count: of the show, from 1");
    }
    return true;
  }

  [[nodiscard]] bool has(Column column) const { return at_.contains(column); }
  [[nodiscard]] const config::CsvField* field(const std::vector<config::CsvField>& row, Column column) const {
    const auto found = at_.find(column);
    return found == at_.end() ? nullptr : &row[found->second];
  }

  void read_row(const config::CsvTable& table, const std::vector<config::CsvField>& row) {
    const auto place = place_of(table, row);
    Row out;
    if (const auto* set = field(row, Column::set)) out.set = set->text;
    const auto* when = field(row, has(Column::counts) ? Column::counts : Column::count);
    if (when != nullptr) {
      out.when = *when;
      const auto count = config::parse_number(when->text);
      const double least = has(Column::counts) ? 0 : 1;
      if (!count || *count < least || *count > 1e6) {
        diagnostics_.error(table.at(*when), "", config::in_quotes(when->text) + " is no number of counts",
                           fmt::format("{:g} to 1000000", least));
        return;
      }
      out.count = *count;
    }
    if (!place) return;
    out.place = *place;
    rows_[who(table, row)].push_back(std::move(out));
    is_absolute_ = has(Column::count);
  }

  std::string who(const config::CsvTable& table, const std::vector<config::CsvField>& row) {
    const auto* name = field(row, Column::who);
    const auto* symbol = field(row, Column::symbol);
    std::string out = symbol != nullptr ? symbol->text : "";
    if (name != nullptr) out += name->text;
    if (name == nullptr && symbol == nullptr) {
      const std::size_t slash = table.file.find_last_of('/') + 1;
      out = table.file.substr(slash, table.file.rfind('.') > slash ? table.file.rfind('.') - slash : std::string::npos);
    }
    if (out.empty()) diagnostics_.error(table.at(row.front()), "", "nobody is named", "a name or label in every row");
    return out;
  }

  std::optional<ImportedPlace> place_of(const config::CsvTable& table, const std::vector<config::CsvField>& row) {
    const bool words = has(Column::side);
    const config::CsvField& across = *field(row, words ? Column::side : Column::x);
    const config::CsvField& up = *field(row, words ? Column::depth : Column::y);
    const auto x = words ? steps(table, across, side_to_side(across.text)) : number(table, across, Column::x);
    const auto y = words ? steps(table, up, front_to_back(up.text, choice_.field)) : number(table, up, Column::y);
    if (!x || !y) return std::nullopt;
    return ImportedPlace{{*x, *y}, static_cast<int>(out_.files.size()) - 1, across.line, across.column};
  }
  std::optional<double> steps(const config::CsvTable& table, const config::CsvField& field, const DrillSteps& told) {
    hash_assumed_ = hash_assumed_ || told.hash_assumed;
    if (told.steps) return *told.steps * kStep_m;
    Position at = table.at(field);
    at.column += static_cast<int>(told.offset);
    diagnostics_.error(at, "", told.error, told.hint);
    return std::nullopt;
  }
  std::optional<double> number(const config::CsvTable& table, const config::CsvField& field, Column column) {
    const auto value = config::parse_number(field.text);
    if (value && std::abs(*value) <= kFar_m) return *value * units_.at(column);
    diagnostics_.error(table.at(field), "", config::in_quotes(field.text) + " is no number of this column",
                       "a decimal number");
    return std::nullopt;
  }

  [[nodiscard]] Position position(const Row& row) const { return out_.position(row.place); }

  void make_formations() {
    const std::vector<Row>& first = rows_.begin()->second;
    for (const auto& [name, rows] : rows_) out_.people.push_back({name, std::nullopt});
    double at = 1;
    for (std::size_t s = 0; s < first.size(); ++s) {
      if (s > 0) at = is_absolute_ ? first[s].count : at + first[s].count;
      if (s == 0 && is_absolute_) at = first[s].count;
      ImportedFormation formation;
      formation.name = first[s].set.empty() ? fmt::format("formation {}", s + 1) : "set " + first[s].set;
      formation.count = at;
      if (s > 0 && !(at > out_.formations.back().count)) {
        diagnostics_.error(position(first[s]), "",
                           fmt::format("{} is at count {:g}, no later than the set before", formation.name, at),
                           "sets stand in the order in which they are walked");
      }
      out_.formations.push_back(std::move(formation));
    }
    if (!is_absolute_ && first.front().count > 0) {
      out_.ignored.push_back(
          fmt::format("the {:g} counts of the first set: nobody walks into it", first.front().count));
    }
    check_sets();
    if (diagnostics_.has_errors()) return;
    for (const auto& [name, rows] : rows_) {
      for (std::size_t s = 0; s < rows.size(); ++s) out_.formations[s].places.push_back(rows[s].place);
    }
  }

  /// Everybody has the first one's sets at the same counts.
  void check_sets() {
    const auto& [first_name, first] = *rows_.begin();
    std::set<std::string> names;
    for (const Row& row : first) {
      if (!names.insert(row.set).second) {
        diagnostics_.error(
            position(row), "",
            fmt::format("performer {} is in set {} for the second time", first_name, config::in_quotes(row.set)),
            "one row for each person and set");
      }
    }
    for (const auto& [name, rows] : rows_) {
      for (std::size_t s = 0; s < std::min(rows.size(), first.size()); ++s) {
        if (rows[s].set != first[s].set) {
          diagnostics_.error(position(rows[s]), "",
                             fmt::format("performer {} has set {} where {} has set {}", name,
                                         config::in_quotes(rows[s].set), first_name, config::in_quotes(first[s].set)),
                             "everybody has the same sets in the same order");
          break;
        }
        if (rows[s].count != first[s].count) {
          diagnostics_.error(
              {out_.files[static_cast<std::size_t>(rows[s].place.file)], rows[s].when.line, rows[s].when.column}, "",
              fmt::format("{:g} counts for performer {}, {:g} for {} (line {})", rows[s].count, name, first[s].count,
                          first_name, first[s].place.line),
              "a set has the same counts for everybody");
        }
      }
      if (rows.size() == first.size()) continue;
      diagnostics_.error(
          position(rows.back()), "",
          fmt::format("performer {} has {} sets, {} has {}", name, rows.size(), first_name, first.size()),
          "everybody has the same sets in the same order");
    }
  }

  const ListChoice& choice_;
  Diagnostics diagnostics_;
  Imported out_;
  std::map<Column, std::size_t> at_;
  std::map<Column, double> units_;
  std::map<std::string, std::vector<Row>, Less> rows_;
  std::set<std::string> ignored_columns_;
  bool is_absolute_ = false;
  bool hash_assumed_ = false;
};

}  // namespace

Result<Imported> read_coordinate_lists(const std::vector<ListFile>& files, const ListChoice& choice) {
  FL_CHECK(!files.empty());
  ListReader reader(choice);
  for (const ListFile& file : files) reader.read(file);
  return reader.finish();
}

}  // namespace footlight::app
