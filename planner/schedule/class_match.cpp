// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/class_match.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "core/check.hpp"
#include "planner/schedule/cast_tracks.hpp"

namespace footlight::planner {
namespace {

using Places = std::vector<std::uint32_t>;

Point middle(const Grid& grid, std::span<const CellIndex> cells, const Places& of) {
  Point sum;
  for (const std::uint32_t i : of) sum = sum + grid.centre(cells[i]);
  return of.empty() ? sum : (1.0 / static_cast<double>(of.size())) * sum;
}

std::map<std::uint32_t, Places> by_class(std::span<const std::uint32_t> classes) {
  std::map<std::uint32_t, Places> out;
  for (std::uint32_t i = 0; i < classes.size(); ++i) out[classes[i]].push_back(i);
  return out;
}

/// How many performers of each class have no place yet.
std::map<std::uint32_t, int> missing(const ClassMatchTask& task, const Places& to_class) {
  std::map<std::uint32_t, int> need;
  for (const std::uint32_t one : task.person_to) ++need[one];
  for (const std::uint32_t one : to_class) {
    if (one != kOpenPlace) --need[one];
  }
  for (const auto& [one, people] : need) FL_CHECK(people >= 0);
  return need;
}

/// An open place and a class that could have it.
struct Offer {
  double away_m = 0;
  std::uint32_t place = 0;
  std::uint32_t wants = 0;
};

void take(std::vector<Offer>& offers, std::map<std::uint32_t, int>& need, Places& to_class) {
  std::sort(offers.begin(), offers.end(), [](const Offer& a, const Offer& b) {
    return std::tie(a.away_m, a.place, a.wants) < std::tie(b.away_m, b.place, b.wants);
  });
  for (const Offer& offer : offers) {
    if (to_class[offer.place] != kOpenPlace || need[offer.wants] == 0) continue;
    to_class[offer.place] = offer.wants;
    --need[offer.wants];
  }
}

}  // namespace

void settle_open_places(const ClassMatchTask& task, std::vector<std::uint32_t>& to_class) {
  auto need = missing(task, to_class);
  const auto given = by_class(to_class);
  if (!given.contains(kOpenPlace)) return;
  const Grid& grid = *task.grid;
  const auto own_places = [&](std::uint32_t one) {
    const auto found = given.find(one);
    return found == given.end() ? Places() : found->second;
  };
  // Who comes from where to which class: all who could.
  std::map<std::uint32_t, std::map<std::uint32_t, int>> goes;  // class now -> class then -> people
  for (std::size_t p = 0; p < task.person_from.size(); ++p) ++goes[task.person_from[p]][task.person_to[p]];
  std::vector<Offer> offers;
  std::map<CellIndex, std::uint32_t> standing;  // class now
  for (std::size_t i = 0; i < task.from.size(); ++i) standing[task.from[i]] = task.from_class[i];
  std::map<std::uint32_t, Point> middles;
  for (const auto& [one, people] : need) middles[one] = middle(grid, task.to, own_places(one));
  for (const std::uint32_t j : given.at(kOpenPlace)) {
    const auto here = standing.find(task.to[j]);
    if (here == standing.end()) continue;
    for (const auto& [then, people] : goes[here->second]) {
      offers.push_back({-distance(grid.centre(task.to[j]), middles[then]), j, then});
    }
  }
  take(offers, need, to_class);
  offers.clear();
  std::map<std::uint32_t, Places> coming;  // those of `from` who could be of a class
  for (std::uint32_t i = 0; i < task.from.size(); ++i) {
    for (const auto& [then, people] : goes[task.from_class[i]]) coming[then].push_back(i);
  }
  for (const auto& [one, people] : need) {
    if (people == 0) continue;
    const bool from_somewhere = !coming[one].empty();
    const Point near = from_somewhere ? middle(grid, task.from, coming[one]) : middles[one];
    for (const std::uint32_t j : given.at(kOpenPlace)) {
      if (to_class[j] == kOpenPlace) offers.push_back({distance(grid.centre(task.to[j]), near), j, one});
    }
  }
  take(offers, need, to_class);
}

namespace {

class ClassMatcher {
 public:
  ClassMatcher(const ClassMatchTask& task, const Places& to_class)
      : task_(task), sources_(by_class(task.from_class)), targets_(by_class(to_class)) {
    for (std::size_t p = 0; p < task.person_from.size(); ++p) ++goes_[{task.person_from[p], task.person_to[p]}];
  }

