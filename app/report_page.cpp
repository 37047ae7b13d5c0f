// SPDX-License-Identifier: Apache-2.0
#include "app/report_page.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <span>

#include <fmt/format.h>
#include <nettle/base64.h>

#include "app/html_text.hpp"
#include "app/paper/plot.hpp"
#include "app/paper/preview.hpp"

namespace footlight::app {
namespace {

constexpr double kPlotWidth = 720;
constexpr double kPlotHeight = 240;
constexpr int kSheetWidth = 1440;
constexpr std::size_t kClosest = 10;
constexpr std::size_t kWalkers = 10;

constexpr const char* kStyle = R"(
body{font:15px/1.45 "DejaVu Sans",Verdana,sans-serif;color:#111;max-width:760px;margin:24px auto;padding:0 12px}
h1{font-size:26px;margin:0}h2{font-size:19px;margin:34px 0 8px;border-bottom:2px solid #111}
p.stamp{color:#555;font-size:12px;margin:2px 0 18px}p.about{color:#444;font-size:13px}
img{max-width:100%;display:block;margin:8px 0}
table{border-collapse:collapse;width:100%;font-size:13px;margin:8px 0}
th,td{text-align:right;padding:2px 8px;border-bottom:1px solid #ccc;vertical-align:top}
th:first-child,td:first-child{text-align:left}.refused{color:#b00;font-weight:bold}
@media print{body{max-width:none;margin:0}h2{break-after:avoid}img,tr{break-inside:avoid}}
)";

std::string base64(std::string_view bytes) {
  std::string out(BASE64_ENCODE_RAW_LENGTH(bytes.size()), '\0');
  base64_encode_raw(out.data(), bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  return out;
}

std::string picture(const char* type, std::string_view bytes, const std::string& words) {
  return fmt::format("<img alt=\"{}\" src=\"data:image/{};base64,{}\">\n", escaped(words), type, base64(bytes));
}

std::string plotted(const Plot& plot) {
  return picture("svg+xml", plot_svg(plot, kPlotWidth, kPlotHeight), plot.title);
}

class Table {
 public:
  explicit Table(const std::vector<std::string>& headings) { row(headings, "th"); }
  void add(const std::vector<std::string>& cells) { row(cells, "td"); }
  [[nodiscard]] std::string html() const { return "<table>\n" + rows_ + "</table>\n"; }

 private:
  void row(const std::vector<std::string>& cells, const char* kind) {
    rows_ += "<tr>";
    for (const std::string& cell : cells) rows_ += fmt::format("<{0}>{1}</{0}>", kind, escaped(cell));
    rows_ += "</tr>\n";
  }
  std::string rows_;
};

std::string share(const std::optional<double>& value) { return value ? fmt::format("{:.1f} %", 100 * *value) : "-"; }

/// The class of a histogram: how many values fall between its begin and the next one's.
PlotLine histogram(const std::vector<double>& values, double width) {
  PlotLine out;
  const double most = values.empty() ? 0 : *std::ranges::max_element(values);
  const auto classes = static_cast<std::size_t>(std::floor(most / width)) + 1;
  out.y.assign(classes, 0);
  for (std::size_t i = 0; i < classes; ++i) out.x.push_back(static_cast<double>(i) * width);
  for (const double value : values) ++out.y[static_cast<std::size_t>(value / width)];
  out.x.push_back(static_cast<double>(classes) * width);  // the last bar's end
  out.y.push_back(0);
  return out;
}

class Page {
 public:
  Page(const Plan& plan, const Show& show, const Films& films, const ReportFacts& facts)
      : plan_(plan), show_(show), films_(films), facts_(facts), stamp_(plan) {}

  std::string html() {
    head();
    summary();
    formations();
    drawing();
    clearance();
    ways();
    crowd();
    buses();
    supplies();
    dark();
    warnings();
    return out_ + "</body></html>\n";
  }

 private:
  void heading(const char* words, const char* about) {
    out_ += fmt::format("<h2>{}</h2>\n<p class=\"about\">{}</p>\n", words, about);
  }
  [[nodiscard]] const std::string& name_of(PerformerIndex who) const { return show_.performers.at(who.at()).name; }
  [[nodiscard]] std::string when(double time_s) const {
    return fmt::format("{:.1f} s, count {:.1f}", time_s, show_.tempo.count_at(instant_at(time_s)));
  }

  void head() {
    out_ += fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
        "content=\"width=device-width\">\n<title>{0}</title>\n<style>{1}</style></head><body>\n<h1>{0}</h1>\n<p "
        "class=\"stamp\">{2}</p>\n",
        escaped(stamp_.title), kStyle, escaped(stamp_.line()));
    if (!plan_.valid) out_ += "<p class=\"refused\">This plan is refused: it breaks its limits.</p>\n";
  }

  void summary() {
    const planner::Measures& all = facts_.measures.show;
    out_ += fmt::format(
        "<p>{} performers on {} x {} cells, {:.0f} s, {} formations. Nobody comes nearer than {:.3f} m to anybody "
        "({} and {}, {}); the limit is {:g} m.</p>\n",
        plan_.performers.size(), plan_.stage.grid.columns(), plan_.stage.grid.rows(),
        to_seconds(plan_.sections.back().end), plan_.formations.size(), all.min_clearance_m,
        escaped(plan_.performers.size() > 1 ? name_of(all.closest_a) : "-"),
        escaped(plan_.performers.size() > 1 ? name_of(all.closest_b) : "-"), when(to_seconds(all.closest_at)),
        plan_.stage.clearance_m);
    Table table({"section", "start", "end", "formations", "outside", "missed", "least clearance", "fastest", "walked"});
    for (std::size_t s = 0; s < plan_.sections.size(); ++s) {
      const PlanSection& section = plan_.sections[s];
      const planner::Measures& m = facts_.measures.sections.at(s);
      table.add({section.name, fmt::format("{:.1f} s", to_seconds(section.start)),
                 fmt::format("{:.1f} s", to_seconds(section.end)), std::to_string(m.formations), share(m.theta_dev),
                 share(m.theta_miss), fmt::format("{:.3f} m", m.min_clearance_m),
                 fmt::format("{:.2f} m/s", m.max_speed_m_s), fmt::format("{:.0f} m", m.total_distance_m)});
    }
    out_ += table.html();
  }

  void formations() {
    heading("Key formations", "From above, downstage below. Dim: who waits in the reserve.");
    std::vector<const Film*> none;
    const auto pictures = static_cast<double>(std::ranges::count_if(plan_.formations, &Formation::key));
    const auto rows = std::max(2.0, std::ceil(std::sqrt(pictures)));
    Canvas canvas = Canvas::png(kSheetWidth, static_cast<int>(std::min(1800.0, 120 + 220 * rows)), kOnScreen.ground);
    draw_contact_sheet(canvas, plan_, show_, stamp_, none, {});
    out_ += picture("png", canvas.finish(), "key formations");
  }

  void drawing() {
    heading("How well the floor draws the film",
            "theta_dev: who stands outside of the picture; theta_miss: the share of the picture that nobody covers (Li "
            "et al. 2020, Eq. 8, each frame).");
    Plot plot{"Outside and missed", "time, s", "share", {}, {}, "", true, false};
    const DrawingSeries& d = facts_.drawing;
    plot.lines = {{"theta_dev", d.time_s, d.dev}, {"theta_miss", d.time_s, d.miss}};
    out_ += plotted(plot);
  }

  void clearance() {
    heading("Clearance", "The least distance of any two people in each second, exact between the samples.");
    const ClearanceSeries& c = facts_.clearance;
    out_ += plotted({"Smallest clearance",
                     "time, s",
                     "m",
                     {{"least", c.time_s, c.least_m}},
                     plan_.stage.clearance_m,
                     "limit",
                     true,
                     false});
    std::vector<std::size_t> order(c.least_m.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return c.least_m[i]; });
    Table table({"closest pairs", "distance", "when"});
    // Two who walk together for long are one line.
    std::set<std::pair<PerformerIndex, PerformerIndex>> told;
    for (const std::size_t i : order) {
      if (told.size() == kClosest || !std::isfinite(c.least_m[i])) break;
      if (!told.insert(std::minmax(c.a[i], c.b[i])).second) continue;
      table.add({name_of(c.a[i]) + " and " + name_of(c.b[i]), fmt::format("{:.3f} m", c.least_m[i]), when(c.at_s[i])});
    }
    out_ += table.html();
    std::vector<double> start;
    for (const TransitionFacts& one : plan_.transitions) start.push_back(to_seconds(one.start));
    out_ += plotted({"Lateness that each move tolerates",
                     "time, s",
                     "s (2 s at most)",
                     {{"tolerated", start, facts_.lag_s}},
                     to_seconds(plan_.stage.lag),
                     "wanted",
                     true,
                     false});
  }

  void ways() {
    const planner::Measures& all = facts_.measures.show;
    heading("Ways", "Who walks how far and how fast; and who much more than the others.");
    const std::vector<double>& walked = facts_.ways.walked_m;
    const double longest = walked.empty() ? 0 : *std::ranges::max_element(walked);
    const double width = std::max(1.0, ticks_of(0, std::max(1.0, longest), 25)[1]);
    out_ += plotted({"Distances", "m walked in the show", "people", {histogram(walked, width)}, {}, "", true, true});
    out_ += plotted(
        {"Fastest walk of each", "m/s", "people", {histogram(facts_.ways.fastest_mps, 0.1)}, {}, "", true, true});
    out_ += fmt::format(
        "<p>Half of the people walk less than {:.0f} m. Gini coefficient of the distances: {:.3f} (0: "
        "all walk alike).</p>\n",
        all.median_distance_m, all.distance_gini);
    std::vector<std::size_t> order(walked.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t p) { return walked[p]; });
    Table table({"who walks most", "walked", "of the median", "fastest"});
    for (const std::size_t p : std::span(order).first(std::min(kWalkers, order.size()))) {
      const std::string times =
          all.median_distance_m > 0 ? fmt::format("{:.2f} x", walked[p] / all.median_distance_m) : "-";
      table.add({name_of(PerformerIndex::of(p)), fmt::format("{:.0f} m", walked[p]), times,
                 fmt::format("{:.2f} m/s", facts_.ways.fastest_mps[p])});
    }
    out_ += table.html();
  }

  void crowd() {
    heading(
        "How calmly the crowd moves",
        "Xu et al. 2015: mutual information of place and direction (I_d, Eq. 17; low: people near each other and far "
        "apart go the same way) and of place and speed (I_v), of those who walk; beside them what chance alone gives, "
        "with the same ways of walking dealt out at random. Spread of the distance to the nearest neighbour (Eq. 24) "
        "and of the way since the key formation before (Eq. 26).");
    const planner::CrowdSeries& c = facts_.crowd;
    const auto line = [&](const char* name, const auto& figure) {
      PlotLine out{name, c.time_s, {}};
      for (const planner::CrowdInstant& at : c.at) out.y.push_back(figure(at));
      return out;
    };
    using At = const planner::CrowdInstant&;
    out_ += plotted({"Mutual information of place with direction and with speed",
                     "time, s",
                     "bits",
                     {line("I_d", [](At at) { return at.information.direction_bits; }),
                      line("I_v", [](At at) { return at.information.speed_bits; }),
                      line("I_d by chance", [](At at) { return at.shuffled_direction_bits; }),
                      line("I_v by chance", [](At at) { return at.shuffled_speed_bits; })},
                     {},
                     "",
                     true,
                     false});
    out_ += fmt::format("<p>R {:g} m, K {}.</p>\n", c.classes.bin_m, c.classes.sectors);
    out_ += plotted({"Local structure and effort",
                     "time, s",
                     "m",
                     {line("sigma_min_dis", [](At at) { return at.sigma_nearest_m; }),
                      line("sigma_curr_eft", [](At at) { return at.sigma_effort_m; })},
                     {},
                     "",
                     true,
                     false});
  }

  void buses() {
    heading("Buses",
            "The hardest switch of each bus: what it has to carry against what it can, 30 % kept for repeats.");
    if (!facts_.buses_missing.empty())
      out_ += fmt::format("<p class=\"refused\">{}</p>\n", escaped(facts_.buses_missing));
    Table table({"bus", "load", "needed", "of", "nodes changed", "at"});
    for (const BusLoad& bus : facts_.buses) {
      table.add({bus.bus, share(bus.busiest), fmt::format("{:.0f} ms", 1000 * bus.needed_s),
                 fmt::format("{:.0f} ms", 1000 * bus.allowed_s), std::to_string(bus.changed), bus.cause});
    }
    out_ += table.html();
  }

  void supplies() {
    if (facts_.supplies.empty()) return;
    heading(
        "Power supplies",
        "What the looks take at the brightest moment of their effects, and on average while the show runs; without a "
        "controller markers show NO-GUIDANCE by themselves. A cue that asks for more is dimmed by one factor.");
    Table table({"supply", "limit", "most", "load", "at", "average", "without controller", "nodes", "dimmed"});
    for (const SupplyFigures& supply : facts_.supplies) {
      const std::string dimmed = dimmed_text(supply);
      table.add({supply.name, fmt::format("{:g} A", supply.limit_a), fmt::format("{:.2f} A", supply.peak_a),
                 share(supply.peak_a / supply.limit_a), peak_text(supply), fmt::format("{:.2f} A", supply.mean_a),
                 fmt::format("{:.2f} A", supply.unguided_a), std::to_string(supply.nodes),
                 dimmed.empty() ? "-" : dimmed});
    }
    out_ += table.html();
  }

  void dark() {
    heading("When a marker fails",
            "Each node, and each supply, dark for the whole show, one at a time: whose cues become unsafe. The worst "
            "ten.");
    const auto unsafe = std::ranges::count_if(facts_.dark, [](const auto& unit) { return unit.unsafe > 0; });
    out_ += fmt::format("<p>{} of {} nodes and supplies make somebody's cue unsafe when they are dark.</p>\n", unsafe,
                        facts_.dark.size());
    Table table({"dark", "not shown", "unsafe", "whose worst cue", "comes near to", "distance"});
    for (const controller::DarkUnit& unit :
         std::span(facts_.dark).first(std::min<std::size_t>(10, facts_.dark.size()))) {
      if (unit.unsafe == 0) break;
      const controller::UnsafeCue& worst = unit.worst.front();
      table.add({unit.name, std::to_string(unit.not_shown), std::to_string(unit.unsafe),
                 fmt::format("{} to {}, {}", name_of(worst.who), plan_.stage.grid.name(worst.place),
                             when(to_seconds(worst.told))),
                 name_of(worst.other), fmt::format("{:.2f} m", worst.distance_m)});
    }
    out_ += table.html();
  }

  void warnings() {
    heading("Warnings", "");
    std::string list;
    for (const Diagnostic& warning : facts_.warnings) list += "<li>" + escaped(to_text(warning)) + "</li>\n";
    for (const PlanSection& section : plan_.sections) {
      for (const std::string& note : section.notes) {
        list += fmt::format("<li>{}: {}</li>\n", escaped(section.name), escaped(note));
      }
    }
    out_ += list.empty() ? "<p>None.</p>\n" : "<ul>\n" + list + "</ul>\n";
  }

  const Plan& plan_;
  const Show& show_;
  const Films& films_;
  const ReportFacts& facts_;
  Stamp stamp_;
  std::string out_;
};

}  // namespace

std::string report_html(const Plan& plan, const Show& show, const Films& films, const ReportFacts& facts) {
  return Page(plan, show, films, facts).html();
}

}  // namespace footlight::app
