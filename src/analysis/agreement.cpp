#include "analysis/agreement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/mean.h"
#include "base/numbers.h"
#include "base/rng.h"

namespace filum {
namespace {

constexpr int kDraws = 2000;
constexpr std::size_t kLeastForInterval = 5;  // sessions

using PointsByItem = std::map<std::string, int>;
using Sessions = std::map<std::string, PointsByItem>;          // by session
using Raters = std::map<std::string, Sessions>;                // by rater's code
using Pairs = std::pair<std::vector<double>, std::vector<double>>;

double variance_of(const std::vector<double>& x, double mean) {
  double sum = 0.0;
  for (const double v : x) sum += (v - mean) * (v - mean);
  return sum / static_cast<double>(x.size());
}

void interval(const Pairs& p, Agreement& out) {
  const std::size_t n = p.first.size();
  if (n < kLeastForInterval) return;
  Rng rng(n);
  std::vector<double> found;
  std::vector<double> a(n), b(n);
  for (int k = 0; k < kDraws; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(rng.below(n));
      a[i] = p.first[at];
      b[i] = p.second[at];
    }
    if (const double kappa = weighted_kappa(a, b); std::isfinite(kappa)) found.push_back(kappa);
  }
  if (found.size() < kDraws / 2) return;
  std::sort(found.begin(), found.end());
  out.low = found[static_cast<std::size_t>(0.025 * static_cast<double>(found.size() - 1))];
  out.high = found[static_cast<std::size_t>(0.975 * static_cast<double>(found.size() - 1))];
}

Agreement compare(const Pairs& p) {
  Agreement g;
  g.low = g.high = g.icc = kNaN;
  g.sessions = static_cast<int>(p.first.size());
  for (std::size_t i = 0; i < p.first.size(); ++i) g.same += (p.first[i] == p.second[i] ? 1.0 : 0.0) / g.sessions;
  g.bias = mean_of(p.first) - mean_of(p.second);
  g.kappa = weighted_kappa(p.first, p.second);
  if (std::isfinite(g.kappa)) interval(p, g);
  if (g.sessions < 2) return g;
  Eigen::MatrixXd x(g.sessions, 2);
  for (int i = 0; i < g.sessions; ++i) x.row(i) << p.first[static_cast<std::size_t>(i)], p.second[static_cast<std::size_t>(i)];
  g.icc = icc_2_1(x);
  return g;
}

/// Items that all of these mark in some session together, in order.
std::vector<std::string> common_items(const std::vector<const Sessions*>& raters) {
  std::set<std::string> items;
  for (const auto& [session, points] : *raters[0])
    for (const auto& [item, value] : points)
      if (std::all_of(raters.begin(), raters.end(), [&, s = session, i = item](const Sessions* r) { return r->contains(s) && r->at(s).contains(i); })) items.insert(item);
  return {items.begin(), items.end()};
}

/// Points of each rater for the sessions in which all marked `items`: their sum.
std::vector<std::vector<double>> together(const std::vector<const Sessions*>& raters, const std::vector<std::string>& items) {
  std::vector<std::vector<double>> columns(raters.size());
  for (const auto& [session, points] : *raters[0]) {
    std::vector<double> row;
    for (const Sessions* r : raters) {
      const auto at = r->find(session);
      if (at == r->end() || !std::all_of(items.begin(), items.end(), [&](const std::string& i) { return at->second.contains(i); })) break;
      double sum = 0.0;
      for (const std::string& i : items) sum += at->second.at(i);
      row.push_back(sum);
    }
    if (row.size() < raters.size()) continue;
    for (std::size_t k = 0; k < row.size(); ++k) columns[k].push_back(row[k]);
  }
  return columns;
}

template <class Add>
void each_item(const std::vector<const Sessions*>& raters, Add add) {
  const std::vector<std::string> items = common_items(raters);
  for (const std::string& item : items) add(item, together(raters, {item}));
  if (items.size() > 1) add("total", together(raters, items));
}

void of_scale(const std::string& scale, const Raters& raters, std::vector<Agreement>& all) {
  std::vector<std::string> codes;
  for (const auto& [code, sessions] : raters)
    if (code != kSimulatorCode) codes.push_back(code);
  const std::vector<std::string> people = codes;
  if (raters.contains(kSimulatorCode)) codes.emplace_back(kSimulatorCode);
  for (std::size_t i = 0; i < codes.size(); ++i)
    for (std::size_t j = i + 1; j < codes.size(); ++j)
      each_item({&raters.at(codes[i]), &raters.at(codes[j])}, [&](const std::string& item, const std::vector<std::vector<double>>& columns) {
        if (columns[0].empty()) return;
        Agreement g = compare({columns[0], columns[1]});
        g.scale = scale;
        g.item = item;
        g.a = codes[i];
        g.b = codes[j];
        all.push_back(g);
      });
  if (people.size() < 3) return;
  std::vector<const Sessions*> everybody;
  for (const std::string& code : people) everybody.push_back(&raters.at(code));
  each_item(everybody, [&](const std::string& item, const std::vector<std::vector<double>>& columns) {
    const auto n = static_cast<Eigen::Index>(columns[0].size());
    if (n < 2) return;
    Eigen::MatrixXd x(n, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) x.col(static_cast<Eigen::Index>(k)) = Eigen::Map<const Eigen::VectorXd>(columns[k].data(), n);
    all.push_back({scale, item, "raters", "", static_cast<int>(n), static_cast<int>(columns.size()), kNaN, kNaN, kNaN, kNaN, kNaN, icc_2_1(x)});
  });
}

std::string number(double value) {
  if (!std::isfinite(value)) return "";
  return nlohmann::json(value).dump();
}

}  // namespace

