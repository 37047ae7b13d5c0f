// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/painted_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "core/check.hpp"
#include "planner/painted/in_chunks.hpp"

namespace footlight::planner {
namespace {

constexpr std::uint32_t kNoStroke = std::numeric_limits<std::uint32_t>::max();
constexpr double kArriveShare = 0.85;  // of a leg's time: the rest is for who is late
constexpr double kLook_m = 4;          // how far around a pixel obstacles are looked for
constexpr double kAccelerations = 3;   // most, in top speeds over the reaction
constexpr double kStiffness = 2;       // pressure: a top speed over the reaction at so many times the rest density
constexpr double kRoomShare = 1.15;    // of two radii: people farther apart do not press each other
constexpr double kHandle_m = 1.5;      // around a waypoint forces of others calm down
constexpr double kDiscReach_m = 2;
constexpr int kSlides = 2;
constexpr std::size_t kLookAhead = 12;  // points of a stroke's line

Point unit(Point a) {
  const double size = length(a);
  return size > 1e-12 ? 1 / size * a : Point{};
}

Point at_most(Point a, double size) {
  const double is = length(a);
  return is > size ? size / is * a : a;
}

}  // namespace

PaintedModel::PaintedModel(const MotionTask& task, const PaintedOptions& options, const PaintedScene& scene)
    : task_(task), options_(options), scene_(scene) {
  away_px_ = nearest_pixels(scene.blocked).distance_px;
  clear_m_ = Raster<double>(scene.width, scene.height, kLook_m);
  in_chunks(clear_m_.cells.size(), [&](std::size_t i) {
    const auto width = static_cast<std::size_t>(scene.width);
    const Point middle = scene.floor.to_floor({double(i % width) + 0.5, double(i / width) + 0.5});
    const auto near = task.floor->nearest(middle, kLook_m);
    if (near) clear_m_.cells[i] = near->distance_m;
  });
  find_people();
  prepare_legs();
  time_legs();
  double room = 0;
  for (const double radius : task.radius_m) room = std::max(room, 2 * radius);
  const double spacing = kRoomShare * std::max(room, 0.1);
  fluid_.reach_m = 2 * spacing;
  // Density that the kernel finds in a triangular lattice of that spacing: oneself, six neighbours, six more at
  // sqrt(3).
  fluid_.rest_per_m2 = poly6(0, fluid_.reach_m) + 6 * poly6(spacing * spacing, fluid_.reach_m) +
                       6 * poly6(3 * spacing * spacing, fluid_.reach_m);
  double fastest = 0;
  for (const double speed : task.speed_mps) fastest = std::max(fastest, speed);
  fluid_.stiffness = kStiffness * fastest / options.reaction_s * spacing / fluid_.rest_per_m2;
  fluid_.viscosity_m2ps = options.viscosity;
}

/// Who is who: people stand on the cells where the scene's people begin.
void PaintedModel::find_people() {
  const Grid& grid = scene_.ways->grid();
  std::map<std::uint32_t, std::uint32_t> who;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seat;
  for (std::size_t p = 0; p < scene_.parties.size(); ++p) {
    for (std::size_t k = 0; k < scene_.parties[p].begin.size(); ++k) {
      who[scene_.parties[p].begin[k].value()] = static_cast<std::uint32_t>(seat.size());
      seat.emplace_back(p, k);
    }
  }
  FL_CHECK(who.size() == task_.people());
  for (const Point at : task_.from) {
    const auto found = who.find(grid.nearest(at).value());
    FL_CHECK(found != who.end());
    number_.push_back(found->second);
    party_.push_back(seat[found->second].first);
    place_.push_back(seat[found->second].second);
  }
}

PaintedModel::StrokeFlow PaintedModel::stroke_flow(const PaintedScene::Party& party, std::size_t leg,
                                                   std::size_t stroke) const {
  const Stroke& painted = party.legs[leg].strokes[stroke];
  const FlowField& field = party.legs[leg].fields[stroke];
  Raster<GridFlow::Pixel> pixels(scene_.width, scene_.height, GridFlow::Pixel::wall);
  Raster<Point> wanted(scene_.width, scene_.height);
  double fastest = 0;
  for (const double speed : task_.speed_mps) fastest = std::max(fastest, speed);
  const Point tail = painted.line.front();
  const Point head = painted.line.back();
  for (int y = 0; y < scene_.height; ++y) {
    for (int x = 0; x < scene_.width; ++x) {
      if (scene_.blocked.at(x, y) != 0) continue;
      const Point at{x + 0.5, y + 0.5};
      const bool end = distance(at, tail) <= std::max(2.0, painted.half_width.front()) ||
                       distance(at, head) <= std::max(2.0, painted.half_width.back());
      if (party.shapes[leg].at(x, y) != 0 || party.shapes[leg + 1].at(x, y) != 0 || end) {
        pixels.at(x, y) = GridFlow::Pixel::open;
      }
      if (painted.pixels.at(x, y) != 0 && !end) pixels.at(x, y) = GridFlow::Pixel::fluid;
      wanted.at(x, y) = fastest / scene_.floor.pixel_m * field.direction.at(x, y);
    }
  }
  std::vector<double> left(painted.line.size(), 0);
  for (std::size_t i = left.size() - 1; i > 0; --i) {
    left[i - 1] = left[i] + scene_.floor.pixel_m * distance(painted.line[i], painted.line[i - 1]);
  }
  return {&painted, &field, GridFlow(std::move(pixels), std::move(wanted), options_.reaction_s),
          way_field(scene_.blocked, painted.pixels), std::move(left)};
}

void PaintedModel::prepare_legs() {
  for (const PaintedScene::Party& party : scene_.parties) {
    auto& legs = legs_.emplace_back(party.legs.size());
    for (std::size_t l = 0; l < legs.size(); ++l) {
      legs[l].way = way_field(scene_.blocked, party.shapes[l + 1]);
      for (std::size_t s = 0; s < party.legs[l].strokes.size(); ++s) {
        legs[l].strokes.push_back(flows_.size());
        flows_.push_back(stroke_flow(party, l, s));
      }
    }
  }
  // Of several strokes of a leg everybody takes the one whose tail is nearest to where she comes from.
  stroke_.resize(task_.people());
  for (std::size_t i = 0; i < task_.people(); ++i) {
    const auto& legs = legs_[party_[i]];
    for (std::size_t l = 0; l < legs.size(); ++l) {
      const Point from = scene_.floor.to_pixel(scene_.parties[party_[i]].places[l][place_[i]]);
      std::uint32_t best = kNoStroke;
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t s : legs[l].strokes) {
        const double away = distance(from, flows_[s].stroke->line.front());
        if (away >= least) continue;
        least = away;
        best = static_cast<std::uint32_t>(s);
      }
      stroke_[i].push_back(best);
    }
  }
}