  std::vector<ClassLot> lots() {
    std::vector<ClassLot> out;
    for (const std::vector<Pair>& tied : components()) {
      const auto same = [&](auto part) {
        return std::all_of(tied.begin(), tied.end(), [&](const Pair& one) { return part(one) == part(tied[0]); });
      };
      const bool star =
          same([](const Pair& one) { return one.first; }) || same([](const Pair& one) { return one.second; });
      if (star) {
        out.push_back(whole(tied));
      } else {
        cut(tied, out);
      }
    }
    return out;
  }

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  /// Combinations that share classes, directly or over others.
  [[nodiscard]] std::vector<std::vector<Pair>> components() const {
    std::map<std::uint32_t, std::vector<Pair>> of_source;
    std::map<std::uint32_t, std::vector<Pair>> of_target;
    for (const auto& [one, people] : goes_) {
      of_source[one.first].push_back(one);
      of_target[one.second].push_back(one);
    }
    std::vector<std::vector<Pair>> out;
    std::map<Pair, bool> seen;
    for (const auto& [start, people] : goes_) {
      if (seen[start]) continue;
      seen[start] = true;
      std::vector<Pair> tied{start};
      for (std::size_t n = 0; n < tied.size(); ++n) {
        for (const auto* list : {&of_source[tied[n].first], &of_target[tied[n].second]}) {
          for (const Pair& next : *list) {
            if (!seen[next]) tied.push_back(next);
            seen[next] = true;
          }
        }
      }
      std::sort(tied.begin(), tied.end());
      out.push_back(std::move(tied));
    }
    return out;
  }

  /// All places of the classes.
  [[nodiscard]] ClassLot whole(const std::vector<Pair>& tied) const {
    ClassLot lot;
    const auto add = [](std::vector<std::uint32_t> classes, const std::map<std::uint32_t, Places>& places,
                        Places& out) {
      std::sort(classes.begin(), classes.end());
      classes.erase(std::unique(classes.begin(), classes.end()), classes.end());
      for (const std::uint32_t one : classes) out.insert(out.end(), places.at(one).begin(), places.at(one).end());
      std::sort(out.begin(), out.end());
    };
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> second;
    for (const auto& [a, b] : tied) {
      first.push_back(a);
      second.push_back(b);
    }
    add(first, sources_, lot.from);
    add(second, targets_, lot.to);
    return lot;
  }

  void cut(std::vector<Pair> tied, std::vector<ClassLot>& out) {
    std::stable_sort(tied.begin(), tied.end(), [&](const Pair& a, const Pair& b) { return goes_.at(a) < goes_.at(b); });
    for (const Pair& one : tied) {
      const auto people = static_cast<std::size_t>(goes_.at(one));
      Places& from = sources_.at(one.first);
      Places& to = targets_.at(one.second);
      ClassLot& lot = out.emplace_back();
      lot.from = nearest(task_.from, from, people, middle(*task_.grid, task_.to, to));
      lot.to = nearest(task_.to, to, people, middle(*task_.grid, task_.from, lot.from));
    }
  }

  /// Takes the places nearest to a point out of `places`.
  [[nodiscard]] Places nearest(std::span<const CellIndex> cells, Places& places, std::size_t people, Point to) const {
    FL_CHECK(people <= places.size());
    std::stable_sort(places.begin(), places.end(), [&](std::uint32_t a, std::uint32_t b) {
      return distance(task_.grid->centre(cells[a]), to) < distance(task_.grid->centre(cells[b]), to);
    });
    const auto end = places.begin() + static_cast<std::ptrdiff_t>(people);
    Places out(places.begin(), end);
    places.erase(places.begin(), end);
    std::sort(out.begin(), out.end());
    std::sort(places.begin(), places.end());
    return out;
  }

  const ClassMatchTask& task_;
  std::map<std::uint32_t, Places> sources_;
  std::map<std::uint32_t, Places> targets_;
  std::map<Pair, int> goes_;
};

}  // namespace

std::vector<std::uint32_t> match_classes(const ClassMatchTask& task, const std::vector<std::uint32_t>& to_class,
                                         const std::function<std::vector<std::uint32_t>(const ClassLot&)>& pair_lot) {
  std::vector<std::uint32_t> target_of(task.from.size());
  for (const ClassLot& lot : ClassMatcher(task, to_class).lots()) {
    FL_CHECK(lot.from.size() == lot.to.size());
    const std::vector<std::uint32_t> matched = pair_lot(lot);
    for (std::size_t n = 0; n < lot.from.size(); ++n) target_of[lot.from[n]] = lot.to[matched[n]];
  }
  return target_of;
}

}  // namespace footlight::planner