double weighted_kappa(const std::vector<double>& a, const std::vector<double>& b) {
  double seen = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) seen += (a[i] - b[i]) * (a[i] - b[i]) / static_cast<double>(a.size());
  const double ma = mean_of(a), mb = mean_of(b);
  const double chance = variance_of(a, ma) + variance_of(b, mb) + (ma - mb) * (ma - mb);
  return chance > 1e-12 && variance_of(a, ma) + variance_of(b, mb) > 1e-12 ? 1.0 - seen / chance : kNaN;
}

double icc_2_1(const Eigen::MatrixXd& x) {
  const auto n = static_cast<double>(x.rows()), k = static_cast<double>(x.cols());
  const double grand = x.mean();
  const Eigen::VectorXd rows = x.rowwise().mean();
  const Eigen::RowVectorXd columns = x.colwise().mean();
  const double bms = k * (rows.array() - grand).square().sum() / (n - 1.0);
  const double jms = n * (columns.array() - grand).square().sum() / (k - 1.0);
  const Eigen::MatrixXd rest = (x.colwise() - rows).rowwise() - (columns.array() - grand).matrix();
  const double ems = rest.squaredNorm() / ((n - 1.0) * (k - 1.0));
  const double below = bms + (k - 1.0) * ems + k * (jms - ems) / n;
  return below > 1e-12 ? (bms - ems) / below : kNaN;
}

std::vector<Agreement> agreements(const std::vector<Rating>& ratings) {
  std::map<std::string, Raters> scales;
  for (const Rating& r : ratings)
    for (const ItemMark& m : r.marks) scales[r.scale][r.rater][r.session][m.item] = m.points;
  std::vector<Agreement> all;
  for (const auto& [scale, raters] : scales) of_scale(scale, raters, all);
  return all;
}

nlohmann::ordered_json agreement_json(const std::vector<Agreement>& all, const std::vector<Rating>& ratings) {
  using Json = nlohmann::ordered_json;
  const auto finite = [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); };
  Json rows = Json::array(), given = Json::array();
  for (const Agreement& g : all)
    rows.push_back({{"scale", g.scale}, {"item", g.item}, {"a", g.a}, {"b", g.b}, {"sessions", g.sessions}, {"raters", g.raters}, {"same", finite(g.same)},
                    {"bias", finite(g.bias)}, {"kappa", finite(g.kappa)}, {"kappa_low", finite(g.low)}, {"kappa_high", finite(g.high)}, {"icc", finite(g.icc)}});
  for (const Rating& r : ratings) {
    Json marks = Json::object();
    for (const ItemMark& m : r.marks) marks[m.item] = m.points;
    given.push_back({{"session", r.session}, {"task", r.task}, {"scale", r.scale}, {"rater", r.rater}, {"stored", r.stored_utc}, {"marks", marks}});
  }
  return {{"statistics", "kappa: Cohen 1968, quadratic weights, 95 % by resampling sessions; icc: Shrout and Fleiss 1979, ICC(2,1)"},
          {"simulator", "marks of the code \"simulator\" are estimates, not validated"},
          {"agreement", rows},
          {"ratings", given}};
}

std::string agreement_csv(const std::vector<Agreement>& all) {
  std::string text = "scale,item,a,b,sessions,raters,same_share,bias_points,kappa,kappa_low,kappa_high,icc_2_1\r\n";
  for (const Agreement& g : all)
    text += g.scale + "," + g.item + "," + g.a + "," + g.b + "," + std::to_string(g.sessions) + "," + std::to_string(g.raters) + "," + number(g.same) + "," + number(g.bias) + "," +
            number(g.kappa) + "," + number(g.low) + "," + number(g.high) + "," + number(g.icc) + "\r\n";
  return text;
}

std::string ratings_csv(const std::vector<Rating>& ratings) {
  std::string text = "session,task,scale,rater,stored_utc,item,points\r\n";
  for (const Rating& r : ratings)
    for (const ItemMark& m : r.marks)
      text += r.session + "," + r.task + "," + r.scale + "," + r.rater + "," + r.stored_utc + "," + m.item + "," + std::to_string(m.points) + "\r\n";
  return text;
}

}  // namespace filum