/// The section's time is shared out in proportion to the mean way of each leg.
void PaintedModel::time_legs() {
  for (std::size_t p = 0; p < legs_.size(); ++p) {
    std::vector<double> mean(legs_[p].size(), 0);
    for (std::size_t i = 0; i < task_.people(); ++i) {
      if (party_[i] != p) continue;
      for (std::size_t l = 0; l < mean.size(); ++l) {
        const auto& places = scene_.parties[p].places;
        const Point from = places[l][place_[i]];
        const Point to = places[l + 1][place_[i]];
        const StrokeFlow* stroke = stroke_of(i, l);
        double way = distance(from, to);
        if (stroke != nullptr) {
          way = distance(from, scene_.floor.to_floor(stroke->stroke->line.front())) + stroke->left_m.front() +
                distance(scene_.floor.to_floor(stroke->stroke->line.back()), to);
        }
        mean[l] += way;
      }
    }
    double whole = 0;
    for (const double one : mean) whole += one;
    double so_far = 0;
    for (std::size_t l = 0; l < mean.size(); ++l) {
      so_far += whole > 0 ? mean[l] / whole : 1.0 / static_cast<double>(mean.size());
      legs_[p][l].end_s = so_far * task_.duration_s();
    }
  }
}

const PaintedModel::StrokeFlow* PaintedModel::stroke_of(std::size_t person, std::size_t leg) const {
  const std::uint32_t stroke = stroke_[person][leg];
  return stroke == kNoStroke ? nullptr : &flows_[stroke];
}

PaintedModel::State PaintedModel::begin() const {
  State out;
  out.position = task_.from;
  out.velocity.assign(task_.people(), {});
  out.leg.assign(task_.people(), 0);
  out.along.assign(task_.people(), 0);
  for (const StrokeFlow& flow : flows_) out.flow.push_back(flow.flow.begin());
  return out;
}

