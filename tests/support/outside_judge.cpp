// SPDX-License-Identifier: Apache-2.0
#include "tests/support/outside_judge.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include <unistd.h>

#include "core/check.hpp"

namespace footlight::tests {
namespace {

namespace fs = std::filesystem;

std::string judges_folder() {
  const char* shared = std::getenv("FOOTLIGHT_SHARED");
  return (shared != nullptr ? fs::path(shared) : fs::path(FOOTLIGHT_SOURCE_DIR) / ".." / "shared") / "check";
}

std::string exact(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

std::string cells_json(const Grid& grid, const std::vector<CellIndex>& cells) {
  std::string out = "[";
  for (const CellIndex index : cells) {
    const Cell cell = grid.cell(index);
    out += (out.size() > 1 ? "," : "") + ("[" + std::to_string(cell.column)) + "," + std::to_string(cell.row) + "]";
  }
  return out + "]";
}

std::string section_json(const Grid& grid, const PlanSection& section) {
  std::string out = R"({"name":")" + section.name + R"(","start_s":)" + exact(to_seconds(section.start)) +
                    R"(,"end_s":)" + exact(to_seconds(section.end));
  if (section.film) {
    const StageToFrame& m = section.film->stage_to_frame;
    out += R"(,"video":"film","frame0":)" + std::to_string(section.film->first_frame) + R"(,"fps":)" +
           exact(section.film->show_fps) + R"(,"threshold":128,"invert":false,"stage_to_frame":[[)" + exact(m[0]) +
           "," + exact(m[1]) + "," + exact(m[2]) + "],[" + exact(m[3]) + "," + exact(m[4]) + "," + exact(m[5]) +
           R"(]],"reserve":)" + cells_json(grid, section.reserve);
  }
  return out + "}";
}

std::string stage_json(const Plan& plan) {
  const Grid& grid = plan.stage.grid;
  std::string out = R"({"grid":{"kind":")" + std::string(to_text(grid.kind())) + R"(","cols":)" +
                    std::to_string(grid.columns()) + R"(,"rows":)" + std::to_string(grid.rows()) + R"(,"pitch_m":)" +
                    exact(grid.pitch_m()) + R"(,"cell_area_m2":)" + exact(grid.cell_area_m2()) + R"(},"blocked":)" +
                    cells_json(grid, plan.stage.blocked) + R"(,"clearance_m":)" + exact(plan.stage.clearance_m) +
                    R"(,"max_speed_m_s":)" + exact(plan.stage.max_speed_mps) + R"(,"cells":[)";
  for (int i = 0; i < grid.size(); ++i) {
    const Cell cell = grid.cell(CellIndex::of(i));
    const Point at = grid.centre(cell);
    out += (i > 0 ? ",[" : "[") + std::to_string(cell.column) + "," + std::to_string(cell.row) + "," + exact(at.x) +
           "," + exact(at.y) + "]";
  }
  out += R"(],"sections":[)";
  for (std::size_t k = 0; k < plan.sections.size(); ++k) {
    out += (k > 0 ? "," : "") + section_json(grid, plan.sections[k]);
  }
  return out + "]}";
}

}  // namespace

std::string OutsideJudge::missing() {
  if (!fs::exists(fs::path(judges_folder()) / "check_marks.py")) {
    return "the outside judges are not here: no check_marks.py in " + judges_folder() +
           " (set FOOTLIGHT_SHARED to the folder that has check/)";
  }
  if (std::system("/usr/bin/python3 -c 'import cv2, numpy, scipy' 2>/dev/null") !=
      0) {  // NOLINT(*-env33-c,*-mt-unsafe)
    return "the outside judges cannot run: python3-opencv, python3-numpy or python3-scipy is not installed";
  }
  return {};
}

OutsideJudge::OutsideJudge() {
  std::string pattern = (fs::temp_directory_path() / "footlight-judge-XXXXXX").string();
  FL_CHECK(mkdtemp(pattern.data()) != nullptr);
  folder_ = pattern;
}

OutsideJudge::~OutsideJudge() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void OutsideJudge::write(const Plan& plan) const {
  std::ofstream marks(folder_ + "/marks.csv");
  marks << "performer,count,time_s,col,row,x_m,y_m,look,section\n";
  for (std::size_t i = 0; i < plan.tracks.size(); ++i) {
    for (const Mark& mark : plan.tracks[i]) {
      const Cell cell = plan.stage.grid.cell(mark.cell);
      const Point at = plan.stage.grid.centre(cell);
      marks << plan.performers[i] << ",1," << exact(to_seconds(mark.time)) << ',' << cell.column << ',' << cell.row
            << ',' << exact(at.x) << ',' << exact(at.y) << ",here,all\n";
    }
  }
  std::ofstream(folder_ + "/stage.json") << stage_json(plan);
}

std::string OutsideJudge::write(const Film& film) const {
  FL_CHECK(film.first_frame == 0);
  for (std::size_t k = 0; k < film.frames.size(); ++k) {
    const Mask& mask = film.frames[k];
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "/frame_%04zu.pgm", k);
    std::ofstream out(folder_ + name.data(), std::ios::binary);
    out << "P5\n" << mask.width() << ' ' << mask.height() << "\n255\n";
    for (int y = 0; y < mask.height(); ++y) {
      for (int x = 0; x < mask.width(); ++x) out.put(mask.at(x, y) ? '\xff' : '\0');
    }
  }
  return folder_ + "/frame_%04d.pgm";
}

std::string OutsideJudge::run(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);  // NOLINT(cert-env33-c)
  FL_CHECK(pipe != nullptr);
  std::string out;
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe.get())) > 0;) out.append(part.data(), n);
  return out;
}

std::string OutsideJudge::check_marks(const std::string& options) const {
  return run("/usr/bin/python3 '" + judges_folder() + "/check_marks.py' '" + folder_ + "' --json " + options);
}

std::string OutsideJudge::theta_dev(const std::string& film, const std::string& section) const {
  return run("/usr/bin/python3 '" + judges_folder() + "/theta_dev.py' '" + folder_ + "' '" + film + "' --section '" +
             section + "' --json");
}

std::optional<double> number_in(const std::string& json, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\": ");
  if (at == std::string::npos) return std::nullopt;
  const char* begin = json.c_str() + at + key.size() + 4;
  char* end = nullptr;
  const double value = std::strtod(begin, &end);
  return end == begin ? std::nullopt : std::optional(value);
}

}  // namespace footlight::tests
