// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/sodm.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

/// Something that no lattice fits: a horseshoe.
PixelSet horseshoe() {
  PixelSet out(80, 80);
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 80; ++x) {
      const double r = std::hypot(x - 39.5, y - 39.5);
      out.at(x, y) = r <= 38 && r >= 16 && !(y > 40 && x > 25 && x < 55) ? 1 : 0;
    }
  }
  return out;
}

TEST(Lattice, HasAPlaceForEverybodyAndRowsOfNearlyOneLength) {
  EXPECT_TRUE(rc::check([] {
    const int people = *rc::gen::inRange(1, 300);
    const double aspect = *rc::gen::inRange(1, 40) / 10.0;
    const Lattice lattice(people, aspect);
    RC_ASSERT(lattice.people() == people);
    std::vector<int> row(static_cast<std::size_t>(lattice.rows()), 0);
    for (const Point at : lattice.places()) ++row[static_cast<std::size_t>(at.y)];
    const auto [least, most] = std::minmax_element(row.begin(), row.end());
    RC_ASSERT(*most - *least <= 1);
    for (const auto& [a, b] : lattice.neighbours()) {
      RC_ASSERT(a < b && b < people);
      RC_ASSERT(distance(lattice.places()[std::size_t(a)], lattice.places()[std::size_t(b)]) < 1.8);
    }
  }));
}

TEST(Lattice, OfASquareHasTheNeighboursOfAGrid) {
  const Lattice lattice(9, 1);
  EXPECT_EQ(lattice.rows(), 3);
  EXPECT_EQ(lattice.neighbours().size(), 12U);
}

TEST(Sodm, EverybodyIsInTheShapeApartAndBesideHerNeighbours) {
  const PixelSet shape = horseshoe();
  const Lattice lattice(225, 1);
  const SodmTask task{&shape, &lattice, 3000, 1, true, true};
  const MapQuality with = quality(shape, lattice, sodm(task));
  SodmTask without = task;
  without.fit_shape = without.keep_apart = false;
  const MapQuality plain = quality(shape, lattice, sodm(without));
  EXPECT_EQ(with.inside, 1);
  EXPECT_GT(with.separation, 0.5);
  EXPECT_GT(with.coverage, 0.9);
  EXPECT_GT(with.neighbours_kept, 0.7);
  EXPECT_GT(with.separation, 2 * plain.separation);
  EXPECT_GT(with.coverage, plain.coverage);
  EXPECT_GE(with.inside, plain.inside);
}

TEST(Sodm, KeepsNeighboursThatChanceDoesNot) {
  const PixelSet shape = horseshoe();
  const Lattice lattice(100, 1);
  std::vector<Point> random;
  Rng rng(3);
  while (random.size() < 100) {
    const Point p{rng.uniform() * 80, rng.uniform() * 80};
    if (shape.at(int(p.x), int(p.y)) != 0) random.push_back(p);
  }
  const MapQuality with = quality(shape, lattice, sodm({&shape, &lattice, 2000, 1, true, true}));
  EXPECT_GT(with.neighbours_kept, 4 * quality(shape, lattice, random).neighbours_kept);
}

TEST(Sodm, IsTheSameForOneSeedAndAnotherForAnother) {
  const PixelSet shape = horseshoe();
  const Lattice lattice(40, 1);
  const auto first = sodm({&shape, &lattice, 500, 7, true, true});
  EXPECT_EQ(first, sodm({&shape, &lattice, 500, 7, true, true}));
  EXPECT_NE(first, sodm({&shape, &lattice, 500, 8, true, true}));
}

TEST(Sodm, OnePersonInOnePixelStandsInIt) {
  PixelSet shape(5, 5);
  shape.at(3, 1) = 1;
  const Lattice lattice(1, 1);
  const auto places = sodm({&shape, &lattice, 100, 1, true, true});
  ASSERT_EQ(places.size(), 1U);
  EXPECT_NEAR(places[0].x, 3.5, 0.5);
  EXPECT_NEAR(places[0].y, 1.5, 0.5);
}

TEST(Sodm, QualityOfATriangularLatticeIsWhole) {
  PixelSet shape(100, 100, 1);
  const Lattice lattice(4, 1);
  EXPECT_NEAR(ideal_spacing(shape, 4), std::sqrt(2 / std::sqrt(3.0) * 2500), 1e-9);
  const MapQuality q = quality(shape, lattice, {{25, 25}, {75, 25}, {25, 75}, {75, 75}});
  EXPECT_EQ(q.neighbours_kept, 1);
  EXPECT_EQ(q.inside, 1);
  EXPECT_NEAR(q.separation, 50 / ideal_spacing(shape, 4), 1e-12);
}

}  // namespace
}  // namespace footlight::planner
