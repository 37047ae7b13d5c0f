// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "core/motion.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

class CollectiveKeys : public testing::Test {
 protected:
  void write(const std::string& planner) {
    folder_.write("show.yaml",
                  "footlight: 1\ntitle: T\nstage: {grid: {columns: 30, rows: 20}}\nperformers: {count: 4}\nsections:\n"
                  "  - {name: a, start: count 1, from: {shape: block}}\n"
                  "  - name: b\n    start: count 9\n    duration: 32 counts\n    from: {shape: circle}\n    planner: " +
                      planner + "\n");
  }
  ShowFolder folder_;
};

TEST_F(CollectiveKeys, AreReadWithTheirUnits) {
  write(
      "{model: collective, collective: {pairing: {cost: manhattan, lambda: 0.25}, forces: {reaction: 800 ms, "
      "repulsion: "
      "3, range: 40 cm, fluctuation: 0}, subgroups: {on: false, cohesion: 2, separation: 0.5, range: 1 m, rigidity: 0, "
      "damping: 0.8, rounds: 50}, feedback: {on: false, bin: 8 m, sectors: 12}}}");
  const auto loaded = load_show(folder_.path("show.yaml"));
  ASSERT_TRUE(loaded) << loaded.error().to_text();
  const Section& section = loaded->show.sections.at(1);
  EXPECT_EQ(section.planner.model, PlannerModel::collective);
  ASSERT_NE(section.motion, nullptr);
  const auto& read = std::get<CollectiveOptions>(section.motion->options);
  EXPECT_EQ(read.pairing, CollectiveOptions::Pairing::manhattan);
  EXPECT_EQ(read.lambda, 0.25);
  EXPECT_EQ(read.reaction_s, 0.8);
  EXPECT_EQ(read.repulsion_mps2, 3);
  EXPECT_EQ(read.repulsion_range_m, 0.4);
  EXPECT_EQ(read.fluctuation_mps2, 0);
  EXPECT_FALSE(read.subgroups);
  EXPECT_EQ(read.cohesion_mps2, 2);
  EXPECT_EQ(read.separation_mps2, 0.5);
  EXPECT_EQ(read.group_range_m, 1);
  EXPECT_EQ(read.rigidity, 0);
  EXPECT_EQ(read.damping, 0.8);
  EXPECT_EQ(read.rounds, 50);
  EXPECT_FALSE(read.feedback);
  EXPECT_EQ(read.bin_m, 8);
  EXPECT_EQ(read.sectors, 12);
}

TEST_F(CollectiveKeys, DefaultsOfTheListingAreThoseOfTheOptions) {
  write("{model: collective}");
  const auto loaded = load_show(folder_.path("show.yaml"));
  ASSERT_TRUE(loaded) << loaded.error().to_text();
  const auto& read = std::get<CollectiveOptions>(loaded->show.sections.at(1).motion->options);
  const CollectiveOptions own;
  EXPECT_EQ(read.pairing, own.pairing);
  EXPECT_EQ(read.lambda, own.lambda);
  EXPECT_EQ(read.reaction_s, own.reaction_s);
  EXPECT_EQ(read.repulsion_mps2, own.repulsion_mps2);
  EXPECT_EQ(read.repulsion_range_m, own.repulsion_range_m);
  EXPECT_EQ(read.fluctuation_mps2, own.fluctuation_mps2);
  EXPECT_EQ(read.subgroups, own.subgroups);
  EXPECT_EQ(read.cohesion_mps2, own.cohesion_mps2);
  EXPECT_EQ(read.separation_mps2, own.separation_mps2);
  EXPECT_EQ(read.group_range_m, own.group_range_m);
  EXPECT_EQ(read.rigidity, own.rigidity);
  EXPECT_EQ(read.damping, own.damping);
  EXPECT_EQ(read.rounds, own.rounds);
  EXPECT_EQ(read.feedback, own.feedback);
  EXPECT_EQ(read.bin_m, own.bin_m);
  EXPECT_EQ(read.sectors, own.sectors);
}

TEST_F(CollectiveKeys, SayWhatIsWrongWithThem) {
  write(
      "{model: collective, collective: {pairing: {cost: least, lambda: 2}, forces: {reaction: 1 m}, subgroups: "
      "{rigidty: 1}, feedback: {sectors: 1}}}");
  const auto loaded = load_show(folder_.path("show.yaml"));
  ASSERT_FALSE(loaded);
  EXPECT_EQ(
      folder_.without_folder(loaded.error().to_text()),
      "show.yaml:11:63: error: sections[1].planner.collective.pairing.cost: \"least\" is not one of the choices (did "
      "you mean \"least effort\"?)\n"
      "show.yaml:11:78: error: sections[1].planner.collective.pairing.lambda: \"2\" is out of range (0 to 1)\n"
      "show.yaml:11:101: error: sections[1].planner.collective.forces.reaction: \"m\" is not a unit of a time (write "
      "for example \"3.2 s\"; units: s, ms, min)\n"
      "show.yaml:11:119: error: sections[1].planner.collective.subgroups.rigidty: unknown key (did you mean "
      "\"rigidity\"?)\n"
      "show.yaml:11:152: error: sections[1].planner.collective.feedback.sectors: \"1\" is out of range (2 to "
      "64)\n");
}

}  // namespace
}  // namespace footlight::config