/// Straight where that is free, else along the way around. @param length_m of what is left
Point PaintedModel::toward(Point from, Point to, const WayField& way, double& length_m) const {
  const Point pixel = scene_.floor.to_pixel(from);
  const Point goal = scene_.floor.to_pixel(to);
  if (sees(away_px_, pixel, goal)) {
    length_m = distance(from, to);
    return unit(to - from);
  }
  const int x = std::clamp(static_cast<int>(pixel.x), 0, scene_.width - 1);
  const int y = std::clamp(static_cast<int>(pixel.y), 0, scene_.height - 1);
  const double around = way.length_px.at(x, y);
  const Point along = to_floor_vector(bilinear(way.direction, pixel));
  if (std::isfinite(around) && around > 0 && squared_length(along) > 1e-6) {
    length_m = around * scene_.floor.pixel_m;
    return unit(along);
  }
  length_m = distance(from, to);
  return unit(to - from);
}

PaintedModel::Guidance PaintedModel::guidance(std::size_t person, const State& now, State& next) const {
  const auto& legs = legs_[party_[person]];
  std::uint32_t leg = now.leg[person];
  const double time_s = static_cast<double>(now.tick) * options_.step_s;
  if (leg + 1 < legs.size() && time_s >= legs[leg].end_s) {
    ++leg;
    next.along[person] = 0;
  } else {
    next.along[person] = now.along[person];
  }
  next.leg[person] = leg;
  const Point at = now.position[person];
  const Point goal = scene_.parties[party_[person]].places[leg + 1][place_[person]];
  Guidance out;
  const StrokeFlow* stroke = stroke_of(person, leg);
  const Point pixel = scene_.floor.to_pixel(at);
  if (stroke != nullptr) {
    const auto& line = stroke->stroke->line;
    // Who has come so far does not fall back to where the stroke passes the same place earlier.
    const auto first = static_cast<std::size_t>(next.along[person]);
    const std::size_t last = line.size() - 1;
    std::size_t best = first;
    double least = std::numeric_limits<double>::infinity();
    // The line may come by again: who is on it looks a little ahead, who is not as far as she is from its tail.
    const double reach_m = 1.5 * scene_.floor.pixel_m * distance(pixel, line.front());
    for (std::size_t i = first; i <= last; ++i) {
      if (i > first + kLookAhead && (first > 0 || stroke->left_m.front() - stroke->left_m[i] > reach_m)) break;
      const double away = squared_length(line[i] - pixel);
      if (away < least) {
        least = away;
        best = i;
      }
    }
    next.along[person] = static_cast<double>(best);
    if (best + 1 < last) {
      const double strength = std::min(1.0, options_.stroke_force * bilinear(stroke->field->strength, pixel));
      const double ahead = std::max(2.0, 2 * stroke->stroke->half_width[best]);
      std::size_t aim = best;
      for (double walked = 0; aim < last && walked < ahead; ++aim) walked += distance(line[aim], line[aim + 1]);
      double to_line = 0;
      const Point enter = toward(at, scene_.floor.to_floor(line[aim]), stroke->way, to_line);
      const Point field = to_floor_vector(unit(bilinear(stroke->field->direction, pixel)));
      if (options_.stroke_force > 0) {
        out.direction = unit(strength * field + (1 - strength) * enter);
        out.on_stroke = strength;
        out.left_m = std::sqrt(least) * (1 - strength) * scene_.floor.pixel_m + stroke->left_m[best] +
                     distance(scene_.floor.to_floor(line[last]), goal);
        return out;
      }
    }
  }
  out.direction = toward(at, goal, legs[leg].way, out.left_m);
  return out;
}

Point PaintedModel::from_discs(Point at, double radius_m, double speed_mps,
                               const std::vector<MotionFloor::Disc>& discs) const {
  Point out;
  for (const MotionFloor::Disc& disc : discs) {
    const Point off = at - disc.centre;
    const double gap = length(off) - disc.radius_m - radius_m;
    if (gap > kDiscReach_m) continue;
    // Aside of its way rather than ahead of it.
    Point away = unit(off);
    const Point heading = unit(disc.velocity);
    if (heading != Point{} && dot(off, disc.velocity) > 0) {
      const Point side = off - dot(off, heading) * heading;
      away = unit(away + (squared_length(side) > 1e-12 ? unit(side) : Point{-heading.y, heading.x}));
    }
    const double press = std::clamp(1 - gap / kDiscReach_m, 0.0, 1.5);
    out = out + 3 * press * speed_mps / options_.reaction_s * away;
  }
  return out;
}

