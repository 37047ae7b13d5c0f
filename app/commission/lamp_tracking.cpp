// SPDX-License-Identifier: Apache-2.0
#include "app/commission/lamp_tracking.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

namespace footlight::app {
namespace {

using config::LightSpot;

constexpr double kSiteRadius = 0.4;  // of the way to the neighbour
constexpr double kMostRadius_px = 16;
constexpr double kLeastRadius_px = 1.5;
constexpr double kSamePlace_px = 0.01;
constexpr double kMiddle = 0.2;     // of a part at each end is left out
constexpr double kSeenOften = 0.4;  // of the frames in which all lamps shine
constexpr std::size_t kLeastForAffine = 12;
constexpr std::size_t kLeastForShift = 3;
constexpr double kLost = 2.5;  // distances of two lamps that are searched when the picture was lost
constexpr double kLostGrain = 0.3;
constexpr int kRounds = 3;
constexpr double kOutlier = 2.5;  // of the median residual

struct Pair {
  LightSpot from;
  LightSpot to;
};

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double away(const LightSpot& a, const LightSpot& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// The same way for all: the medians.
PictureShift moved(PictureShift shift, const std::vector<Pair>& pairs) {
  std::vector<double> dx;
  std::vector<double> dy;
  for (const Pair& pair : pairs) {
    const LightSpot at = shift.of(pair.from);
    dx.push_back(pair.to.x - at.x);
    dy.push_back(pair.to.y - at.y);
  }
  shift.m[2] += median_of(dx);
  shift.m[5] += median_of(dy);
  return shift;
}

/// Least squares, without those that are far off.
PictureShift affine(const PictureShift& guess, std::vector<Pair> pairs) {
  std::vector<double> residuals;
  for (const Pair& pair : pairs) residuals.push_back(away(guess.of(pair.from), pair.to));
  const double most = kOutlier * std::max(0.2, median_of(residuals));
  std::erase_if(pairs, [&](const Pair& pair) { return away(guess.of(pair.from), pair.to) > most; });
  if (pairs.size() < kLeastForAffine) return guess;
  Eigen::MatrixXd from(static_cast<Eigen::Index>(pairs.size()), 3);
  Eigen::MatrixXd to(static_cast<Eigen::Index>(pairs.size()), 2);
  for (Eigen::Index i = 0; i < from.rows(); ++i) {
    const Pair& pair = pairs[static_cast<std::size_t>(i)];
    from.row(i) << pair.from.x, pair.from.y, 1;
    to.row(i) << pair.to.x, pair.to.y;
  }
  const Eigen::MatrixXd solved = (from.transpose() * from).ldlt().solve(from.transpose() * to);
  if (!solved.allFinite()) return guess;
  return {{solved(0, 0), solved(1, 0), solved(2, 0), solved(0, 1), solved(1, 1), solved(2, 1)}};
}

/// Follows the picture from frame to frame.
class Tracker {
 public:
  Tracker(const config::LampFilm& film, float least_light) : film_(film), least_light_(least_light) {}

  void set_sites(const std::vector<LightSpot>& places) {
    constexpr double kReach_px = kMostRadius_px / kSiteRadius;
    sites_.clear();
    const SpotIndex index(places, 0, kReach_px);
    std::vector<double> distances;
    for (const LightSpot& place : places) {
      const LightSpot* other = index.nearest(place.x, place.y, kReach_px, kSamePlace_px);
      const double nearest = other == nullptr ? kReach_px : away(place, *other);
      const double radius = std::clamp(kSiteRadius * nearest, kLeastRadius_px, kMostRadius_px);
      distances.push_back(radius / kSiteRadius);
      sites_.push_back({place, radius, {}});
    }
    distance_px_ = median_of(distances);
  }
  [[nodiscard]] std::vector<LightSite>& sites() { return sites_; }

  [[nodiscard]] SpotIndex index_of(std::size_t frame) const {
    return {film_.frames[frame].spots, least_light_, kMostRadius_px};
  }

  /// The picture of `frame`, from where it was in the frame before.
  [[nodiscard]] PictureShift follow(const SpotIndex& spots, PictureShift shift, bool lost) const {
    if (lost) shift = search(spots, shift);
    for (int round = 0; round < kRounds; ++round) {
      const std::vector<Pair> pairs = match(spots, shift);
      if (pairs.size() < kLeastForShift) return shift;
      shift = moved(shift, pairs);
      if (round > 0 && pairs.size() >= kLeastForAffine) shift = affine(shift, pairs);
    }
    return shift;
  }
  [[nodiscard]] std::vector<Pair> match(const SpotIndex& spots, const PictureShift& shift) const {
    std::vector<Pair> pairs;
    for (const LightSite& site : sites_) {
      const LightSpot at = shift.of(site.place);
      if (const LightSpot* spot = spots.nearest(at.x, at.y, site.radius_px)) pairs.push_back({site.place, *spot});
    }
    return pairs;
  }

 private:
  /// The shift at which most sites have a light, however far within kLost.
  [[nodiscard]] PictureShift search(const SpotIndex& spots, const PictureShift& from) const {
    const int reach = static_cast<int>(std::lround(kLost / kLostGrain));
    PictureShift best = from;
    std::size_t most = 0;
    for (int ring = 0; ring <= reach; ++ring) {  // from the middle outwards: of two that are as good, the nearer
      for (int v = -ring; v <= ring; ++v) {
        for (int u = -ring; u <= ring; ++u) {
          if (std::max(std::abs(u), std::abs(v)) != ring) continue;
          PictureShift shift = from;
          shift.m[2] += u * kLostGrain * distance_px_;
          shift.m[5] += v * kLostGrain * distance_px_;
          const std::size_t matched = match(spots, shift).size();
          if (matched > most) {
            most = matched;
            best = shift;
          }
        }
      }
    }
    return best;
  }

  const config::LampFilm& film_;
  float least_light_;
  std::vector<LightSite> sites_;
  double distance_px_ = 1;
};

/// Lights of the frames in which all lamps shine, in the picture of the first of them; those that are seen often.
class Gathering {
 public:
  explicit Gathering(double radius_px) : radius_px_(radius_px) {}
  void add(const std::vector<LightSpot>& spots, float least_light, const PictureShift& to_reference) {
    ++frames_;
    std::vector<LightSpot> places;
    places.reserve(found_.size());
    for (const Found& found : found_) places.push_back(found.place);
    const SpotIndex index(places, -1, radius_px_);
    for (const LightSpot& spot : spots) {
      if (spot.light < least_light) continue;
      const LightSpot at = to_reference.of(spot);
      if (const LightSpot* known = index.nearest(at.x, at.y, radius_px_)) {
        Found& found = found_[static_cast<std::size_t>(known->light)];
        ++found.times;
        found.place.x += (at.x - found.place.x) / static_cast<float>(found.times);
        found.place.y += (at.y - found.place.y) / static_cast<float>(found.times);
      } else {
        // The light of a place is its number here: the index sorts its spots.
        found_.push_back({{at.x, at.y, static_cast<float>(found_.size())}, spot.light, 1});
      }
    }
  }
  [[nodiscard]] std::vector<LightSpot> often() const {
    std::vector<LightSpot> out;
    for (const Found& found : found_) {
      if (static_cast<double>(found.times) < kSeenOften * static_cast<double>(frames_)) continue;
      out.push_back({found.place.x, found.place.y, found.light});
    }
    return out;
  }

 private:
  struct Found {
    LightSpot place;
    float light = 0;
    std::size_t times = 0;
  };
  double radius_px_;
  std::size_t frames_ = 0;
  std::vector<Found> found_;
};

std::size_t frame_at(const config::LampFilm& film, double time_s) {
  const auto after = std::ranges::lower_bound(film.frames, time_s, {}, &config::LampFrame::time_s);
  return after == film.frames.end() ? film.frames.size() - 1 : static_cast<std::size_t>(after - film.frames.begin());
}

std::vector<LightSpot> strong(const std::vector<LightSpot>& spots, float least) {
  std::vector<LightSpot> out;
  std::ranges::copy_if(spots, std::back_inserter(out), [&](const LightSpot& spot) { return spot.light >= least; });
  return out;
}

}  // namespace

LightSpot PictureShift::of(const LightSpot& spot) const {
  return {static_cast<float>(m[0] * spot.x + m[1] * spot.y + m[2]),
          static_cast<float>(m[3] * spot.x + m[4] * spot.y + m[5]), spot.light};
}

PictureShift PictureShift::inverse() const {
  const double det = m[0] * m[4] - m[1] * m[3];
  const double a = m[4] / det;
  const double b = -m[1] / det;
  const double d = -m[3] / det;
  const double e = m[0] / det;
  return {{a, b, -(a * m[2] + b * m[5]), d, e, -(d * m[2] + e * m[5])}};
}

SpotIndex::SpotIndex(const std::vector<LightSpot>& spots, float least_light, double reach_px)
    : spots_(strong(spots, least_light)), reach_px_(std::max(1.0, reach_px)) {
  if (spots_.empty()) return;
  double x1 = spots_[0].x;
  double y1 = spots_[0].y;
  x0_ = x1;
  y0_ = y1;
  for (const LightSpot& spot : spots_) {
    x0_ = std::min<double>(x0_, spot.x);
    x1 = std::max<double>(x1, spot.x);
    y0_ = std::min<double>(y0_, spot.y);
    y1 = std::max<double>(y1, spot.y);
  }
  columns_ = static_cast<int>((x1 - x0_) / reach_px_) + 1;
  rows_ = static_cast<int>((y1 - y0_) / reach_px_) + 1;
  const auto of = [&](const LightSpot& spot) {
    return bucket(static_cast<int>((spot.x - x0_) / reach_px_), static_cast<int>((spot.y - y0_) / reach_px_));
  };
  std::ranges::stable_sort(spots_, {}, of);
  begins_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const LightSpot& spot : spots_) ++begins_[of(spot) + 1];
  for (std::size_t b = 1; b < begins_.size(); ++b) begins_[b] += begins_[b - 1];
}

std::size_t SpotIndex::bucket(int column, int row) const {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
}

const LightSpot* SpotIndex::nearest(double x, double y, double radius_px, double beyond_px) const {
  if (spots_.empty()) return nullptr;
  const double u = std::floor((x - x0_) / reach_px_);
  const double v = std::floor((y - y0_) / reach_px_);
  if (u < -1 || v < -1 || u > columns_ || v > rows_) return nullptr;
  const LightSpot* best = nullptr;
  double least = radius_px * radius_px;
  for (int row = std::max(0, static_cast<int>(v) - 1); row <= std::min(rows_ - 1, static_cast<int>(v) + 1); ++row) {
    for (int column = std::max(0, static_cast<int>(u) - 1); column <= std::min(columns_ - 1, static_cast<int>(u) + 1);
         ++column) {
      const std::size_t at = bucket(column, row);
      for (std::size_t i = begins_[at]; i < begins_[at + 1]; ++i) {
        const double squared = (spots_[i].x - x) * (spots_[i].x - x) + (spots_[i].y - y) * (spots_[i].y - y);
        if (squared > least || (beyond_px >= 0 && squared <= beyond_px * beyond_px)) continue;
        least = squared;
        best = &spots_[i];
      }
    }
  }
  return best;
}

TrackedFilm track_lamps(const config::LampFilm& film, const FlashSequence& sequence, const FilmTiming& timing) {
  const float least = least_light(film);
  const auto& parts = sequence.parts();
  const FlashPart& first = parts[1];
  const FlashPart& last = parts[parts.size() - 2];
  TrackedFilm out;
  out.reference = frame_at(film, 0.5 * (timing.begins_s(first) + timing.ends_s(first)));
  Tracker tracker(film, least);
  tracker.set_sites(strong(film.frames[out.reference].spots, least));
  if (tracker.sites().empty()) return out;

  // Which lights there are: all frames of the first part in which all lamps shine.
  const double margin = kMiddle * timing.step_s;
  const std::size_t from = frame_at(film, timing.begins_s(first) + margin);
  const std::size_t to = std::max(from + 1, frame_at(film, timing.ends_s(first) - margin));
  std::vector<double> radii;
  for (const LightSite& site : tracker.sites()) radii.push_back(site.radius_px);
  Gathering gathering(median_of(radii));
  PictureShift shift_at_start;
  for (const bool forward : {true, false}) {
    PictureShift shift;
    for (std::size_t i = out.reference; i >= from && i < to; forward ? ++i : --i) {
      shift = tracker.follow(tracker.index_of(i), shift, false);
      if (forward || i != out.reference) gathering.add(film.frames[i].spots, least, shift.inverse());
      if (i == 0) break;
    }
    if (!forward) shift_at_start = shift;
  }
  tracker.set_sites(gathering.often());

  // What each of them does.
  std::vector<LightSite>& sites = tracker.sites();
  for (LightSite& site : sites) site.light_of_part.assign(parts.size(), 0);
  PictureShift shift = shift_at_start;
  double seen_at_s = film.frames[from].time_s;
  std::vector<std::size_t> frames_of_part(parts.size());
  std::size_t part = 1;
  for (std::size_t i = from; i < film.frames.size() && film.frames[i].time_s < timing.ends_s(last); ++i) {
    const double now = film.frames[i].time_s;
    while (part + 1 < parts.size() && now >= timing.ends_s(parts[part])) ++part;
    const SpotIndex spots = tracker.index_of(i);
    const bool all = parts[part].kind == FlashPart::Kind::all;
    shift = tracker.follow(spots, shift, all && now - seen_at_s > 0.5 * timing.step_s);
    const std::size_t enough = std::min(kLeastForAffine, 1 + sites.size() / 4);
    if (tracker.match(spots, shift).size() >= enough) seen_at_s = now;
    out.most_moved_px = std::max(out.most_moved_px, std::hypot(shift.m[2], shift.m[5]));
    if (now < timing.begins_s(parts[part]) + margin || now > timing.ends_s(parts[part]) - margin) continue;
    ++frames_of_part[part];
    for (LightSite& site : sites) {
      const LightSpot at = shift.of(site.place);
      if (const LightSpot* spot = spots.nearest(at.x, at.y, site.radius_px)) site.light_of_part[part] += spot->light;
    }
  }
  for (LightSite& site : sites) {
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (frames_of_part[p] > 0) site.light_of_part[p] /= static_cast<double>(frames_of_part[p]);
    }
  }
  out.sites = std::move(sites);
  return out;
}

}  // namespace footlight::app
