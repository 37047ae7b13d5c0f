// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/painted_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/check.hpp"
#include "planner/painted/in_chunks.hpp"

namespace footlight::planner {
namespace {

constexpr std::uint32_t kNoStroke = std::numeric_limits<std::uint32_t>::max();
constexpr double kArriveShare = 0.7;  // of a leg's time: the rest is for who is late
constexpr double kLook_m = 4;         // how far around a pixel obstacles are looked for
constexpr double kAccelerations = 3;  // most, in top speeds over the reaction
constexpr double kStiffness = 2;      // pressure: a top speed over the reaction at so many times the rest
constexpr double kRoomShare = 1.15;   // of two radii: people farther apart do not press each other
constexpr double kFill = 0.8;         // of the cells taken where people walk: more cannot follow a way any more
constexpr double kHandle_m = 1.5;     // around a waypoint forces of others calm down
constexpr double kDiscReach_m = 2;
constexpr double kHair_m = 0.005;
constexpr std::size_t kMostAhead = 24;  // people whom a person minds
constexpr int kSlides = 3;
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
  const double of_cells_m = std::sqrt(scene.ways->grid().cell_area_m2() / (kFill * std::numbers::sqrt3 / 2));
  for (const double radius : task.radius_m) {
    spacing_m_.push_back(std::max(of_cells_m, 2 * kRoomShare * radius));
    widest_m_ = std::max(widest_m_, spacing_m_.back());
  }
  double fastest = 0;
  for (const double speed : task.speed_mps) fastest = std::max(fastest, speed);
  fluid_.stiffness_m2ps2 = kStiffness * fastest / options.reaction_s * of_cells_m;
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
  for (const StrokeFlow& flow : flows_) out.flow.push_back(std::make_shared<const GridFlow::State>(flow.flow.begin()));
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
  out.calm = std::clamp(out.left_m / kHandle_m, 0.0, 1.0);
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

/// As far as it is free, then along what is in the way. A hair is left to everything: who touches a wall exactly is
/// held by the rounding of the sweep.
Point PaintedModel::walked(Point from, Point to) const {
  const Point pixel = scene_.floor.to_pixel(from);
  const double keep = scene_.ways->keep_m();
  const int x = std::clamp(static_cast<int>(pixel.x), 0, scene_.width - 1);
  const int y = std::clamp(static_cast<int>(pixel.y), 0, scene_.height - 1);
  const double beside = scene_.floor.pixel_m * distance(pixel, {x + 0.5, y + 0.5});
  to = {std::clamp(to.x, task_.floor->low().x, task_.floor->high().x),
        std::clamp(to.y, task_.floor->low().y, task_.floor->high().y)};
  if (clear_m_.at(x, y) - beside - distance(from, to) > keep + kHair_m) return to;
  const auto reached = [&](Point a, Point b) {
    const double share = task_.floor->free_share(a, b);
    const double whole = distance(a, b);
    return share >= 1 || whole <= 0 ? b : a + std::max(0.0, share - kHair_m / whole) * (b - a);
  };
  const Point start = from;
  const double most = distance(from, to);
  const Point first = reached(from, to);
  Point last = first;
  for (int slide = 0; slide < kSlides && last != to; ++slide) {
    const auto near = task_.floor->nearest(last, keep + 3 * kHair_m);
    if (!near) break;
    const Point off = unit(last - near->at);
    const Point rest = to - last;
    from = last + std::max(0.0, keep + kHair_m - near->distance_m) * off;
    to = from + (rest - std::min(0.0, dot(rest, off)) * off);
    last = reached(from, to);
  }
  // A hair off a wall is no way to be faster.
  const double whole = distance(start, last);
  if (whole > most) last = start + most / whole * (last - start);
  // Others see a straight line from generation to generation; it must be free as well.
  return task_.floor->free_share(start, last) >= 1 ? last : first;
}

/// All of a party go as fast as whoever has the longest way left has to: who is in front does not hold up the others.
std::vector<double> PaintedModel::paces(const std::vector<Guidance>& lead, const State& next) const {
  std::vector<double> left_m(legs_.size(), 0);
  std::vector<std::uint32_t> leg(legs_.size(), 0);
  for (std::size_t i = 0; i < lead.size(); ++i) {
    left_m[party_[i]] = std::max(left_m[party_[i]], lead[i].left_m);
    leg[party_[i]] = next.leg[i];
  }
  const double now_s = static_cast<double>(next.tick - 1) * options_.step_s;
  for (std::size_t p = 0; p < left_m.size(); ++p) {
    const double begun_s = leg[p] > 0 ? legs_[p][leg[p] - 1].end_s : 0;
    const double until_s = begun_s + kArriveShare * (legs_[p][leg[p]].end_s - begun_s) - now_s;
    left_m[p] /= std::max(until_s, options_.reaction_s);
  }
  return left_m;
}

/// Less of a velocity, so that nobody walks into who is ahead of her and wants the same way. The nearest count first,
/// whatever their numbers are.
Point PaintedModel::queued(std::size_t person, Point velocity, const Around& around) const {
  struct Ahead {
    double squared = 0;
    Point at;
    std::uint32_t who = 0;
    [[nodiscard]] auto order() const { return std::tuple(squared, at.x, at.y); }
  };
  std::array<Ahead, kMostAhead> ahead;
  std::size_t count = 0;
  const Guidance& lead = around.lead[person];
  const Point at = around.people.position[person];
  const double own = spacing_m_[person];
  const double reach = (own + widest_m_) / 2 + options_.reaction_s * task_.speed_mps[person];
  around.near.visit(at, reach, [&](std::uint32_t k, double squared) {
    if (squared <= 0 || dot(around.lead[k].direction, lead.direction) <= 0) return;
    Ahead one{squared, around.people.position[k], k};
    if (count < ahead.size())
      ++count;
    else if (ahead.back().order() <= one.order())
      return;
    std::size_t i = count - 1;
    for (; i > 0 && one.order() < ahead[i - 1].order(); --i) ahead[i] = ahead[i - 1];
    ahead[i] = one;
  });
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint32_t k = ahead[n].who;
    const double r = std::sqrt(ahead[n].squared);
    const Point to = 1 / r * (ahead[n].at - at);
    const double room = r - (own + spacing_m_[k]) / 2;
    const double most = std::max(0.0, dot(around.people.velocity[k], to) + room / options_.reaction_s);
    const double over = dot(velocity, to) - most;
    // Whoever is at her place is in nobody's way: cells leave room to pass between.
    if (over > 0) velocity = velocity - std::min(lead.calm, around.lead[k].calm) * over * to;
  }
  return velocity;
}

void PaintedModel::move(std::size_t person, const State& now, State& next, const Around& around) const {
  const double step = options_.step_s;
  const Guidance& lead = around.lead[person];
  const std::uint32_t leg = next.leg[person];
  const double fastest = task_.speed_mps[person];
  const double pace = std::min({fastest, around.pace_mps[party_[person]], lead.left_m / step});
  const Point at = now.position[person];
  const Point is = now.velocity[person];
  const double take = 1 / options_.reaction_s;
  Point force = take * (pace * lead.direction - is);
  const Point pixel = scene_.floor.to_pixel(at);
  const Point background = to_floor_vector(bilinear(scene_.background_field, pixel));
  force = force + options_.background_force * lead.calm * 0.5 * fastest * take * background;
  const StrokeFlow* stroke = stroke_of(person, leg);
  if (stroke != nullptr && lead.on_stroke > 0 && options_.flow_force > 0) {
    const auto& flow = *now.flow[stroke_[person][leg]];
    const Point u = scene_.floor.pixel_m * to_floor_vector(stroke->flow.velocity(flow, pixel));
    // No faster than she has to be: the flow's speed belongs to the fluid, its direction to her.
    force = force + options_.flow_force * lead.on_stroke * take * (at_most(u, pace) - is);
  }
  const bool minds = !around.taken.empty();
  if (minds) {
    const Point particles = particle_acceleration(fluid_, around.people, around.taken, around.near, person);
    force = force + options_.people_force * lead.calm * particles;
  }
  force = at_most(force, kAccelerations * fastest * take);
  force = force + from_discs(at, task_.radius_m[person], fastest, around.discs);
  Point velocity = at_most(is + step * force, fastest);
  if (minds) velocity = queued(person, velocity, around);
  const Point to = walked(at, at + step * velocity);
  next.position[person] = to;
  // A slide along a wall ends with the speed that it had.
  next.velocity[person] = 1 / step * (to - at);
}

void PaintedModel::step(const State& now, State& next) const {
  const std::size_t people = now.position.size();
  Around around;
  around.near.sort(now.position, 2 * widest_m_);
  around.lead.resize(people);
  in_chunks(people, [&](std::size_t person) { around.lead[person] = guidance(person, now, next); });
  around.pace_mps = paces(around.lead, next);
  // Who is at her place needs no more room than her body: a shape may be as full as its cells are.
  around.spacing_m.resize(people);
  for (std::size_t i = 0; i < people; ++i) {
    const double body = 2 * kRoomShare * task_.radius_m[i];
    around.spacing_m[i] = body + around.lead[i].calm * (spacing_m_[i] - body);
  }
  around.people = {now.position, now.velocity, around.spacing_m, widest_m_};
  if (options_.people_force > 0) around.taken = floor_taken(around.people, around.near);
  around.discs = task_.floor->discs(static_cast<double>(now.tick) * options_.step_s);
  if (options_.flow_force > 0) {
    for_each_index(flows_.size(), "motion", {}, [&](std::size_t f) {
      if (now.flow[f]->steady) return;
      auto flow = std::make_shared<GridFlow::State>(*now.flow[f]);
      flows_[f].flow.step(*now.flow[f], *flow, options_.step_s);
      next.flow[f] = std::move(flow);
    });
  }
  in_chunks(people, [&](std::size_t person) { move(person, now, next, around); });
}

}  // namespace footlight::planner
