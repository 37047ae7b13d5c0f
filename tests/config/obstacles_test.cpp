// SPDX-License-Identifier: Apache-2.0
#include "config/obstacles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "config/show_file.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

using testing::ElementsAre;

Grid grid_of(GridKind kind = GridKind::square) { return *Grid::make(kind, 6, 5, 1.0); }

std::vector<std::string> names(const Grid& grid, const std::vector<CellIndex>& cells) {
  std::vector<std::string> out;
  for (const CellIndex cell : cells) out.push_back(grid.name(cell));
  return out;
}

TEST(Obstacles, ReachIntoCellsAndNotAlongThem) {
  const Grid grid = grid_of();  // x from -3 to 3, y from 0 to 5
  EXPECT_THAT(names(grid, cells_of_polygon(grid, {{-1, 1}, {1, 1}, {1, 2}, {-1, 2}})), ElementsAre("C2", "D2"));
  EXPECT_THAT(names(grid, cells_of_polygon(grid, {{-1, 1}, {-1, 2}, {1.001, 2}, {1.001, 1}})),
              ElementsAre("C2", "D2", "E2"));
}

TEST(Obstacles, MayBeSmallerThanACellOrAWallWithoutWidth) {
  const Grid grid = grid_of();
  EXPECT_THAT(names(grid, cells_of_polygon(grid, {{0.2, 0.2}, {0.3, 0.2}, {0.2, 0.3}})), ElementsAre("D1"));
  EXPECT_THAT(names(grid, cells_of_polygon(grid, {{-2.5, 0.5}, {-0.5, 2.6}, {-2.5, 0.5}})),
              ElementsAre("A1", "A2", "B2", "B3", "C3"));
}

TEST(Obstacles, MayBeConcave) {
  const Grid grid = grid_of();
  // A U around D3 and D4.
  EXPECT_THAT(names(grid, cells_of_polygon(grid, {{-1, 1}, {2, 1}, {2, 4}, {1, 4}, {1, 2}, {0, 2}, {0, 4}, {-1, 4}})),
              ElementsAre("C2", "D2", "E2", "C3", "E3", "C4", "E4"));
}

TEST(Obstacles, CoverEveryCellOfAnyGridThatTheyEnclose) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    const Grid grid = grid_of(kind);
    const auto all = cells_of_polygon(grid, {{-50, -50}, {50, -50}, {50, 50}, {-50, 50}});
    EXPECT_EQ(all.size(), static_cast<std::size_t>(grid.size())) << to_text(kind);
    const auto one = cells_of_polygon(grid, grid.outline(grid.index({3, 2})));
    EXPECT_THAT(names(grid, one), ElementsAre("D3")) << to_text(kind);
  }
}

TEST(Obstacles, OfAMapAreTheCellsUnderItsPixels) {
  const Grid grid = grid_of();
  Mask map(12, 5);
  map.set(0, 0);
  map.set(7, 4);
  EXPECT_THAT(names(grid, cells_of_map(grid, map)), ElementsAre("D1", "A5"));
  Mask coarse(3, 1);
  coarse.set(2, 0);
  EXPECT_EQ(cells_of_map(grid, coarse).size(), 10U);
  Mask all(4, 4);
  for (int i = 0; i < 16; ++i) all.set(i % 4, i / 4);
  for (const GridKind kind : {GridKind::hexagonal, GridKind::triangular}) {
    EXPECT_EQ(cells_of_map(grid_of(kind), all).size(), 30U) << to_text(kind);
  }
}

class StageObstacles : public testing::Test {
 protected:
  Result<LoadedShow, Diagnostics> load(const std::string& obstacles) {
    folder_.write("a.csv", "col,row\n0,0\n");
    folder_.write("show.yaml",
                  "footlight: 1\ntitle: t\nperformers: {count: 1}\n"
                  "sections: [{name: a, from: {cells: a.csv}, start: count 1}]\n"
                  "stage: {grid: {columns: 6, rows: 5}, blocked: [F5], obstacles: [" +
                      obstacles + "]}\n");
    return load_show(folder_.path("show.yaml"));
  }
  std::string errors(const std::string& obstacles) {
    const auto result = load(obstacles);
    EXPECT_FALSE(result);
    return result ? "" : folder_.without_folder(result.error().to_text());
  }
  void map(const std::string& name, int dark_columns) {
    cv::Mat image(5, 6, CV_8U, cv::Scalar(255));
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < dark_columns; ++x) image.at<std::uint8_t>(y, x) = 40;
    }
    cv::imwrite(folder_.path(name).string(), image);
  }

  ShowFolder folder_;
};

TEST_F(StageObstacles, AreBlockedCellsBesideTheListedOnes) {
  const auto result = load("{polygon: [[0 m, 1 m], [2 m, 1 m], [1 m, 2 m]]}");
  ASSERT_TRUE(result) << result.error().to_text();
  EXPECT_THAT(names(result->show.stage.grid, result->show.stage.blocked), ElementsAre("D2", "E2", "F5"));
}

TEST_F(StageObstacles, OfAMapAreItsDarkPixels) {
  map("floor.png", 2);
  const auto result = load("{map: floor.png, threshold: 40}");
  ASSERT_FALSE(result) << "performer 1 stands on A1";
  EXPECT_EQ(folder_.without_folder(result.error().to_text()),
            "a.csv:2:1: error: the cell A1 is blocked (nobody can stand on a blocked cell)\n");
}

TEST_F(StageObstacles, ThatAreNoneAreRefused) {
  map("white.png", 0);
  EXPECT_EQ(errors("{polygon: [[0 m, 1 m], [2 m, 1 m]]}"),
            "show.yaml:5:75: error: stage.obstacles[0].polygon: a polygon has three corners or more, and this has 2 "
            "(write for example [[0 m, 2 m], [4 m, 2 m], [2 m, 5 m]])\n");
  EXPECT_EQ(
      errors("{polygon: [[90 m, 1 m], [92 m, 1 m], [91 m, 7 m]]}"),
      "show.yaml:5:75: error: stage.obstacles[0].polygon: it reaches into no cell of the stage (x from stage right "
      "to stage left with 0 in the middle, y upstage from 0 at the edge)\n");
  EXPECT_EQ(errors("{map: white.png, threshold: 100}"),
            "show.yaml:5:71: error: stage.obstacles[0].map: nothing in the map is in the way (dark pixels are; another "
            "threshold)\n");
  EXPECT_EQ(errors("{map: show.yaml}"),
            "show.yaml:5:71: error: stage.obstacles[0].map: 'show.yaml' cannot be decoded as an image (a whole file is "
            "needed: PNG, JPEG, BMP, PBM, PGM or SVG, of 1 to "
            "16777216 pixels)\n");
}

}  // namespace
}  // namespace footlight::config
