// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/index.hpp"
#include "core/look.hpp"

namespace footlight {

/// What one colour of a painting means.
struct Paint {
  enum class Role {
    shape,   ///< where people stand: at the beginning, on the way, at the end
    stroke,  ///< the way from one shape to the next; its brightness says the sense
  };
  Colour colour;
  Role role = Role::shape;
  std::optional<GroupIndex> group;  ///< nothing: of everybody in no other paint's group
  int order = 1;                    ///< 1..100; a shape's place in the sequence, a stroke's: leads on from that shape
  /// Shapes: largest difference in one of red, green, blue, 0..255. Strokes: largest difference of the hue, in degrees:
  /// brightness is what a stroke varies.
  double tolerance = 20;
  Position position;
};

/// Kang, Kim, "Crowd Control with Vector Painting", JRPIT 46(2-3), 2014. Names of the paper in brackets.
struct PaintedOptions {
  /// What the grey background does to people.
  enum class Background {
    repel,    ///< stands in the way; people keep away from it (repulsive field)
    attract,  ///< is no obstacle; people gather along its outlines (attractive field)
    none,     ///< is not looked at
  };
  std::vector<Paint> paint;
  Background background = Background::repel;
  int resolution = 128;         ///< pixels of the longer side of the picture that is worked on, 32..512; the paper's 64
  int iterations = 3000;        ///< inputs shown to a map of a shape, at least 20 a person [Eq. 1], 100..1e6
  double grey_tolerance = 12;   ///< largest difference between red, green, blue of a grey, 0..100
  double stroke_force = 1;      ///< weight of the strokes' field [Eq. 3], 0..10
  double background_force = 1;  ///< weight of the background's field (gradient vector flow), 0..10
  double flow_force = 0.5;      ///< weight of the incompressible flow within strokes [Eq. 4], 0..10
  double people_force = 1;      ///< weight of smoothed particles between people, 0..10
  double viscosity = 0.5;       ///< how much people take on of their neighbours' velocity, m^2/s, 0..10
  double reaction_s = 0.5;      ///< time to reach a wanted velocity, s, (0, 10]
  double step_s = 0.1;          ///< of the simulation, s, [0.01, 0.5]
};

}  // namespace footlight
