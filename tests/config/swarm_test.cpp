// SPDX-License-Identifier: Apache-2.0
//
// The particle swarm and the terrain in a show file.
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "config/show_file.hpp"
#include "core/motion.hpp"
#include "core/motion/swarm_options.hpp"
#include "core/terrain.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

class SwarmKeys : public testing::Test {
 protected:
  void SetUp() override {
    cv::Mat image(2, 3, CV_8U);
    for (int n = 0; n < 6; ++n) image.at<std::uint8_t>(n / 3, n % 3) = static_cast<std::uint8_t>(40 * n);
    folder_.write("broken.png", "x");
    cv::imwrite(folder_.path("hills.png").string(), image);
  }
  std::string text(const std::string& stage, const std::string& planner) const {
    return "footlight: 1\ntitle: t\nstage: {grid: {columns: 30, rows: 20}" + stage +
           "}\nperformers: {count: 5}\nsections:\n  - {name: a, from: {shape: line}, start: count 1}\n" +
           "  - {name: b, from: {shape: line}, start: count 2, duration: 60 counts, planner: " + planner + "}\n";
  }
  Show show(const std::string& stage, const std::string& planner) {
    folder_.write("show.yaml", text(stage, planner));
    auto result = load_show(folder_.path("show.yaml"));
    EXPECT_TRUE(result) << (result ? "" : result.error().to_text());
    return result ? result->show : Show();
  }
  std::string errors(const std::string& stage, const std::string& planner) {
    folder_.write("show.yaml", text(stage, planner));
    const auto result = load_show(folder_.path("show.yaml"));
    EXPECT_FALSE(result);
    return result ? "" : folder_.without_folder(result.error().to_text());
  }
  SwarmOptions options(const std::string& planner) {
    const Show read = show("", planner);
    if (read.sections.size() < 2 || !read.sections[1].motion) return {};
    return std::get<SwarmOptions>(read.sections[1].motion->options);
  }

  ShowFolder folder_;
};

TEST_F(SwarmKeys, HaveTheDefaultsOfTheModel) {
  const SwarmOptions out = options("{model: swarm}");
  const SwarmOptions own;
  EXPECT_EQ(out.method, own.method);
  EXPECT_EQ(out.best, own.best);
  EXPECT_EQ(out.inertia, own.inertia);
  EXPECT_EQ(out.cognitive, own.cognitive);
  EXPECT_EQ(out.social, own.social);
  EXPECT_EQ(out.avoid, own.avoid);
  EXPECT_EQ(out.hardness, own.hardness);
  EXPECT_EQ(out.person_m, own.person_m);
  EXPECT_EQ(out.pace_spread, own.pace_spread);
  EXPECT_EQ(out.directions, own.directions);
  EXPECT_NEAR(out.grid_angle_rad, own.grid_angle_rad, 1e-12);
  EXPECT_EQ(out.grid_steps, own.grid_steps);
  EXPECT_EQ(out.slow_m, own.slow_m);
  EXPECT_EQ(out.follow, own.follow);
  EXPECT_EQ(out.step_s, own.step_s);
}

TEST_F(SwarmKeys, AreReadWithTheirUnits) {
  const SwarmOptions out = options(
      "{model: swarm, swarm: {method: original, best: swarm, inertia: 0.7, cognitive: 1, social: 2, avoid: 3, "
      "hardness: "
      "1.5, person: 40 cm, pace_spread: 0.1, directions: 4, grid_angle: 10 deg, grid_steps: 2, slow: 2 m, follow: 0.5, "
      "step: 100 ms}}");
  EXPECT_EQ(out.method, SwarmOptions::Method::original);
  EXPECT_EQ(out.best, SwarmOptions::Best::swarm);
  EXPECT_EQ(out.inertia, 0.7);
  EXPECT_EQ(out.cognitive, 1);
  EXPECT_EQ(out.social, 2);
  EXPECT_EQ(out.avoid, 3);
  EXPECT_EQ(out.hardness, 1.5);
  EXPECT_EQ(out.person_m, 0.4);
  EXPECT_EQ(out.pace_spread, 0.1);
  EXPECT_EQ(out.directions, 4);
  EXPECT_NEAR(out.grid_angle_rad, 0.17453292519943295, 1e-12);
  EXPECT_EQ(out.grid_steps, 2);
  EXPECT_EQ(out.slow_m, 2);
  EXPECT_EQ(out.follow, 0.5);
  EXPECT_EQ(out.step_s, 0.1);
}