/// As far as it is free, then along what is in the way.
Point PaintedModel::walked(Point from, Point to) const {
  const Point pixel = scene_.floor.to_pixel(from);
  const double keep = scene_.ways->keep_m();
  const int x = std::clamp(static_cast<int>(pixel.x), 0, scene_.width - 1);
  const int y = std::clamp(static_cast<int>(pixel.y), 0, scene_.height - 1);
  const double beside = scene_.floor.pixel_m * distance(pixel, {x + 0.5, y + 0.5});
  to = {std::clamp(to.x, task_.floor->low().x, task_.floor->high().x),
        std::clamp(to.y, task_.floor->low().y, task_.floor->high().y)};
  if (clear_m_.at(x, y) - beside - distance(from, to) > keep) return to;
  const Point start = from;
  Point first = from;
  for (int slide = 0; slide <= kSlides; ++slide) {
    const double share = task_.floor->free_share(from, to);
    const Point contact = from + share * (to - from);
    if (slide == 0) first = contact;
    if (share >= 1) break;
    from = contact;
    const auto near = task_.floor->nearest(contact, keep + 0.05);
    if (!near || slide == kSlides) break;
    const Point off = unit(contact - near->at);
    const Point rest = to - contact;
    to = contact + (rest - std::min(0.0, dot(rest, off)) * off);
  }
  const Point reached = from + task_.floor->free_share(from, to) * (to - from);
  // Others see a straight line from generation to generation; it must be free as well.
  return task_.floor->free_share(start, reached) >= 1 ? reached : first;
}

void PaintedModel::move(std::size_t person, const State& now, State& next, const std::vector<Point>& particles,
                        const std::vector<MotionFloor::Disc>& discs) const {
  const double step = options_.step_s;
  const Guidance lead = guidance(person, now, next);
  const std::uint32_t leg = next.leg[person];
  const double fastest = task_.speed_mps[person];
  const double left_s =
      kArriveShare * (legs_[party_[person]][leg].end_s - (leg > 0 ? legs_[party_[person]][leg - 1].end_s : 0));
  const double begun_s = leg > 0 ? legs_[party_[person]][leg - 1].end_s : 0;
  const double time_s = static_cast<double>(now.tick) * step;
  const double until_s = std::max(begun_s + left_s - time_s, options_.reaction_s);
  const double pace = std::min({fastest, lead.left_m / until_s, lead.left_m / step});
  const Point at = now.position[person];
  const Point is = now.velocity[person];
  const double take = 1 / options_.reaction_s;
  Point force = take * (pace * lead.direction - is);
  const double calm = std::clamp(lead.left_m / kHandle_m, 0.0, 1.0);
  const Point pixel = scene_.floor.to_pixel(at);
  const Point background = to_floor_vector(bilinear(scene_.background_field, pixel));
  force = force + options_.background_force * calm * 0.5 * fastest * take * background;
  const StrokeFlow* stroke = stroke_of(person, leg);
  if (stroke != nullptr && lead.on_stroke > 0 && options_.flow_force > 0) {
    const auto& flow = now.flow[stroke_[person][leg]];
    const Point u = scene_.floor.pixel_m * to_floor_vector(stroke->flow.velocity(flow, pixel));
    // No faster than she has to be: the flow's speed belongs to the fluid, its direction to her.
    force = force + options_.flow_force * lead.on_stroke * take * (at_most(u, pace) - is);
  }
  force = force + options_.people_force * calm * particles[person];
  force = at_most(force, kAccelerations * fastest * take);
  force = force + from_discs(at, task_.radius_m[person], fastest, discs);
  const Point velocity = at_most(is + step * force, fastest);
  const Point to = walked(at, at + step * velocity);
  next.position[person] = to;
  // A slide along a wall ends with the speed that it had.
  next.velocity[person] = 1 / step * (to - at);
}

void PaintedModel::step(const State& now, State& next) const {
  Neighbours near;
  near.sort(now.position, fluid_.reach_m);
  const std::vector<Point> particles = options_.people_force > 0
                                           ? particle_accelerations(fluid_, near, now.position, now.velocity)
                                           : std::vector<Point>(now.position.size());
  const auto discs = task_.floor->discs(static_cast<double>(now.tick) * options_.step_s);
  if (options_.flow_force > 0) {
    for_each_index(flows_.size(), "motion", {},
                   [&](std::size_t f) { flows_[f].flow.step(now.flow[f], next.flow[f], options_.step_s); });
  }
  in_chunks(now.position.size(), [&](std::size_t person) { move(person, now, next, particles, discs); });
}

}  // namespace footlight::planner
