// SPDX-License-Identifier: BSD-3-Clause
#include "placement/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace waymark::placement {
namespace {

constexpr double kEverywhere_m = 2.0;  // spacing of markers that are hung everywhere
constexpr double kAboveFloor = 1.02;   // least aim / sigma with markers everywhere
constexpr double kNothing = 1e-12;     // a smaller excess [m^3] counts as none

/// Evaluates sets of places by their excess: variance above the aim, integrated along the path.
class Search {
 public:
  Search(const CovarianceModel& model, std::span<const Step> steps, std::span<const Sightings> hung,
         std::span<const Sightings> at_places)
      : model_{model}, steps_{steps}, hung_{hung}, at_places_{at_places} {}

  std::vector<double> sigmas_m(const std::vector<std::size_t>& chosen) const {
    return model_.sigmas_m(model_.predict(hung_and(hung_, at_places_, chosen)));
  }

  void aim_at(const std::vector<double>& aims_m) { aims_m_ = aims_m; }

  /// Excess of these sigmas, one per step [m^3].
  double excess(std::span<const double> sigmas_m) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < sigmas_m.size(); ++i) {
      const double above_m2 = sigmas_m[i] * sigmas_m[i] - aims_m_[i] * aims_m_[i];
      sum += std::max(0.0, above_m2) * std::max(1e-3, steps_[i].motion.distance_m);
    }
    return sum;
  }

 private:
  const CovarianceModel& model_;
  std::span<const Step> steps_;
  std::span<const Sightings> hung_;
  std::span<const Sightings> at_places_;
  std::vector<double> aims_m_{};
};

std::vector<std::size_t> with(std::vector<std::size_t> chosen, std::size_t place) {
  chosen.push_back(place);
  return chosen;
}

struct Gain {
  std::size_t place{0};
  double gain{std::numeric_limits<double>::infinity()};
  std::size_t round{0};  ///< round in which `gain` was evaluated
};

/// The place that lowers the excess most; nullopt when none does.
std::optional<std::size_t> best_place(const Search& search, std::vector<Gain>& gains,
                                      const std::vector<std::size_t>& chosen, double excess,
                                      std::size_t round) {
  const auto less = [](const Gain& a, const Gain& b) {
    return a.gain < b.gain || (a.gain == b.gain && a.place > b.place);
  };
  while (!gains.empty()) {
    const auto top = std::max_element(gains.begin(), gains.end(), less);
    if (!(top->gain > kNothing)) return std::nullopt;
    if (top->round == round) return top->place;
    top->gain = excess - search.excess(search.sigmas_m(with(chosen, top->place)));
    top->round = round;
  }
  return std::nullopt;
}

/// Removes places that are not needed, later ones first.
void drop_needless(const Search& search, std::vector<std::size_t>& chosen) {
  for (std::size_t i = chosen.size(); i-- > 0 && chosen.size() > 1;) {
    std::vector<std::size_t> fewer = chosen;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    if (search.excess(search.sigmas_m(fewer)) <= kNothing) chosen = fewer;
  }
}

}  // namespace

std::vector<std::size_t> everywhere(std::span<const WallPlace> places) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&](std::size_t other) {
      return overlap(places[i].map_from_marker, places[other].map_from_marker, kEverywhere_m);
    });
    if (!is_near) chosen.push_back(i);
  }
  return chosen;
}

std::vector<Stretch> stretches_above(std::span<const double> sigmas_m, double target_m) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < sigmas_m.size(); ++i) {
    if (sigmas_m[i] <= target_m) continue;
    if (stretches.empty() || stretches.back().last + 1 != i) stretches.push_back({i, i, 0.0});
    stretches.back().last = i;
    stretches.back().worst_m = std::max(stretches.back().worst_m, sigmas_m[i]);
  }
  return stretches;
}

double worst(std::span<const double> sigmas_m) {
  return sigmas_m.empty() ? 0.0 : *std::max_element(sigmas_m.begin(), sigmas_m.end());
}

std::vector<const Sightings*> hung_and(std::span<const Sightings> hung,
                                       std::span<const Sightings> at_places,
                                       std::span<const std::size_t> chosen) {
  std::vector<const Sightings*> markers;
  for (const Sightings& marker : hung)
    markers.push_back(&marker);
  for (const std::size_t place : chosen)
    markers.push_back(&at_places[place]);
  return markers;
}

Advice advise(const CovarianceModel& model, std::span<const Step> steps,
              std::span<const Sightings> hung, std::span<const WallPlace> places,
              std::span<const Sightings> at_places, double plate_m, double target_m,
              std::size_t most, const Report& report) {
  Search search{model, steps, hung, at_places};
  Advice advice;
  advice.now_m = search.sigmas_m({});
  advice.aims_m.assign(advice.now_m.size(), target_m);
  std::vector<double> sigmas_m = advice.now_m;
  if (worst(sigmas_m) > target_m) {
    const std::vector<double> floor_m = search.sigmas_m(everywhere(places));
    advice.everywhere_m = worst(floor_m);
    for (std::size_t i = 0; i < floor_m.size(); ++i)
      if (floor_m[i] > target_m) advice.aims_m[i] = kAboveFloor * floor_m[i];
  }
  search.aim_at(advice.aims_m);
  std::vector<Gain> gains;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!at_places[i].empty()) gains.push_back({i});
  double excess = search.excess(sigmas_m);
  for (std::size_t round = 1; excess > kNothing && advice.chosen.size() < most; ++round) {
    const auto best = best_place(search, gains, advice.chosen, excess, round);
    if (!best) break;
    advice.chosen.push_back(*best);
    sigmas_m = search.sigmas_m(advice.chosen);
    excess = search.excess(sigmas_m);
    report(
        fmt::format("new marker {}: worst sigma {:.4f} m", advice.chosen.size(), worst(sigmas_m)));
    std::erase_if(gains, [&](const Gain& gain) {
      return overlap(places[gain.place].map_from_marker, places[*best].map_from_marker, plate_m);
    });
  }
  if (excess <= kNothing) drop_needless(search, advice.chosen);
  advice.then_m = advice.now_m;
  std::vector<std::size_t> hung_so_far;
  for (const std::size_t place : advice.chosen) {
    hung_so_far.push_back(place);
    advice.then_m = search.sigmas_m(hung_so_far);
    advice.worst_after_m.push_back(worst(advice.then_m));
  }
  return advice;
}

}  // namespace waymark::placement