TEST_F(SwarmKeys, KBelowOneIsRefused) {
  EXPECT_EQ(errors("", "{model: swarm, swarm: {hardness: 0.5}}"),
            "show.yaml:7:115: error: sections[1].planner.swarm.hardness: \"0.5\" is out of range (1 to 4)\n");
}

TEST_F(SwarmKeys, UnknownOnesAndWrongValuesAreErrors) {
  EXPECT_EQ(
      errors("", "{model: swarm, swarm: {methd: original, grid_angle: 15, best: all}}"),
      "show.yaml:7:105: error: sections[1].planner.swarm.methd: unknown key (did you mean \"method\"?)\n"
      "show.yaml:7:134: error: sections[1].planner.swarm.grid_angle: \"15\" has no unit (write for example \"30 "
      "deg\"; units: rad, deg)\n"
      "show.yaml:7:144: error: sections[1].planner.swarm.best: \"all\" is not one of the choices (choices: target, "
      "swarm)\n");
}

TEST_F(SwarmKeys, GoWithTheModel) {
  EXPECT_EQ(
      errors("", "{model: flat, swarm: {step: 1 s}}"),
      "show.yaml:7:52: error: sections[1].duration: the key has no meaning here (it goes with a video; a single "
      "formation has a hold)\n"
      "show.yaml:7:96: error: sections[1].planner.swarm: the key has no meaning here (it goes with model: swarm)\n");
}

TEST_F(SwarmKeys, TerrainIsAFileAndAShare) {
  const Show read = show(", terrain: {map: hills.png, slowest: 0.4}", "{model: swarm}");
  ASSERT_TRUE(read.terrain);
  EXPECT_EQ(folder_.without_folder(read.terrain->path), "hills.png");
  EXPECT_EQ(read.terrain->slowest, 0.4);
  EXPECT_EQ(read.terrain->width, 3);
  EXPECT_EQ(read.terrain->height, 2);
  EXPECT_EQ(read.terrain->grey, (std::vector<std::uint8_t>{0, 40, 80, 120, 160, 200}));
  EXPECT_FALSE(show("", "{model: swarm}").terrain);
}

TEST_F(SwarmKeys, TerrainOfNothingIsAnError) {
  EXPECT_EQ(errors(", terrain: {map: valleys.png, slowest: 0}", "{model: swarm}"),
            "show.yaml:3:55: error: stage.terrain.map: the file \"valleys.png\" is missing (looked for valleys.png)\n"
            "show.yaml:3:77: error: stage.terrain.slowest: \"0\" is out of range (0.1 to 1)\n");
  EXPECT_EQ(errors(", terrain: {slowest: 0.5}", "{model: swarm}")
                .rfind("show.yaml:3:40: error: stage.terrain.map: the key is missing", 0),
            0U);
  EXPECT_EQ(
      errors(", terrain: {map: broken.png}", "{model: swarm}"),
      "show.yaml:3:55: error: stage.terrain.map: 'broken.png' cannot be decoded as an image (a whole file is needed: "
      "PNG, JPEG, BMP, PBM, PGM or SVG, of 1 to 16777216 pixels)\n");
}

TEST(Terrain, IsEvenBetweenTheMiddlesOfPixels) {
  Terrain hills;
  hills.slowest = 0.2;
  hills.width = 2;
  hills.height = 2;
  hills.grey = {0, 255, 0, 0};  // upstage at stage left
  const Point low{-10, 0};
  const Point high{10, 20};
  EXPECT_DOUBLE_EQ(hills.speed_factor({-10, 20}, low, high), 1);
  EXPECT_DOUBLE_EQ(hills.speed_factor({5, 15}, low, high), 0.2);
  EXPECT_DOUBLE_EQ(hills.speed_factor({10, 20}, low, high), 0.2);
  EXPECT_DOUBLE_EQ(hills.speed_factor({0, 15}, low, high), 0.6);
  EXPECT_DOUBLE_EQ(hills.speed_factor({0, 10}, low, high), 0.8);
  EXPECT_DOUBLE_EQ(hills.speed_factor({9, -5}, low, high), 1) << "beyond the edge as at the edge";
}

}  // namespace
}  // namespace footlight::config
